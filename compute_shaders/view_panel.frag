// view_panel.frag - a pixel of the panels, which are drawn when they change and laid over every picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(binding = kBindPanels) uniform texture2D panels;

layout(location = 0) out vec4 picture;

void main() { picture = texelFetch(panels, ivec2(gl_FragCoord.xy), 0); }
