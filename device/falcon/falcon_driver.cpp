#include "device/falcon/falcon_driver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <thread>

#include "device/haptic_device.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::array<std::uint8_t, 3> kHello{0x0A, 0x43, 0x0D};
constexpr std::array<std::uint8_t, 4> kWelcome{0x0A, 0x44, 0x2C, 0x0D};
constexpr std::uint8_t                kLoad = 0x41;

constexpr int         kHellos      = 30;    ///< per attempt; libnifalcon says hello up to 100 times, in fewer attempts
constexpr double      kHelloTime   = 50e-3; ///< [s] 7 bytes at 9600 baud are 7 ms, and the latency timer has 16
constexpr std::size_t kChunk       = 62;    ///< [byte] whose echo fills a packet, which does not wait for the timer
constexpr double      kEchoTime    = 0.1;   ///< [s] a chunk takes 4.4 ms, the last one up to 16 more
constexpr double      kAnswerTime  = 20e-3; ///< [s] for a packet and its answer: 1 to 2 ms
constexpr int         kAnswers     = 3;     ///< in a row before the firmware counts as running
constexpr int         kProbes      = 5;     ///< packets to firmware that may be running
constexpr int         kQuestions   = 4;     ///< packets of askFalcon(): 80 ms
constexpr int         kFirstProbes = 50;    ///< packets to starting firmware: for 1 s
constexpr int         kTimed       = 16;    ///< packets by which two ways are compared: 8 to 50 ms each
constexpr double      kFaster      = 0.9;   ///< [1] of the timer's time that is worth a change

constexpr std::chrono::milliseconds kGlance(10); ///< between looks at `cancel` while it waits to reopen

constexpr const char* kAdvice = "; try without a hub, or take the Falcon off its power for a moment";

constexpr std::uint16_t kDtrLow = 0x0100, kDtrHigh = 0x0101, kRtsLow = 0x0200, k8N1 = 0x0008;
constexpr std::uint16_t kLoaderLatency = 16, kRunLatency = 1; ///< [ms] libnifalcon: the loader's checks fail at 1
constexpr std::uint16_t kEventOnEnd = 0x0100 | '>', kNoEvent = '>';
constexpr std::uint16_t kPurgeReceived = 1, kPurgeToSend = 2;

void prepare(FalconLink& link, std::uint16_t latency, FalconDivisor divisor, std::uint16_t event)
{
    link.control(FtdiRequest::reset, kPurgeReceived);
    link.control(FtdiRequest::reset, kPurgeToSend);
    link.control(FtdiRequest::latencyTimer, latency);
    link.control(FtdiRequest::divisor, std::uint16_t(divisor));
    link.control(FtdiRequest::lineFormat, k8N1);
    link.control(FtdiRequest::flowControl, 0);
    link.control(FtdiRequest::eventCharacter, event);
}

/// Returns the first answer that comes in time.
std::optional<FalconReply> listen(FalconLink& link, FalconParser& parser)
{
    std::array<std::uint8_t, 256> bytes;
    const double                  until = link.now() + kAnswerTime;
    for (double left = kAnswerTime; left > 0; left = until - link.now()) {
        parser.feed(std::span(bytes).first(link.read(bytes, left)));
        if (const auto reply = parser.next()) return reply;
    }
    return {};
}

/// One start of a Falcon. The reason why an attempt failed is a string, empty if it did not fail.
class Start {
public:
    Start(std::span<const std::uint8_t> firmware, const FalconStartSettings& settings)
        : firmware_(firmware), settings_(settings)
    {
    }

    StartedFalcon run(const FalconLinkOpener& open)
    {
        StartedFalcon started;
        started.link = open();
        end_         = started.link->now() + settings_.deadline;
        if (firmwareRuns(started)) return hurried(std::move(started));
        if (firmware_.empty() && !lost_.empty()) throw Error(lost_ + kAdvice);
        if (firmware_.empty())
            throw Error("the Falcon has no firmware: name the file that came with its software (--falcon-firmware)");
        while (started.attempts < settings_.attempts) {
            ++started.attempts;
            reason_ = attempt(started, open);
            if (reason_.empty()) return hurried(std::move(started));
        }
        throw Error("the Falcon did not start in " + std::to_string(started.attempts) + " attempts: " + reason_ +
                    kAdvice);
    }

private:
    bool firmwareRuns(StartedFalcon& started)
    {
        try {
            return probe(started, kProbes);
        } catch (const LinkLost& lost) { // an attempt reopens it
            lost_ = lost.what();
            return false;
        }
    }

    std::string attempt(StartedFalcon& started, const FalconLinkOpener& open)
    {
        started.link.reset(); // before it is opened again
        try {
            started.link = open();
        } catch (const Error& error) { // it may be coming back, or busy for a moment
            waitToReopen();
            return error.what();
        }
        try {
            FalconLink& link   = *started.link;
            std::string reason = greet(link);
            if (reason.empty()) reason = upload(link);
            if (reason.empty() && !probe(started, kFirstProbes)) reason = "it took the firmware but gives no answers";
            return reason;
        } catch (const LinkLost& lost) {
            return lost.what();
        }
    }

    void heedCancel() const
    {
        if (settings_.cancel && settings_.cancel->load()) throw Error("the start of the Falcon was cancelled");
    }

    /// Waits in steady time, because there is no link with a clock.
    void waitToReopen() const
    {
        using Clock    = std::chrono::steady_clock;
        const auto end = Clock::now() + std::chrono::duration<double>(settings_.reopenAfter);
        do heedCancel();
        while (Clock::now() < end && (std::this_thread::sleep_for(kGlance), true));
    }

    void pause(const FalconLink& link) const
    {
        heedCancel();
        if (link.now() > end_)
            throw Error("the Falcon did not start in " + std::to_string(std::lround(settings_.deadline)) +
                        " s: " + reason_ + kAdvice);
    }

    /// Returns whether the firmware answers. It leaves the link as run-time packets need it.
    bool probe(StartedFalcon& started, int packets)
    {
        FalconLink& link = *started.link;
        prepare(link, kRunLatency, FalconDivisor::run, kNoEvent);
        const FalconPacket zero = encode(FalconCommand{.homing = true, .lights = std::uint8_t(DeviceLight::red)});
        FalconParser       parser;
        int                inARow = 0;
        for (int n = 0; n < packets && inARow < kAnswers; ++n) {
            pause(link);
            link.write(zero);
            const auto reply = listen(link, parser);
            inARow           = reply ? inARow + 1 : 0;
            if (reply) started.reply = *reply;
        }
        return inARow == kAnswers;
    }

    /// Lets the bridge pass on answers in the faster of two ways.
    StartedFalcon hurried(StartedFalcon started) const
    {
        if (!settings_.triesEventCharacter) return started;
        FalconLink& link = *started.link;
        try {
            const double timer = roundTrips(link);
            link.control(FtdiRequest::eventCharacter, kEventOnEnd);
            started.usesEventCharacter = roundTrips(link) < kFaster * timer;
            if (!started.usesEventCharacter) link.control(FtdiRequest::eventCharacter, kNoEvent);
        } catch (const LinkLost& lost) {
            throw Error(lost.what() + std::string(kAdvice));
        }
        return started;
    }

    /// Returns the time of some exchanges [s]; infinity if one found no answer.
    static double roundTrips(FalconLink& link)
    {
        const FalconPacket zero = encode(FalconCommand{.homing = true, .lights = std::uint8_t(DeviceLight::red)});
        FalconParser       parser;
        const double       begin = link.now();
        for (int n = 0; n < kTimed; ++n) {
            link.write(zero);
            if (!listen(link, parser)) return std::numeric_limits<double>::infinity();
        }
        return link.now() - begin;
    }

    /// Wakes the boot loader.
    std::string greet(FalconLink& link) const
    {
        prepare(link, kLoaderLatency, FalconDivisor::hello, 0);
        link.control(FtdiRequest::modemLines, kRtsLow);
        link.control(FtdiRequest::modemLines, kDtrLow);
        link.control(FtdiRequest::modemLines, kDtrHigh);
        for (int n = 0; n < kHellos; ++n) {
            pause(link);
            link.write(kHello);
            if (!heard(link, kWelcome, kHelloTime)) continue;
            link.control(FtdiRequest::modemLines, kDtrLow);
            link.control(FtdiRequest::divisor, std::uint16_t(FalconDivisor::loader));
            link.write(std::array{kLoad});
            return heard(link, std::array{kLoad}, kHelloTime) ? "" : "the boot loader did not accept the upload";
        }
        return "the boot loader does not answer";
    }

    /// Returns whether these bytes come, perhaps after others: some hosts see a zero before them.
    static bool heard(FalconLink& link, std::span<const std::uint8_t> wanted, double timeout)
    {
        std::array<std::uint8_t, 256> bytes;
        std::size_t                   count = 0;
        const double                  until = link.now() + timeout;
        for (double left = timeout; left > 0 && count < bytes.size(); left = until - link.now()) {
            count += link.read(std::span(bytes).subspan(count), left);
            if (count >= wanted.size() &&
                std::equal(wanted.begin(), wanted.end(), bytes.begin() + std::ptrdiff_t(count - wanted.size())))
                return true;
        }
        return false;
    }

    /// Uploads chunk after chunk and compares each with its echo: there is no other check.
    std::string upload(FalconLink& link) const
    {
        for (std::size_t at = 0; at < firmware_.size(); at += kChunk) {
            pause(link);
            const auto chunk = firmware_.subspan(at, std::min(kChunk, firmware_.size() - at));
            link.write(chunk);
            std::array<std::uint8_t, kChunk> echo;
            std::size_t                      count = 0;
            const double                     until = link.now() + kEchoTime;
            for (double left = kEchoTime; left > 0 && count < chunk.size(); left = until - link.now())
                count += link.read(std::span(echo).subspan(count, chunk.size() - count), left);
            if (count < chunk.size()) return "byte " + std::to_string(at + count) + " of the firmware found no echo";
            for (std::size_t n = 0; n < count; ++n)
                if (echo[n] != chunk[n]) return "byte " + std::to_string(at + n) + " of the firmware came back changed";
            if (settings_.onUpload) settings_.onUpload(at + count, firmware_.size());
        }
        return {};
    }

    std::span<const std::uint8_t> firmware_;
    FalconStartSettings           settings_;
    double                        end_ = 0;                      ///< [s] by the link's clock
    std::string                   lost_;                         ///< why asking failed, if it did
    std::string                   reason_ = "it gave no answer"; ///< why the last attempt failed
};

} // namespace

StartedFalcon startFalcon(const FalconLinkOpener& open, std::span<const std::uint8_t> firmware,
                          const FalconStartSettings& settings)
{
    return Start(firmware, settings).run(open);
}

FalconReadiness askFalcon(FalconLink& link)
{
    prepare(link, kRunLatency, FalconDivisor::run, 0);
    FalconParser parser;
    for (int n = 0, inARow = 0; n < kQuestions; ++n) {
        link.write(encode(FalconCommand{}));
        const auto reply = listen(link, parser);
        inARow           = reply ? inARow + 1 : 0;
        if (inARow == 2) return reply->homed() ? FalconReadiness::ready : FalconReadiness::notHomed;
    }
    return FalconReadiness::noFirmware;
}

bool releaseMotors(FalconLink& link, const FalconCommand& command) noexcept
{
    FalconCommand zero = command;
    zero.motors        = {};
    for (int n = 0; n < 3; ++n) {
        try {
            link.write(encode(zero));
        } catch (const LinkGone&) { // the motors let go by themselves
            return false;
        } catch (const std::exception&) { // the next one may get through
        }
    }
    return true;
}

} // namespace palp
