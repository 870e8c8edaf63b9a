#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/core/npy.h"
#include "engine/plate/problem_file.h"
#include "tests/fuzz/fuzz_expect.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// A folder with the one grid, D.npy, that a problem of 4 x 4 cells may name.
const TemporaryFolder& folder()
{
    static const TemporaryFolder kFolder;
    static const bool            kWritten = [] {
        writeNpy(kFolder / "D.npy", NodeField(5, 5, 2));
        return true;
    }();
    if (!kWritten) std::abort();
    return kFolder;
}

/// What must hold of every problem that is accepted: a solver can take it as it is.
void check(const PlateProblem& problem)
{
    const PlateGrid& grid = problem.plate.grid;
    fuzzExpect(!whyUnsolvable(problem.plate) && problem.nodalForce.on(grid));
    for (const double force : problem.nodalForce.values()) fuzzExpect(std::isfinite(force));
    for (const Probe& p : problem.probes)
        fuzzExpect(p.x >= 0 && p.x <= grid.sizeX() && p.z >= 0 && p.z <= grid.sizeZ());
}

} // namespace
} // namespace palp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr int kCells = 8; // along x: the fields stay small whatever "cells" says, up to 4096 a side
    const auto path = palp::folder().write("problem.json", std::string_view(reinterpret_cast<const char*>(data), size));
    palp::fuzzRefusals([&] { palp::check(palp::readProblem(path, kCells)); });
    return 0;
}
