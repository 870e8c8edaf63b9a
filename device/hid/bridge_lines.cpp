#include "device/hid/bridge_lines.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "device/detail/guardian.h"
#include "device/hid/bridge_stream.h"

namespace palp {
namespace {

constexpr double kForgotten = 1;   ///< [s] of silence, after which another may speak
constexpr double kLate      = 1.5; ///< [s] for the first report: a peer may start together with us

/// Waits until a descriptor has something to read, for a time [s].
bool hasBytes(int fd, double timeout)
{
    const double   wait = std::isfinite(timeout) ? std::clamp(timeout, 0.0, 60.0) : 0;
    const timespec time{time_t(wait), long((wait - std::floor(wait)) * 1e9)};
    pollfd         ready{fd, POLLIN, 0};
    return ppoll(&ready, 1, &time, nullptr) > 0;
}

/// What both lines have in common: a descriptor, which a guardian may write to as well.
class DescriptorPort : public HidPort {
public:
    DescriptorPort(int fd, std::string name) : fd_(fd), name_(std::move(name)) {}
    ~DescriptorPort() override
    {
        guardian_.reset(); // it may still write zeros
        close(fd_);
    }

    void write(std::span<const std::uint8_t> report) override
    {
        // Told once; the zeros that end a session still pass.
        if (guardian_ && !guardian_->isWatching() && !std::exchange(unguarded_, true))
            throw HidLost(name_ + ": its guardian process has ended");
        put(guardian_ ? guardian_->pass(report) : report);
        if (guardian_) guardian_->passed();
    }
    void guard(const ZeroRule& rule) override { guardian_.emplace(Guardian::Line{.fd = fd_}, rule, name_); }
    [[nodiscard]] bool wasSilenced() noexcept override { return guardian_ && guardian_->hasSilenced(); }

protected:
    virtual void put(std::span<const std::uint8_t> report) = 0;

    const int         fd_;
    const std::string name_;

private:
    bool                    unguarded_ = false; ///< it has ended, and that was told
    std::optional<Guardian> guardian_;
};

/// Where a datagram comes from.
struct Address {
    sockaddr_storage name{};
    socklen_t        size = sizeof name; ///< [byte]

    bool operator==(const Address& other) const noexcept
    {
        return size == other.size && std::memcmp(&name, &other.name, size) == 0;
    }
};

class UdpPort : public DescriptorPort {
public:
    using DescriptorPort::DescriptorPort;

    std::size_t read(std::span<std::uint8_t> report, double timeout) override
    {
        constexpr int kMostStrangers =
            1024; // datagrams that waited when the peer became one: more than the socket holds
        for (int strangers = 0; strangers < kMostStrangers && hasBytes(fd_, timeout); ++strangers) {
            Address       from;
            const ssize_t got = recvfrom(fd_, report.data(), report.size(), MSG_DONTWAIT | MSG_TRUNC,
                                         reinterpret_cast<sockaddr*>(&from.name), &from.size);
            if (got < 0) return 0; // such as the answer of a machine that nobody listens there: silence
            if (hasPeer_ && !(from == peer_)) continue;
            const std::size_t whole = std::min(std::size_t(got), report.size());
            hear(report.first(whole), from);
            return whole;
        }
        forget();
        return 0;
    }

protected:
    void put(std::span<const std::uint8_t> report) override
    {
        // A datagram that is lost is like one of USB that is: the next one replaces it.
        if (hasPeer_) static_cast<void>(!send(fd_, report.data(), report.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
    }

private:
    /// Makes the first that sends a good report the device. From here on the system drops what others send.
    void hear(std::span<const std::uint8_t> report, const Address& from)
    {
        BridgeAnswer answer;
        if (!hasPeer_ && decode(report, answer) == BridgeVerdict::good)
            hasPeer_ = connect(fd_, reinterpret_cast<const sockaddr*>(&from.name), from.size) == 0;
        if (hasPeer_) peer_ = from;
        heard_ = std::chrono::steady_clock::now();
    }

    /// Hears others again once the device was silent.
    void forget()
    {
        if (!hasPeer_ || std::chrono::duration<double>(std::chrono::steady_clock::now() - heard_).count() < kForgotten)
            return;
        const sockaddr nobody{AF_UNSPEC, {}};
        connect(fd_, &nobody, sizeof nobody);
        hasPeer_ = false;
    }

    Address                               peer_{};
    bool                                  hasPeer_ = false;
    std::chrono::steady_clock::time_point heard_{};
};

class SerialPort : public DescriptorPort {
public:
    using DescriptorPort::DescriptorPort;
    ~SerialPort() override { ioctl(fd_, TIOCNXCL); } // a pseudo terminal would remember it

    std::size_t read(std::span<std::uint8_t> report, double timeout) override
    {
        constexpr int kMostReads = 16; // of 1 KiB: a flood of rubbish must not hold the exchange
        bool          waited     = false;
        for (int reads = 0;; ++reads) {
            if (const auto found = stream_.next()) {
                const std::size_t size = std::min(report.size(), found->size());
                std::copy_n(found->begin(), size, report.begin());
                return size;
            }
            if (waited || reads == kMostReads || !hasBytes(fd_, timeout)) return 0;
            std::array<std::uint8_t, 1024> bytes{};
            const ssize_t                  got = ::read(fd_, bytes.data(), bytes.size());
            if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) throw HidLost(name_ + " was unplugged");
            if (got > 0) stream_.feed(std::span(bytes).first(std::size_t(got)));
            waited  = got <= 0;
            timeout = 0;
        }
    }

protected:
    void put(std::span<const std::uint8_t> report) override
    {
        // A command in two pieces is still one; one that never fits is lost like a datagram, and the next begins anew.
        constexpr int kMostPieces = 4;
        for (int piece = 0; piece < kMostPieces && !report.empty(); ++piece) {
            const ssize_t done = ::write(fd_, report.data(), report.size());
            if (done < 0 && errno != EAGAIN && errno != EINTR)
                throw HidLost(name_ + ": writing failed: " + std::strerror(errno));
            report = report.subspan(std::size_t(std::max<ssize_t>(done, 0)));
        }
    }

private:
    BridgeStream stream_;
};

std::unique_ptr<HidPort> openUdp(const BridgeLine& line)
{
    const std::string name = "udp:" + line.place + ":" + std::to_string(line.port);
    addrinfo          hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags    = AI_PASSIVE;
    if (const int error = getaddrinfo(line.place.c_str(), std::to_string(line.port).c_str(), &hints, &found);
        error != 0)
        throw HidRefused(name + ": " + gai_strerror(error), "name an address of this machine");
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, freeaddrinfo);
    std::string                                          why;
    for (const addrinfo* each = found; each; each = each->ai_next) {
        const int fd = socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
        if (fd >= 0 && bind(fd, each->ai_addr, each->ai_addrlen) == 0) return std::make_unique<UdpPort>(fd, name);
        why = std::strerror(errno);
        if (fd >= 0) close(fd);
    }
    throw HidRefused(name + ": " + why, "take another port, or end the program that has it");
}

std::unique_ptr<HidPort> openSerial(const BridgeLine& line)
{
    const int fd = ::open(line.place.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        throw HidRefused(line.place + " cannot be opened: " + std::strerror(errno),
                         errno == EACCES ? "join the group that owns it, dialout on most systems, and log in anew"
                                         : "see that the board is plugged in");
    termios settings{};
    if (tcgetattr(fd, &settings) != 0) {
        close(fd);
        throw HidRefused(line.place + " is no serial port", "name a node such as /dev/ttyACM0");
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    cfsetspeed(&settings, B921600); // a board with USB of its own ignores it
    // Two programs at one arm would mix their forces. The lock stops those that ask for it, and of root's too;
    // exclusive use all others but root's from now on, yet nobody who has the port open already.
    const bool isOurs = flock(fd, LOCK_EX | LOCK_NB) == 0 && ioctl(fd, TIOCEXCL) == 0;
    if (!isOurs || tcsetattr(fd, TCSANOW, &settings) != 0) {
        const std::string why =
            isOurs ? std::string("cannot be set: ") + std::strerror(errno) : "is used by another program";
        close(fd);
        throw HidRefused(line.place + " " + why, isOurs ? "see that it is a serial port" : "end that program");
    }
    tcflush(fd, TCIOFLUSH);
    return std::make_unique<SerialPort>(fd, line.place);
}

/// A system with one device, at a line.
class LineSystem : public HidSystem {
public:
    explicit LineSystem(BridgeLine line) : line_(std::move(line)) {}

    [[nodiscard]] std::vector<HidListing>  list() override { return {}; }
    [[nodiscard]] std::unique_ptr<HidPort> open(const std::string& /*path*/) override { return openBridgeLine(line_); }

private:
    BridgeLine line_;
};

struct OwnsSystem {
    LineSystem system;
};

/// A bridge with a system of its own, which is made first and ends last.
class LineBridge : private OwnsSystem, public HidBridgeDevice {
public:
    LineBridge(const BridgeLine& line, const HidListing& listing, const HidBridgeSettings& settings)
        : OwnsSystem{LineSystem(line)}, HidBridgeDevice(OwnsSystem::system, listing, settings)
    {
    }
};

} // namespace

std::optional<BridgeLine> parseBridgeLine(std::string_view text)
{
    constexpr std::string_view kUdp = "udp:", kSerial = "serial:";
    if (text.starts_with(kSerial)) {
        BridgeLine line{BridgeLine::Kind::serial, std::string(text.substr(kSerial.size()))};
        if (line.place.empty())
            throw Error("bridge: expected serial:NODE, such as serial:/dev/ttyACM0, found \"" + std::string(text) +
                        "\"");
        return line;
    }
    if (!text.starts_with(kUdp)) {
        for (const std::string_view form : {"udp", "serial", "tcp", "tcp:"})
            if (text == form || (form.back() == ':' && text.starts_with(form)))
                throw Error("bridge: expected udp:PORT, udp:HOST:PORT or serial:NODE, found \"" + std::string(text) +
                            "\"");
        return {};
    }
    const std::string_view address = text.substr(kUdp.size());
    const std::size_t      colon   = address.rfind(':');
    const std::string_view digits  = colon == std::string_view::npos ? address : address.substr(colon + 1);
    BridgeLine             line{BridgeLine::Kind::udp,
                    std::string(colon == std::string_view::npos ? "127.0.0.1" : address.substr(0, colon))};
    if (line.place.starts_with('[') && line.place.ends_with(']'))
        line.place = line.place.substr(1, line.place.size() - 2);
    const auto number = std::from_chars(digits.data(), digits.data() + digits.size(), line.port);
    if (number.ec != std::errc() || number.ptr != digits.data() + digits.size() || line.port == 0 || line.place.empty())
        throw Error("bridge: expected udp:PORT or udp:HOST:PORT, found \"" + std::string(text) + "\"");
    return line;
}

std::unique_ptr<HidPort> openBridgeLine(const BridgeLine& line)
{
    return line.kind == BridgeLine::Kind::udp ? openUdp(line) : openSerial(line);
}

std::unique_ptr<HapticDevice> makeLineBridge(const BridgeLine& line, HidBridgeSettings settings)
{
    HidListing listing;
    const bool isUdp  = line.kind == BridgeLine::Kind::udp;
    listing.path      = isUdp ? "udp:" + line.place + ":" + std::to_string(line.port) : "serial:" + line.place;
    listing.model     = isUdp ? "bridge by UDP" : "bridge at a serial port";
    settings.openWait = std::max(settings.openWait, kLate);
    return std::make_unique<LineBridge>(line, listing, settings);
}

} // namespace palp
