#include "engine/session/marker_input.h"

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "engine/session/interrupt.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using namespace std::chrono_literals;

/// What was heard, on whichever thread.
struct Heard {
    std::mutex               mutex;
    std::vector<std::string> texts;

    void add(std::string_view text)
    {
        const std::lock_guard lock(mutex);
        texts.emplace_back(text);
    }
    /// Waits for a number of texts, at most ten seconds.
    std::vector<std::string> wait(std::size_t count)
    {
        for (int n = 0; n < 2000; ++n) {
            {
                const std::lock_guard lock(mutex);
                if (texts.size() >= count) return texts;
            }
            std::this_thread::sleep_for(5ms);
        }
        const std::lock_guard lock(mutex);
        return texts;
    }
};

TEST(MarkerInput, EachDatagramIsAMarker)
{
    Heard       heard;
    const auto  takeAll = [](std::string_view) { return true; }; // keys, not datagrams: nobody clutches from afar
    MarkerInput input({.address = UdpAddress{"127.0.0.1", 0}, .onKey = takeAll});
    input.listen([&](std::string_view text) { heard.add(text); });
    const UdpSocket from({"127.0.0.1", input.port()}, UdpEnd::there, "a test");

    for (const std::string& text : {std::string("one"), std::string("two\n"), std::string(5000, 'x')})
        ASSERT_EQ(::send(from.handle(), text.data(), text.size(), 0), ssize_t(text.size()));
    const auto texts = heard.wait(3);

    ASSERT_EQ(texts.size(), 3u);
    EXPECT_EQ(texts[0], "one");
    EXPECT_EQ(texts[1], "two\n");
    EXPECT_EQ(texts[2], std::string(1024, 'x')) << "what is longer is cut before it takes memory";
}

TEST(MarkerInput, ItsPortIsThisMachinesAloneUnlessAHostIsStated)
{
    EXPECT_EQ(parseUdpAddress("udp:9871", "--markers", "127.0.0.1").host, "127.0.0.1");
    const MarkerInput first({.address = UdpAddress{"127.0.0.1", 0}});
    EXPECT_TRUE(holds(refusalOf([&] {
                          const MarkerInput second({.address = UdpAddress{"127.0.0.1", first.port()}});
                      }),
                      {"--markers", "cannot be listened at", "in use"}));
}

TEST(MarkerInput, AnAddressIsAPortOrAHostAndAPortAndNothingElse)
{
    const auto refusal = [](const std::string& text, const std::string& hostless) {
        return refusalOf([&] { static_cast<void>(parseUdpAddress(text, "--markers", hostless)); });
    };
    for (const char* wrong :
         {"tcp:9870", "9870", "udp:", "udp:host:", "udp:0", "udp:host:65536", "udp:host:9870x", "udp:host:-1",
          "udp: 9870", "udp::9870", "udp:[]:9870", "udp:[[a]]:9870", "udp:[a:9870", "udp:a:b:1"})
        EXPECT_TRUE(holds(refusal(wrong, "127.0.0.1"),
                          {"--markers: expected udp:PORT or udp:HOST:PORT, such as", std::string("\"") + wrong + "\""}))
            << wrong;
    EXPECT_TRUE(holds(refusal("udp:9870", ""), {"--markers: expected udp:HOST:PORT", "found \"udp:9870\""}));
    for (const char* right : {"udp:host:1", "udp:127.0.0.1:65535", "udp:[::1]:80"})
        EXPECT_EQ(parseUdpAddress(right, "--markers").text(), right);
    EXPECT_EQ(parseUdpAddress("udp:[fe80::1]:9870", "--markers").host, "fe80::1");
}

/// 127.0.0.2 stands for an address of this machine on a network: what is bound to 127.0.0.1 does not hear it.
TEST(MarkerInput, WhatComesByAnotherAddressIsHeardOnlyWhereTheUserNamesOne)
{
    for (const std::string host : {"127.0.0.1", "0.0.0.0"}) {
        Heard       heard;
        MarkerInput input({.address = UdpAddress{host, 0}});
        input.listen([&](std::string_view text) { heard.add(text); });
        const UdpSocket far({"127.0.0.2", input.port()}, UdpEnd::there, "a test");
        const UdpSocket near({"127.0.0.1", input.port()}, UdpEnd::there, "a test");
        static_cast<void>(!::send(far.handle(), "far", 3, MSG_NOSIGNAL));
        ASSERT_EQ(::send(near.handle(), "near", 4, 0), 4);
        const bool isNamed = host == "0.0.0.0";
        EXPECT_EQ(heard.wait(isNamed ? 2 : 1).front(), isNamed ? "far" : "near") << host;
    }
}

/// Nobody reads while they come, so that the system has to drop the last ones, which no datagram follows.
TEST(MarkerInput, WhatTheSystemDropsIsCountedAsLost)
{
    for (const std::string host : {"127.0.0.1", "::1"}) {
        Heard                      heard;
        std::atomic<std::uint64_t> lost  = 0;
        constexpr std::size_t      kSent = 8000; // of 1000 bytes: more than the room that is asked for
        const std::string          text(1000, 'x');
        std::optional<MarkerInput> input;
        try {
            input.emplace(MarkerSources{.address = UdpAddress{host, 0}});
        } catch (const Error&) { // a machine without IPv6
            ASSERT_EQ(host, "::1");
            continue;
        }
        const UdpSocket from({host, input->port()}, UdpEnd::there, "a test");
        for (std::size_t n = 0; n < kSent; ++n) {
            ASSERT_EQ(::send(from.handle(), text.data(), text.size(), 0), ssize_t(text.size()));
            if (n % 200 == 0) std::this_thread::sleep_for(1ms); // what is on its way comes to the socket
        }
        input->listen([&](std::string_view marker) { heard.add(marker); },
                      [&](std::uint64_t markers) { lost += markers; });
        input.reset(); // which hears what has arrived
        EXPECT_GT(heard.texts.size(), 20u) << host;
        EXPECT_GT(lost, 1000u) << host;
        EXPECT_EQ(heard.texts.size() + lost, kSent) << host;
    }
}

TEST(MarkerInput, ItEndsAtOnceWhetherOrNotItListened)
{
    const auto began = std::chrono::steady_clock::now();
    {
        const MarkerInput idle({.address = UdpAddress{"127.0.0.1", 0}, .keys = true});
        MarkerInput       input({.keys = false});
        input.listen([](std::string_view) {});
        EXPECT_FALSE(input.hearsKeys());
    }
    EXPECT_LT(std::chrono::steady_clock::now() - began, 5s) << "on however busy a machine";
}

TEST(MarkerInputChild, DISABLED_TellsItsKeys) // its standard input is a terminal, its output a pipe
{
    termios before{}, during{}, after{};
    ASSERT_EQ(::tcgetattr(STDIN_FILENO, &before), 0);
    static_cast<void>(catchInterrupts());
    {
        Heard            heard;
        std::atomic<int> clutched = 0;
        MarkerInput input({.keys = true, .onKey = [&](std::string_view key) { return key == "k" && ++clutched > 0; }});
        input.listen([&](std::string_view text) { heard.add(text); });
        ::tcgetattr(STDIN_FILENO, &during);
        EXPECT_TRUE(input.hearsKeys());
        EXPECT_EQ(during.c_lflag & tcflag_t(ICANON | ECHO), 0U);
        EXPECT_NE(during.c_lflag & tcflag_t(ISIG), 0U) << "Ctrl-C";
        ASSERT_EQ(::write(3, "r", 1), 1); // ready
        heard.wait(1);
        EXPECT_EQ(::kill(::getpid(), SIGTSTP), 0); // as Ctrl-Z does
        ::tcgetattr(STDIN_FILENO, &during);
        EXPECT_EQ(during.c_lflag & tcflag_t(ICANON | ECHO), 0U) << "it goes on as before";
        ASSERT_EQ(::write(3, "c", 1), 1); // continued
        const auto               texts = heard.wait(4);
        std::vector<std::string> wanted{"m", "space", "\xC3\xA9", "enter"};
        EXPECT_EQ(texts, wanted);
        EXPECT_EQ(clutched, 1) << "the key that has another meaning is no marker";
    }
    ::tcgetattr(STDIN_FILENO, &after);
    EXPECT_EQ(after.c_lflag, before.c_lflag) << "the terminal is as it was";
}

TEST(MarkerInput, KeysOfTheTerminalAreMarkersAndTheTerminalIsGivenBack)
{
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) GTEST_SKIP() << "no pseudo-terminal";
    const std::string  name = ::ptsname(master);
    std::array<int, 2> ready{};
    ASSERT_EQ(::pipe2(ready.data(), O_CLOEXEC), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::setsid();
        const int terminal = ::open(name.c_str(), O_RDWR); // becomes the controlling terminal, with us in front
        const int nowhere  = ::open("/dev/null", O_WRONLY);
        ::ioctl(terminal, TIOCSCTTY, 0);
        ::dup2(terminal, STDIN_FILENO);
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(ready[1], 3);
        ::execl("/proc/self/exe", "session_test", "--gtest_filter=MarkerInputChild.DISABLED_TellsItsKeys",
                "--gtest_also_run_disabled_tests", nullptr);
        ::_exit(127);
    }
    ::close(ready[1]);
    char   byte = 0;
    pollfd from{ready[0], POLLIN, 0};
    ASSERT_EQ(::poll(&from, 1, 30'000), 1);
    ASSERT_EQ(::read(ready[0], &byte, 1), 1) << "the child has failed before";

    ASSERT_EQ(::write(master, "mk ", 3), 3);
    int stopped = 0;
    ASSERT_EQ(::waitpid(child, &stopped, WUNTRACED), child);
    ASSERT_TRUE(WIFSTOPPED(stopped)) << stopped;
    termios now{};
    EXPECT_EQ(::tcgetattr(master, &now), 0);
    EXPECT_EQ(now.c_lflag & tcflag_t(ICANON | ECHO), tcflag_t(ICANON | ECHO))
        << "the shell has its terminal while Ctrl-Z lasts";
    ::kill(child, SIGCONT);
    ASSERT_EQ(::poll(&from, 1, 30'000), 1);
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);

    std::this_thread::sleep_for(100ms);
    ASSERT_EQ(::write(master, "\x1b[A", 3), 3); // an arrow: no marker
    std::this_thread::sleep_for(100ms);
    ASSERT_EQ(::write(master, "\xC3\xA9\r", 3), 3);
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(ready[0]);
    ::close(master);

    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

} // namespace
} // namespace palp
