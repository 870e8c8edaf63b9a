#include "engine/core/extremes.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace palp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The loop works on pairs, for which every processor of the last twenty years has a register. Compilers leave loops of
// plain minima scalar, because of NaN.
constexpr std::size_t kPair                             = 2;
using Pair [[gnu::vector_size(kPair * sizeof(double))]] = double;

struct Running {
    Pair least = Pair{} + kInfinity, most = Pair{} - kInfinity;
    Pair broken{}; ///< 0 while all values are finite, else NaN

    void take(const Pair& v)
    {
        least = v < least ? v : least;
        most  = v > most ? v : most;
        broken += v - v;
    }

    void take(const Running& of)
    {
        least = of.least < least ? of.least : least;
        most  = of.most > most ? of.most : most;
        broken += of.broken;
    }
};

} // namespace

double geometricMean(std::span<const double> values) noexcept
{
    double sum = 0; // of logarithms
    for (const double value : values) sum += std::log(value);
    return std::exp(sum / double(values.size()));
}

Extremes extremesOf(std::span<const double> values) noexcept
{
    Running     one, other; // independent, so that neither waits for the other's sums
    std::size_t n = 0;
    for (; n + 2 * kPair <= values.size(); n += 2 * kPair) {
        Pair v[2];
        std::memcpy(v, values.data() + n, sizeof v);
        one.take(v[0]);
        other.take(v[1]);
    }
    for (; n < values.size(); ++n) one.take(Pair{} + values[n]);
    one.broken += other.broken;
    one.take(other);

    Extremes all{kInfinity, -kInfinity, true};
    for (std::size_t lane = 0; lane < kPair; ++lane) {
        all.least  = one.least[lane] < all.least ? one.least[lane] : all.least;
        all.most   = one.most[lane] > all.most ? one.most[lane] : all.most;
        all.finite = all.finite && one.broken[lane] == 0;
    }
    return all;
}

} // namespace palp
