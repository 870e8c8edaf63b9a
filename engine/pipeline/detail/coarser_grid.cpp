#include "engine/pipeline/detail/coarser_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/resampling.h"

namespace palp {
namespace {

/// Returns the field averaged along one axis with the weights of nodes 0, 1, ... away; beyond the window there are
/// none.
NodeField averagedAlong(bool alongX, const NodeField& field, const PlateGrid& grid, const std::vector<double>& weights)
{
    const int reach = int(weights.size()) - 1, nodes = alongX ? grid.nodesX() : grid.nodesZ();
    NodeField result(grid);
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) {
            const int own = alongX ? i : j;
            double    sum = 0, all = 0;
            for (int k = std::max(0, own - reach); k <= std::min(nodes - 1, own + reach); ++k) {
                const double weight = weights[std::size_t(std::abs(k - own))];
                sum += weight * (alongX ? field(k, j) : field(i, k));
                all += weight;
            }
            result(i, j) = sum / all;
        }
    return result;
}

} // namespace

NodeField everySecondOf(const NodeField& fine, const PlateGrid& coarse)
{
    if (fine.values().empty()) return {};
    NodeField values(coarse);
    for (int i = 0; i < coarse.nodesX(); ++i)
        for (int j = 0; j < coarse.nodesZ(); ++j) values(i, j) = fine(2 * i, 2 * j);
    return values;
}

Shell everySecondOf(const Shell& fine)
{
    Shell            shell  = fine;
    const PlateGrid& grid   = fine.bending.grid;
    const PlateGrid  coarse = {grid.cellsX / 2, grid.cellsZ / 2, 2 * grid.spacingX, 2 * grid.spacingZ};
    shell.bending.grid      = coarse;
    for (NodeField* field :
         {&shell.bending.rigidity, &shell.bending.foundationShape, &shell.membraneCompliance, &shell.curvatureX,
          &shell.curvatureZ, &shell.curvatureXZ, &shell.stressBed, &shell.sheared, &shell.stretched})
        *field = everySecondOf(*field, coarse);
    for (NodeField& thrust : shell.thrusts) thrust = everySecondOf(thrust, coarse);
    return shell;
}

void blurAsIfCoarser(Shell& shell, double pointSpacing)
{
    const PlateGrid& grid = shell.bending.grid;
    const double     h    = std::max(grid.spacingX, grid.spacingZ);
    const double     own = resamplingWidth(pointSpacing, h), wider = resamplingWidth(pointSpacing, 2 * h);
    const double     variance = (wider * wider - own * own) / (h * h); // at most 3/4 [cells^2]
    if (!(variance > 0)) return;
    constexpr double    kLeast = 1e-3; // [1] weights below are left out
    std::vector<double> weights;
    for (int k = 0; k == 0 || weights.back() > kLeast; ++k) weights.push_back(std::exp(-k * k / (2 * variance)));
    for (NodeField* field : {&shell.bending.rigidity, &shell.membraneCompliance}) {
        if (field->values().empty()) continue;
        for (double& value : field->values()) value = std::log(value);
        *field = averagedAlong(false, averagedAlong(true, *field, grid, weights), grid, weights);
        for (double& value : field->values()) value = std::exp(value);
    }
}

} // namespace palp
