#include "engine/tools/bench/bench_report.h"

#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::bench {
namespace {

BenchReport reportOf(const BenchRow& row)
{
    BenchReport report;
    report.rows = {row};
    return report;
}

BenchRow goodRow()
{
    BenchRow row;
    row.kind        = "new_map";
    row.map         = "linear";
    row.nodes       = 129;
    row.accuracy    = "1e-6";
    row.target      = 1e-6;
    row.peer        = "CHOLMOD";
    row.peerMs      = Quartiles{9, 10, 11};
    row.palpateMs   = Quartiles{1.5, 2, 2.5};
    row.peerPartsMs = {1, 7, 2};
    row.error       = 5e-7;
    row.peerError   = 1e-11;
    row.iterations  = 5;
    row.workUnits   = 42;
    return row;
}

std::string textOf(const BenchReport& report)
{
    std::ostringstream text;
    printText(text, report);
    return text.str();
}

TEST(BenchReport, TheClockOfAGpuIsSaidToBeTheWalls)
{
    BenchReport report = reportOf(goodRow());
    const auto  inJson = [&] { return nlohmann::json::parse(jsonOf(report)).at("clock"); };
    EXPECT_NE(textOf(report).find("in ms of processor time, one thread each"), std::string::npos);
    EXPECT_EQ(inJson(), "processor");
    report.clock = Clock::wall;
    EXPECT_EQ(inJson(), "wall");
    EXPECT_NE(textOf(report).find("in ms of time on the wall for Palpate"), std::string::npos) << textOf(report);
}

TEST(BenchReport, EveryRowHasEveryField)
{
    for (const BenchRow& row : {goodRow(), BenchRow{}}) {
        const auto json = nlohmann::json::parse(jsonOf(reportOf(row)));
        for (const char* field : {"case",
                                  "map",
                                  "nodes",
                                  "accuracy",
                                  "peer",
                                  "peer_ms",
                                  "palpate_ms",
                                  "ratio",
                                  "error",
                                  "peer_error",
                                  "work_units",
                                  "iterations",
                                  "peer_lower_ms",
                                  "peer_upper_ms",
                                  "palpate_lower_ms",
                                  "palpate_upper_ms",
                                  "tolerance",
                                  "extrapolated",
                                  "peer_bytes",
                                  "palpate_bytes",
                                  "loads",
                                  "dispatches_per_cycle",
                                  "moved_gb_per_s",
                                  "copy_gb_per_s",
                                  "note"})
            EXPECT_TRUE(json.at("rows").at(0).contains(field)) << field;
    }
}

TEST(BenchReport, WhatIsNotKnownIsNull)
{
    const auto row = nlohmann::json::parse(jsonOf(reportOf({}))).at("rows").at(0);

    for (const char* field : {"map", "nodes", "peer_ms", "palpate_ms", "ratio", "error", "iterations", "extrapolated"})
        EXPECT_TRUE(row.at(field).is_null()) << field;
}

TEST(BenchReport, TheRatioIsPeerOverPalpate)
{
    const BenchReport report = reportOf(goodRow());

    const auto row = nlohmann::json::parse(jsonOf(report)).at("rows").at(0);

    EXPECT_EQ(row.at("ratio"), 5);
    EXPECT_EQ(row.at("peer_parts_ms").at("factor"), 7);
    EXPECT_NE(textOf(report).find("5.0e-07"), std::string::npos);
}

TEST(BenchReport, ThereIsNoRatioWithoutItsError)
{
    BenchRow unknown = goodRow(), missed = goodRow(), broken = goodRow();
    unknown.error.reset();
    missed.error = 2e-6; // above the target
    broken.error = std::numeric_limits<double>::infinity();

    for (const BenchRow& row : {unknown, missed, broken}) {
        EXPECT_FALSE(row.ratio());
        EXPECT_TRUE(nlohmann::json::parse(jsonOf(reportOf(row))).at("rows").at(0).at("ratio").is_null());
    }
}

TEST(BenchReport, MemoryIsComparedByBytes)
{
    BenchRow row = goodRow();
    row.peerMs.reset();
    row.palpateMs.reset();
    row.peerBytes    = 70e6;
    row.palpateBytes = 7e6;

    EXPECT_EQ(row.ratio(), 10);
    EXPECT_NE(textOf(reportOf(row)).find("70.0 MB"), std::string::npos);
}

TEST(BenchReport, AnExtrapolatedTimeSaysSo)
{
    BenchRow row     = goodRow();
    row.extrapolated = true;

    EXPECT_NE(textOf(reportOf(row)).find("extrapolated"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(jsonOf(reportOf(row))).at("rows").at(0).at("extrapolated"), true);
}

TEST(BenchReport, DrawsALinePerSolver)
{
    BenchReport report = reportOf(goodRow());
    report.rows.push_back(goodRow());
    report.rows.back().nodes = 257;

    const std::string svg = plotOf(report, "new_map", "linear");

    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("CHOLMOD"), std::string::npos);
    EXPECT_NE(svg.find("Palpate, 1e-6"), std::string::npos);
    EXPECT_NE(plotOf({}, "new_map", "linear").find("<svg"), std::string::npos);
}

} // namespace
} // namespace palp::bench
