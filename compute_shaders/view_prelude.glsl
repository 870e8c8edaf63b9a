// view_prelude.glsl - common to all shaders of a picture: the frame, and conversions of depths, places and pixels.
#extension GL_EXT_samplerless_texture_functions : require

#include "compute_shaders/shared/view_layout.h"

layout(std140, binding = kBindFrame) uniform Frame { ViewFrame frame; };

/// Returns the place in view space of a point of the picture at a depth.
/// \param at     [px]
/// \param depth  [m]
vec3 placeAt(vec2 at, float depth)
{
    vec2 half_ = vec2(frame.widthAtOne, frame.heightAtOne) * (frame.orthographic == 1u ? 1.0 : depth);
    vec2 place = vec2(2.0 * at.x / frame.width - 1.0, 1.0 - 2.0 * at.y / frame.height);
    return vec3(place * half_, -depth);
}

/// Returns the pixels per metre at a depth [px/m].
float pixelsPerMetre(float depth)
{
    return 0.5 * frame.width / (frame.widthAtOne * (frame.orthographic == 1u ? 1.0 : depth));
}

/// Returns the background's colour at a height in the picture [px].
vec4 groundAt(float y) { return vec4(mix(frame.groundAbove, frame.groundBelow, y / frame.height), 1); }

/// Returns the unit vector from a place in view space to the eye.
vec3 toEyeFrom(vec3 place) { return frame.orthographic == 1u ? vec3(0, 0, 1) : normalize(-place); }

/// A position outside the picture, for corners on a closed object's inner side, which are not drawn.
const vec4 kUnseen = vec4(2, 2, 2, 1);

// Light from the upper left, as in printed relief.
const vec3 kLight = normalize(vec3(-0.75, 0.50, 0.43));

/// Returns the brightness of a matt surface in the light [1].
float litBy(vec3 normal)
{
    const float kAmbient = 0.46, kDiffuse = 0.80; // of the light [1]
    const float kWrap = 0.25;                     // reach of the light around the object [1]
    float lit = max(0.0, (dot(normal, kLight) + kWrap) / (1.0 + kWrap));
    float relief = kAmbient + kDiffuse * lit * lit;
    return relief + frame.even * (1.0 - relief);
}

/// Returns the light's reflection on a smooth surface [1].
float reflection(vec3 normal, vec3 place)
{
    float c = max(0.0, dot(normal, normalize(kLight + toEyeFrom(place))));
    float c2 = c * c, c4 = c2 * c2, c8 = c4 * c4;
    return c8 * c8 * c8; // the power of 24
}

/// Returns the change of brightness of a hump or a hollow [1].
/// \param facing  cosine to the eye: at grazing slopes depths differ for other reasons
float cueOf(float hollow, float facing)
{
    const float kDarkest = -0.45, kLightest = 0.18;
    return (1.0 - frame.even) * clamp(-frame.cueGain * facing * facing * hollow, kDarkest, kLightest);
}

/// Returns the colour of a lit point of a fast picture.
/// \param packed  its colour and hollowness, see ViewSplat
/// \param side  -1 where the normal was turned round to face the eye
vec3 litPoint(vec4 packed, vec3 normal, float facing, float side, vec3 place)
{
    float hollow = side * (packed.a - 128.0 / 255.0) / float(kHollow);
    return min(vec3(1), packed.rgb * litBy(normal) * (1.0 + cueOf(hollow, facing)) + frame.shine * reflection(normal, place));
}
