#include "engine/tools/bench/dispatch_bench.h"

#include <sstream>

#include <gtest/gtest.h>

#include "engine/tools/bench/bench_report.h"

namespace palp::bench {
namespace {

TEST(DispatchBench, CountsWithoutAClock)
{
    compute::Context context({.processor = std::string(compute::kHostProcessor)});
    BenchReport      report;
    report.rows = countDispatches(context, Schedule::automatic, {33, 65});

    ASSERT_EQ(report.rows.size(), 4U) << "a smooth map and one that jumps, on two grids; the host has one schedule";
    EXPECT_EQ(report.rows[0].nodes, 33);
    EXPECT_EQ(report.rows[0].map, "linear");
    EXPECT_EQ(report.rows[0].schedule, "pass-by-pass");
    const auto coarse = *report.rows[0].commands, fine = *report.rows[2].commands, sharp = *report.rows[3].commands;
    EXPECT_EQ(coarse.cycle, 8) << "two steps, residual, two transfers, two steps, the coarsest level";
    EXPECT_EQ(coarse.step, coarse.cycle + 7);
    EXPECT_EQ(fine.cycle, 15);
    EXPECT_GT(sharp.cycle, fine.cycle) << "extra sweeps of tiles";
    EXPECT_EQ(sharp.prepare, fine.prepare);
    for (const BenchRow& row : report.rows) EXPECT_FALSE(row.palpateMs);

    std::ostringstream text;
    printText(text, report);
    EXPECT_NE(text.str().find("pass-by-pass: new map "), std::string::npos) << text.str();
    EXPECT_NE(text.str().find("a step 15, of which the cycle 8"), std::string::npos) << text.str();
    EXPECT_NE(jsonOf(report).find("\"nested_iteration\""), std::string::npos);
}

} // namespace
} // namespace palp::bench
