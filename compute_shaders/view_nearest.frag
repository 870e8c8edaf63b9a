// view_nearest.frag - first pass: the nearest depth of all discs. Only the core of a disc counts, so that an
// object ends where its points end.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(location = 0) in vec2  within;
layout(location = 1) in float depth;
layout(location = 2) flat in float core;
layout(location = 0) out float nearest;

void main()
{
    if (dot(within, within) > core * core) discard;
    nearest = depth;
}
