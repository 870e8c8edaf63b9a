// Tests of what is stored of a Falcon: where, whether it is used, and that a damaged file is refused in a sentence.
#include "device/falcon/falcon_constants.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "device/falcon/falcon_record.h"
#include "tests/device/falcon_bench.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// A user whose folder of settings is a new one.
class StoredFalcon : public ::testing::Test {
protected:
    void SetUp() override
    {
        before_ = std::getenv("XDG_CONFIG_HOME") ? std::getenv("XDG_CONFIG_HOME") : "";
        ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
    }
    void TearDown() override
    {
        before_.empty() ? ::unsetenv("XDG_CONFIG_HOME") : ::setenv("XDG_CONFIG_HOME", before_.c_str(), 1);
    }

    /// Puts a text where the file of Falcon F1 is read.
    void put(const std::string& text)
    {
        std::filesystem::create_directories(folder_ / "palpate");
        static_cast<void>(folder_.write("palpate/falcon-F1.json", text));
    }

    TemporaryFolder folder_;
    std::string     before_;
    FalconConstants found_{
        .serial = "F1", .countsPerTorque = 9876.5, .armMass = 0.2134, .date = "2026-11-22", .hold = 0.0234};
};

TEST_F(StoredFalcon, IsFoundAgainBySerialNumber)
{
    EXPECT_FALSE(readFalconConstants("F1"));
    const auto file = writeFalconConstants(found_);
    EXPECT_EQ(file, folder_ / "palpate/falcon-F1.json");

    const auto again = readFalconConstants("F1");

    ASSERT_TRUE(again);
    EXPECT_EQ(again->countsPerTorque, found_.countsPerTorque);
    EXPECT_EQ(again->armMass, found_.armMass);
    EXPECT_EQ(again->date, found_.date);
    EXPECT_EQ(again->hold, found_.hold);
    EXPECT_FALSE(readFalconConstants("F2")) << "another Falcon";
    EXPECT_TRUE(holds(describeConstants("F1"), {"9877 counts per N m", "213 g", "a hold of 23 ms", "2026-11-22"}));
    EXPECT_TRUE(holds(describeConstants("F2"), {"none", "palpate calibrate"}));
}

/// A hold is not always found, and files of earlier versions do not have it.
TEST_F(StoredFalcon, AHoldThatIsNotKnownIsNoFault)
{
    found_.hold.reset();
    EXPECT_EQ(contentsOf(writeFalconConstants(found_)).find("hold"), std::string::npos) << "as in an older file";

    const auto again = readFalconConstants("F1");

    ASSERT_TRUE(again);
    EXPECT_FALSE(again->hold);
    EXPECT_EQ(again->armMass, found_.armMass);
    EXPECT_TRUE(holds(describeConstants("F1"), {"9877 counts per N m", "an unknown hold"})) << describeConstants("F1");
}

TEST_F(StoredFalcon, OneWithoutASerialNumberHasAFileToo)
{
    found_.serial = "";
    writeFalconConstants(found_);
    EXPECT_TRUE(readFalconConstants(""));
    EXPECT_EQ(falconConstantsFile("../../etc/x").filename(), "falcon-______etc_x.json") << "no way out of the folder";
}

TEST_F(StoredFalcon, IsReplacedAsAWhole)
{
    writeFalconConstants(found_);
    found_.countsPerTorque = 4300;
    writeFalconConstants(found_);
    EXPECT_EQ(readFalconConstants("F1")->countsPerTorque, 4300);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "palpate"), {}), 1) << "no draft is left";
    for (const FalconConstants& wrong :
         {FalconConstants{"F1", 20000, 0.2, "2026-11-22"}, FalconConstants{"F1", 4200, 3, "2026-11-22"},
          FalconConstants{"F1", 4200, 0.2, "today"}, FalconConstants{"F1", 4200, 0.2, "2026-11-22", 1.1}})
        EXPECT_THROW(writeFalconConstants(wrong), Error);
    EXPECT_EQ(readFalconConstants("F1")->countsPerTorque, 4300) << "what is refused leaves it";
}

/// Whatever the file holds: one sentence with its path and the remedy, and never a value from it.
TEST_F(StoredFalcon, ADamagedFileIsRefusedInOneSentence)
{
    const std::string good = R"({"format": "palpate falcon calibration 1", "serial": "F1", "counts_per_torque": 4200,
                                 "arm_kg": 0.2, "hold_s": 0.02, "date": "2026-11-22"})";
    put(good);
    ASSERT_TRUE(readFalconConstants("F1"));
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        return text.replace(text.find(from), from.size(), to);
    };
    put(with("2026-11-22", "1999-09-09"));
    EXPECT_EQ(readFalconConstants("F1")->date, "1999-09-09");
    put(good + std::string(4096 - good.size(), ' '));
    EXPECT_TRUE(readFalconConstants("F1"));
    for (const std::string& bad : {std::string(),
                                   std::string("{"),
                                   std::string("[]"),
                                   good + std::string(4097 - good.size(), ' '),
                                   std::string("\0\xFF\xFE", 3),
                                   with("4200", "42000"),
                                   with("4200", "1e999"),
                                   with("4200", "\"4200\""),
                                   with("4200", "-1"),
                                   with("0.02", "1.1"),
                                   with("0.02", "-0.01"),
                                   with("0.02", "null"),
                                   with("0.2", "0.41"),
                                   with("0.2", "-0.1"),
                                   with("0.2", "null"),
                                   with("\"F1\"", "\"F2\""),
                                   with("calibration 1", "calibration 2"),
                                   with("2026-11-22", "22.11.2026"),
                                   with("2026-11-22", "2026-11-22\\n"),
                                   with("2026-11-22", "2026-11-2:"),
                                   with("2026-11-22", "2026-11-2/"),
                                   with("2026-11-22", "2026/11/22"),
                                   with("\"arm_kg\"", "\"arm\""),
                                   with("\"arm_kg\"", "\"counts_per_torque\""),
                                   with("{", "{\"more\": 1, ")}) {
        put(bad);
        const std::string why = refusalOf([] { static_cast<void>(readFalconConstants("F1")); });
        EXPECT_TRUE(holds(why, {"the Falcon's calibration is damaged", "falcon-F1.json", "run palpate calibrate anew"}))
            << bad << ": " << why;
        EXPECT_EQ(why.find('\n'), std::string::npos) << why;
        EXPECT_EQ(describeConstants("F1"), "its file is damaged; palpate calibrate writes it anew");
    }
    std::filesystem::remove(folder_ / "palpate/falcon-F1.json");
    ASSERT_EQ(::mkfifo((folder_ / "palpate/falcon-F1.json").c_str(), 0600), 0);
    EXPECT_THROW(static_cast<void>(readFalconConstants("F1")), Error) << "a pipe, on which it would wait";
}

/// It may hold other counts, so that "not calibrated" would be a guess about the forces.
TEST_F(StoredFalcon, AFileThatCannotBeReadIsNoMissingOne)
{
    const auto expectRefused = [](const char* which) {
        const std::string why = refusalOf([] { static_cast<void>(tuningOf("F1", {})); });
        EXPECT_TRUE(holds(why, {"the Falcon's calibration cannot be read", "falcon-F1.json", "make the file"}))
            << which << ": " << why;
        EXPECT_EQ(why.find('\n'), std::string::npos) << why;
        EXPECT_NE(refusalOf([] { static_cast<void>(tuningOf("F1", 5000)); }), "") << "its arm is not known";
        EXPECT_EQ(describeConstants("F1"), why) << which;
    };
    const auto folder = folder_ / "palpate", loop = folder_ / "loop";
    std::filesystem::create_symlink(loop, loop); // nobody can enter it, not even an administrator
    std::filesystem::create_symlink(loop, folder);
    expectRefused("a folder that leads nowhere");
    std::filesystem::remove(folder);

    writeFalconConstants(found_);
    if (::geteuid() != 0) { // whom no permission stops
        std::filesystem::permissions(folder, std::filesystem::perms::none);
        expectRefused("a folder without permission");
        std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
        std::filesystem::permissions(folder / "falcon-F1.json", std::filesystem::perms::none);
        expectRefused("a file without permission");
    }

    std::filesystem::remove_all(folder);
    std::ofstream(folder) << "a file"; // there is no folder, so nothing was ever stored in it
    EXPECT_FALSE(readFalconConstants("F1"));
}

/// A recalibration begins with what every command used until then.
TEST_F(StoredFalcon, IsWhereTheNextCalibrationBegins)
{
    EXPECT_EQ(tuningToCalibrate("F1", {}).countsPerTorque, FalconMotors::kCountsPerTorque);
    writeFalconConstants(found_);
    const FalconTuning stored = tuningToCalibrate("F1", {});
    EXPECT_EQ(stored.countsPerTorque, 9876.5);
    EXPECT_EQ(stored.armMass, 0) << "it is weighed, not carried";
    EXPECT_EQ(stored.note, "");
    EXPECT_EQ(tuningToCalibrate("F1", 5000).countsPerTorque, 5000);
    put("{");
    const FalconTuning damaged = tuningToCalibrate("F1", {});
    EXPECT_EQ(damaged.countsPerTorque, FalconMotors::kCountsPerTorque);
    EXPECT_TRUE(holds(damaged.note, {"damaged"})) << "calibration is the remedy, so it goes on";
}

TEST_F(StoredFalcon, CountsGivenByHandWinAndThisIsSaid)
{
    writeFalconConstants(found_);
    const FalconTuning stored = tuningOf("F1", {}), byHand = tuningOf("F1", 5000);
    EXPECT_EQ(stored.countsPerTorque, 9876.5);
    EXPECT_EQ(stored.note, "");
    EXPECT_EQ(byHand.countsPerTorque, 5000);
    EXPECT_EQ(byHand.armMass, found_.armMass) << "the arm is the same";
    EXPECT_TRUE(holds(byHand.note, {"5000", "given by hand", "9877"})) << byHand.note;
    EXPECT_TRUE(holds(tuningOf("F2", {}).note, {"not been calibrated", "palpate calibrate"}));
    EXPECT_EQ(tuningOf("F2", {}).countsPerTorque, FalconMotors::kCountsPerTorque);
    EXPECT_EQ(tuningOf("F2", 5000).note, "");
}

/// The open device runs with what its serial number finds, and states its weight.
TEST_F(StoredFalcon, TheDeviceUsesItOnceItIsOpen)
{
    std::string          asked;
    FalconDeviceSettings settings;
    settings.tune = [&](const std::string& serial) {
        asked = serial;
        return tuningOf("F1", {});
    };
    writeFalconConstants(found_);
    FalconBench bench(runningFalcon(), {}, settings);
    EXPECT_EQ(asked, "") << "the emulator's bridge has no number";
    EXPECT_NEAR(bench.device->info().weight.y, -0.2134 * 9.81, 1e-12);
    EXPECT_EQ(bench.device->countsInUse(), 9876.5);

    bench.tick(); // homed first
    bench.force = governed({0, 0, 1});
    bench.run(0.1);

    FalconKinematics kinematics;
    const auto       torques = kinematics.torques(FalconKinematics::kMiddle, {0, 0, 1}).value();
    EXPECT_NEAR(bench.emulator.falcon().motors()[0], -9876.5 * torques[0], 1) << "[counts] rounding";

    bench.device->useCounts(4200);
    bench.run(0.1);
    EXPECT_NEAR(bench.emulator.falcon().motors()[0], -4200 * torques[0], 1) << "from the next exchange on";
    bench.device->useCounts(1e6);
    bench.run(0.1);
    EXPECT_NEAR(bench.emulator.falcon().motors()[0], -10000 * torques[0], 1) << "the bound holds";
}

} // namespace
} // namespace palp
