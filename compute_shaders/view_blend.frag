// view_blend.frag - second pass, adds up: the discs near the nearest depth, weighted by the distance from their
// middles. Source     the idea of averaging overlapping splats: Zwicker et al. 2001, "Surface splatting"
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(binding = kBindDepth) uniform texture2D nearestDepth;

layout(location = 0) in vec2  within;
layout(location = 1) in float depth;
layout(location = 2) flat in vec3  normal;
layout(location = 3) flat in vec3  colour;
layout(location = 4) flat in float radius;
layout(location = 0) out vec4 normals;
layout(location = 1) out vec4 colours;

void main()
{
    const float kSameSurface = 0.7; // of a radius: discs farther from the nearest core are another surface [1]
    float r2 = dot(within, within);
    if (r2 > 1.0) discard;
    float nearest = texelFetch(nearestDepth, ivec2(gl_FragCoord.xy), 0).r;
    float behind  = depth - nearest;
    if (abs(behind) > kSameSurface * radius) discard;
    float weight = (1.0 - r2) * (1.0 - r2) * (1.0 - r2);
    normals      = weight * vec4(normal, 1);
    colours      = weight * vec4(colour, behind * pixelsPerMetre(nearest)); // of metres, half precision loses most
}
