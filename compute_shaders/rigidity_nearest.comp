// rigidity_nearest.comp - rigidity at the nodes, that of the nearest point; see nearest_point.h.
// Domain     one invocation per node
// Reads      layout, bucket starts, points
// Writes     rigidity [unit], 1 for a node without a point nearby, else 0
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/point_buckets.glsl"

void main()
{
    PointLayout g = grid;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    Nearest nearest = nearestPoint(g, i, j);
    int n = i * (g.cellsZ + 1) + j;
    D[n] = points[nearest.at].rigidity;
    without[n] = nearest.distance2 > g.nearby2 ? 1u : 0u;
}
