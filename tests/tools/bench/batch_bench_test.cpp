#include "engine/tools/bench/batch_bench.h"

#include <sstream>

#include <gtest/gtest.h>

#include "engine/compute/context.h"
#include "engine/tools/bench/bench_report.h"

namespace palp::bench {
namespace {

TEST(BatchBench, SaysWhatABatchCostsWithoutARatio)
{
    compute::Context   context({.processor = std::string(compute::kHostProcessor)});
    const PlateKernels kernels(context);
    const auto         rows = measureBatches(context, kernels, 33, 11);

    ASSERT_EQ(rows.size(), 4U);
    for (std::size_t n = 0; n < rows.size(); ++n) {
        EXPECT_EQ(rows[n].loads, (std::vector{1, 9, 25, 49})[n]);
        EXPECT_EQ(rows[n].dispatchesPerCycle, 8) << "two steps, residual, two transfers, two steps, the coarsest level";
        EXPECT_GE(rows[n].iterations, 2);
        EXPECT_GT(rows[n].palpateMs->median, 0);
        EXPECT_GT(rows[n].movedGigabytes, 0);
        EXPECT_EQ(rows[n].ratio(), std::nullopt);
    }
    const double step = *rows[0].workUnits / *rows[0].iterations; // and more: nested iteration is in it
    EXPECT_NEAR(*rows[3].workUnits, *rows[0].workUnits, step) << "per load: the worst of 49 may take a step more";

    BenchReport report;
    report.rows = {rows[3]};
    std::ostringstream text;
    printText(text, report);
    EXPECT_NE(text.str().find("49 loads, "), std::string::npos) << text.str();
    EXPECT_NE(text.str().find("8 dispatches per cycle"), std::string::npos) << text.str();
}

} // namespace
} // namespace palp::bench
