#pragma once
#include <memory>
#include <string>

#include "engine/tools/bench/direct_solver.h"

namespace palp::bench {

/// Makes a solver by CHOLMOD in doubles. It takes the best of CHOLMOD's minimum degree and nested dissection orders,
/// and the simplicial or supernodal factorisation, as CHOLMOD chooses.
[[nodiscard]] std::unique_ptr<DirectSolver> cholmodSolver(const PlateMatrix& matrix);

/// Returns a text such as "CHOLMOD 3.0.14, BLAS /usr/lib/.../libblas.so.3": the supernodal factorisation is as fast as
/// the BLAS.
[[nodiscard]] std::string cholmodVersion();

} // namespace palp::bench
