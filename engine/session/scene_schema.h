#pragma once
#include <string_view>

// Internal to the session layer: JSON Schema of the values that no kind of key describes.

namespace palp {

// clang-format off
/// A law of stiffness, see parseSpatialLaw().
inline constexpr std::string_view kLawSchema = R"({"anyOf": [{"type": "string"}, {"type": "object", "required": ["law"], "additionalProperties":
false, "properties": {"law": {"enum": ["constant", "linear", "hyperbolic", "exponential",
"gaussian", "disc", "box", "checker", "grid"]}, "value": {"description": "of constant [Pa]", "type":
"number", "exclusiveMinimum": 0}, "from": {"description": "[Pa]", "type": "number",
"exclusiveMinimum": 0}, "to": {"description": "[Pa]", "type": "number", "exclusiveMinimum": 0},
"axis": {"description": "along which linear, hyperbolic and exponential run across the cloud",
"enum": ["x", "y", "z"]}, "start": {"description": "of the line, instead of an axis [m]", "type":
"array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, "end": {"description": "of the
line [m]", "type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, "centre":
{"description": "of gaussian and disc [m]", "type": "array", "items": {"type": "number"},
"minItems": 3, "maxItems": 3}, "centres": {"description": "of gaussian and disc [m]", "type":
"array", "items": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
"minItems": 1}, "sigma": {"description": "standard deviation of gaussian [m]", "type": "number",
"exclusiveMinimum": 0}, "radius": {"description": "of disc [m]", "type": "number",
"exclusiveMinimum": 0}, "edge": {"description": "of checker's cubes [m]", "type": "number",
"exclusiveMinimum": 0}, "low": {"description": "corner of box [m]", "type": "array", "items":
{"type": "number"}, "minItems": 3, "maxItems": 3}, "high": {"description": "opposite corner of box
[m]", "type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, "file": {"description": "of grid: a .npy, .nii or
.nii.gz file", "type": "string"}, "factor": {"description": "of grid: on the values of its file, 1000
for kPa [1]", "type": "number", "exclusiveMinimum": 0}, "outside": {"description": "of grid: where its
file has no value [Pa]", "type": "number", "exclusiveMinimum": 0}, "along": {"description": "of grid:
at the points, or through the sheet below each", "enum": ["points", "thickness"]}, "length_unit": {"description": "of
a grid's .nii file that states none", "enum": ["m", "mm", "cm", "um", "km", "in", "ft"]}, "origin":
{"description": "of a grid's .npy file: place of the first value [m]", "type": "array", "items":
{"type": "number"}, "minItems": 3, "maxItems": 3}, "spacing": {"description": "of a grid's .npy file:
between two values along the axes [m]", "anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"type":
"array", "items": {"type": "number", "exclusiveMinimum": 0}, "minItems": 3, "maxItems": 3}]}}}]})";

// clang-format on

} // namespace palp
