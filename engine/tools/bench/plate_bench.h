#pragma once
#include <functional>
#include <string>
#include <vector>

#include "engine/tools/bench/bench_row.h"

namespace palp::compute {
class Context;
}
namespace palp {
class PlateKernels;
}

namespace palp::bench {

struct PlateBenchOptions {
    std::vector<std::string> cases; ///< of those that plateCases() lists
    std::vector<int>         nodes; ///< a side, odd
    std::vector<std::string> maps;  ///< by name, see bench_plates.h; empty: all
    int                      runs          = 11;
    int                      mostEigen     = 257;   ///< nodes a side beyond which Eigen takes seconds
    bool                     quick         = false; ///< one load, and fewer maps beyond 129 nodes
    double                   patience      = 1e9;   ///< no new comparison begins after this time [s]
    double                   jacobiSeconds = 150;   ///< per grid; the rest is extrapolated [s]
    int                      mostMemory    = 1025;  ///< nodes a side of the largest grid of the case memory
};

/// Lists the cases: new_map, new_load, contrast, jacobi, memory, batch.
[[nodiscard]] const std::vector<std::string>& plateCases();

/// A function that is called with (done, total) steps when a row has been measured.
using OnStep = std::function<void(std::size_t done, std::size_t total)>;

/// Measures the cases that need nothing but plates, small grids first. A comparison for which `patience` leaves no time
/// has a row that says so.
/// \thread one; see takeTurns
[[nodiscard]] std::vector<BenchRow> measurePlates(compute::Context& context, const PlateKernels& kernels,
                                                  const PlateBenchOptions& options, const OnStep& onStep);

} // namespace palp::bench
