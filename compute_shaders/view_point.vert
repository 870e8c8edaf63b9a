// view_point.vert - a point of the cloud for pictures that move: a lit disc of pixels, one corner in place of six and
// the light once per point in place of once per pixel.
// Reads      splats  Writes  the lit colour, and the disc's place in its square
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(std430, binding = kBindSplats) readonly buffer Splats { ViewSplat splats[]; };

layout(location = 0) flat out vec4 colour;
layout(location = 1) flat out vec2 slope;  // of the tangent plane against that of the picture [1]
layout(location = 2) flat out vec3 toEye;  // its first two [1], and half the square's side over the disc's radius [1]

void main()
{
    const float kLeastPixels = 0.7; // least radius of a disc that covers a pixel's middle
    const float kSteepest    = 0.2; // cosine of the slope beyond which discs get no narrower
    ViewSplat splat = splats[gl_VertexIndex];
    vec3  centre    = (frame.viewFromWorld * vec4(splat.position, 1)).xyz;
    vec3  normal    = mat3(frame.viewFromWorld) * splat.normal;
    vec4  packed    = unpackUnorm4x8(splat.colour);
    vec3  eye       = toEyeFrom(centre);
    float facing    = dot(normal, eye);
    float side      = facing < 0.0 ? -1.0 : 1.0;
    normal *= side;
    colour       = vec4(litPoint(packed, normal, side * facing, side, centre), 1);
    slope        = normal.xy / max(side * facing, kSteepest);
    float steep  = sqrt(max(0.0, 1.0 - normal.z * normal.z));
    toEye        = vec3(eye.xy, 1.0 + steep * length(eye.xy)); // seen obliquely, a disc may be longer than its radius
    gl_Position  = frame.clipFromView * vec4(centre, 1);
    gl_PointSize = 2.0 * toEye.z * max(kLeastPixels, abs(splat.radius) * pixelsPerMetre(max(1e-6, -centre.z)));
    if (splat.radius < 0.0 && facing < 0.0) gl_Position = kUnseen;
}
