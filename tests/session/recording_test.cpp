#include "engine/session/hand_path.h"
#include "engine/session/recording.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/file.h"
#include "engine/session/recorded_session.h"
#include "engine/session/session_table.h"
#include "tests/session/sessions.h"
#include "tests/support/allocations.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Json  = nlohmann::json;
using Clock = std::chrono::steady_clock;

bool sameBytes(const TickRecord& a, const TickRecord& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Records this many records and ends.
RecordingReport recorded(const std::filesystem::path& folder, int count)
{
    Recording recording(folder, someInfo());
    for (int i = 0; i < count; ++i) recording.pushWaiting(recordNumber(i));
    return recording.finish();
}

std::size_t lines(const std::string& text)
{
    return std::size_t(std::ranges::count(text, '\n'));
}

TEST(Recording, WhatIsPushedIsReadBackByteForByte)
{
    const TemporaryFolder folder;

    const RecordingReport report  = recorded(folder / "run", 20'000);
    const RecordedSession session = readSession(folder / "run");

    EXPECT_EQ(report.ticks, 20'000u);
    EXPECT_EQ(report.lost, 0u);
    EXPECT_FALSE(report.stopped) << *report.stopped;
    ASSERT_EQ(session.records.size(), 20'000u);
    for (int i = 0; i < 20'000; ++i)
        ASSERT_TRUE(sameBytes(session.records[std::size_t(i)], asStored(recordNumber(i)))) << i;
    EXPECT_TRUE(session.finished);
    EXPECT_EQ(session.clock, SessionClock::virtualTime);
}

TEST(Recording, TheDescriptionSaysWhatWasRunAndHow)
{
    const TemporaryFolder folder;
    static_cast<void>(recorded(folder / "run", 10));

    const Json json = Json::parse(contentsOf(folder / "run" / "session.json"));

    EXPECT_EQ(json["versions"]["palpate"], "0.1.0");
    EXPECT_EQ(json["solver"], "host");
    EXPECT_EQ(json["command"], "palpate run skin.json --hand press");
    EXPECT_EQ(json["scene"]["thickness"], 0.003);
    EXPECT_EQ(json["origins"]["thickness"], "scene skin.json");
    EXPECT_EQ(json["columns"]["force"]["unit"], "N");
    EXPECT_EQ(json["samples"], 10);
    EXPECT_EQ(json["lost"], 0);
    EXPECT_TRUE(json["stopped"].is_null());
    EXPECT_EQ(json["started"].get<std::string>().size(), std::string("2026-01-01T00:00:00Z").size());
}

TEST(Recording, NumbersThatAreNoDoublesAreRoundedToFloatsAndNothingElseChanges)
{
    const TickRecord whole = recordNumber(7), stored = asStored(whole);

    EXPECT_EQ(stored.hip, whole.hip);
    EXPECT_EQ(stored.force, whole.force);
    EXPECT_EQ(stored.answerAge, whole.answerAge);
    EXPECT_EQ(stored.stiffness, double(float(whole.stiffness)));
    EXPECT_NE(stored.stiffness, whole.stiffness) << "or this record shows nothing";
    EXPECT_EQ(stored.orientation.y, double(float(0.6)));
    EXPECT_EQ(stored.answers, whole.answers);
    EXPECT_TRUE(sameBytes(asStored(stored), stored));
}

TEST(Recording, ATickTakesTheBytesOfItsRow)
{
    const TemporaryFolder folder;
    static_cast<void>(recorded(folder / "run", 10'000));

    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder / "run")) bytes += file.file_size();

    EXPECT_EQ(tickRowBytes(), 15 * 8 + 19 * 4 + 6 * 4 + 4) << "recordings.md says so, and Python that reads datagrams";
    // The description and the header take some 8 kB however long the session is.
    EXPECT_LT(double(bytes), 10'000 * 224.0 + 20'000);
}

TEST(Recording, TheTableHoldsTheSameNumbers)
{
    const TemporaryFolder folder;
    static_cast<void>(recorded(folder / "run", 5'000)); // more than are in memory at once

    std::ostringstream written;
    EXPECT_EQ(writeTable(readDescription(folder / "run"), written).ticks, 5'000u);
    std::istringstream csv(written.str());
    std::string        line;
    std::getline(csv, line);
    EXPECT_TRUE(line.starts_with("time,hip_x,hip_y,hip_z,hip_velocity_x,hip_velocity_y,hip_velocity_z,proxy_x,proxy_y,"
                                 "proxy_z,force_x,force_y,force_z,answer_time,answer_age,wanted_x,"))
        << line;
    EXPECT_TRUE(line.ends_with(",iterations,missed,faults,actions,device,answers,grip")) << line;
    for (int i = 0; i < 5'000; ++i) {
        std::getline(csv, line);
        std::ranges::replace(line, ',', ' ');
        std::istringstream  words(line);
        std::vector<double> numbers;
        for (std::string word; words >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
        ASSERT_EQ(numbers.size(), 41u);
        ASSERT_EQ(numbers[1], recordNumber(i).hip.x);
        ASSERT_EQ(numbers[12], recordNumber(i).force.z);
        ASSERT_EQ(float(numbers[17]), float(recordNumber(i).wanted.z)) << "the shortest text brings the float back";
        ASSERT_EQ(numbers[34], recordNumber(i).iterations);
        ASSERT_EQ(numbers[36], recordNumber(i).faults);
        ASSERT_EQ(float(numbers[40]), float(recordNumber(i).grip));
    }
    EXPECT_FALSE(std::getline(csv, line));
    EXPECT_EQ(readHand(folder.write("table.csv", written.str())).position(0.05), recordNumber(50).hip)
        << "a hand again";
}

TEST(Recording, TheClocksOfTimeZeroAreInItWhileItRuns)
{
    const TemporaryFolder folder;
    Recording             recording(folder / "run", someInfo());
    EXPECT_FALSE(readSession(folder / "run").clocks) << "time 0 has not come";
    const auto start = std::chrono::steady_clock::now() - std::chrono::milliseconds(1500);

    recording.begin(SessionClocks::at(start));
    recording.push(recordNumber(0));
    for (int n = 0; n < 2000 && !readSession(folder / "run").clocks; ++n)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const auto clocks = readSession(folder / "run").clocks;

    ASSERT_TRUE(clocks);
    EXPECT_EQ(clocks->monotonic, std::chrono::nanoseconds(start.time_since_epoch()).count());
    const auto now = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
    EXPECT_LT(clocks->realtime, now - 1'400'000'000);
    EXPECT_GT(clocks->realtime, now - 60'000'000'000) << "a busy machine may take seconds for the above";
    EXPECT_FALSE(readSession(folder / "run").finished);
}

TEST(Recording, TimeZeroIsTheFirstTickWhereNobodyBegan)
{
    const TemporaryFolder folder;
    for (const bool waits : {false, true}) {
        Recording  recording(folder / std::to_string(waits), someInfo());
        const auto before = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
        if (waits)
            recording.pushWaiting(recordNumber(0));
        else
            recording.push(recordNumber(0));
        const auto after = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
        EXPECT_EQ(recording.finish().ticks, 1u);
        const auto clocks = readSession(folder / std::to_string(waits)).clocks;
        ASSERT_TRUE(clocks) << waits;
        EXPECT_GE(clocks->monotonic, before);
        EXPECT_LE(clocks->monotonic, after);
    }
}

TEST(Recording, TimeZeroIsAsLongAgoAsTheFirstTickSays)
{
    const TemporaryFolder folder;
    for (const double time : {1000.0, -3.0, 1e300}) {
        Recording  recording(folder / std::to_string(time).substr(0, 6), someInfo());
        TickRecord record = recordNumber(0);
        record.time       = time;
        const auto before = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
        recording.push(record);
        const auto after = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
        static_cast<void>(recording.finish());
        const auto clocks = readSession(folder / std::to_string(time).substr(0, 6)).clocks;
        ASSERT_TRUE(clocks) << time;
        if (time > 1e9) continue; // there is no such clock, and no overflow
        EXPECT_GE(clocks->monotonic + std::int64_t(time * 1e9), before) << time;
        EXPECT_LE(clocks->monotonic + std::int64_t(time * 1e9), after) << time;
    }
}

TEST(Recording, MarkersAreLinesOfJsonThatNothingCanBreak)
{
    const TemporaryFolder folder;
    {
        Recording recording(folder / "run", someInfo());
        recording.push(recordNumber(0));
        recording.mark({0.125, markerText("start \"A\"")});
        recording.mark({0.25, markerText("\x1b[31mred\n{\"time\": 9}")});
        const RecordingReport report = recording.finish();
        EXPECT_EQ(report.markers, 2u);
        EXPECT_EQ(report.markersLost, 0u);
    }
    const std::string lines_ = contentsOf(folder / "run" / "markers.jsonl");
    std::ofstream(folder / "run" / "markers.jsonl", std::ios::app) << "{\"time\": 0.5, \"te"; // cut by a kill

    const RecordedSession session = readSession(folder / "run");

    EXPECT_EQ(lines(lines_), 2u);
    ASSERT_EQ(session.markers.size(), 2u);
    EXPECT_EQ(session.markers[0].time, 0.125);
    EXPECT_EQ(session.markers[0].text, "start \"A\"");
    EXPECT_EQ(session.markers[1].text, "[31mred {\"time\": 9}");
}

TEST(Recording, AFloodOfMarkersIsCutAndCounted)
{
    const TemporaryFolder folder;
    Recording             recording(folder / "run", someInfo());

    for (int i = 0; i < 200'000; ++i) recording.mark({0, "x"});
    const RecordingReport report = recording.finish();

    EXPECT_EQ(report.markers + report.markersLost, 200'000u);
    EXPECT_LE(report.markers, Recording::kMostMarkers);
    EXPECT_GE(report.markers, 1u);
    EXPECT_EQ(readSession(folder / "run").markers.size(), report.markers);
}

TEST(Recording, MarkersThatDidNotReachItAreAmongThoseThatItLacks)
{
    const TemporaryFolder folder;
    Recording             recording(folder / "run", someInfo());

    recording.lose(7);
    recording.mark({0, "x"});
    recording.lose(2);
    const RecordingReport report = recording.finish();

    EXPECT_EQ(report.markers, 1u);
    EXPECT_EQ(report.markersLost, 9u);
    EXPECT_EQ(readDescription(folder / "run").whyIncomplete, "it lacks 9 markers");
}

TEST(Recording, NoSessionIsOverwritten)
{
    const TemporaryFolder folder;
    static_cast<void>(recorded(folder / "run", 5));
    const std::string before = contentsOf(folder / "run" / "ticks.npy");

    const auto sentence = refusalOf([&] { const Recording second(folder / "run", someInfo()); });

    EXPECT_TRUE(holds(sentence, {"run", "new or empty folder", "overwritten"})) << sentence;
    EXPECT_EQ(contentsOf(folder / "run" / "ticks.npy"), before);
    static_cast<void>(folder.write("file", ""));
    EXPECT_TRUE(holds(refusalOf([&] { const Recording r(folder / "file", someInfo()); }), {"file", "cannot be made"}));
    EXPECT_TRUE(holds(refusalOf([&] { const Recording r(folder / "file" / "run", someInfo()); }), {"cannot be made"}));
    std::filesystem::create_directory(folder / "empty");
    EXPECT_NO_THROW(static_cast<void>(recorded(folder / "empty", 5))) << "an empty folder is nobody's";
}

/// The one that comes too late must not clear away the files of the other.
TEST(Recording, OfTwoThatBeginInOneFolderAtOnceOneIsRefusedAndTheOtherIsWhole)
{
    const TemporaryFolder folder;
    for (int run = 0; run < 50; ++run) {
        const auto       place = folder / std::to_string(run);
        std::atomic<int> ready{0}, refused{0}, whole{0};
        const auto       record = [&] {
            ++ready;
            while (ready < 2) std::this_thread::yield();
            try {
                Recording recording(place, someInfo());
                for (int n = 0; n < 3; ++n) recording.pushWaiting(recordNumber(n));
                const RecordingReport report = recording.finish();
                whole += report.ticks == 3 && !report.stopped;
            } catch (const Error&) {
                ++refused;
            }
        };
        std::thread other(record);
        record();
        other.join();
        ASSERT_EQ(refused, 1) << run;
        ASSERT_EQ(whole, 1) << run;
        ASSERT_EQ(readSession(place).records.size(), 3U);
    }
    const FolderLock begins((std::filesystem::create_directory(folder / "other"), folder / "other"), "taken");
    const auto       sentence = refusalOf([&] { const Recording late(folder / "other", someInfo()); });
    EXPECT_TRUE(holds(sentence, {"other", "another program begins a session"})) << sentence;
}

TEST(Recording, IsNotMadeThroughALinkThatAnotherUserPutIntoAFolderOfAnybody)
{
    if (::geteuid() != 0) GTEST_SKIP() << "only root can make another user's link";
    constexpr uid_t       kStranger = 65534;
    const TemporaryFolder folder, mine;
    std::filesystem::create_directory_symlink(mine.path(), folder / "run");
    ASSERT_EQ(::lchown((folder / "run").c_str(), kStranger, kStranger), 0);
    std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
    for (const auto& run : {folder / "run", folder / "run" / "1"}) {
        const auto sentence = refusalOf([&] { const Recording recording(run, someInfo()); });
        EXPECT_TRUE(holds(sentence, {"run", "a link that another user put"})) << sentence;
    }
    EXPECT_TRUE(std::filesystem::is_empty(mine.path()));
}

TEST(Recording, FilesAreWholeAtEveryMoment)
{
    const TemporaryFolder folder;
    Recording             recording(folder / "run", someInfo());
    std::size_t           seen = readSession(folder / "run").records.size();
    EXPECT_EQ(seen, 0u) << "before the first record";

    for (int i = 0; i < 20'000; ++i) {
        recording.pushWaiting(recordNumber(i));
        if (i % 1000 != 0) continue;
        const RecordedSession session = readSession(folder / "run");
        ASSERT_LE(session.records.size(), std::size_t(i) + 1);
        for (std::size_t k = 0; k < session.records.size(); ++k)
            ASSERT_TRUE(sameBytes(session.records[k], asStored(recordNumber(int(k))))) << k;
        ASSERT_FALSE(session.finished);
        seen = session.records.size();
    }
    EXPECT_GT(seen, 10'000u) << "of the first 19'001 no more than 4096 wait in memory";
}

TEST(Recording, EveryTickIsOnDiskOrCountedAsLost)
{
    const TemporaryFolder    folder;
    std::vector<std::string> said;
    Recording recording(folder / "run", someInfo(), [&](const std::string& sentence) { said.push_back(sentence); });

    constexpr int kFlood = 200'000; // far more than the ring takes at once
    for (int i = 0; i < kFlood; ++i) recording.push(recordNumber(i));
    const RecordingReport report  = recording.finish();
    const RecordedSession session = readSession(folder / "run");

    EXPECT_EQ(report.ticks + report.lost, std::uint64_t(kFlood));
    EXPECT_EQ(session.records.size(), report.ticks);
    EXPECT_GT(report.lost, 0u) << "or the test pushes too slowly";
    ASSERT_EQ(said.size(), 1u) << "a program that fails for this says why";
    EXPECT_TRUE(holds(said[0], {"run: " + std::to_string(report.lost) + " ticks lost"})) << said[0];
    for (std::size_t k = 1; k < session.records.size(); ++k)
        ASSERT_GT(session.records[k].time, session.records[k - 1].time);
    EXPECT_EQ(recording.finish().ticks, report.ticks) << "a second end is the same end";
}

TEST(Recording, PushingAllocatesNothing)
{
    const TemporaryFolder folder;
    Recording             recording(folder / "run", someInfo());
    const TickRecord      record = recordNumber(3);

    const std::size_t before = allocationsOfThisThread();
    for (int i = 0; i < 10'000; ++i) recording.push(record);
    EXPECT_EQ(allocationsOfThisThread(), before);
}

// --- what only a process of its own can show: it is this program again, with one test

/// Runs the named child test with a folder; returns the process.
pid_t start(const char* child, const std::filesystem::path& folder)
{
    std::cout.flush();
    const pid_t process = ::fork();
    if (process != 0) return process;
    ::setenv("PALP_CHILD_FOLDER", folder.c_str(), 1);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    const std::string filter = std::string("--gtest_filter=") + child;
    ::execl("/proc/self/exe", "session_test", filter.c_str(), "--gtest_also_run_disabled_tests", nullptr);
    ::_exit(127);
}

int exitOf(pid_t process)
{
    int status = 0;
    ::waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::filesystem::path childFolder()
{
    const char* const folder = std::getenv("PALP_CHILD_FOLDER");
    return folder ? folder : "";
}

/// What a child tells its parent, in a file that both map.
struct Shared {
    std::atomic<int>                              pushed; ///< records [1]
    std::array<std::atomic<std::int64_t>, 20'000> times;  ///< of each push, by the steady clock [ns]
};

Shared* sharedIn(const std::filesystem::path& folder)
{
    const int   handle = ::open((folder / "shared").c_str(), O_RDWR | O_CREAT, 0600);
    const int   grown  = ::ftruncate(handle, sizeof(Shared));
    void* const memory =
        grown == 0 ? ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, handle, 0) : nullptr;
    ::close(handle);
    return memory == MAP_FAILED ? nullptr : static_cast<Shared*>(memory);
}

std::int64_t nanoseconds()
{
    return std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
}

TEST(RecordingChild, DISABLED_PushesUntilItIsKilled)
{
    Shared* const shared = sharedIn(childFolder());
    ASSERT_NE(shared, nullptr);
    Recording         recording(childFolder() / "run", someInfo());
    Clock::time_point next = Clock::now();
    for (int i = 0; i < int(shared->times.size()); ++i) {
        recording.push(recordNumber(i));
        shared->times[std::size_t(i)] = nanoseconds();
        shared->pushed                = i + 1;
        std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
    }
}

/// Milliseconds of pushed records that a kill costs.
/// \param later  [s] after that tick
double lossOfAKill(const std::filesystem::path& place, int afterTicks, double later)
{
    std::filesystem::create_directory(place);
    Shared* const shared = sharedIn(place);
    const pid_t   child  = start("RecordingChild.DISABLED_PushesUntilItIsKilled", place);
    while (shared->pushed < afterTicks) std::this_thread::sleep_for(std::chrono::microseconds(200));
    std::this_thread::sleep_for(std::chrono::duration<double>(later));
    const std::int64_t killed = nanoseconds();
    ::kill(child, SIGKILL);
    EXPECT_EQ(exitOf(child), -SIGKILL);

    const RecordedSession session = readSession(place / "run");
    EXPECT_FALSE(session.finished);
    const std::size_t kept = session.records.size();
    for (std::size_t k = 0; k < kept; ++k)
        EXPECT_TRUE(sameBytes(session.records[k], asStored(recordNumber(int(k))))) << k;
    const int    pushed = shared->pushed;
    const double loss   = int(kept) < pushed ? double(killed - shared->times[kept]) * 1e-6 : 0;
    ::munmap(shared, sizeof(Shared));
    return loss;
}

TEST(Recording, AKillCostsAtMostTenMilliseconds)
{
    const char* const   asked  = std::getenv("PALPATE_INSTANTS"); // 500 take three minutes
    const int           rounds = std::max(asked ? std::atoi(asked) : 0, 9);
    std::vector<double> losses;
    std::mt19937        random(7);
    for (int round = 0; round < rounds; ++round) {
        const TemporaryFolder folder;
        const int             ticks = std::uniform_int_distribution(60, 390)(random);
        losses.push_back(lossOfAKill(folder / "one", ticks, std::uniform_real_distribution(0.0, 4e-3)(random)));
    }

    std::ranges::sort(losses);
    const auto         at = [&](double share) { return losses[std::size_t(share * double(rounds - 1))]; };
    std::ostringstream all;
    all << rounds << " kills lost " << at(0) << " to " << at(1) << " ms, the median " << at(0.5) << ", 99 % up to "
        << at(0.99);
    RecordProperty("loss_ms", all.str());
    if (asked) std::cout << all.str() << '\n';
    // On a machine that is busy with other work the writer may be scheduled late once or twice; the median may not.
    EXPECT_LE(at(0.5), 10) << all.str();
    EXPECT_LE(at(0.75), 10) << all.str();
    if (rounds < 100) return;
    EXPECT_LE(at(0.99), 10) << all.str();
    EXPECT_LE(at(1), 100) << all.str();
}

/// A recording of a hundred ticks, all of them on the disk.
class Disturbed {
public:
    Disturbed()
    {
        for (int i = 0; i < 100; ++i) recording.pushWaiting(recordNumber(i));
        while (std::filesystem::file_size(folder / "run" / "ticks.npy") < 100 * tickRowBytes())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::this_thread::sleep_for(std::chrono::milliseconds(20)); // and described
    }

    TemporaryFolder          folder;
    std::vector<std::string> said;
    Recording                recording{folder / "run", someInfo(), [this](const std::string& s) { said.push_back(s); }};
};

TEST(Recording, OneThatWasMovedIsLostAndTheFolderThatHasItsNameNowIsLeftAlone)
{
    Disturbed disturbed;
    std::filesystem::rename(disturbed.folder / "run", disturbed.folder / "away");
    std::filesystem::create_directory(disturbed.folder / "run");
    for (const char* file : {"run/session.json", "run/ticks.npy", "run/markers.jsonl"})
        static_cast<void>(disturbed.folder.write(file, "another's"));

    const RecordingReport report = disturbed.recording.finish();

    EXPECT_EQ(report.ticks, 0u);
    EXPECT_EQ(report.lost, 100u);
    ASSERT_EQ(disturbed.said.size(), 1u);
    EXPECT_TRUE(holds(disturbed.said[0], {"run: another program has removed, moved or cut"}));
    EXPECT_EQ(contentsOf(disturbed.folder / "run/session.json"), "another's");
}

TEST(Recording, OneThatWasCutDoesNotGrowAgain)
{
    for (const std::size_t left : {0, 4000}) { // [bytes] of some 22 000
        Disturbed disturbed;
        std::filesystem::resize_file(disturbed.folder / "run/ticks.npy", left);
        for (int i = 100; i < 200; ++i) disturbed.recording.pushWaiting(recordNumber(i));

        const RecordingReport report = disturbed.recording.finish();

        EXPECT_EQ(report.ticks, 0u);
        EXPECT_EQ(report.lost, 200u);
        ASSERT_EQ(disturbed.said.size(), 1u);
        EXPECT_TRUE(holds(disturbed.said[0], {"after 100 ticks", "ticks.npy: another program has cut it short"}));
        EXPECT_EQ(std::filesystem::file_size(disturbed.folder / "run/ticks.npy"), left);
    }
}

TEST(Recording, OneThatWasMovedAndBroughtBackIsWhole)
{
    Disturbed disturbed;
    std::filesystem::rename(disturbed.folder / "run", disturbed.folder / "away");
    std::filesystem::rename(disturbed.folder / "away", disturbed.folder / "run");

    EXPECT_EQ(disturbed.recording.finish().ticks, 100u);
    EXPECT_TRUE(disturbed.said.empty());
}

TEST(Recording, OneThatCannotBeMarkedAsFinishedSaysSo)
{
    Disturbed disturbed;
    std::filesystem::remove(disturbed.folder / "run/session.json");
    std::filesystem::create_directories(disturbed.folder / "run/session.json/in the way");

    const RecordingReport report = disturbed.recording.finish();

    EXPECT_EQ(report.ticks, 100u);
    ASSERT_EQ(disturbed.said.size(), 1u);
    EXPECT_TRUE(holds(disturbed.said[0], {"could not be marked as finished", "session.json"})) << disturbed.said[0];
    EXPECT_EQ(report.stopped, disturbed.said[0]);
}

/// Records until writing stops; then pushing must go on without effect, and one sentence must have been said.
void recordUntilFull(const std::filesystem::path& folder, const char* reason)
{
    std::vector<std::string> said;
    Recording     recording(folder, someInfo(), [&](const std::string& sentence) { said.push_back(sentence); });
    constexpr int kFar = 100'000; // 22 MB
    for (int i = 0; i < kFar; ++i) recording.pushWaiting(recordNumber(i));
    const RecordingReport report = recording.finish();

    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(holds(said[0], {"recording stopped after", "ticks.npy", reason})) << said[0];
    EXPECT_EQ(report.stopped, said[0]);
    EXPECT_EQ(report.ticks + report.lost, std::uint64_t(kFar));
    EXPECT_GT(report.ticks, 0u);
    const RecordedSession session = readSession(folder);
    ASSERT_EQ(session.records.size(), report.ticks) << "it ends at a whole row";
    for (std::size_t k = 0; k < session.records.size(); ++k)
        ASSERT_TRUE(sameBytes(session.records[k], asStored(recordNumber(int(k))))) << k;
}

TEST(RecordingChild, DISABLED_MeetsTheLimitOnSizes)
{
    const rlimit limit{300'000, 300'000}; // [bytes] of a file
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    recordUntilFull(childFolder() / "run", "File too large");
}

TEST(RecordingChild, DISABLED_MeetsAFullDisk)
{
    recordUntilFull(childFolder() / "run", "No space left");
}

TEST(Recording, ALimitOnSizesStopsItWithOneSentenceAndTheTouchGoesOn)
{
    const TemporaryFolder folder;
    EXPECT_EQ(exitOf(start("RecordingChild.DISABLED_MeetsTheLimitOnSizes", folder.path())), 0);
}

TEST(Recording, AFullDiskStopsItWithOneSentenceAndTheTouchGoesOn)
{
    const TemporaryFolder folder;
    if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=2m") != 0)
        GTEST_SKIP() << "a small disk can be mounted by root only";
    EXPECT_EQ(exitOf(start("RecordingChild.DISABLED_MeetsAFullDisk", folder.path())), 0);
    ::umount(folder.path().c_str());
}

TEST(Recording, AFolderOnAFullDiskIsRefusedAndLeftEmpty)
{
    const TemporaryFolder folder;
    if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=8k") != 0)
        GTEST_SKIP() << "a small disk can be mounted by root only";
    const auto sentence = refusalOf([&] { const Recording r(folder / "run", someInfo()); });
    EXPECT_TRUE(holds(sentence, {"cannot be written", "No space left"})) << sentence;
    EXPECT_TRUE(std::filesystem::is_empty(folder / "run"));
    ::umount(folder.path().c_str());
}

/// The python3 that the tests use; PALPATE_PYTHON names another one.
std::string python()
{
    const char* const named = std::getenv("PALPATE_PYTHON");
    return named ? named : "python3";
}

bool hasNumpy()
{
    return std::system((python() + " -c 'import numpy' >/dev/null 2>&1").c_str()) == 0;
}

TEST(Recording, NumpyReadsAKilledSession)
{
    if (!hasNumpy()) GTEST_SKIP() << "no python3 with numpy; the other tests read the files by our own reader";
    const TemporaryFolder folder;
    static_cast<void>(lossOfAKill(folder / "killed", 300, 0));
    const auto script = folder.write("check.py", R"(
import json, sys, numpy
columns = json.load(open(sys.argv[1] + '/session.json'))['columns']
ticks = numpy.load(sys.argv[1] + '/ticks.npy')
n = len(ticks)
assert n > 200, n
assert list(ticks.dtype.names) == list(columns), ticks.dtype
for name, column in columns.items():
    a = ticks[name]
    assert a.dtype == column['type'], (name, a.dtype)
    assert a.shape[1:] == ((column['components'],) if column['components'] > 1 else ()), (name, a.shape)
assert len(numpy.load(sys.argv[1] + '/ticks.npy', mmap_mode='r')) == n
i = numpy.arange(n)
assert (ticks['time'] == i * 1e-3).all()
assert (ticks['force'][:, 2] == i / 3.0).all()
assert (ticks['stiffness'] == (400 + i / 3.0).astype('<f4')).all()
assert (ticks['faults'][::5] == 0x80000001).all()
)");
    EXPECT_EQ(std::system((python() + " " + script.string() + " " + (folder / "killed" / "run").string()).c_str()), 0);
}

TEST(Recording, TheLinesOfPythonInItsPageReadIt)
{
    const std::string page  = contentsOf(PALPATE_RECORDINGS_PAGE);
    const std::string begin = "```python\n# read.py";
    const std::size_t at    = page.find(begin);
    ASSERT_NE(at, std::string::npos);
    const std::string block = page.substr(at + 10, page.find("```", at + 10) - at - 10);
    EXPECT_LE(lines(block), 11u) << "ten lines and the name";
    if (!hasNumpy()) GTEST_SKIP() << "no python3 with numpy";
    const TemporaryFolder folder;
    {
        Recording recording(folder / "run", someInfo());
        for (int i = 0; i < 100; ++i) recording.pushWaiting(recordNumber(i));
        recording.mark({0.05, "a word"});
    }

    const auto script = folder.write("read.py", block);
    EXPECT_EQ(std::system((python() + " " + script.string() + " " + (folder / "run").string() + " >" +
                           (folder / "said").string())
                              .c_str()),
              0);

    EXPECT_TRUE(holds(contentsOf(folder / "said"), {"100 ticks", "33.0 N", "a word"})) << contentsOf(folder / "said");
}

} // namespace
} // namespace palp
