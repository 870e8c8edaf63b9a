#include "engine/tools/bench/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::bench {
namespace {

double largest(const NodeField& field)
{
    double most = 0;
    for (const double value : field.values()) most = std::max(most, std::abs(value));
    return most;
}

} // namespace

double errorOf(const NodeField& found, const NodeField& truth)
{
    PALP_EXPECT(found.nodesX() == truth.nodesX() && found.nodesZ() == truth.nodesZ(), "two grids");
    double difference = 0;
    for (std::size_t n = 0; n < truth.values().size(); ++n) {
        const double d = std::abs(found.values()[n] - truth.values()[n]);
        if (!std::isfinite(d)) return std::numeric_limits<double>::infinity();
        difference = std::max(difference, d);
    }
    return difference / largest(truth);
}

double residualOf(const Plate& plate, const NodeField& force, const NodeField& w)
{
    const NodeField rest = energyResidual(plate, force, w);
    double          left = 0, all = 0;
    for (int i = 0; i < plate.grid.nodesX(); ++i)
        for (int j = 0; j < plate.grid.nodesZ(); ++j) {
            if (isHeld(plate, i, j)) continue;
            left += rest(i, j) * rest(i, j);
            all += force(i, j) * force(i, j);
        }
    return std::sqrt(left / all);
}

Truth refinedTruth(Direct& direct, const Plate& plate, const NodeField& force)
{
    constexpr int    kMostSteps = 10;    // two or three are usual
    constexpr double kEnough    = 1e-13; // [1]
    direct.factorise(plate);
    Truth truth{direct.solve(force), 1};
    for (int step = 0; step < kMostSteps && truth.correction > kEnough; ++step) {
        const NodeField change = direct.solve(energyResidual(plate, force, truth.w));
        const double    size   = largest(change) / largest(truth.w);
        if (size > truth.correction / 2) break; // rounding is all that is left
        for (std::size_t n = 0; n < change.values().size(); ++n) truth.w.values()[n] += change.values()[n];
        truth.correction = size;
    }
    return truth;
}

double discretisationError(const NodeField& fine, const NodeField& coarse)
{
    PALP_EXPECT(fine.nodesX() == 2 * coarse.nodesX() - 1 && fine.nodesZ() == 2 * coarse.nodesZ() - 1,
                "a grid twice as coarse");
    double difference = 0;
    for (int i = 0; i < coarse.nodesX(); ++i)
        for (int j = 0; j < coarse.nodesZ(); ++j)
            difference = std::max(difference, std::abs(coarse(i, j) - fine(2 * i, 2 * j)));
    return difference / 3 / largest(fine);
}

} // namespace palp::bench
