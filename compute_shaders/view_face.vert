// view_face.vert - corners of the cloud's triangles, if it has any.
// Writes     normal, depth [m] and colour for the light pass; with PALPATE_FAST the lit colour alone
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(std430, binding = kBindSplats) readonly buffer Splats { ViewSplat splats[]; };
layout(std430, binding = kBindFaces) readonly buffer Faces { uint corners[]; };

#ifdef PALPATE_FAST
layout(location = 0) out vec4 colour;
#else
layout(location = 0) out vec4 surface;
layout(location = 1) out vec3 colour;
#endif

void main()
{
    ViewSplat splat = splats[corners[gl_VertexIndex]];
    vec3  place     = (frame.viewFromWorld * vec4(splat.position, 1)).xyz;
    vec3  normal    = mat3(frame.viewFromWorld) * splat.normal;
    float facing    = dot(normal, toEyeFrom(place));
    float side      = facing < 0.0 ? -1.0 : 1.0;
    vec4  packed    = unpackUnorm4x8(splat.colour);
#ifdef PALPATE_FAST
    colour = vec4(litPoint(packed, side * normal, side * facing, side, place), 1);
#else
    colour  = packed.rgb;
    surface = vec4(side * normal, -place.z);
#endif
    gl_Position = frame.clipFromView * vec4(place, 1);
}
