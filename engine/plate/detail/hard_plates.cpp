#include "engine/plate/detail/hard_plates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute_shaders/shared/tile_layout.h"
#include "engine/core/extremes.h"

namespace palp {
namespace {

/// Returns whether two positive numbers, or two zeroes, differ by at most a factor.
bool within(double factor, double a, double b)
{
    return a <= factor * b && b <= factor * a;
}

/// Returns whether two plates differ by little but their rigidity. Windows of patches are fitted to what is touched, so
/// that spacings differ from patch to patch; a tenth of a spacing, or twice the foundation, makes no plate easy.
bool similarButRigidity(const Plate& a, const Plate& b)
{
    constexpr double kSpacing = 1.1, kFoundation = 2;
    return a.grid.cellsX == b.grid.cellsX && a.grid.cellsZ == b.grid.cellsZ && a.edges == b.edges &&
           within(kSpacing, a.grid.spacingX, b.grid.spacingX) && within(kSpacing, a.grid.spacingZ, b.grid.spacingZ) &&
           within(kFoundation, a.foundation, b.foundation) &&
           a.foundationShape.values().empty() == b.foundationShape.values().empty();
}

double ratio(double a, double b)
{
    return a > b ? a / b : b / a;
}

} // namespace

double contrastOf(const Plate& plate)
{
    const Extremes of = extremesOf(plate.rigidity.values());
    return of.most / of.least;
}

double largestJump(const Plate& plate)
{
    const NodeField& D    = plate.rigidity;
    double           most = 1;
    for (int i = 0; i <= plate.grid.cellsX; ++i)
        for (int j = 0; j <= plate.grid.cellsZ; ++j) {
            if (i > 0) most = std::max(most, ratio(D(i, j), D(i - 1, j)));
            if (j > 0) most = std::max(most, ratio(D(i, j), D(i, j - 1)));
        }
    return most;
}

void HardPlates::remember(const Plate& plate, double tolerance, std::string why)
{
    constexpr std::size_t kMost = 8; // those of several grids, or of one that becomes softer
    if (all_.size() == kMost) all_.erase(all_.begin());
    Plate like    = plate;
    like.rigidity = {};
    all_.push_back({std::move(like), contrastOf(plate), largestJump(plate), tolerance, std::move(why)});
}

const std::string* HardPlates::knownBecause(const Plate& plate, double tolerance) const
{
    constexpr double kContrast = 0.5; // patches of one map show more of its contrast, or less [1]
    constexpr double kJump     = 0.5; // of a jump's logarithm: resampled, a rim may lie between two steps [1]
    if (!plate.rigidity.on(plate.grid)) return nullptr; // it will be refused
    const auto isLike = [&](const One& one) {
        if (!similarButRigidity(one.plate, plate) || tolerance > one.tolerance) return false;
        if (contrastOf(plate) < kContrast * one.contrast) return false;
        return one.jump < double(shared::kJump) || std::log(largestJump(plate)) >= kJump * std::log(one.jump);
    };
    const auto known = std::ranges::find_if(all_, isLike);
    return known == all_.end() ? nullptr : &known->why;
}

} // namespace palp
