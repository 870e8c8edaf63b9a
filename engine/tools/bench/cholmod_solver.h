#pragma once
#include <memory>
#include <string>

#include "engine/tools/bench/direct_solver.h"

namespace palp::bench {

/// CHOLMOD in doubles: the best of its minimum degree and nested dissection orders, and whichever of its simplicial and
/// supernodal factorisations it prefers.
[[nodiscard]] std::unique_ptr<DirectSolver> cholmodSolver(const PlateMatrix& matrix);

/// "CHOLMOD 3.0.14, BLAS /usr/lib/.../libblas.so.3": its supernodal factorisation is as fast as the BLAS is.
[[nodiscard]] std::string cholmodVersion();

} // namespace palp::bench
