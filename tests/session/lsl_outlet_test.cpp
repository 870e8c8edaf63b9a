#include "engine/session/lsl_outlet.h"

#include <chrono>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/session/sessions.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

std::vector<std::string> linesOf(const std::string& text)
{
    std::istringstream       in(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST(LslOutlet, TicksAndMarkersAreOfferedWithLabelsAndTimesOnTheLayersClock)
{
    const TemporaryFolder folder;
    ::setenv("FAKE_LSL_LOG", (folder / "log").c_str(), 1);
    {
        TickStream          stream(std::make_unique<LslOutlet>("Rig 2", PALPATE_FAKE_LSL));
        const SessionClocks clocks = SessionClocks::at(std::chrono::steady_clock::now()); // 5000 s on the layer's clock
        stream.begin(clocks);
        stream.push(recordNumber(2000)); // 2 s later
        stream.mark({2.0, "left hand"}, clocks);
        EXPECT_EQ(stream.finish().sent, 1u);
    }
    const auto lines = linesOf(contentsOf(folder / "log"));

    ASSERT_EQ(lines.size(), 6u) << contentsOf(folder / "log");
    EXPECT_TRUE(holds(lines[0], {"outlet Rig 2; Haptics; 41 channels of format 2; 1000 Hz", "label=hip_x unit=m",
                                 "label=stiffness unit=N/m"}))
        << lines[0];
    EXPECT_TRUE(holds(lines[1], {"outlet Rig 2 Markers; Markers; 1 channels of format 3; 0 Hz"})) << lines[1];
    std::istringstream  sample(lines[2]);
    std::string         word;
    double              time = 0;
    std::vector<double> values;
    sample >> word >> time >> word;
    for (double value; sample >> value;) values.push_back(value);
    EXPECT_NEAR(time, 5002, 0.5) << "the thread of a busy machine reads the layer's clock a little later";
    ASSERT_EQ(values.size(), 41u);
    EXPECT_NEAR(values[12], recordNumber(2000).force.z, 1e-5) << "as far as the log's digits go";
    EXPECT_EQ(values[39], 2000) << "answers";
    EXPECT_NEAR(values[40], 2000 / 900.0, 1e-5) << "grip, as far as the log's digits go";
    EXPECT_TRUE(holds(lines[3], {"text Rig 2 Markers 500", "left hand"})) << lines[3];
    EXPECT_TRUE(lines[4].starts_with("end of Rig 2") && lines[5].starts_with("end of Rig 2"));
}

TEST(LslOutlet, AMissingLibraryIsSaidWithWhatHelps)
{
    EXPECT_TRUE(holds(refusalOf([] { const LslOutlet outlet("Palpate", "/nowhere/liblsl.so"); }),
                      {"--stream lsl", "liblsl", "/nowhere/liblsl.so", "install", "LD_LIBRARY_PATH", "udp:HOST:PORT"}));
}

TEST(LslOutlet, ALibraryOfAnotherKindIsRefused)
{
    EXPECT_TRUE(holds(refusalOf([] { const LslOutlet outlet("Palpate", "libm.so.6"); }),
                      {"--stream lsl", "lsl_create_streaminfo", "1.13"}));
}

} // namespace
} // namespace palp
