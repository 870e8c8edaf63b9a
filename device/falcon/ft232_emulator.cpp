#include "device/falcon/ft232_emulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double                      kClock        = 3e6;  ///< [Hz] clock that divisors divide
constexpr double                      kBitsPerByte  = 10;   ///< start, eight, stop
constexpr double                      kWriteTimeout = 0.1;  ///< [s] FalconLink::write
constexpr std::size_t                 kOutBuffer    = 256;  ///< [byte] of the chip, to the wire
constexpr std::size_t                 kPayload      = 62;   ///< [byte] of a packet of 64
constexpr std::size_t                 kPast         = 50;   ///< answers by which a replay goes back
constexpr double                      kSplit        = 1e-3; ///< [s] between the pieces of a split answer
constexpr std::array<std::uint8_t, 2> kStatus{0x01, 0x60};  ///< modem and line status: nothing to report

/// Returns the time of a byte [s]. Bits 14 and 15 are the fraction: 0, 1/2, 1/4, 1/8; 0 and 1 are 3 and 2 Mbaud.
double byteTime(std::uint16_t divisor)
{
    constexpr std::array<double, 4> kFractions{0, 0.5, 0.25, 0.125};
    double                          by = (divisor & 0x3FFF) + kFractions[divisor >> 14];
    if (divisor == 0) by = 1;
    if (divisor == 1) by = 1.5;
    return kBitsPerByte * by / kClock;
}

/// One opening of the emulator's link. It is gone once the emulator was unplugged, and lost once a write failed.
class Connection final : public FalconLink {
public:
    explicit Connection(Ft232Emulator& emulator) noexcept : emulator_(emulator) {}

    [[nodiscard]] double now() const noexcept override { return emulator_.now(); }

    void control(FtdiRequest request, std::uint16_t value) override
    {
        guard([&] { emulator_.control(request, value); });
    }
    void write(std::span<const std::uint8_t> bytes) override
    {
        guard([&] { emulator_.write(bytes); });
    }
    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        std::size_t count = 0;
        guard([&] { count = emulator_.read(bytes, timeout); });
        return count;
    }
    [[nodiscard]] std::string serial() const override { return emulator_.serial(); }

private:
    template <class Action>
    void guard(const Action& action)
    {
        if (isGone_) throw LinkGone("the Falcon was unplugged");
        try {
            action();
        } catch (const LinkGone&) {
            isGone_ = true;
            throw;
        } catch (const LinkLost&) {
            isLost_ = true;
            throw;
        }
        if (isLost_) throw LinkLost("the Falcon's link is broken");
    }

    Ft232Emulator& emulator_;
    bool           isGone_ = false, isLost_ = false;
};

} // namespace

Ft232Emulator::Ft232Emulator(const Ft232EmulatorSettings& settings, EmulatedFalcon::Arm arm)
    : settings_(settings), falcon_(settings.falcon, std::move(arm))
{
    if (!(settings.transferTime > 0))
        throw Error("emulated link: transferTime must be above 0, found " + std::to_string(settings.transferTime));
}

std::unique_ptr<FalconLink> Ft232Emulator::connect()
{
    if (troubled(LinkTroubleKind::unplug, time_)) throw Error("no Falcon is plugged in");
    purge(true, true);
    eventCharacter_ = -1;
    latency_        = 16e-3;
    falcon_.linkOpened();
    return std::make_unique<Connection>(*this);
}

bool Ft232Emulator::troubled(LinkTroubleKind kind, double time) const noexcept
{
    return std::any_of(troubles_.begin(), troubles_.end(), [&](const LinkTrouble& trouble) {
        return trouble.kind == kind && time >= trouble.from && time < trouble.until;
    });
}

/// Returns when data that is ready at `time` [s] can move [s].
double Ft232Emulator::unstalled(double time) const noexcept
{
    for (const LinkTrouble& trouble : troubles_)
        if (trouble.kind == LinkTroubleKind::stall && time >= trouble.from && time < trouble.until)
            time = trouble.until;
    return time;
}

void Ft232Emulator::demandPlugged() const
{
    if (troubled(LinkTroubleKind::unplug, time_)) throw LinkGone("the Falcon was unplugged");
}

void Ft232Emulator::control(FtdiRequest request, std::uint16_t value)
{
    demandPlugged();
    waitUntil(unstalled(time_) + settings_.transferTime);
    switch (request) {
    case FtdiRequest::reset:
        return purge(value != 2, value != 1);
    case FtdiRequest::modemLines:
        if (value & 0x0100) falcon_.setDtr(value & 0x0001);
        return;
    case FtdiRequest::divisor:
        divisor_ = value;
        return;
    case FtdiRequest::eventCharacter:
        eventCharacter_ = value & 0x0100 ? value & 0xFF : -1;
        return;
    case FtdiRequest::latencyTimer:
        latency_ = std::clamp(value & 0xFF, 1, 255) * 1e-3;
        timer_   = time_ + latency_;
        return;
    case FtdiRequest::flowControl:
    case FtdiRequest::lineFormat:
        return;
    }
}

void Ft232Emulator::purge(bool received, bool toSend)
{
    if (received) {
        buffer_.clear();
        packets_.clear();
        host_.clear();
    }
    if (toSend) {
        out_.clear();
        outFree_ = time_;
    }
}

void Ft232Emulator::write(std::span<const std::uint8_t> bytes)
{
    demandPlugged();
    const double deadline = time_ + kWriteTimeout;
    waitUntil(time_ + settings_.transferTime);
    for (const std::uint8_t byte : bytes) {
        while (out_.size() >= kOutBuffer) { // the chip accepts no more
            if (out_.front().time > deadline) throw LinkLost("the Falcon's link takes no more bytes");
            waitUntil(out_.front().time);
        }
        outFree_ = unstalled(std::max(outFree_, time_)) + byteTime(divisor_);
        out_.push_back({outFree_, byte, divisor_});
    }
}

std::size_t Ft232Emulator::read(std::span<std::uint8_t> bytes, double timeout)
{
    demandPlugged();
    const double deadline = time_ + std::max(0.0, timeout);
    while (host_.empty() && nextEvent() <= deadline) {
        handleEvent();
        demandPlugged();
    }
    if (host_.empty()) waitUntil(deadline);
    demandPlugged();
    falcon_.moveTo(time_);
    const std::size_t count = std::min(bytes.size(), host_.size());
    std::copy_n(host_.begin(), count, bytes.begin());
    host_.erase(host_.begin(), host_.begin() + std::ptrdiff_t(count));
    return count;
}

double Ft232Emulator::nextEvent() const noexcept
{
    double next = timer_;
    if (!out_.empty()) next = std::min(next, out_.front().time);
    if (!in_.empty()) next = std::min(next, in_.front().time);
    if (!packets_.empty()) next = std::min(next, packets_.front().time);
    return next;
}

void Ft232Emulator::handleEvent()
{
    time_ = std::max(time_, nextEvent());
    if (!packets_.empty() && packets_.front().time <= time_) {
        const auto& bytes = packets_.front().bytes;
        host_.insert(host_.end(), bytes.begin() + std::ptrdiff_t(kStatus.size()), bytes.end());
        packets_.pop_front();
    } else if (!in_.empty() && in_.front().time <= time_) {
        arrive(in_.front());
        in_.pop_front();
    } else if (!out_.empty() && out_.front().time <= time_) {
        const WireByte byte = out_.front();
        out_.pop_front();
        answer(falcon_.receive(byte.value, byte.divisor, byte.time), byte.divisor, byte.time + falcon_.answerTime());
    } else {
        sendPacket(time_);
    }
}

void Ft232Emulator::waitUntil(double time)
{
    while (nextEvent() <= time) handleEvent();
    time_ = std::max(time_, time);
    falcon_.moveTo(time_);
}

/// Sends the Falcon's answer from `time` [s] on, at the divisor of the command, with the troubles of that time.
void Ft232Emulator::answer(std::span<const std::uint8_t> bytes, std::uint16_t divisor, double time)
{
    const auto has = [&](LinkTroubleKind kind) { return troubled(kind, time); };
    if (bytes.empty() || has(LinkTroubleKind::silence)) return;
    std::vector<std::uint8_t> said(bytes.begin(), bytes.end());
    if (said.size() < FalconPacket{}.size()) { // an answer of the boot loader
        if (falcon_.stage() == FalconStage::loader && has(LinkTroubleKind::echoMismatch)) said.back() ^= 0x10;
        return put(said, divisor, time);
    }
    FalconPacket packet;
    std::copy(bytes.begin(), bytes.end(), packet.begin());
    past_.push_back(packet);
    if (past_.size() > kPast + 1) past_.pop_front();

    if (has(LinkTroubleKind::replay)) said.assign(past_.front().begin(), past_.front().end());
    if (has(LinkTroubleKind::runt)) said.resize(said.size() - 2);
    if (has(LinkTroubleKind::repeat)) said.insert(said.end(), bytes.begin(), bytes.end());
    if (has(LinkTroubleKind::garbage))
        for (int n = 0; n < 5; ++n) {
            noise_ = noise_ * 1664525u + 1013904223u; // any bytes suffice
            said.insert(said.begin(), std::uint8_t(noise_ >> 24));
        }
    if (has(LinkTroubleKind::merged) && held_.empty()) {
        held_ = std::move(said);
        return;
    }
    said.insert(said.begin(), held_.begin(), held_.end());
    held_.clear();
    if (has(LinkTroubleKind::split)) {
        put(std::span(said).first(7), divisor, time);
        return put(std::span(said).subspan(7), divisor, time + kSplit);
    }
    put(said, divisor, time);
}

/// Puts bytes on the wire to the host.
void Ft232Emulator::put(std::span<const std::uint8_t> bytes, std::uint16_t divisor, double time)
{
    for (const std::uint8_t byte : bytes) {
        inFree_ = std::max(inFree_, time) + byteTime(divisor);
        in_.push_back({inFree_, byte, divisor});
    }
}

/// Takes a byte into the chip. Where the bauds differ it would be noise; here it is lost.
void Ft232Emulator::arrive(const WireByte& byte)
{
    if (byte.divisor != divisor_) return;
    buffer_.push_back(byte.value);
    if (buffer_.size() == kPayload || byte.value == eventCharacter_) sendPacket(byte.time);
}

void Ft232Emulator::sendPacket(double time)
{
    timer_ = time + latency_;
    if (buffer_.empty()) return; // a packet of two status bytes, which FalconLink does not report
    std::vector<std::uint8_t> bytes(kStatus.begin(), kStatus.end());
    bytes.insert(bytes.end(), buffer_.begin(), buffer_.end());
    buffer_.clear();
    const double arrives = unstalled(time) + settings_.transferTime;
    packets_.push_back({packets_.empty() ? arrives : std::max(arrives, packets_.back().time), std::move(bytes)});
}

} // namespace palp
