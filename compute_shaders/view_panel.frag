// view_panel.frag - a pixel of the panels, which were drawn when they changed and are laid over every picture since.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(binding = kBindPanels) uniform texture2D panels;

layout(location = 0) out vec4 picture;

void main() { picture = texelFetch(panels, ivec2(gl_FragCoord.xy), 0); }
