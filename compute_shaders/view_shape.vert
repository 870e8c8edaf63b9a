// view_shape.vert - corners of the triangles of proxy, arrows and outline.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(std430, binding = kBindShapes) readonly buffer Shapes { ViewCorner corners[]; };

layout(location = 0) out vec3 normal;
layout(location = 1) flat out vec3 colour;

void main()
{
    ViewCorner corner = corners[gl_VertexIndex];
    normal            = mat3(frame.viewFromWorld) * corner.normal;
    colour            = unpackUnorm4x8(corner.colour).rgb;
    gl_Position       = frame.clipFromView * (frame.viewFromWorld * vec4(corner.position, 1));
}
