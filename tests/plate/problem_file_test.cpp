#include "engine/plate/problem_file.h"

#include <cmath>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/core/npy.h"
#include "engine/plate/load.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// A problem in which each test changes one thing.
const std::string kProblem = R"({
 "size": [1, 1.5], "cells": [8, 12], "poisson": 0.3, // comments are welcome
 "edges": {"x0": "clamped", "x1": "free", "z0": "supported", "z1": "clamped"},
 "foundation": 5,
 "rigidity": {"law": "linear", "from": 1, "to": 10, "axis": "z"},
 "load": {"law": "point", "force": 2, "at": [0.5, 0.75]},
 "probes": [[0.25, 0.25], [1, 1.5]]})";

class ProblemFile : public testing::Test {
protected:
    PlateProblem read(const std::string& text, std::optional<int> cells = {}) const
    {
        return readProblem(folder_.write("plate.json", text), cells);
    }

    /// The problem with one part of its text exchanged.
    static std::string with(const std::string& part, const std::string& other)
    {
        std::string text = kProblem;
        const auto  at   = text.find(part);
        PALP_EXPECT(at != std::string::npos, "the problem has no " + part);
        return text.replace(at, part.size(), other);
    }

    std::string refusal(const std::string& text, std::optional<int> cells = {}) const
    {
        return refusalOf([&] { static_cast<void>(read(text, cells)); });
    }

    static std::string rigidityOf(const std::string& law)
    {
        return with(R"({"law": "linear", "from": 1, "to": 10, "axis": "z"})", law);
    }
    static std::string loadOf(const std::string& law)
    {
        return with(R"({"law": "point", "force": 2, "at": [0.5, 0.75]})", law);
    }

    TemporaryFolder folder_;
};

double total(const NodeField& forces)
{
    return std::accumulate(forces.values().begin(), forces.values().end(), 0.0);
}

TEST_F(ProblemFile, SaysEverythingAboutThePlate)
{
    const PlateProblem problem = read(kProblem);

    EXPECT_EQ(problem.plate.grid, (PlateGrid{8, 12, 0.125, 0.125}));
    EXPECT_EQ(problem.plate.edges, (PlateEdges{Edge::clamped, Edge::free, Edge::supported, Edge::clamped}));
    EXPECT_EQ(problem.plate.poissonRatio, 0.3);
    EXPECT_EQ(problem.plate.foundation, 5);
    EXPECT_EQ(problem.plate.rigidity(3, 0), 1);
    EXPECT_EQ(problem.plate.rigidity(3, 6), 5.5);
    EXPECT_EQ(problem.nodalForce(4, 6), 2);
    EXPECT_EQ(total(problem.nodalForce), 2);
    ASSERT_EQ(problem.probes.size(), 2u);
    EXPECT_EQ(problem.probes[1].x, 1);
    EXPECT_EQ(problem.probes[1].z, 1.5);
}

TEST_F(ProblemFile, WithoutEdgesFoundationAndProbesIsClampedOnNothingAndAsksNothing)
{
    const PlateProblem problem = read(R"({"size": [1, 1], "cells": [4, 4], "poisson": 0.3,
        "rigidity": {"law": "constant", "value": 2}, "load": {"law": "uniform", "pressure": 1}})");

    EXPECT_EQ(problem.plate.edges, PlateEdges{});
    EXPECT_EQ(problem.plate.foundation, 0);
    EXPECT_TRUE(problem.probes.empty());
    EXPECT_EQ(read(with(R"("x1": "free", )", "")).plate.edges.x1, Edge::clamped);
}

TEST_F(ProblemFile, KnowsEveryLoad)
{
    EXPECT_DOUBLE_EQ(total(read(loadOf(R"({"law": "uniform", "pressure": -3})")).nodalForce), -3 * 1.5);
    EXPECT_NEAR(
        total(read(loadOf(R"({"law": "gaussian", "force": 2, "centre": [0.5, 0.75], "sigma": 0.05})")).nodalForce), 2,
        1e-12)
        << "the edges are ten deviations away";

    NodeField pressure(9, 13);
    pressure(4, 5) = 7;
    writeNpy(folder_ / "q.npy", pressure);
    const NodeField force = read(loadOf(R"({"law": "grid", "file": "q.npy"})")).nodalForce;
    EXPECT_EQ(force(4, 5), 7 * 0.125 * 0.125);
    EXPECT_EQ(total(force), force(4, 5));
}

TEST_F(ProblemFile, KnowsEveryRigidity)
{
    const auto at = [&](const std::string& law, int i, int j) { return read(rigidityOf(law)).plate.rigidity(i, j); };

    EXPECT_EQ(at(R"({"law": "constant", "value": 4})", 0, 0), 4);
    EXPECT_DOUBLE_EQ(at(R"({"law": "hyperbolic", "from": 10, "to": 1})", 4, 0), 10 / (1 + 9 * 0.5));
    EXPECT_DOUBLE_EQ(at(R"({"law": "exponential", "from": 1, "to": 100, "axis": "z"})", 0, 6), 10);
    EXPECT_EQ(at(R"({"law": "gaussian", "from": 1, "to": 10, "centre": [0.5, 0.75], "sigma": 0.1})", 4, 6), 10);
    EXPECT_EQ(at(R"({"law": "disc", "from": 1, "to": 10, "centres": [[0.5, 0.75], [0, 0]], "radius": 0.2})", 1, 1), 10);
    EXPECT_EQ(at(R"({"law": "box", "from": 1, "to": 10, "low": [0.25, 0.5], "high": [0.5, 0.75]})", 2, 4), 10);
    EXPECT_EQ(at(R"({"law": "checker", "from": 1, "to": 10, "edge": 0.5})", 4, 0), 1);

    NodeField field(9, 13, 3);
    field(2, 3) = 8;
    writeNpy(folder_ / "D.npy", field);
    EXPECT_EQ(at(R"({"law": "grid", "file": "D.npy"})", 2, 3), 8);
}

TEST_F(ProblemFile, GridsLieBesideTheFileWhereverTheProgramRuns)
{
    std::filesystem::create_directory(folder_ / "sub");
    writeNpy(folder_ / "sub" / "D.npy", NodeField(9, 13, 3));

    EXPECT_EQ(read(rigidityOf(R"({"law": "grid", "file": "sub/D.npy"})")).plate.rigidity(0, 0), 3);
}

TEST_F(ProblemFile, NamesTheFilesThatWereRead)
{
    writeNpy(folder_ / "D.npy", NodeField(9, 9, 1.0));
    const PlateProblem                       problem = read(R"({"size": [1, 1], "cells": [8, 8], "poisson": 0.3,
        "rigidity": {"law": "grid", "file": "D.npy"}, "foundation": {"law": "grid", "file": "D.npy"},
        "load": {"law": "grid", "file": "D.npy"}})");
    const std::vector<std::filesystem::path> expected{folder_ / "plate.json", folder_ / "D.npy", folder_ / "D.npy",
                                                      folder_ / "D.npy"};
    EXPECT_EQ(problem.files, expected);
}

TEST_F(ProblemFile, OtherCellsKeepTheProportionAndResampleGrids)
{
    NodeField field(9, 13);
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 12; ++j) field(i, j) = 1 + i + 0.5 * j + i * j; // bilinear: resampled exactly
    writeNpy(folder_ / "D.npy", field);

    const PlateProblem fine   = read(rigidityOf(R"({"law": "grid", "file": "D.npy"})"), 32);
    const PlateProblem coarse = read(kProblem, 5);

    EXPECT_EQ(fine.plate.grid.cellsX, 32);
    EXPECT_EQ(fine.plate.grid.cellsZ, 48);
    EXPECT_NEAR(fine.plate.rigidity(13, 22), 1 + 3.25 + 0.5 * 5.5 + 3.25 * 5.5, 1e-12) << "rounding";
    EXPECT_EQ(fine.plate.rigidity(32, 48), field(8, 12));
    EXPECT_EQ(coarse.plate.grid.cellsZ, 8) << "12 * 5 / 8 is 7.5, rounded away from zero";
    EXPECT_DOUBLE_EQ(coarse.plate.grid.sizeZ(), 1.5);
}

TEST_F(ProblemFile, IsSolvedToTheClassicalAnswer)
{
    const PlateProblem problem = read(R"({"size": [1, 1], "cells": [64, 64], "poisson": 0.3,
        "rigidity": {"law": "constant", "value": 1}, "load": {"law": "uniform", "pressure": 1}})");

    const NodeField w = ReferencePlateSolver(problem.plate).solve(problem.nodalForce).deflection;

    EXPECT_NEAR(w(32, 32) / 1.265319087480e-3, 1, 3e-3) << "series solution; 0.2 % at 64 cells";
}

TEST_F(ProblemFile, EveryMissingKeyIsNamed)
{
    EXPECT_TRUE(holds(refusal("{}"), {"plate.json", "\"size\"", "missing"}));
    for (const std::string key : {"size", "cells", "poisson", "rigidity", "load"})
        EXPECT_TRUE(holds(refusal(with("\"" + key + "\":", "\"probes_\":")), {"plate.json", "probes_"})) << key;
    EXPECT_TRUE(holds(refusal(R"({"size":[1,1],"cells":[8,8],"poisson":0.3,"rigidity":{"law":"constant","value":1}})"),
                      {"\"load\"", "missing"}));
    EXPECT_TRUE(holds(refusal(loadOf(R"({"law": "point", "force": 2})")), {"load", "\"at\"", "missing"}));
    EXPECT_TRUE(holds(refusal(loadOf(R"({"force": 2})")), {"load", "\"law\"", "missing"}));
}

TEST_F(ProblemFile, UnknownKeysAreRefusedWithTheKnownOnes)
{
    EXPECT_TRUE(holds(refusal(with("\"poisson\"", "\"nu\"")), {"\"nu\"", "poisson", "foundation"}));
    EXPECT_TRUE(holds(refusal(with("\"x1\"", "\"x2\"")), {"edges", "\"x2\"", "x0, x1, z0, z1"}));
    EXPECT_TRUE(
        holds(refusal(loadOf(R"({"law": "uniform", "pressure": 1, "at": [0, 0]})")), {"load", "\"at\"", "pressure"}));
    EXPECT_TRUE(holds(refusal(loadOf(R"({"law": "wind", "force": 1})")), {"load", "wind", "gaussian"}));
    EXPECT_TRUE(holds(refusal(rigidityOf(R"({"law": "wavy"})")), {"rigidity", "wavy", "checker"}));
    EXPECT_TRUE(holds(refusal(with("\"free\"", "\"loose\"")), {"edges", "x1", "loose", "supported"}));
}

TEST_F(ProblemFile, TheFoundationMayBeALawOrAGridWithHoles)
{
    const auto foundationOf = [](const std::string& law) {
        return with("\"foundation\": 5", "\"foundation\": " + law);
    };
    const Plate linear = read(foundationOf(R"({"law": "linear", "from": 2, "to": 8, "axis": "x"})")).plate;
    EXPECT_EQ(foundationAt(linear, 0, 7), 2);
    EXPECT_EQ(foundationAt(linear, 4, 7), 5);
    EXPECT_EQ(foundationAt(linear, 8, 7), 8);

    NodeField k(9, 13, 3);
    k(2, 5) = 0;
    writeNpy(folder_ / "k.npy", k);
    const std::string grid = foundationOf(R"({"law": "grid", "file": "k.npy"})");
    EXPECT_EQ(foundationAt(read(grid).plate, 2, 5), 0);
    EXPECT_EQ(foundationAt(read(grid).plate, 3, 5), 3);
    EXPECT_EQ(foundationAt(read(grid, 16).plate, 5, 10), 1.5) << "half way to the hole on the finer grid";
    k(2, 5) = -1;
    writeNpy(folder_ / "k.npy", k);
    EXPECT_TRUE(holds(refusal(grid), {"foundation", "not negative", "-1 Pa/m", "[2, 5]"}));

    writeNpy(folder_ / "k.npy", NodeField(9, 13, 0));
    EXPECT_EQ(read(grid).plate.foundation, 0);
}

TEST_F(ProblemFile, ValuesOutOfRangeAreRefusedWithWhatWasFound)
{
    EXPECT_TRUE(holds(refusal(with("[1, 1.5]", "[1, 0]")), {"size", "positive", "[1,0]"}));
    EXPECT_TRUE(holds(refusal(with("[1, 1.5]", "[1, -2]")), {"size", "positive"}));
    EXPECT_TRUE(holds(refusal(with("[1, 1.5]", "[1]")), {"size", "2 numbers"}));
    EXPECT_TRUE(holds(refusal(with("[1, 1.5]", "[1e999, 1]")), {"plate.json", "1e999"}));
    for (const char* cells : {"[3, 12]", "[8, 4097]", "[8, 1e12]", "[8.5, 12]", "[8]", "8", "[8, \"12\"]", "[-8, 12]"})
        EXPECT_TRUE(holds(refusal(with("[8, 12]", cells)), {"cells", "4 to 4096"})) << cells;
    EXPECT_TRUE(holds(refusal(with("0.3", "0.6")), {"poisson", "0.5", "0.6"}));
    EXPECT_TRUE(holds(refusal(with("0.3", "\"soft\"")), {"poisson", "number", "soft"}));
    for (const std::string other : {"true", "null", "[0.3]", "{}"})
        EXPECT_TRUE(refusal(with("0.3", other)).ends_with("key \"poisson\": expected a number, found " + other))
            << other;
    const std::string whole = '"' + std::string(198, 's') + '"', longer = '"' + std::string(199, 's') + '"';
    EXPECT_TRUE(refusal(with("0.3", whole)).ends_with("found " + whole));
    EXPECT_TRUE(refusal(with("0.3", longer)).ends_with("found " + longer.substr(0, 200) + "..."));
    EXPECT_TRUE(holds(refusal(with("\"foundation\": 5", "\"foundation\": -5")), {"foundation", "-5"}));
    EXPECT_TRUE(holds(refusal(with("\"foundation\": 5", R"("foundation": {"law": "constant", "value": -5})")),
                      {"foundation", "-5"}));
    EXPECT_TRUE(holds(refusal(loadOf(R"({"law": "gaussian", "force": 1, "centre": [0, 0], "sigma": 0})")),
                      {"sigma", "positive"}));
    EXPECT_TRUE(holds(refusal(rigidityOf(R"({"law": "constant", "value": 0})")), {"rigidity", "value", "positive"}));
}

TEST_F(ProblemFile, PlacesBesideThePlateAreRefused)
{
    EXPECT_TRUE(holds(refusal(with("[1, 1.5]]", "[1, 1.6]]")), {"probes", "entry 1", "1.6", "1.5"}));
    EXPECT_TRUE(holds(refusal(with("[0.5, 0.75]", "[-0.1, 0.75]")), {"load", "at", "-0.1", "[0, 1]"}));
    EXPECT_TRUE(holds(refusal(with("[[0.25, 0.25], [1, 1.5]]", "[[0.25]]")), {"probes", "2 numbers", "[0.25]"}));
    EXPECT_TRUE(holds(refusal(with("[[0.25, 0.25], [1, 1.5]]", "0.25")), {"probes", "0.25"}));
}

TEST_F(ProblemFile, TheFarEdgeIsOnThePlateWhereCellsTimesSpacingRoundBelowTheSize)
{
    for (const int cells : {49, 98}) {
        ASSERT_LT(cells * (1.0 / cells), 1.0) << "these cells no longer show the rounding";
        const std::string  side = std::to_string(cells);
        const PlateProblem problem =
            read(R"({"size": [1, 1], "cells": [)" + side + ", " + side +
                 R"(], "poisson": 0.3, "rigidity": {"law": "constant", "value": 1}, "probes": [[1, 1]],
                 "load": {"law": "point", "force": 2, "at": [1, 0.5]}})");
        EXPECT_NEAR(total(problem.nodalForce), 2, 1e-12);
        EXPECT_EQ(problem.probes.size(), 1u);
    }
}

TEST_F(ProblemFile, APlateThatNothingHoldsIsRefused)
{
    const std::string loose = with(R"({"x0": "clamped", "x1": "free", "z0": "supported", "z1": "clamped"},
 "foundation": 5)",
                                   R"({"x0": "free", "x1": "free", "z0": "supported", "z1": "free"})");

    EXPECT_TRUE(holds(refusal(loose), {"plate.json", "rigid body"}));
}

TEST_F(ProblemFile, GridsOfAnotherShapeOrWithBadNodesAreRefused)
{
    const std::string law = R"({"law": "grid", "file": "D.npy"})";
    EXPECT_TRUE(
        holds(refusal(rigidityOf(law)), {"plate.json", "rigidity", "\"file\"", "D.npy", "No such file", "folder"}));
    EXPECT_TRUE(holds(refusal(loadOf(R"({"law": "grid", "file": ""})")), {"plate.json", "load", "\"file\"", ".npy"}));
    EXPECT_EQ(refusal(rigidityOf(R"({"law": "grid", "file": "/no/D.npy"})")).find("start at"), std::string::npos);

    writeNpy(folder_ / "D.npy", NodeField(8, 12, 1));
    EXPECT_TRUE(holds(refusal(rigidityOf(law)), {"rigidity", "D.npy", "(9, 13)", "(8, 12)"}));
    EXPECT_TRUE(holds(refusal(loadOf(law)), {"load", "D.npy", "(9, 13)"}));

    NodeField field(9, 13, 1);
    field(3, 11) = 0;
    writeNpy(folder_ / "D.npy", field);
    EXPECT_TRUE(holds(refusal(rigidityOf(law)), {"rigidity", "positive", "[3, 11]"}));
    EXPECT_TRUE(holds(refusal(rigidityOf(law), 5), {"rigidity", "positive", "[3, 11]"}))
        << "even where resampling misses it";
    field(3, 11) = std::nan("");
    writeNpy(folder_ / "D.npy", field);
    EXPECT_TRUE(holds(refusal(rigidityOf(law)), {"D.npy", "NaN", "[3, 11]"}));
}

TEST_F(ProblemFile, WhatIsLegalAndHardlyMeantIsWarnedOf)
{
    const auto warning = [&](const std::string& text, std::optional<int> cells = {}) {
        const std::vector<std::string> warnings = read(text, cells).warnings;
        return warnings.size() == 1 ? warnings.front() : std::to_string(warnings.size()) + " warnings";
    };
    const auto none = [&](const std::string& text) { return read(text).warnings.empty(); };

    for (const char* shape : {R"("disc", "centre": [3, 3], "radius": 0.2)", R"("box", "low": [2, 2], "high": [3, 3])",
                              R"("gaussian", "centre": [30, 3], "sigma": 0.2)"}) {
        const std::string law = R"({"from": 1, "to": 10, "law": )" + std::string(shape) + "}";
        EXPECT_TRUE(holds(warning(rigidityOf(law)), {"plate.json", "rigidity", "same value", "1 m x 1.5 m"})) << law;
    }
    const std::string checker = rigidityOf(R"({"law": "checker", "from": 1, "to": 10, "edge": 0.06})");
    EXPECT_TRUE(holds(warning(checker), {"rigidity", "edge of 0.06 m", "spacing of 0.125 m"}));
    EXPECT_TRUE(holds(warning(loadOf(R"({"law": "gaussian", "force": 1, "centre": [0.5, 0.5], "sigma": 0.01})")),
                      {"load", "sigma of 0.01 m", "spacing of 0.125 m"}));
    for (const char* at : {"[0, 0.75]", "[0.3, 1.5]", "[1, 0]"}) // clamped, clamped, the corner of a supported edge
        EXPECT_TRUE(holds(warning(loadOf(R"({"law": "point", "force": 1, "at": )" + std::string(at) + "}")),
                          {"load", "bends nothing"}))
            << at;

    EXPECT_TRUE(none(kProblem));
    EXPECT_TRUE(none(loadOf(R"({"law": "point", "force": 1, "at": [1, 0.75]})"))) << "a free edge";
    EXPECT_TRUE(none(loadOf(R"({"law": "point", "force": 1, "at": [0.01, 0.75]})"))) << "a share reaches a free node";
    EXPECT_TRUE(none(loadOf(R"({"law": "uniform", "pressure": 0})")));
    EXPECT_TRUE(none(rigidityOf(R"({"law": "disc", "from": 1, "to": 1, "centre": [3, 3], "radius": 0.2})")));
    EXPECT_EQ(read(checker, 32).warnings.size(), 0u) << "the spacing is that of the grid that is solved on";
}

TEST_F(ProblemFile, CellsAskedForBeyondTheBoundsAreRefused)
{
    EXPECT_TRUE(holds(refusal(kProblem, 3), {"--cells", "4 to 4096", "3"}));
    EXPECT_TRUE(holds(refusal(kProblem, 4000), {"--cells", "along z", "6000"}));
    EXPECT_TRUE(holds(refusal(kProblem, -8), {"--cells", "-8"}));
    EXPECT_TRUE(holds(refusal(kProblem, 2147483647), {"--cells"}));
}

TEST_F(ProblemFile, BrokenJsonIsReportedWithItsPlace)
{
    EXPECT_TRUE(holds(refusal("{\n\"size\": [1, 1],\n\"cells\" 8}"), {"plate.json", "line 3", "JSON"}));
    EXPECT_TRUE(holds(refusal(""), {"plate.json", "JSON"}));
    EXPECT_TRUE(holds(refusal("[1]"), {"plate.json", "object", "array"}));
    for (const std::string before : {"true", "null", "8", "-8", "0.5", "\"a\"", "[]", "{}"})
        EXPECT_TRUE(holds(refusal(R"({"size": )" + before + R"(, "poisson": 0.3, "poisson": 0.4})"),
                          {"the key \"poisson\" is given twice"}))
            << before;
    EXPECT_TRUE(holds(refusal(std::string(100000, '[')), {"plate.json", "JSON"})) << "deep nesting";
    EXPECT_TRUE(holds(refusal("\x93NUMPY\x01"), {"plate.json", "JSON"}));
    EXPECT_TRUE(holds(refusal(std::string((16u << 20) + 1, ' ')), {"plate.json", "longer than"}));
}

TEST_F(ProblemFile, AMissingFileIsNamed)
{
    EXPECT_TRUE(
        holds(refusalOf([&] { static_cast<void>(readProblem(folder_ / "no.json")); }), {"no.json", "No such file"}));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readProblem(folder_ / "")); }), {"folder"}));
}

} // namespace
} // namespace palp
