// plate_lift.comp - deflection of the points, where the host reads it; 0 outside the grid.
// Domain     x: one invocation per point that there is room for; z: loads
// Reads      layout, points, answer (real), metres per unit of each load (float)
// Writes     deflection [m], points in the order of the host, one load after the other
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/point_layout.h"

layout(std430, binding = 0) readonly buffer Layout { PointLayout grid; };
layout(std430, binding = 1) readonly buffer Points { ScatteredPoint points[]; };
layout(std430, binding = 2) readonly buffer Answer { real answer[]; };
layout(std430, binding = 3) readonly buffer Unit { float metres[]; };
layout(std430, binding = 4) writeonly buffer Deflection { float w[]; };

int base, stride;
real deflection(int i, int j) { return answer[base + i * stride + j]; }

#include "compute_shaders/shared/plate_lift.h"

void main()
{
    PointLayout g = grid;
    uint load = gl_GlobalInvocationID.z, n = gl_GlobalInvocationID.x;
    if (n >= g.points) return;
    stride = g.cellsZ + 1;
    base = int(load) * (g.cellsX + 1) * stride;
    w[load * g.points + points[n].number] = float(liftedAt(g, points[n].x, points[n].z)) * metres[load];
}
