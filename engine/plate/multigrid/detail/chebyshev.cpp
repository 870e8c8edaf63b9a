#include "engine/plate/multigrid/detail/chebyshev.h"

#include <string>

#include "engine/core/contract.h"

namespace palp {

std::vector<ChebyshevStep> chebyshevSteps(int count, double smallest, double largest)
{
    PALP_EXPECT(count >= 1 && 0 < smallest && smallest < largest,
                std::to_string(count) + " steps from " + std::to_string(smallest) + " to " + std::to_string(largest));
    const double middle = (largest + smallest) / 2, half = (largest - smallest) / 2;
    const double sigma = middle / half;

    std::vector<ChebyshevStep> steps{{0, float(1 / middle)}};
    for (double rho = 1 / sigma; int(steps.size()) < count;) {
        const double next = 1 / (2 * sigma - rho);
        steps.push_back({float(next * rho), float(2 * next / half)});
        rho = next;
    }
    return steps;
}

} // namespace palp
