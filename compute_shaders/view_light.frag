// view_light.frag - last pass: light, hollows and humps, the background; writes the depth for the shapes that follow.
// The cue is the rise of the surroundings above the tangent plane here, in units of their distance. Hollows are darker
// and humps lighter, so that a dent shows although its slope is slight.
// Source     after Luft et al. 2006, "Image enhancement by unsharp masking the depth buffer", with the tangent plane in
//            place of a blurred depth: a slope is no hollow
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(binding = kBindSurface) uniform texture2D surfaces;
layout(binding = kBindAlbedo) uniform texture2D albedos;

layout(location = 0) out vec4 picture;

// A spiral by the golden angle, evenly spread over the unit disc: sqrt((n + 1/2) / 16) (cos, sin)(2.39996 n).
const int  kTaps = 16;
const vec2 kSpiral[kTaps] = vec2[](
    vec2(0.1768, 0.0000), vec2(-0.2258, 0.2068), vec2(0.0346, -0.3938), vec2(0.2846, 0.3712),
    vec2(-0.5222, -0.0924), vec2(0.4947, -0.3147), vec2(-0.1655, 0.6155), vec2(-0.3156, -0.6076),
    vec2(0.6846, 0.2500), vec2(-0.7123, 0.2940), vec2(0.3434, -0.7337), vec2(0.2537, 0.8089),
    vec2(-0.7647, -0.4432), vec2(0.8971, -0.1972), vec2(-0.5475, 0.7788), vec2(-0.1265, -0.9761));

/// Returns the mean rise of the surroundings within a radius [1].
float hollowness(vec2 at, vec3 place, vec3 normal, float radius)
{
    const float kLeastPixels = 3.0;
    const float kAcrossEdge  = 0.5; // cosine: beyond a sharp edge lies another face, and no hump
    float pixels = max(kLeastPixels, radius * pixelsPerMetre(-place.z));
    float sum = 0.0, weights = 0.0;
    for (int n = 0; n < kTaps; ++n) {
        ivec2 texel = clamp(ivec2(at + pixels * kSpiral[n]), ivec2(0), ivec2(frame.width, frame.height) - 1);
        vec4  there = texelFetch(surfaces, texel, 0);
        if (there.w == 0.0 || dot(there.xyz, normal) < kAcrossEdge) continue;
        vec3  rise     = placeAt(vec2(texel) + 0.5, there.w) - place;
        float distance = length(rise);
        float weight   = max(0.0, 1.0 - distance / (2.0 * radius)); // a point far in depth belongs to another surface
        sum += weight * dot(rise, normal) / (distance + 0.1 * radius);
        weights += weight;
    }
    return weights > 0.0 ? sum / max(weights, 0.25 * float(kTaps)) : 0.0;
}

void main()
{
    vec2 at      = gl_FragCoord.xy;
    vec4 surface = texelFetch(surfaces, ivec2(at), 0);
    if (surface.w == 0.0) {
        picture      = groundAt(at.y);
        gl_FragDepth = 1.0;
        return;
    }
    const float kWider   = 3.5;                     // a second, wider radius finds wide and shallow dents [1]
    vec3  place  = placeAt(at, surface.w);
    float hollow = hollowness(at, place, surface.xyz, frame.cueRadius) +
                   hollowness(at, place, surface.xyz, kWider * frame.cueRadius);
    float bright = litBy(surface.xyz) * (1.0 + cueOf(hollow, max(0.0, dot(surface.xyz, toEyeFrom(place)))));
    vec3  colour = texelFetch(albedos, ivec2(at), 0).rgb * bright + frame.shine * reflection(surface.xyz, place);
    picture      = vec4(min(vec3(1), colour), 1);
    vec4 clip    = frame.clipFromView * vec4(place, 1);
    gl_FragDepth = clip.z / clip.w;
}
