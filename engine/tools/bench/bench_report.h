#pragma once
#include <iosfwd>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/tools/bench/bench_row.h"

namespace palp::bench {

/// The measurements, and the machine and libraries on which they were made.
struct BenchReport {
    std::string              solver, processor, cholmod, eigen, nanoflann;
    Clock                    clock = Clock::processor; ///< of Palpate's times; peers run on the CPU
    int                      runs  = 0;
    bool                     quick = false;
    std::vector<std::string> environment; ///< NAME=value, variables that keep libraries to one thread
    std::vector<BenchRow>    rows;
};

/// Prints lines of text. A ratio is printed only beside its error.
void printText(std::ostream& out, const BenchReport& report);

/// Writes one JSON object with the list `rows`; engine/performance.md describes the fields.
[[nodiscard]] std::string jsonOf(const BenchReport& report);

/// Plots times against nodes, a line per solver, from the rows of one case.
[[nodiscard]] std::string plotOf(const BenchReport& report, const std::string& kind, const std::string& map);

} // namespace palp::bench
