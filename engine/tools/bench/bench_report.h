#pragma once
#include <iosfwd>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/tools/bench/bench_row.h"

namespace palp::bench {

/// What was measured, and on what.
struct BenchReport {
    std::string              device, processor, cholmod, eigen, nanoflann;
    int                      runs  = 0;
    bool                     quick = false;
    std::vector<std::string> environment; ///< NAME=value, what keeps libraries to one thread
    std::vector<BenchRow>    rows;
};

/// Prints lines of text. A ratio stands only where its error does.
void printText(std::ostream& out, const BenchReport& report);

/// Writes one JSON object with the list `rows`; engine/performance.md says what each field is.
[[nodiscard]] std::string jsonOf(const BenchReport& report);

/// Plots times against nodes, a line per solver, from the rows of one case.
[[nodiscard]] std::string plotOf(const BenchReport& report, const std::string& kind, const std::string& map);

} // namespace palp::bench
