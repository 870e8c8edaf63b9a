#include "engine/pipeline/detail/shell_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/extremes.h"

namespace palp {
namespace {

constexpr double kStep   = 0.02; ///< of curvature and foundation, relative; half of it is the most that is lost [1]
constexpr double kShares = 50;   ///< steps from none of a curvature to all of it
constexpr double kThin   = 1e-3; ///< of the thickness, which is the same throughout a scene, relative [1]
constexpr int    kNone   = std::numeric_limits<int>::min();

int stepOf(double value, double step)
{
    return value > 0 ? int(std::lround(std::log(value) / step)) : kNone;
}

double valueOf(int steps, double step)
{
    return steps == kNone ? 0 : std::exp(step * steps);
}

double meanOf(const NodeField& field)
{
    double sum = 0;
    for (const double value : field.values()) sum += value;
    return sum / double(field.values().size());
}

} // namespace

ShellShape meanShape(const Shell& shell, double below)
{
    const double     window = shell.bending.grid.sizeX(), rigidity = geometricMean(shell.bending.rigidity.values());
    const double     thin = std::sqrt(rigidity * geometricMean(shell.membraneCompliance.values())) / window;
    const std::array curvatures{meanOf(shell.curvatureX), meanOf(shell.curvatureZ), meanOf(shell.curvatureXZ)};
    double           most = 0;
    for (const double k : curvatures) most = std::max(most, std::abs(k));
    const auto share = [&](double k) { return most > 0 ? int(std::lround(kShares * k / most)) : 0; };
    return {.thin       = stepOf(thin, kThin),
            .curved     = stepOf(most * window / thin, kStep),
            .shares     = {share(curvatures[0]), share(curvatures[1]), share(curvatures[2])},
            .foundation = stepOf(below * std::pow(window, 4) / rigidity, kStep)};
}

Shell shellOfShape(const ShellShape& shape, const Shell& like)
{
    const PlateGrid& grid   = like.bending.grid;
    const double     window = grid.sizeX();
    const double     thin = valueOf(shape.thin, kThin), curved = valueOf(shape.curved, kStep) * thin / window;
    constexpr double kRigidity    = 1; // [N m]: it is a factor of all compliances
    Shell            shell        = like;
    shell.bending.foundation      = valueOf(shape.foundation, kStep) * kRigidity / std::pow(window, 4);
    shell.bending.foundationShape = {};
    shell.bending.rigidity        = NodeField(grid, kRigidity);
    shell.membraneCompliance      = NodeField(grid, std::pow(thin * window, 2) / kRigidity);
    shell.curvatureX              = NodeField(grid, curved * shape.shares[0] / kShares);
    shell.curvatureZ              = NodeField(grid, curved * shape.shares[1] / kShares);
    shell.curvatureXZ             = NodeField(grid, curved * shape.shares[2] / kShares);
    return shell;
}

} // namespace palp
