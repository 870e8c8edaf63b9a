#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/tools/plot/axis.h"
#include "engine/tools/plot/colour_map.h"

namespace palp {

enum class Ground { light, dark };

/// The meaning of a surface's colours.
struct ViewColours {
    ColourMap   map   = ColourMap::viridis;
    Scale       scale = Scale::linear;
    ValueRange  range;          ///< its ends [unit]
    std::string quantity;       ///< "deflection"
    std::string unit;           ///< SI; the legend chooses the prefix
    bool        goesOn = false; ///< some values lie above the range
};

struct ViewSegment {
    glm::dvec3 from{}, to{}; ///< [m]
};

/// A pen in the user's hand: its tip is the HIP.
struct ViewStylus {
    glm::dvec3 tip{};                  ///< [m]
    glm::dvec3 axis{0, 0, 1};          ///< from the tip to the other end [1]
    glm::dvec3 side{0, 1, 0};          ///< where its button is, perpendicular to the axis [1]
    double     length = 0, radius = 0; ///< [m]
};

/// A small round mark that faces the eye.
struct ViewDot {
    glm::dvec3 position{}; ///< [m]
    double     radius = 0; ///< [m]
    Rgb8       colour;
};

/// The content of one picture. The arrays are the caller's and must live while it is drawn.
struct ViewScene {
    std::span<const glm::dvec3> positions; ///< of the points, deformed [m]
    std::span<const glm::dvec3> normals;   ///< as many [1], unit; their side does not matter
    std::span<const double>     radii;     ///< as many, of the discs whose means are the surface [m]
    std::span<const double>     cores;     ///< as many, of the part of each that hides what is behind [m]
    std::span<const double>     values;    ///< as many [unit of `colours`], NaN for none; empty: one plain colour
    ViewColours                 colours;
    /// As many, or none: how far a dent's surroundings rise above it, on the side of the normal [1]. Only pictures of
    /// Detail::fast need it, all others see it in the depths.
    std::span<const double> hollows;
    /// As many, or none: 1 where only the side of the normal can be seen, as of closed objects; 0: both sides.
    std::span<const std::uint8_t> oneSided;
    /// Triangles of points; empty: discs are the surface.
    std::span<const Triangle> faces;
    std::vector<ViewDot>      dots;

    std::optional<glm::dvec3>  proxy;            ///< a ball [m]
    std::optional<glm::dvec3>  hip;              ///< an octahedron, seen through the surface [m]
    double                     markerRadius = 0; ///< of both [m]
    std::optional<ViewStylus>  stylus;           ///< of a hand whose device senses how it is turned
    std::optional<ViewSegment> force;            ///< on the hand
    std::optional<ViewSegment> normal;
    double                     arrowRadius = 0;   ///< of the force's shaft; the normal's is thinner [m]
    std::vector<ViewSegment>   outline;           ///< of the patch
    std::vector<ViewSegment>   brush;             ///< rim of what paints
    std::vector<ViewSegment>   sphere;            ///< lines of the fitted sphere
    std::vector<ViewSegment>   bulging, hollow;   ///< strokes along principal curvatures
    double                     outlineRadius = 0; ///< of all lines [m]

    double cueRadius = 0; ///< of the surroundings in whose light hollows are darker [m]; 0: none are
    double evenLight =
        0; ///< share of the light that comes from everywhere alike: the more, the more colours are read [1]

    Ground      ground = Ground::light;
    std::string title; ///< above the picture
    std::string note;  ///< a second, smaller line; may be empty
};

/// Colours of the things in a picture, apart from each other for every kind of colour vision and in shape too.
inline constexpr Rgb8 kProxyColour = kNamedColours[4], kHipColour = kNamedColours[3], kForceColour = kNamedColours[1],
                      kNormalColour = kNamedColours[5], kSphereColour = kNamedColours[2],
                      kProjectedColour = kNamedColours[0], kPlainColour = {206, 198, 186},
                      kStylusColour = {120, 118, 130}, kBulgingColour = kNamedColours[0],
                      kHollowColour = kNamedColours[1];

/// Returns the colour of outlines and texts on this ground.
[[nodiscard]] constexpr Rgb8 inkOn(Ground ground)
{
    return ground == Ground::light ? Rgb8{26, 26, 26} : Rgb8{235, 235, 235};
}

} // namespace palp
