// view_point.frag - the part of a point's square that its disc covers.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(location = 0) flat in vec4 colour;
layout(location = 1) flat in vec2 slope;
layout(location = 2) flat in vec3 toEye;
layout(location = 0) out vec4 picture;

void main()
{
    // Distance towards the eye at which the ray through the pixel meets the tangent plane, in units of the disc's
    // radius.
    vec2  at   = toEye.z * vec2(2.0 * gl_PointCoord.x - 1.0, 1.0 - 2.0 * gl_PointCoord.y);
    float rise = dot(slope, at);
    if (dot(at, at) - 2.0 * rise * dot(toEye.xy, at) + rise * rise > 1.0) discard;
    picture = colour;
}
