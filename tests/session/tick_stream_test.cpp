#include "engine/session/tick_stream.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "engine/session/recorded_session.h"
#include "engine/session/session_tap.h"
#include "engine/session/udp_outlet.h"
#include "tests/session/sessions.h"
#include "tests/support/allocations.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using namespace std::chrono_literals;

/// Another program's socket.
class Receiver {
public:
    Receiver() : socket_({"127.0.0.1", 0}, UdpEnd::here, "a test") {}

    [[nodiscard]] std::string address() const { return "udp:127.0.0.1:" + std::to_string(socket_.port()); }
    /// Returns the next datagram; empty if none comes within ten seconds, which a busy machine may need.
    [[nodiscard]] std::string next() const
    {
        pollfd                 from{socket_.handle(), POLLIN, 0};
        std::array<char, 2048> data{};
        if (::poll(&from, 1, 10'000) != 1) return {};
        const ssize_t size = ::recv(socket_.handle(), data.data(), data.size(), 0);
        return {data.data(), std::size_t(std::max<ssize_t>(size, 0))};
    }

private:
    UdpSocket socket_;
};

template <class Number>
Number at(const std::string& bytes, std::size_t place)
{
    Number number{};
    std::memcpy(&number, bytes.data() + place, sizeof number);
    return number;
}

TEST(UdpStream, EachTickIsADatagramOfHeaderAndRow)
{
    const Receiver receiver;
    TickStream     stream(openOutlet(receiver.address()));
    stream.begin({111, 222});

    stream.push(recordNumber(41));
    stream.push(recordNumber(42));
    static_cast<void>(receiver.next());
    const std::string data = receiver.next();

    std::string row(tickRowBytes(), '\0');
    packTick(recordNumber(42), row.data());
    ASSERT_EQ(data.size(), 32 + tickRowBytes());
    EXPECT_EQ(data.substr(0, 4), "PALP");
    EXPECT_EQ(at<std::uint16_t>(data, 4), 1);
    EXPECT_EQ(at<std::uint16_t>(data, 6), 0);
    EXPECT_EQ(at<std::uint64_t>(data, 8), 2u);
    EXPECT_EQ(at<std::int64_t>(data, 16), 111);
    EXPECT_EQ(at<std::int64_t>(data, 24), 222);
    EXPECT_EQ(data.substr(32), row);
    const StreamReport report = stream.finish();
    EXPECT_EQ(report.sent, 2u);
    EXPECT_EQ(report.dropped, 0u);
    EXPECT_EQ(report.to, receiver.address());
}

TEST(UdpStream, AMarkerIsADatagramOfItsOwn)
{
    const Receiver receiver;
    TickStream     stream(openOutlet(receiver.address()));

    stream.mark({0.75, "left hand"}, {111, 222});
    const std::string data = receiver.next();

    ASSERT_EQ(data.size(), 32u + 8 + 9);
    EXPECT_EQ(at<std::uint16_t>(data, 6), 1);
    EXPECT_EQ(at<std::uint64_t>(data, 8), 1u);
    EXPECT_EQ(at<std::int64_t>(data, 16), 111);
    EXPECT_EQ(at<std::int64_t>(data, 24), 222);
    EXPECT_EQ(at<double>(data, 32), 0.75);
    EXPECT_EQ(data.substr(40), "left hand");
    EXPECT_EQ(stream.finish().markers, 1u);
}

/// An outlet that can be held up.
class SlowOutlet : public TickOutlet {
public:
    explicit SlowOutlet(std::atomic<bool>& goOn) : goOn_(goOn) {}
    std::string name() const override { return "slow"; }
    bool        send(const StreamedTick& tick) noexcept override
    {
        while (!goOn_) std::this_thread::sleep_for(1ms);
        last = tick.number;
        return true;
    }
    bool send(const StreamedMarker& marker) noexcept override
    {
        lastMarker = marker.number;
        return true;
    }

    std::uint64_t              last = 0;
    std::atomic<std::uint64_t> lastMarker{0};

private:
    std::atomic<bool>& goOn_;
};

TEST(TickStream, AReceiverThatStopsCostsTheServoNothingAndTheDroppedAreCounted)
{
    std::atomic<bool> goOn = false;
    auto              made = std::make_unique<SlowOutlet>(goOn);
    const SlowOutlet& slow = *made;
    TickStream        stream(std::move(made));
    constexpr int     kMany = 20'000; // five times as many as the ring holds

    const auto        began  = std::chrono::steady_clock::now();
    const std::size_t before = allocationsOfThisThread();
    for (int i = 0; i < kMany; ++i) stream.push(recordNumber(i));
    EXPECT_EQ(allocationsOfThisThread(), before);
    const auto took           = std::chrono::steady_clock::now() - began;
    goOn                      = true;
    const StreamReport report = stream.finish();

    EXPECT_LT(took, 5s) << "it waited for nobody, on however busy a machine";
    EXPECT_EQ(report.sent + report.dropped, std::uint64_t(kMany));
    EXPECT_GE(report.sent, 4096u);
    EXPECT_GT(report.dropped, 10'000u);
    EXPECT_LE(slow.last, std::uint64_t(kMany));
    EXPECT_EQ(stream.finish().sent, report.sent) << "a second end is the same end";
}

TEST(TickStream, MarkersThatAreDroppedLeaveAGapInTheirNumbers)
{
    std::atomic<bool> goOn = false;
    auto              made = std::make_unique<SlowOutlet>(goOn);
    const SlowOutlet& slow = *made;
    TickStream        stream(std::move(made));
    constexpr int     kMany = 1000; // four times as many as wait

    stream.push(recordNumber(0)); // which holds it up
    for (int i = 0; i < kMany; ++i) stream.mark({0, "x"}, {});
    goOn = true;
    while (slow.lastMarker == 0) std::this_thread::sleep_for(1ms); // those that waited are on their way: there is room
    stream.mark({0, "after the flood"}, {});
    const StreamReport report = stream.finish();

    EXPECT_LT(report.markers, std::uint64_t(kMany));
    EXPECT_EQ(slow.lastMarker, std::uint64_t(kMany + 1));
    EXPECT_EQ(report.markers + report.markersLost, std::uint64_t(kMany + 1));
}

TEST(UdpStream, WhatNobodyListensToIsDropped)
{
    std::string address;
    {
        const Receiver gone;
        address = gone.address();
    }
    TickStream stream(openOutlet(address));

    for (int i = 0; i < 200; ++i) {
        stream.push(recordNumber(i));
        std::this_thread::sleep_for(1ms); // the machine says so after each
    }
    const StreamReport report = stream.finish();

    EXPECT_EQ(report.sent + report.dropped, 200u);
    EXPECT_GT(report.dropped, 100u) << "those that left together are told of once";
}

TEST(TickStream, OutletsThatAreNotThereAreRefused)
{
    const auto refusal = [](const std::string& name) {
        return refusalOf([&] { static_cast<void>(openOutlet(name)); });
    };
    EXPECT_TRUE(holds(refusal("tcp:1"), {"--stream", "udp:HOST:PORT, lsl or lsl:NAME", "\"tcp:1\""}));
    for (const char* wrong : {"udp:", "udp:9870", "udp:host:", "udp:host:0", "udp:host:70000", "udp:host:9870x",
                              "udp::1:9870", "udp:a:b:1", "udp:host:-1"})
        EXPECT_TRUE(holds(refusal(wrong), {"--stream", "udp:HOST:PORT", wrong})) << wrong;
    EXPECT_TRUE(holds(refusal("udp:no host:1"), {"--stream", "cannot be found"})) << refusal("udp:no host:1");
    EXPECT_EQ(parseUdpAddress("udp:[::1]:80", "x").text(), "udp:[::1]:80");
    EXPECT_EQ(parseUdpAddress("udp:80", "x", "127.0.0.1").text(), "udp:127.0.0.1:80");
}

/// A session that is recorded and streamed, with what gets both.
struct Tapped {
    TemporaryFolder folder{};
    Receiver        receiver{};
    TickStream      stream{openOutlet(receiver.address())};
    Recording       recording{folder / "run", someInfo()};
    SessionTap      tap{&recording, {&stream}};

    Tapped() { tap.begin(std::chrono::steady_clock::now()); }
};

TEST(SessionTap, MarkersGetTheTimeOfTheNewestTickEverywhere)
{
    Tapped tapped;
    auto& [folder, receiver, stream, recording, tap] = tapped;

    tap.push(recordNumber(7));
    tap.mark("one\n");
    std::string marker;
    while (!(marker = receiver.next()).empty() && at<std::uint16_t>(marker, 6) == 0) {
    }

    ASSERT_GE(marker.size(), 40u);
    EXPECT_EQ(at<double>(marker, 32), recordNumber(7).time);
    EXPECT_EQ(marker.substr(40), "one");
    EXPECT_GT(at<std::int64_t>(marker, 16), 0) << "the clocks of the session";
    static_cast<void>(recording.finish());
    const RecordedSession session = readSession(folder / "run");
    ASSERT_EQ(session.markers.size(), 1u);
    EXPECT_EQ(session.markers[0].time, recordNumber(7).time);
    EXPECT_EQ(session.markers[0].text, "one");
    EXPECT_EQ(session.clocks->realtime, at<std::int64_t>(marker, 16)) << "one clock for both";
}

TEST(SessionTap, MarkersThatDidNotComeAreLostEverywhere)
{
    Tapped tapped;
    auto& [folder, receiver, stream, recording, tap] = tapped;

    tap.lose(4);
    tap.mark("one");
    const std::string marker = receiver.next();

    ASSERT_GE(marker.size(), 40u);
    EXPECT_EQ(at<std::uint64_t>(marker, 8), 5u) << "a gap in the numbers";
    EXPECT_EQ(recording.finish().markersLost, 4u);
    EXPECT_EQ(stream.finish().markersLost, 4u);
}

TEST(SessionTap, AMarkerBeforeTheFirstTickHasTheClocksOfItsMoment)
{
    const Receiver receiver;
    TickStream     stream(openOutlet(receiver.address()));
    stream.begin({111, 222}); // of a session before
    SessionTap tap(nullptr, {&stream});

    const std::int64_t before = SessionClocks::at(std::chrono::steady_clock::now()).realtime;
    tap.mark("ready");
    const std::string  marker = receiver.next();
    const std::int64_t after  = SessionClocks::at(std::chrono::steady_clock::now()).realtime;

    ASSERT_GE(marker.size(), 40u);
    EXPECT_EQ(at<double>(marker, 32), 0);
    EXPECT_GE(at<std::int64_t>(marker, 16), before - 1'000'000) << "a clock may be set by a little meanwhile";
    EXPECT_LE(at<std::int64_t>(marker, 16), after + 1'000'000);
}

TEST(SessionTap, AfterAPauseStreamsGetTimeZeroAnewAndARecordingKeepsIt)
{
    const TemporaryFolder folder;
    const Receiver        receiver;
    TickStream            stream(openOutlet(receiver.address()));
    Recording             recording(folder / "run", someInfo());
    SessionTap            tap(&recording, {&stream});
    const auto            start   = std::chrono::steady_clock::now();
    const auto            clockOf = [](const std::string& data) { return at<std::int64_t>(data, 24); };

    tap.begin(start);
    tap.push(recordNumber(1));
    const std::string first = receiver.next();
    tap.begin(start + 5s); // the program was stopped for as long
    tap.push(recordNumber(2));
    const std::string second = receiver.next();
    tap.mark("on");
    const std::string marker = receiver.next();

    ASSERT_FALSE(marker.empty());
    EXPECT_EQ(clockOf(second) - clockOf(first), 5'000'000'000);
    EXPECT_EQ(clockOf(marker), clockOf(second));
    EXPECT_EQ(at<double>(marker, 32), recordNumber(2).time);
    static_cast<void>(recording.finish());
    EXPECT_EQ(readSession(folder / "run").clocks->monotonic, clockOf(first));

    Recording  alone(folder / "alone", someInfo()); // nothing of it is written yet where the later clocks come
    SessionTap early(&alone, {});
    early.begin(start);
    early.begin(start + 5s);
    early.push(recordNumber(1));
    static_cast<void>(alone.finish());
    EXPECT_EQ(readSession(folder / "alone").clocks->monotonic, clockOf(first));
}

TEST(UdpStream, TheLinesOfPythonInThePageReadIt)
{
    const char* const named  = std::getenv("PALPATE_PYTHON");
    const std::string python = named ? named : "python3";
    if (std::system((python + " -c '' >/dev/null 2>&1").c_str()) != 0) GTEST_SKIP() << "no python3";
    const std::string page = contentsOf(PALPATE_RECORDINGS_PAGE);
    const std::size_t from = page.find("```python\n# listen.py");
    ASSERT_NE(from, std::string::npos);
    const TemporaryFolder folder;
    const auto  script = folder.write("listen.py", page.substr(from + 10, page.find("```", from + 10) - from - 10));
    std::string port;
    {
        const Receiver passing; // a port that is free; the script binds it a moment later
        port = passing.address().substr(14);
    }
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(pipe[1], STDOUT_FILENO);
        ::execlp(python.c_str(), python.c_str(), script.c_str(), port.c_str(), nullptr);
        ::_exit(127);
    }
    ::close(pipe[1]);

    TickStream  stream(openOutlet("udp:127.0.0.1:" + port));
    std::string said;
    for (int i = 0; i < 2000 && said.find("a word") == std::string::npos; ++i) { // until python listens
        stream.push(recordNumber(300));
        stream.mark({0.5, "a word"}, {});
        pollfd reader{pipe[0], POLLIN, 0};
        if (::poll(&reader, 1, 10) != 1) continue;
        std::array<char, 4096> text{};
        const ssize_t          size = ::read(pipe[0], text.data(), text.size());
        if (size <= 0) break;
        said.append(text.data(), std::size_t(size));
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(pipe[0]);

    EXPECT_TRUE(holds(said, {"0.3 s, force (0.0, 0.0, 100.0) N", "marker at 0.5 s: a word"})) << said;
}

} // namespace
} // namespace palp
