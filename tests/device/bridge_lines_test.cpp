// The bridge over UDP and over a serial port: the driver of USB at real sockets and pseudo terminals.
#include "device/hid/bridge_lines.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <glm/geometric.hpp>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "device/hid/bridge_stream.h"
#include "engine/core/contract.h"
#include "tests/device/governed.h"
#include "tests/device/guardian_of.h"

namespace palp {
namespace {

BridgeAnswer answerOf(std::uint16_t sequence)
{
    BridgeAnswer answer;
    answer.sequence        = sequence;
    answer.flags           = BridgeFlag::homed | BridgeFlag::inBox;
    answer.position        = {0.01, 0.02, 0.03};
    answer.workspaceRadius = 0.05;
    answer.maximumForce    = 4;
    return answer;
}

double seconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// --- the stream

TEST(BridgeStream, FindsReportsInAnyPiecesAndAfterAnyRubbish)
{
    const BridgeBytes         one = encode(answerOf(1)), two = encode(answerOf(2));
    std::vector<std::uint8_t> bytes{0x01, 0x50, 7, 0x01};
    bytes.insert(bytes.end(), one.begin(), one.end());
    bytes.insert(bytes.end(), {0x01, 0x50, 0x42, 9, 9}); // a start, and then bytes were lost
    bytes.insert(bytes.end(), two.begin(), two.end());
    bytes.insert(bytes.end(), one.begin(), one.end() - 1); // not whole yet
    for (const std::size_t piece : {1U, 3U, 64U, 1000U}) {
        BridgeStream               stream;
        std::vector<std::uint16_t> good;
        for (std::size_t at = 0; at < bytes.size(); at += piece) {
            stream.feed(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
            BridgeAnswer answer;
            while (const auto report = stream.next())
                if (decode(*report, answer) == BridgeVerdict::good) good.push_back(answer.sequence);
        }
        EXPECT_EQ(good, (std::vector<std::uint16_t>{1, 2})) << piece;
    }
}

TEST(BridgeStream, ItDoesNotGrow)
{
    BridgeStream                    stream;
    const std::vector<std::uint8_t> rubbish(1 << 20U, 0x01);
    stream.feed(rubbish);
    EXPECT_FALSE(stream.next());
    const BridgeBytes report = encode(answerOf(7));
    stream.feed(report);
    EXPECT_TRUE(stream.next());
}

TEST(BridgeLines, AreNamedByTheirKind)
{
    EXPECT_EQ(parseBridgeLine("/dev/hidraw3"), std::nullopt);
    EXPECT_EQ(parseBridgeLine("udp:5005")->port, 5005);
    EXPECT_EQ(parseBridgeLine("udp:5005")->place, "127.0.0.1");
    EXPECT_EQ(parseBridgeLine("udp:0.0.0.0:5005")->place, "0.0.0.0");
    EXPECT_EQ(parseBridgeLine("udp:[::1]:5005")->place, "::1") << "as other addresses are written";
    EXPECT_EQ(parseBridgeLine("serial:/dev/ttyACM0")->place, "/dev/ttyACM0");
    for (const char* text :
         {"udp:", "udp:x", "udp:70000", "udp::1", "udp:[]:1", "udp:5005x", "serial:", "udp", "serial", "tcp:5"})
        EXPECT_THROW((void)parseBridgeLine(text), Error) << text;
}

// --- whole lines

/// Ticks until it is so; false after 10 s, for a busy machine.
bool until(HapticDevice& device, const GovernedForce& push, const std::function<bool(const HapticState&)>& so)
{
    for (const double end = seconds() + 10; seconds() < end;) {
        if (so(device.exchange(push, seconds()))) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

/// A device at the other end of a line, on a thread of its own: position out, force in, with the mandatory watchdog.
class Firmware {
public:
    using Write = std::function<void(std::span<const std::uint8_t>)>;
    using Read  = std::function<std::size_t(std::span<std::uint8_t>)>;

    Firmware(Write write, Read read)
        : thread_([this, write = std::move(write), read = std::move(read)](const std::stop_token& stop) {
              double        heard = 0, patience = 0;
              std::uint16_t sequence = 0;
              while (!stop.stop_requested()) {
                  std::array<std::uint8_t, kBridgeSize> report{};
                  BridgeCommand                         command;
                  while (read(report) == kBridgeSize)
                      if (decode(report, command) == BridgeVerdict::good) {
                          heard    = seconds();
                          patience = command.watchdog;
                          force    = command.enable ? command.force.x : 0;
                      }
                  if (!isStubborn && seconds() - heard > patience) force = 0;
                  if (!isSilent) send(write, encode(answerOf(++sequence)));
                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
              }
          })
    {
    }

    enum class Trouble { none, garbage, damaged, split, merged };

    std::atomic<double>  force{0}; ///< [N] x
    std::atomic<bool>    isSilent{false};
    std::atomic<bool>    isStubborn{false}; ///< it has no watchdog, so that only a report ends its force
    std::atomic<Trouble> trouble{Trouble::none};

private:
    void send(const Write& write, const BridgeBytes& report)
    {
        BridgeBytes bytes = report;
        switch (trouble) {
        case Trouble::none:
            return write(bytes);
        case Trouble::garbage:
            for (std::size_t n = 0; n < bytes.size(); ++n) bytes[n] = std::uint8_t(31 * n + ++noise_);
            return write(bytes);
        case Trouble::damaged:
            bytes[14] ^= 0x40U; // a place that the checksum does not have
            return write(bytes);
        case Trouble::split:
            for (const std::uint8_t& byte : bytes) write(std::span(&byte, 1));
            return;
        case Trouble::merged:
            if (!kept_) {
                kept_ = bytes;
                return;
            }
            std::array<std::uint8_t, 2 * kBridgeSize> both{};
            std::copy(bytes.begin(), bytes.end(), std::copy(kept_->begin(), kept_->end(), both.begin()));
            kept_.reset();
            return write(both);
        }
    }

    std::uint8_t               noise_ = 0;
    std::optional<BridgeBytes> kept_;
    std::jthread               thread_; ///< last member: it ends before what it uses
};

/// What cannot be understood is a fault, zero force, and borne; a stream in any pieces is none.
void bearsTroubles(HapticDevice& device, Firmware& firmware, bool isStream)
{
    using enum Firmware::Trouble;
    const GovernedForce push = governed({1, 0, 0});
    device.open();
    const auto pushes = [&] {
        return until(device, push,
                     [&](const HapticState& s) { return s.fault == DeviceFault::none && firmware.force > 0.3; });
    };
    for (const auto trouble : {garbage, damaged}) {
        ASSERT_TRUE(pushes());
        firmware.trouble = trouble;
        EXPECT_TRUE(until(device, push, [&](const HapticState& s) {
            return s.fault == DeviceFault::garbled || s.fault == DeviceFault::silent;
        }));
        EXPECT_TRUE(until(device, push, [&](const HapticState& s) {
            EXPECT_LT(glm::length(s.position - glm::dvec3(0.01, 0.02, 0.03)), 1e-9) << "no place came from it";
            return firmware.force == 0;
        }));
        firmware.trouble = none;
    }
    for (const auto trouble : {split, merged}) {
        if (!isStream) break; // a datagram is whole or lost
        ASSERT_TRUE(pushes());
        firmware.trouble          = trouble;
        const std::uint64_t since = device.exchange(push, seconds()).sequence;
        EXPECT_TRUE(until(device, push, [&](const HapticState& s) { return s.sequence > since + 20; }));
        EXPECT_TRUE(pushes());
        firmware.trouble = none;
    }
    device.close();
}

/// What must hold of either line.
void conversesAndFallsSilent(HapticDevice& device, Firmware& firmware)
{
    device.open();
    EXPECT_EQ(device.info().maximumForce, 4);
    const GovernedForce push = governed({1, 0, 0});
    ASSERT_TRUE(until(device, push, [&](const HapticState& s) {
        return s.fault == DeviceFault::none && firmware.force > 0.3 && s.sequence > 5;
    }));
    EXPECT_TRUE(until(device, push, [&](const HapticState& s) {
        return glm::length(s.position - glm::dvec3(0.01, 0.02, 0.03)) < 1e-9;
    }));
    firmware.isSilent = true;
    EXPECT_TRUE(until(device, push, [&](const HapticState& s) { return s.fault == DeviceFault::silent; }));
    EXPECT_TRUE(until(device, push, [&](const HapticState&) { return firmware.force == 0; }));
    firmware.isSilent = false;
    EXPECT_TRUE(until(device, push,
                      [&](const HapticState& s) { return s.fault == DeviceFault::none && firmware.force > 0.3; }));
    device.close();
    for (const double end = seconds() + 5; firmware.force != 0 && seconds() < end;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(firmware.force, 0);
}

struct Socket {
    Socket() : fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0))
    {
        address.sin_family      = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    }
    ~Socket() { close(fd); }

    int         fd;
    sockaddr_in address{};
};

/// Returns a port at which nobody listens.
std::uint16_t freePort()
{
    Socket    probe;
    socklen_t size = sizeof probe.address;
    auto*     any  = reinterpret_cast<sockaddr*>(&probe.address);
    if (bind(probe.fd, any, size) != 0 || getsockname(probe.fd, any, &size) != 0) throw Error(std::strerror(errno));
    return ntohs(probe.address.sin_port);
}

/// Kills this program's guardian, its only child.
bool killGuardian()
{
    const pid_t guardian = guardianOf(getpid());
    return guardian > 0 && kill(guardian, SIGKILL) == 0;
}

/// A device by UDP.
struct UdpFirmware {
    std::uint16_t                 port = freePort();
    Socket                        peer{};
    Firmware                      firmware{[this](std::span<const std::uint8_t> bytes) {
                          peer.address.sin_port = htons(port);
                          static_cast<void>(!sendto(peer.fd, bytes.data(), bytes.size(), 0,
                                                                         reinterpret_cast<const sockaddr*>(&peer.address),
                                                                         sizeof peer.address));
                      },
                      [this](std::span<std::uint8_t> bytes) {
                          const ssize_t got = recv(peer.fd, bytes.data(), bytes.size(), MSG_TRUNC);
                          return got < 0 ? 0 : std::size_t(got);
                      }};
    std::unique_ptr<HapticDevice> host =
        makeLineBridge({BridgeLine::Kind::udp, "127.0.0.1", port}, {.asksForRealTime = false});
};

TEST(BridgeLines, UdpIsALineLikeUsb)
{
    UdpFirmware udp;
    conversesAndFallsSilent(*udp.host, udp.firmware);
    bearsTroubles(*udp.host, udp.firmware, false);
}

TEST(BridgeLines, WhereTheGuardianHasEndedTheLastReportIsZero)
{
    UdpFirmware         udp;
    const GovernedForce push = governed({1, 0, 0});
    udp.host->open();
    udp.firmware.isStubborn = true;
    ASSERT_TRUE(until(*udp.host, push, [&](const HapticState&) { return udp.firmware.force > 0.3; }));
    ASSERT_TRUE(killGuardian());
    EXPECT_TRUE(until(*udp.host, push, [&](const HapticState& s) { return s.fault == DeviceFault::unplugged; }));
    EXPECT_TRUE(until(*udp.host, push, [&](const HapticState&) { return udp.firmware.force == 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    static_cast<void>(udp.host->exchange(push, seconds()));
    EXPECT_EQ(udp.firmware.force, 0) << "and so it stays";
    udp.host->close();

    udp.host->open(); // where closing is the first to meet it
    ASSERT_TRUE(until(*udp.host, push, [&](const HapticState&) { return udp.firmware.force > 0.3; }));
    ASSERT_TRUE(killGuardian());
    udp.host->close();
    for (const double end = seconds() + 5; udp.firmware.force != 0 && seconds() < end;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(udp.firmware.force, 0);
}

/// Whoever was not first is not heard: its reports would move the hand.
TEST(BridgeLines, ByUdpTheFirstIsTheDeviceAndOthersAreNotHeard)
{
    const std::uint16_t port = freePort();
    const auto          line = openBridgeLine({BridgeLine::Kind::udp, "127.0.0.1", port});
    Socket              first, second;
    first.address.sin_port = second.address.sin_port = htons(port);
    const auto send                                  = [](const Socket& from, std::span<const std::uint8_t> bytes) {
        ASSERT_EQ(sendto(from.fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&from.address),
                                                          sizeof from.address),
                                                   ssize_t(bytes.size()));
    };
    std::array<std::uint8_t, kBridgeSize + 1> report{};
    line->write(encode(BridgeCommand{})); // to nobody
    const std::array<std::uint8_t, 3> rubbish{1, 2, 3};
    send(second, rubbish);
    EXPECT_EQ(line->read(report, 1), 3U) << "what is no report makes nobody the device";
    send(first, encode(answerOf(1)));
    send(second, {}); // an empty one is no silence of the first
    send(second, encode(answerOf(2)));
    send(first, encode(answerOf(3)));
    BridgeAnswer heard;
    for (const int sequence : {1, 3}) { // the second's wait in the socket when the first becomes the device
        EXPECT_EQ(line->read(report, 1), kBridgeSize);
        EXPECT_EQ(decode(std::span(report).first(kBridgeSize), heard), BridgeVerdict::good);
        EXPECT_EQ(heard.sequence, sequence);
    }
    send(second, encode(answerOf(4)));
    EXPECT_EQ(line->read(report, 0.05), 0U);
    line->write(encode(BridgeCommand{}));
    pollfd ready{first.fd, POLLIN, 0};
    EXPECT_EQ(poll(&ready, 1, 1000), 1) << "commands go to the first";
    EXPECT_LT(recv(second.fd, report.data(), report.size(), MSG_DONTWAIT), 0);
    EXPECT_THROW((void)openBridgeLine({BridgeLine::Kind::udp, "127.0.0.1", port}), HidRefused) << "the port is taken";
}

/// Opens the other end of a serial port, and says what its node is.
int openTerminal(std::array<char, 64>& node)
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0 || ptsname_r(master, node.data(), node.size()) != 0)
        throw Error(std::strerror(errno));
    return master;
}

TEST(BridgeLines, ASerialPortIsALineLikeUsbAndUnplugged)
{
    std::array<char, 64> node{};
    const int            master = openTerminal(node);
    const auto device = makeLineBridge({BridgeLine::Kind::serial, node.data(), 0}, {.asksForRealTime = false});
    {
        Firmware firmware(
            [&](std::span<const std::uint8_t> bytes) { static_cast<void>(!write(master, bytes.data(), bytes.size())); },
            [&](std::span<std::uint8_t> bytes) {
                const ssize_t got = read(master, bytes.data(), bytes.size());
                return got < 0 ? 0 : std::size_t(got);
            });
        conversesAndFallsSilent(*device, firmware);
        bearsTroubles(*device, firmware, true);
        device->open();
        ASSERT_TRUE(until(*device, {}, [](const HapticState& s) { return s.fault == DeviceFault::none; }));
    }
    EXPECT_THROW((void)openBridgeLine({BridgeLine::Kind::serial, node.data(), 0}), HidRefused) << "it is used already";
    const BridgeBytes half = encode(answerOf(7)); // it ends in the middle of a report
    ASSERT_EQ(write(master, half.data(), half.size() / 2), ssize_t(half.size() / 2));
    close(master);
    EXPECT_TRUE(until(*device, {}, [](const HapticState& s) { return s.fault == DeviceFault::unplugged; }));
    EXPECT_THROW((void)openBridgeLine({BridgeLine::Kind::serial, "/dev/null", 0}), HidRefused) << "no serial port";
    try {
        static_cast<void>(openBridgeLine({BridgeLine::Kind::serial, "/dev/nowhere", 0}));
        ADD_FAILURE() << "nothing is there";
    } catch (const HidRefused& refused) {
        EXPECT_NE(refused.help.find("plugged in"), std::string::npos) << refused.what();
    }
}

TEST(BridgeLines, ASerialPortIsForOneProgramAlsoWhereItAsksForNoLock)
{
    std::array<char, 64> node{};
    const int            master = openTerminal(node);
    const auto           isShut = [&] { // to all but root
        const int fd     = ::open(node.data(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
        int       isOnly = fd < 0 && errno == EBUSY ? 1 : 0;
        if (fd >= 0) ioctl(fd, TIOCGEXCL, &isOnly);
        if (fd >= 0) close(fd);
        return isOnly != 0;
    };
    EXPECT_FALSE(isShut());
    {
        const auto line = openBridgeLine({BridgeLine::Kind::serial, node.data(), 0});
        EXPECT_TRUE(isShut());
    }
    EXPECT_FALSE(isShut()) << "let go again";
    close(master);
}

TEST(BridgeLines, HalfAReportIsNotAwaitedTwice)
{
    std::array<char, 64> node{};
    const int            master = openTerminal(node);
    const auto           line   = openBridgeLine({BridgeLine::Kind::serial, node.data(), 0});
    const BridgeBytes    whole  = encode(answerOf(7));
    ASSERT_EQ(write(master, whole.data(), whole.size() / 2), ssize_t(whole.size() / 2));
    std::array<std::uint8_t, kBridgeSize> report{};
    const double                          begin = seconds();
    EXPECT_EQ(line->read(report, 5), 0U) << "the exchange goes on";
    EXPECT_LT(seconds() - begin, 4) << "of 5 s that it would have waited for the first byte";
    ASSERT_EQ(write(master, whole.data() + whole.size() / 2, whole.size() / 2), ssize_t(whole.size() / 2));
    EXPECT_EQ(line->read(report, 5), kBridgeSize);
    close(master);
    EXPECT_THROW(static_cast<void>(line->read(report, 5)), HidLost) << "unplugged, though nobody writes";
}

TEST(BridgeLines, AGuardianThatHasEndedIsToldOnceAndZerosStillPass)
{
    const auto line = openBridgeLine({BridgeLine::Kind::udp, "127.0.0.1", freePort()});
    line->guard(kBridgeZero);
    const BridgeBytes push = encode(BridgeCommand{.enable = true, .force = {1, 0, 0}}), zero = encode(BridgeCommand{});
    EXPECT_NO_THROW(line->write(push));
    ASSERT_TRUE(killGuardian());
    const auto isTold = [&](const BridgeBytes& report) {
        try {
            line->write(report);
        } catch (const HidLost&) {
            return true;
        }
        return false;
    };
    bool told = false;
    for (const double end = seconds() + 5; !told && seconds() < end;) told = isTold(push);
    EXPECT_TRUE(told);
    EXPECT_FALSE(isTold(zero)) << "the zeros that end a session";
}

/// A session that tries a line every second would have no handles left after some minutes.
TEST(BridgeLines, NeitherALineThatEndedNorARefusedOneKeepsAHandle)
{
    const auto           port = freePort();
    std::array<char, 64> node{};
    const int            master  = openTerminal(node);
    const auto           handles = [] {
        const std::filesystem::directory_iterator all("/proc/self/fd");
        return std::distance(begin(all), end(all));
    };
    const auto before = handles();
    for (const BridgeLine& line :
         {BridgeLine{BridgeLine::Kind::udp, "127.0.0.1", port}, {BridgeLine::Kind::serial, node.data(), 0}}) {
        const auto held = openBridgeLine(line);
        EXPECT_EQ(handles(), before + 1) << line.place;
        EXPECT_THROW((void)openBridgeLine(line), HidRefused);
        EXPECT_EQ(handles(), before + 1) << line.place << " is used already";
    }
    EXPECT_EQ(handles(), before) << "both have ended";
    EXPECT_THROW((void)openBridgeLine({BridgeLine::Kind::serial, "/dev/null", 0}), HidRefused);
    EXPECT_EQ(handles(), before) << "no serial port";
    close(master);
}

} // namespace
} // namespace palp
