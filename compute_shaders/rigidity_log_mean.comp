// rigidity_log_mean.comp - rigidity at the nodes, exp of a weighted mean of ln D; see log_mean.h.
// Domain     one invocation per node
// Reads      layout, bucket starts, points
// Writes     rigidity [unit], that of the nearest point where none is in the square; 1 for a node without a point
//            nearby, else 0
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/point_buckets.glsl"
#include "compute_shaders/shared/log_mean.h"

void main()
{
    PointLayout g = grid;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    int n = i * (g.cellsZ + 1) + j;
    LogMean mean = logMeanAt(g, i, j);
    if (mean.weight > 0.0f)
        D[n] = exp(mean.logarithm / mean.weight);
    else
        D[n] = points[nearestPoint(g, i, j).at].rigidity;
    without[n] = mean.nearest2 > g.nearby2 ? 1u : 0u; // the square holds all that is nearby
}
