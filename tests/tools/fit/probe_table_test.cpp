#include "engine/tools/fit/probe_table.h"

#include <fstream>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp::fit {
namespace {

const std::string kRising = "0,0\n1,0.1\n2,0.3\n3,0.6\n4,1\n";

std::string refusal(const std::string& text)
{
    try {
        (void)parseProbes(text, "probes.csv");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

::testing::AssertionResult says(const std::string& text, std::initializer_list<std::string> parts)
{
    const std::string said = refusal(text);
    for (const std::string& part : parts)
        if (said.find(part) == std::string::npos)
            return ::testing::AssertionFailure() << "\"" << said << "\" lacks \"" << part << "\"";
    return ::testing::AssertionSuccess();
}

TEST(ProbeTable, ReadsProbesThatAreMixedWithUnitsAndPlaces)
{
    const auto probes =
        parseProbes("# a scan\r\nprobe, depth [mm], note, force [mN], x [cm], y [cm], z [cm], nx, ny, nz\r\n"
                    "a,0,?,0,1,2,3,0,0,1\r\nb,0,,0,4,5,6,0,1,0\r\n"
                    "a,1,,100,1,2,3,0,0,1\r\na,2,,250,1,2,3,0,0,1\r\na,3,,300,1,2,3,0,0,1\r\n"
                    "a,3,,310,1,2,3,0,0,1\r\nb,1,,2,4,5,6,0,1,0\r\nb,2,,3,4,5,6,0,1,0\r\n"
                    "b,3,,4,4,5,6,0,1,0\r\nb,4,,5,4,5,6,0,1,0",
                    "probes.csv");

    ASSERT_EQ(probes.size(), 2u);
    EXPECT_EQ(probes[0].name, "a");
    EXPECT_EQ(probes[0].depth, (std::vector<double>{0, 1e-3, 2e-3, 3e-3, 3e-3}));
    EXPECT_EQ(probes[0].force, (std::vector<double>{0, 0.1, 0.25, 0.3, 0.31}));
    EXPECT_EQ(probes[1].place, glm::dvec3(0.04, 0.05, 0.06));
    EXPECT_EQ(probes[1].normal, glm::dvec3(0, 1, 0));
    EXPECT_TRUE(probes[0].time.empty());
}

TEST(ProbeTable, AByteOrderMarkIsNoPartOfTheFirstName)
{
    std::string two = "\xEF\xBB\xBFprobe,depth [mm],force,time\n";
    for (const char* name : {"a", "b"})
        for (int n = 0; n < 5; ++n)
            two +=
                std::string(name) + "," + std::to_string(n) + "," + std::to_string(n) + "," + std::to_string(n) + "\n";
    EXPECT_EQ(parseProbes(two, "p").size(), 2u);
    const TemporaryFolder folder;
    EXPECT_TRUE(holdsProbes(folder.write("a.csv", "\xEF\xBB\xBF"
                                                  "depth,force\n")));
}

TEST(ProbeTable, RowsOfOneProbeHaveOnePlace)
{
    const auto rows = [](const std::string& header, const std::string& name) {
        std::string text = header + "depth [mm],force,x [mm],y,z\n";
        for (int n = 0; n < 10; ++n)
            text += name + std::to_string(n % 5) + "," + std::to_string(n % 5) + "," + (n < 5 ? "0" : "20") + ",0,0\n";
        return text;
    };
    EXPECT_TRUE(says(rows("time,", "0,"), {"line 7", "one place", "(20.0 mm, 0 m, 0 m) after (0 m, 0 m, 0 m)",
                                           "20.0 mm apart", "name several probes by a column \"probe\""}));
    EXPECT_TRUE(says(rows("probe,", "a,"), {"line 7", "of probe a", "in the first row alone"}));
}

/// As robots and people write them.
TEST(ProbeTable, APlaceMayTrembleOrStandInTheFirstRowAlone)
{
    const auto rows = [](const std::string& first, const std::string& later) {
        std::string text = "depth [mm],force,x [mm],y [mm],z [mm],nx,ny,nz\n";
        for (int n = 0; n < 6; ++n)
            text += std::to_string(n) + "," + std::to_string(n) + "," + (n ? later : first) + "\n";
        return text;
    };
    const std::string first = "10,0,5,0,0,1";
    for (const std::string& later : {first, std::string("10.05,0.0000001,5,0.001,0,1"), std::string(",,,,,")}) {
        const auto probes = parseProbes(rows(first, later), "p");
        ASSERT_EQ(probes.size(), 1U);
        EXPECT_EQ(probes.front().place, glm::dvec3(0.01, 0, 0.005)) << "that of the first row";
        EXPECT_EQ(probes.front().normal, glm::dvec3(0, 0, 1));
    }
    EXPECT_TRUE(says(rows(first, "10.2,0,5,0,0,1"), {"line 3", "200 \u00b5m apart"}));
    EXPECT_TRUE(says(rows(first, "10,0,5,0,1,0"), {"line 3", "one direction"}));
    EXPECT_TRUE(says(rows(",,,0,0,1", first), {"line 3", "in its first row"}));
    EXPECT_TRUE(says(rows(first, "10,,5,0,0,1"), {"line 3", "column y", "finite number"}));
}

TEST(ProbeTable, WithoutNamesAllRowsAreOneProbeAndWithTimesItMayGoBack)
{
    const auto probes = parseProbes("time,depth,force\n0,0,0\n1,1e-3,1\n2,1e-3,0.8\n3,0,0\n4,0,0\n", "p");

    ASSERT_EQ(probes.size(), 1u);
    EXPECT_EQ(probes[0].time.size(), 5u);
    EXPECT_EQ(probes[0].deepest(), 1e-3);
    EXPECT_EQ(probes[0].forceRange(), 1);
}

TEST(ProbeTable, WhatNoProbeMeasuresIsRefusedAndANameIsShownAsATerminalMayHaveIt)
{
    EXPECT_TRUE(says("depth,force\n1e-320,1\n2e-320,1\n3e-320,1\n4e-320,1\n5e-320,1\n", {"depths that differ"}));
    EXPECT_TRUE(
        says("depth [mm],force\n1,1e-310\n2,2e-310\n3,3e-310\n4,4e-310\n5,5e-310\n", {"a force above 1.00 nN"}));
    EXPECT_TRUE(says("depth [mm],force,time\n0,0,0\n1,1,1\n2,1,2\n2,1,3\n2,1,1e300\n", {"line 6", "times over 1"}));
    const auto probes = parseProbes(
        "depth,force,probe\n0,0,\x1b[31m\n.01,1,\x1b[31m\n.02,2,\x1b[31m\n.03,3,\x1b[31m\n.04,4,\x1b[31m\n", "p");
    EXPECT_EQ(probes[0].name, "?[31m");
    std::string latin = "probe,depth,force\n"; // names of one byte each that is no UTF-8
    for (int n = 0; n < 10; ++n)
        latin += std::string(1, n % 2 ? '\xe4' : '\xf6') + ",0.0" + std::to_string(n / 2) + ",1\n";
    EXPECT_EQ(parseProbes(latin, "p").size(), 2u);
}

TEST(ProbeTable, ANameForEachRowIsRefused)
{
    std::string text = "probe,depth,force\n";
    for (int n = 0; n <= 10000; ++n) text += std::to_string(n) + ",0,1\n";
    EXPECT_TRUE(says(text, {"line 10002", "at most 10000 probes", "\"probe\""}));
}

TEST(ProbeTable, EachMistakeIsOneSentenceWithItsLineAndARemedy)
{
    EXPECT_TRUE(
        says("depth,force\n" + kRising, {"probes.csv, line 3", "probe 1", "at most 100 mm", "1.00 m", "depth [mm]"}));
    EXPECT_TRUE(says("depth [mm],force\n0,0\n1,-0.1\n2,-0.3\n3,-0.6\n4,-1\n", {"line 6", "-1.00 N", "turn the sign"}));
    EXPECT_TRUE(says("depth [mm],force\n0,0\n1,100\n2,300\n3,600\n4,5000\n", {"line 6", "5.00 kN", "force [mN]"}));
    EXPECT_TRUE(says("depth [mm],force\n0,0\n2,0.3\n1,0.1\n3,0.6\n4,1\n",
                     {"line 4", "1.00 mm after 2.00 mm", "sort the rows"}));
    EXPECT_TRUE(says("depth [mm],force\n0,0\n1,0.1\n2,0.3\n", {"line 4", "at least 5 rows", "found 3"}));
    EXPECT_TRUE(
        says("depth [mm],force\n-1,0\n1,0.1\n2,0.3\n3,0.6\n4,1\n", {"line 2", "depth of 0 or more", "-1.00 mm"}));
    EXPECT_TRUE(says("depth [mm],force,time\n0,0,0\n1,1,1\n1,1,1\n1,1,2\n1,1,3\n", {"line 4", "times that rise"}));
    EXPECT_TRUE(says("depth [mm],force\n1,1\n1,1\n1,1\n1,1\n1,1\n", {"depths that differ"}));
    EXPECT_TRUE(says("depth [mm],force\n0,0\n1,0\n2,0\n3,0\n4,0\n", {"a force above 1.00 nN"}));
    EXPECT_TRUE(says("depth [furlong],force\n" + kRising, {"line 1", "\"depth\"", "furlong", "mm"}));
    EXPECT_TRUE(says("deep,force\n" + kRising, {"column \"depth\"", "deep,force"}));
    EXPECT_TRUE(says("depth,depth,force\n", {"one column \"depth\", found two"}));
    EXPECT_TRUE(says("depth,force\n0\n", {"line 2", "at least 2 numbers, found 1"}));
    EXPECT_TRUE(says("depth,force\n0,nan\n", {"line 2", "column force", "\"nan\""}));
    EXPECT_TRUE(says("depth,force\n", {"rows below a header line"}));
}

TEST(ProbeTable, IsKnownByItsHeader)
{
    const TemporaryFolder folder;
    const auto            holds = [&](const std::string& text) {
        std::ofstream(folder.path() / "a.csv") << text;
        return holdsProbes(folder.path() / "a.csv");
    };
    EXPECT_TRUE(holds("# a comment\n\nprobe,\"depth [mm]\",force(N)\n"));
    EXPECT_TRUE(holds("depth [mm],force\r\n0,0\r\n"));
    EXPECT_FALSE(holds("x,y,z,felt_stiffness\n1,2,3,4\n"));
    EXPECT_FALSE(holds(""));
}

} // namespace
} // namespace palp::fit
