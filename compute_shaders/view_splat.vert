// view_splat.vert - a point of the cloud as a disc in its tangent plane: six corners of the square around it.
// Reads      splats
// Writes     place within the disc (-1 to 1), depth [m], normal and colour; with PALPATE_DEPTH the first two and
//            the core
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(std430, binding = kBindSplats) readonly buffer Splats { ViewSplat splats[]; };

layout(location = 0) out vec2  within;
layout(location = 1) out float depth;
#ifdef PALPATE_DEPTH
layout(location = 2) flat out float core;
vec3  normal, colour;
float radius;
#else
layout(location = 2) flat out vec3  normal;
layout(location = 3) flat out vec3  colour;
layout(location = 4) flat out float radius;
#endif

void main()
{
    const vec2 kCorners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));
    ViewSplat splat = splats[gl_VertexIndex / 6];
    vec3 centre     = (frame.viewFromWorld * vec4(splat.position, 1)).xyz;
    normal          = mat3(frame.viewFromWorld) * splat.normal;
    bool away       = dot(normal, toEyeFrom(centre)) < 0.0;
    if (away) normal = -normal;
    colour = unpackUnorm4x8(splat.colour).rgb;

    // A disc smaller than a pixel may fall between the pixels' middles, so that a dense cloud would show holes.
    const float kLeastPixels = 1.0;
    radius      = max(abs(splat.radius), kLeastPixels / pixelsPerMetre(max(1e-6, -centre.z)));
    vec3 aside  = normalize(cross(normal, abs(normal.x) < 0.7 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    within      = kCorners[gl_VertexIndex % 6];
#ifdef PALPATE_DEPTH
    core = unpackUnorm4x8(splat.colour).a; // the rest would be discarded
    within *= core;
#endif
    vec3 place  = centre + radius * (within.x * aside + within.y * cross(normal, aside));
    depth       = -place.z;
    gl_Position = away && splat.radius < 0.0 ? kUnseen : frame.clipFromView * vec4(place, 1);
}
