#include "engine/session/recorded_session.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/session/recording.h"
#include "engine/session/replay_device.h"
#include "engine/session/scene_keys.h"
#include "engine/session/session_table.h"
#include "tests/session/old_recording.h"
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

RecordedSession asStoredAll(RecordedSession session)
{
    for (TickRecord& record : session.records) record = asStored(record);
    return session;
}

TEST(RecordedSession, EqualSessionsDoNotDiffer)
{
    EXPECT_FALSE(compareSessions(made("a", 500), made("b", 500)));
    EXPECT_FALSE(compareSessions(made("a", 0), made("b", 0)));
}

TEST(RecordedSession, TheLastBitOfAnyColumnIsFoundWithTickColumnAndValues)
{
    const RecordedSession a = asStoredAll(made("a", 100));
    for (const SessionColumn& column : sessionColumns()) {
        const std::size_t each = column.recordBytes();
        for (std::size_t k = 0; k < column.components; ++k) {
            RecordedSession b     = asStoredAll(made("b", 100));
            char* const     place = reinterpret_cast<char*>(&b.records[42]) + column.offset + k * each;
            if (column.type == SessionColumn::Type::float32) { // the last bit that is stored
                double value = 0;
                std::memcpy(&value, place, sizeof value);
                value = std::nextafter(float(value), 1e30F);
                std::memcpy(place, &value, sizeof value);
            } else {
                *place = char(*place ^ 1);
            }

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
    std::filesystem::create_directory(folder / "old");
    writeOldColumns(folder / "old", made("", 5).records);
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
    ASSERT_EQ(session.records.size(), 5u);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(session.records[std::size_t(i)].hip, recordNumber(i).hip);
        EXPECT_EQ(session.records[std::size_t(i)].compliance, recordNumber(i).compliance) << "a double then";
        EXPECT_EQ(session.records[std::size_t(i)].wanted, glm::dvec3(0)) << "not recorded then";
        EXPECT_EQ(session.records[std::size_t(i)].grip, 0) << "likewise";
        EXPECT_EQ(session.records[std::size_t(i)].answers, std::uint32_t(i + 1)) << "one a tick";
    }
    EXPECT_FALSE(compareSessions(session, made("again", 5))) << "what both have is equal";
    std::ostringstream table;
    EXPECT_EQ(writeTable(session, table).ticks, 5u);
    EXPECT_EQ(table.str().find("wanted"), std::string::npos);
    EXPECT_EQ(scene.solver, "lavapipe");
    EXPECT_EQ(scene.complianceLaw, ComplianceLaw::blend);
    EXPECT_EQ(scene.patch.resampling, Resampling::nearest);
    EXPECT_EQ(scene.material.thickness, 0.004);
    EXPECT_EQ(scene.workspaceScale, 1) << "there was no other";

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

    RecordedSession c        = made("run2", 100);
    c.records[50].iterations = 9;
    EXPECT_EQ(describe(*compareSessions(a, c), a, c), "tick 50 (0.05 s): iterations is 0 in run1 and 9 in run2");
}

TEST(RecordedSession, BitsCountNotValues)
{
    const RecordedSession a = made("a", 10);
    RecordedSession       b = made("b", 10);
    b.records[3].hip.z      = 0.0; // was -0
    EXPECT_EQ(compareSessions(a, b)->column, "hip");
    EXPECT_EQ(compareSessions(a, b)->first, "-0");

    RecordedSession c = made("c", 10), d = made("d", 10);
    c.records[3].answerAge = d.records[3].answerAge = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(compareSessions(c, d)) << "the same NaN";
    char* const bits = reinterpret_cast<char*>(&d.records[3].answerAge);
    bits[0]          = char(bits[0] ^ 1);
    const auto nans  = compareSessions(c, d);
    ASSERT_TRUE(nans);
    EXPECT_TRUE(holds(nans->first, {"nan", "(bits 0x7ff8000000000000)"})) << nans->first;
    EXPECT_TRUE(holds(nans->second, {"nan", "(bits 0x7ff8000000000001)"})) << nans->second;
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

TEST_F(SessionFolder, TheDeviceThatWasHeldComesBack)
{
    SessionInfo info           = someInfo();
    info.hand.model            = "an arm";
    info.hand.maximumForce     = 3;
    info.hand.maximumStiffness = 500;
    info.hand.mass             = 0.25;
    info.hand.ownDamping       = 1.5;
    info.hand.weight           = {0.5, -2, 1};
    info.hand.rotates = info.hand.hasGripper = true;
    static_cast<void>(Recording(folder / "arm", info).finish());

    const RecordedSession       session = readSession(folder / "arm");
    const std::vector<SceneKey> none;

    EXPECT_EQ(session.hand.model, "an arm");
    EXPECT_EQ(session.hand.maximumForce, 3);
    EXPECT_EQ(session.hand.maximumStiffness, 500);
    EXPECT_EQ(session.hand.mass, 0.25);
    EXPECT_EQ(session.hand.ownDamping, 1.5);
    EXPECT_EQ(session.hand.weight, glm::dvec3(0.5, -2, 1));
    EXPECT_TRUE(session.hand.rotates && session.hand.hasGripper);
    EXPECT_EQ(sceneOf(session, &none).toolKeys, &none);
}

TEST_F(SessionFolder, WhatItLacksIsSaid)
{
    const std::string whole = contentsOf(run / "session.json");
    const auto        lacks = [&](const std::string& was, const std::string& is) {
        std::string text = whole;
        text.replace(text.find(was), was.size(), is);
        put("session.json", text);
        return readDescription(run).whyIncomplete;
    };
    EXPECT_EQ(readDescription(run).whyIncomplete, "");
    EXPECT_TRUE(holds(lacks("\"finished\": true", "\"finished\": false"), {"it has no end"}));
    EXPECT_EQ(lacks("\"stopped\": null", "\"stopped\": \"the disk\\u001b[31m was full\""), "the disk?[31m was full");
    EXPECT_EQ(lacks("\"lost\": 0", "\"lost\": 12"), "it lacks 12 ticks");
    EXPECT_EQ(lacks("\"markers_lost\": 0", "\"markers_lost\": 2"), "it lacks 2 markers");
    const std::string file = (run / "markers.jsonl").string();
    put("markers.jsonl", "{\"time\": 0.5, \"text\": \"a\"}\n");
    EXPECT_EQ(lacks("\"markers\": 0", "\"markers\": 1"), "");
    EXPECT_EQ(lacks("\"markers\": 0", "\"markers\": 3"),
              file + ": expected the 3 markers that session.json counts, found 1");
    std::filesystem::remove(file);
    EXPECT_EQ(lacks("\"markers\": 0", "\"markers\": 1"),
              file + ": expected the 1 marker that session.json counts, found no such file");
    EXPECT_EQ(readSession(run).records.size(), 100u) << "its ticks are there";
    EXPECT_EQ(lacks("\"markers\": 0,\n  \"markers_lost\": 0", "\"markers\": 1,\n  \"markers_lost\": 2"),
              "it lacks 2 markers; " + file + ": expected the 1 marker that session.json counts, found no such file");
    EXPECT_EQ(lacks("\"markers\": 0", "\"markers\": 0"), "");
}

TEST_F(SessionFolder, NumbersThatAreNoneAreNamedByTickAndColumn)
{
    const auto doubtsWith = [&](const auto& spoil) {
        std::filesystem::remove_all(run);
        Recording recording(run, someInfo());
        for (int i = 0; i < 100; ++i) {
            TickRecord record = recordNumber(i);
            spoil(i, record);
            recording.pushWaiting(record);
        }
        static_cast<void>(recording.finish());
        std::ostringstream table;
        const auto         doubts = readSession(run).doubts;
        EXPECT_EQ(writeTable(readDescription(run), table).doubts, doubts);
        return doubts;
    };
    constexpr double  kNone = std::numeric_limits<double>::quiet_NaN(), kMost = std::numeric_limits<double>::infinity();
    const std::string file = (run / "ticks.npy").string();
    using Doubts           = std::vector<std::string>;

    EXPECT_EQ(doubtsWith([](int, TickRecord&) {}), Doubts());
    EXPECT_EQ(doubtsWith([](int i, TickRecord& record) { record.hip.y = i == 42 ? kNone : record.hip.y; }),
              Doubts{file + ": tick 42: expected a number as hip_y, found NaN"});
    EXPECT_EQ(doubtsWith([](int i, TickRecord& record) { record.compliance = i > 97 ? -kMost : record.compliance; }),
              Doubts{file + ": tick 98: expected a number as compliance, found infinity; 1 later tick lacks one too"});
    EXPECT_EQ(doubtsWith([](int i, TickRecord& record) { record.time = i > 7 ? kNone : record.time; }),
              Doubts{file + ": tick 8: expected a number as time, found NaN; 91 later ticks lack one too"});
}

TEST_F(SessionFolder, OneClockAloneIsNoMomentOfTimeZero)
{
    const std::string json = contentsOf(run / "session.json");
    const auto        with = [&](const std::string& realtime, const std::string& monotonic) {
        std::string now = json;
        for (const auto& [key, value] : {std::pair{"realtime_ns", realtime}, std::pair{"monotonic_ns", monotonic}}) {
            const std::size_t at = now.find("\": ", now.find(key)) + 3;
            now.replace(at, now.find(',', at) - at, value);
        }
        put("session.json", now);
        return readSession(run).clocks;
    };
    EXPECT_FALSE(with("null", "7"));
    EXPECT_FALSE(with("7", "null"));
    const auto both = with("7", "8");
    ASSERT_TRUE(both);
    EXPECT_EQ(both->realtime, 7);
    EXPECT_EQ(both->monotonic, 8);
}

TEST_F(SessionFolder, OldColumnsThatAKillLeftLongerAreCutToTheShortest)
{
    std::filesystem::remove(run / "ticks.npy");
    writeOldColumns(run, made("", 100).records);
    EXPECT_EQ(readSession(run).records.size(), 100u);
    const std::string whole = contentsOf(run / "force.npy"), finished = contentsOf(run / "session.json");
    std::string       force = whole;
    force.replace(force.find("(100, 3)"), 8, "(98, 3) ");
    put("force.npy", force);

    EXPECT_TRUE(holds(refusal(), {"force.npy", "100 ticks", "found 98", "damaged"})) << "it was finished";
    std::string description = contentsOf(run / "session.json");
    description.replace(description.find("\"finished\": true"), 16, "\"finished\": false");
    put("session.json", description);
    EXPECT_EQ(readSession(run).records.size(), 98u);
    EXPECT_EQ(readSession(run).doubts, std::vector<std::string>());
    put("session.json", finished);
    put("force.npy", whole + "half");
    EXPECT_EQ(readSession(run).doubts,
              std::vector{(run / "force.npy").string() +
                          ": expected the end after the 100 ticks that the header counts, found 4 bytes more; what "
                          "lies beyond is not read"});
    put("force.npy", contentsOf(run / "time.npy"));
    EXPECT_TRUE(holds(refusal(), {"force.npy", "expected {'descr': '<f8'", "N, 3)", "(100,)"})) << refusal();
}

/// Those of a recording that still runs have been written, and are not yet counted.
TEST_F(SessionFolder, DataBeyondWhatTheHeaderCountsIsIgnoredAndSaidOfAFinishedRecording)
{
    const std::string ticks = contentsOf(run / "ticks.npy"), file = (run / "ticks.npy").string();
    const std::string json     = contentsOf(run / "session.json");
    const auto        sentence = [&](const std::string& more) {
        return file + ": expected the end after the 100 ticks that the header counts, found " + more +
               " more; what lies beyond is not read";
    };
    using Doubts = std::vector<std::string>;
    for (const auto& [bytes, more] :
         {std::pair<std::size_t, std::string>{4, "4 bytes"}, {230, "1 tick"}, {4480, "20 ticks"}}) {
        put("session.json", json);
        put("ticks.npy", ticks + std::string(bytes, 'x'));
        const RecordedSession session = readSession(run);
        std::ostringstream    table;
        EXPECT_EQ(session.records.size(), 100u);
        EXPECT_EQ(session.doubts, Doubts{sentence(more)});
        EXPECT_EQ(writeTable(readDescription(run), table).doubts, session.doubts);
        std::string running = json;
        running.replace(running.find("\"finished\": true"), 16, "\"finished\": false");
        put("session.json", running);
        EXPECT_EQ(readSession(run).doubts, Doubts());
    }
}

TEST_F(SessionFolder, ColumnsOfALaterPalpateArePassedOver)
{
    std::string ticks = contentsOf(run / "ticks.npy");
    ticks.replace(ticks.find("'tank_energy'"), 13, "'tonk_energy'");
    put("ticks.npy", ticks);

    const RecordedSession session = readSession(run);

    EXPECT_EQ(session.records[7].tankEnergy, 0);
    EXPECT_EQ(session.records[7].observerEnergy, asStored(recordNumber(7)).observerEnergy)
        << "what follows is in place";
    EXPECT_EQ(compareSessions(session, made("b", 100)), std::nullopt) << "it is not compared";
}

/// Sessions that were recorded before the grip had a column are read, and replay.
TEST_F(SessionFolder, OneWithoutTheGripIsReadAsAHandThatHasNone)
{
    std::string ticks = contentsOf(run / "ticks.npy");
    ticks.replace(ticks.find("'grip'"), 6, "'grop'");
    put("ticks.npy", ticks);

    const RecordedSession session = readSession(run);

    EXPECT_EQ(session.records[7].grip, 0);
    EXPECT_EQ(session.records[7].answers, recordNumber(7).answers);
    EXPECT_EQ(compareSessions(session, made("b", 100)), std::nullopt) << "it is not compared";
}

TEST_F(SessionFolder, APipeInThePlaceOfAFileIsNotWaitedFor)
{
    for (const char* const name : {"session.json", "markers.jsonl", "ticks.npy"}) {
        const std::string whole = contentsOf(run / name);
        std::filesystem::remove(run / name);
        ASSERT_EQ(::mkfifo((run / name).c_str(), 0666), 0);
        EXPECT_TRUE(holds(refusal(), {name, "found a pipe"})) << refusal();
        std::filesystem::remove(run / name);
        put(name, whole);
    }
    EXPECT_EQ(refusal(), "");
}

TEST_F(SessionFolder, AHeaderWithAnyOneByteWrongIsRefusedOrReadAndNothingElse)
{
    const std::string ticks = contentsOf(run / "ticks.npy");
    for (std::size_t at = 0; at < ticks.find('\n', 12); ++at) {
        std::string wild = ticks;
        wild[at]         = "9'\xff"[at % 3];
        put("ticks.npy", wild);
        // Another exception than an Error, or a crash, fails: sizes are believed nowhere. Other names of columns are
        // read.
        if (!refusal().empty()) continue;
        EXPECT_EQ(readSession(run).records.size(), 100u) << at;
    }
}

TEST_F(SessionFolder, ThePageHasATableOfTheColumnsInTheirOrder)
{
    const std::string page = contentsOf(PALPATE_RECORDINGS_PAGE);
    std::size_t       from = page.find("### The columns");
    for (const SessionColumn& column : sessionColumns()) {
        const std::string type = (column.components > 1 ? std::to_string(column.components) + " " : "") +
                                 std::string(column.numpyType().substr(1));
        const std::size_t at = page.find("| `" + std::string(column.name) + "` | " + type + " |", from);
        ASSERT_NE(at, std::string::npos) << column.name << " " << type;
        EXPECT_LT(page.find("\n", from), at);
        from = at;
    }
    EXPECT_NE(
        page.find("array of NumPy whose fields are the columns below; " + std::to_string(tickRowBytes()) + " bytes"),
        std::string::npos);
}

TEST_F(SessionFolder, BrokenFilesAreNamed)
{
    const std::string ticks = contentsOf(run / "ticks.npy"), json = contentsOf(run / "session.json");
    const auto        with = [&](const std::string& old, const std::string& now) {
        std::string wild = ticks;
        wild.replace(wild.find(old), old.size(), now);
        put("ticks.npy", wild);
        return refusal();
    };

    put("ticks.npy", ticks.substr(0, ticks.size() - 1));
    EXPECT_TRUE(
        holds(refusal(), {"ticks.npy", "counts 100", "224 bytes", "22399 bytes, 99 whole ticks;", "copy it again"}))
        << refusal();
    put("ticks.npy", ticks.substr(0, 40));
    EXPECT_TRUE(holds(refusal(), {"ticks.npy", "ends within its header"})) << refusal();
    put("ticks.npy", "not numpy");
    EXPECT_TRUE(holds(refusal(), {"ticks.npy", "expected a .npy file"})) << refusal();
    EXPECT_TRUE(holds(with("(100,), }            ", "(9999999999999999999,)"), {"ticks.npy", "9999999999999999999"}));
    EXPECT_TRUE(holds(with("(100,), }            ", "(99999999999999999999)"), {"ticks.npy", "expected rows"}));
    EXPECT_TRUE(holds(with("(100,)", "(101,)"), {"counts 101", "22400 bytes"}));
    EXPECT_TRUE(holds(with("('hip', '<f8', (3,))", "('hip', '<f8', (9,))"), {"column hip", "expected once, 3"}));
    EXPECT_TRUE(holds(with("('hip', '<f8'", "('hip', '<f4'"), {"column hip", "<f4"}));
    EXPECT_TRUE(holds(with("('hip', '<f8'", "('hup', '<f8'"), {"expected a column hip"}));
    EXPECT_TRUE(holds(with("('proxy', '<f8', (3,))", "('proxy', '<f8', 3333)"), {"ticks.npy", "expected rows"}));
    EXPECT_TRUE(holds(with("('wanted', '<f4', (3,))", "('time', '<f4', (3,))  "), {"column time", "once"}));
    EXPECT_TRUE(holds(with("'fortran_order': False", "'fortran_order': True "), {"ticks.npy", "expected rows"}));
    std::filesystem::remove(run / "ticks.npy");
    EXPECT_TRUE(holds(refusal(), {"ticks.npy", "No such file"})) << refusal();
    put("ticks.npy", ticks);

    put("markers.jsonl", "{\"time\": 1}\n");
    EXPECT_TRUE(holds(refusal(), {"markers.jsonl: line 1", "\"text\""})) << refusal();
    put("markers.jsonl", "{\"time\": 1, \"text\": \"" + std::string(20000, 'a') + "\"}\n");
    EXPECT_TRUE(holds(refusal(), {"markers.jsonl: line 1", "at most 16384 bytes", "found 20023"})) << refusal();
    put("markers.jsonl", "");
    std::string counted = json;
    counted.replace(counted.find("\"samples\": 100"), 14, "\"samples\": 99 ");
    put("session.json", counted);
    EXPECT_TRUE(holds(refusal(), {"run", "99 ticks", "found 100", "damaged"})) << refusal();

    std::string later = json;
    later.replace(later.find("\"format\": 2"), 11, "\"format\": 3");
    put("session.json", later);
    EXPECT_TRUE(holds(refusal(), {"session.json", "format", "later palpate"})) << refusal();
    later.erase(later.find("\"format\": 3,"), 12);
    put("session.json", later);
    EXPECT_TRUE(holds(refusal(), {"session.json", "expected \"format\": 1 or 2, found none"})) << refusal();
    put("session.json", json.substr(0, 50));
    EXPECT_TRUE(holds(refusal(), {"session.json", "JSON"})) << refusal();
    std::filesystem::remove(run / "session.json");
    EXPECT_TRUE(holds(refusal(), {"run: expected the folder of a recorded session", "session.json", "--record", "F5"}))
        << refusal();
}

} // namespace
} // namespace palp
