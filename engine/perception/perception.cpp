#include "engine/perception/perception.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "engine/core/contract.h"

namespace palp {

double noticeableSteps(double a, double b, double weber) noexcept
{
    return noticeableSteps(std::log(a / b), weber);
}

double noticeableSteps(double lnRatio, double weber) noexcept
{
    return std::abs(lnRatio) / std::log1p(weber);
}

double rightAnswers(double steps) noexcept
{
    constexpr double kThreeOfFour = 0.67448975019608171; // Phi^-1(3/4) [1]
    return 0.5 * std::erfc(-kThreeOfFour * steps / std::numbers::sqrt2);
}

double largestRange(std::span<const double> along, std::span<const double> values, double within)
{
    PALP_EXPECT(along.size() == values.size(),
                std::to_string(along.size()) + " places for " + std::to_string(values.size()) + " values along a path");
    std::vector<std::size_t> order(along.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return along[a] < along[b]; });

    // A range slides over the places; each queue holds those that may still be its extreme, the best one first.
    std::deque<std::size_t> least, most;
    double                  range = 0;
    for (const std::size_t n : order) {
        while (!least.empty() && values[least.back()] >= values[n]) least.pop_back();
        while (!most.empty() && values[most.back()] <= values[n]) most.pop_back();
        least.push_back(n);
        most.push_back(n);
        while (along[n] - along[least.front()] > within) least.pop_front();
        while (along[n] - along[most.front()] > within) most.pop_front();
        range = std::max(range, values[most.front()] - values[least.front()]);
    }
    return range;
}

} // namespace palp
