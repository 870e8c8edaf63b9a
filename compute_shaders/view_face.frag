// view_face.frag - a triangle of the cloud for the light pass; with PALPATE_FAST already lit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

#ifdef PALPATE_FAST
layout(location = 0) in vec4 colour;
layout(location = 0) out vec4 picture;

void main() { picture = colour; }
#else
layout(location = 0) in vec4 place;
layout(location = 1) in vec3 colour;
layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 albedo;

void main()
{
    surface = vec4(normalize(place.xyz), place.w);
    albedo  = vec4(colour, 1);
}
#endif
