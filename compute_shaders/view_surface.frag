// view_surface.frag - third pass: means from sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(binding = kBindDepth) uniform texture2D nearestDepth;
layout(binding = kBindNormals) uniform texture2D normalSums;
layout(binding = kBindColours) uniform texture2D colourSums;

layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 albedo;

void main()
{
    ivec2 at      = ivec2(gl_FragCoord.xy);
    vec4  normals = texelFetch(normalSums, at, 0);
    vec4  colours = texelFetch(colourSums, at, 0);
    surface       = vec4(0);
    albedo        = vec4(0);
    if (normals.w <= 0.0 || dot(normals.xyz, normals.xyz) == 0.0) return;
    float nearest = texelFetch(nearestDepth, at, 0).r;
    float behind  = colours.w / (normals.w * pixelsPerMetre(nearest));
    surface = vec4(normalize(normals.xyz), nearest + behind);
    albedo  = vec4(colours.rgb / normals.w, 1);
}
