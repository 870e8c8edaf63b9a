// view_ground.frag - the background.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(location = 0) out vec4 picture;

void main() { picture = groundAt(gl_FragCoord.y); }
