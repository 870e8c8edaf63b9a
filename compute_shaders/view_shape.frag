// view_shape.frag - a shape in the light; PALPATE_HIDDEN: the part of it behind the surface, which shines through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) flat in vec3 colour;
layout(location = 0) out vec4 picture;

void main()
{
    vec3 lit = min(vec3(1), colour * litBy(normalize(normal)));
#ifdef PALPATE_HIDDEN
    picture = vec4(lit, frame.hiddenShare);
#else
    picture = vec4(lit, 1);
#endif
}
