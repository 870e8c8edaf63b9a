#include "engine/session/recorded_session.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "engine/session/recording.h"
#include "engine/session/replay_device.h"
#include "tests/session/sessions.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

RecordedSession made(const std::string& name, int count)
{
    RecordedSession session;
    session.folder = name;
    for (int i = 0; i < count; ++i) session.records.push_back(recordNumber(i));
    return session;
}

TEST(RecordedSession, EqualSessionsDoNotDiffer)
{
    EXPECT_FALSE(compareSessions(made("a", 500), made("b", 500)));
    EXPECT_FALSE(compareSessions(made("a", 0), made("b", 0)));
}

TEST(RecordedSession, TheLastBitOfAnyColumnIsFoundWithTickColumnAndValues)
{
    const RecordedSession a = made("a", 100);
    for (const SessionColumn& column : sessionColumns()) {
        const std::size_t each = column.bytes() / column.components;
        for (std::size_t k = 0; k < column.components; ++k) {
            RecordedSession b     = made("b", 100);
            char* const     place = reinterpret_cast<char*>(&b.records[42]) + column.offset + k * each;
            *place                = char(*place ^ 1);

            const auto difference = compareSessions(a, b);

            ASSERT_EQ(difference.has_value(), !column.measured) << column.name;
            if (!difference) continue;
            EXPECT_EQ(difference->tick, 42u);
            EXPECT_EQ(difference->column, column.name);
            EXPECT_EQ(difference->component, k);
            EXPECT_NE(difference->first, difference->second);
        }
    }
}

TEST(RecordedSession, OneOfFormat1IsReadWithTheNamesThatItsKeysHaveToday)
{
    const TemporaryFolder folder;
    {
        Recording recording(folder / "old", someInfo());
        for (int i = 0; i < 5; ++i) recording.push(recordNumber(i));
    }
    const auto description = [&](const std::string& format) { // as format 1 was written
        static_cast<void>(
            folder.write("old/session.json", R"({"format": )" + format + R"(, "versions": {"palpate": "0.1.0"},
            "started": "2026-01-01T00:00:00Z", "command": "palpate run scene.json", "clock": "virtual",
            "device": "llvmpipe", "cloud": "0123456789abcdef",
            "hand": {"model": "a hand", "maximum_force_N": 6.0, "maximum_stiffness_N_per_m": 1000.0},
            "scene": {"cloud": "sample:sheet", "points": 4000, "seed": 1, "thickness": 0.004, "poisson": 0.45,
             "foundation": 1740000.0, "window": 0.07, "cells": 32, "footprint_radius": 0.0044,
             "map": "gall-peters", "sampling": "nearest", "edges": "clamped", "force_law": "series",
             "tolerance": 0.0001, "hand_over": "blend", "table_size": 0, "deformation_rate": 60.0, "proxy": "hybrid",
             "static_friction": 0.5, "dynamic_friction": 0.3, "max_force": 6.0, "stiffness_cap": 1000.0,
             "device": "lavapipe", "place": [0.0,0.0,0.0], "from": [0.0,0.0,1.0], "start_height": 0.01},
            "finished": true, "samples": 5, "lost": 0})"));
    };
    description("1");
    const RecordedSession session = readSession(folder / "old");
    const Scene           scene   = sceneOf(session);

    EXPECT_EQ(session.solver, "llvmpipe");
    EXPECT_EQ(session.records.size(), 5u);
    EXPECT_EQ(scene.solver, "lavapipe");
    EXPECT_EQ(scene.complianceLaw, ComplianceLaw::blend);
    EXPECT_EQ(scene.patch.resampling, Resampling::nearest);
    EXPECT_EQ(scene.material.thickness, 0.004);

    description("2");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readSession(folder / "old")); }), {"\"solver\""}))
        << "the old names are those of format 1 alone";
    description("3");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readSession(folder / "old")); }),
                      {"expected \"format\": 1 or 2", "found 3", "later palpate"}));
}

TEST(RecordedSession, TheFirstDifferenceWinsAndIsDescribedInOneSentence)
{
    const RecordedSession a = made("run1", 100);
    RecordedSession       b = made("run2", 100);
    b.records[50].force.y   = 0.25;
    b.records[60].time      = 9;

    const auto difference = compareSessions(a, b);

    ASSERT_TRUE(difference);
    EXPECT_EQ(describe(*difference, a, b), "tick 50 (0.05 s): force y is 0 in run1 and 0.25 in run2");
}

TEST(RecordedSession, BitsCountNotValues)
{
    const RecordedSession a = made("a", 10);
    RecordedSession       b = made("b", 10);
    b.records[3].hip.z      = 0.0; // was -0
    EXPECT_EQ(compareSessions(a, b)->column, "hip");
    EXPECT_EQ(compareSessions(a, b)->first, "-0");

    RecordedSession c = made("c", 10), d = made("d", 10);
    c.records[3].rigidity = d.records[3].rigidity = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(compareSessions(c, d)) << "the same NaN";
    char* const bits = reinterpret_cast<char*>(&d.records[3].rigidity);
    bits[0]          = char(bits[0] ^ 1);
    const auto nans  = compareSessions(c, d);
    ASSERT_TRUE(nans);
    EXPECT_TRUE(holds(nans->first, {"nan", "bits 0x"})) << nans->first;
    EXPECT_NE(nans->first, nans->second);
}

TEST(RecordedSession, AShorterSessionDiffersWhereItEnds)
{
    const RecordedSession a = made("a", 100), b = made("b", 90);

    const auto difference = compareSessions(a, b);

    ASSERT_TRUE(difference);
    EXPECT_EQ(difference->tick, 90u);
    EXPECT_EQ(difference->column, "");
    EXPECT_EQ(describe(*difference, a, b), "a has 100 ticks and b has 90");
    EXPECT_TRUE(compareSessions(b, a));
}

/// A folder with a finished session of 100 records.
class SessionFolder : public testing::Test {
protected:
    SessionFolder()
    {
        Recording recording(run, someInfo());
        for (int i = 0; i < 100; ++i) recording.pushWaiting(recordNumber(i));
        static_cast<void>(recording.finish());
    }

    [[nodiscard]] std::string refusal() const
    {
        return refusalOf([&] { static_cast<void>(readSession(run)); });
    }
    void put(const std::string& name, const std::string& bytes) const
    {
        std::ofstream(run / name, std::ios::binary) << bytes;
    }

    TemporaryFolder             folder;
    const std::filesystem::path run = folder / "run";
};

TEST_F(SessionFolder, ItsSceneAndItsHandComeBack)
{
    const RecordedSession session = readSession(run);

    const Scene  scene = sceneOf(session);
    ReplayDevice hand(session.records);

    EXPECT_EQ(sceneJson(scene), sceneJson(someInfo().scene));
    EXPECT_EQ(session.command, someInfo().command);
    for (int i = 0; i < 100; ++i) {
        const TickRecord  record = recordNumber(i);
        const HapticState there  = hand.exchange({}, 0);
        EXPECT_EQ(std::memcmp(&there.position, &record.hip, sizeof record.hip), 0) << i;
        EXPECT_EQ(there.velocity, record.hipVelocity) << i;
        EXPECT_EQ(there.buttons, record.device >> 16U) << i;
        EXPECT_EQ(there.missed, record.missed) << i;
        EXPECT_TRUE(there.homed && !there.inBox) << i;
    }
    EXPECT_EQ(hand.exchange({}, 0).fault, DeviceFault::unplugged) << "there is no more";
}

TEST_F(SessionFolder, ColumnsThatAKillLeftLongerAreCutToTheShortest)
{
    std::string force = contentsOf(run / "force.npy");
    force.replace(force.find("(100, 3)"), 8, "(98, 3) ");
    put("force.npy", force);

    EXPECT_TRUE(holds(refusal(), {"force.npy", "100 ticks", "found 98", "damaged"})) << "it was finished";
    std::string description = contentsOf(run / "session.json");
    description.replace(description.find("\"finished\": true"), 16, "\"finished\": false");
    put("session.json", description);
    EXPECT_EQ(readSession(run).records.size(), 98u);
}

TEST_F(SessionFolder, DataBeyondWhatTheHeaderCountsIsIgnored)
{
    put("time.npy", contentsOf(run / "time.npy") + "half");

    EXPECT_EQ(readSession(run).records.size(), 100u);
}

TEST_F(SessionFolder, BrokenFilesAreNamed)
{
    const std::string time = contentsOf(run / "time.npy"), hip = contentsOf(run / "hip.npy"),
                      json = contentsOf(run / "session.json");

    put("time.npy", time.substr(0, time.size() - 1));
    EXPECT_TRUE(holds(refusal(), {"time.npy", "counts 100", "799 bytes"})) << refusal();
    put("time.npy", time.substr(0, 40));
    EXPECT_TRUE(holds(refusal(), {"time.npy", "ends within its header"})) << refusal();
    put("time.npy", hip);
    EXPECT_TRUE(holds(refusal(), {"time.npy", "expected {'descr': '<f8'", "(100, 3)"})) << refusal();
    put("time.npy", "not numpy");
    EXPECT_TRUE(holds(refusal(), {"time.npy", "expected a .npy file"})) << refusal();
    std::string wild = time;
    wild.replace(wild.find("(100,)"), 6, "(99999999999999999999,)");
    put("time.npy", wild);
    EXPECT_TRUE(holds(refusal(), {"time.npy"})) << refusal();
    wild = time;
    wild.replace(wild.find("(100,), }        "), 17, "(9999999999999,),");
    put("time.npy", wild);
    EXPECT_TRUE(holds(refusal(), {"time.npy", "9999999999999", "800 bytes"})) << refusal();
    std::filesystem::remove(run / "time.npy");
    EXPECT_TRUE(holds(refusal(), {"time.npy", "No such file"})) << refusal();
    put("time.npy", time);

    std::string later = json;
    later.replace(later.find("\"format\": 2"), 11, "\"format\": 3");
    put("session.json", later);
    EXPECT_TRUE(holds(refusal(), {"session.json", "format", "later palpate"})) << refusal();
    put("session.json", json.substr(0, 50));
    EXPECT_TRUE(holds(refusal(), {"session.json", "JSON"})) << refusal();
    std::filesystem::remove(run / "session.json");
    EXPECT_TRUE(holds(refusal(), {"run: expected the folder of a recorded session", "session.json", "--record", "F5"}))
        << refusal();
}

} // namespace
} // namespace palp
