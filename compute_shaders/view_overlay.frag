// view_overlay.frag - a pixel of an overlay, blended over the picture by its alpha.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(std430, binding = kBindOverlay) readonly buffer Overlay { uint pixels[]; };

layout(location = 0) out vec4 picture;

void main() { picture = unpackUnorm4x8(pixels[uint(gl_FragCoord.y) * uint(frame.width) + uint(gl_FragCoord.x)]); }
