// Tests of starting a Falcon, in the emulator's virtual time.
#include "device/falcon/falcon_driver.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "device/falcon/ft232_emulator.h"
#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr double kTimeOfUpload = 8492 * 10 / (3e6 / 21); // [s] 0.594: that many bytes at 142 857 baud

/// As long as the one in use; any bytes do.
std::vector<std::uint8_t> firmware()
{
    std::vector<std::uint8_t> bytes(8492);
    for (std::size_t n = 0; n < bytes.size(); ++n) bytes[n] = std::uint8_t(n * n / 7 + n);
    return bytes;
}

struct Start {
    Ft232Emulator       emulator;
    int                 openings = 0;
    FalconStartSettings settings{};
    std::atomic<bool>   cancel = false;

    explicit Start(const Ft232EmulatorSettings& how = {}) : emulator(how) { settings.cancel = &cancel; }

    StartedFalcon run(const std::vector<std::uint8_t>& image)
    {
        return startFalcon(
            [this] {
                ++openings;
                emulator.waitUntil(emulator.now() + 10e-3); // a plug that was loose for less is in again
                return emulator.connect();
            },
            image, settings);
    }

    /// What it complains of; empty: it starts.
    std::string complaint(const std::vector<std::uint8_t>& image = firmware())
    {
        try {
            static_cast<void>(run(image));
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
};

TEST(FalconDriver, UploadsOnceAndBelievesOnlyAnswers)
{
    Start start;

    const StartedFalcon started = start.run(firmware());

    std::printf("  started after %.3f s, of which %.3f s are the bytes on the wire\n", start.emulator.now(),
                kTimeOfUpload);
    EXPECT_EQ(started.attempts, 1);
    EXPECT_EQ(start.emulator.falcon().image(), firmware());
    EXPECT_EQ(start.emulator.falcon().stage(), FalconStage::running);
    EXPECT_FALSE(started.reply.homed());
    EXPECT_LT(start.emulator.now(), 1.0) << "0.1 s of asking first, 0.6 of bytes, 137 turns of 0.4 ms";
    EXPECT_EQ(start.emulator.falcon().lastTorque(), -1) << "no motor ever moved";
}

TEST(FalconDriver, TellsEachPieceOfAnUpload)
{
    Start                    start;
    std::vector<std::size_t> pieces;
    start.settings.onUpload = [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(total, firmware().size());
        EXPECT_EQ(start.emulator.falcon().image().size(), done) << "what was echoed has arrived";
        pieces.push_back(done);
    };

    static_cast<void>(start.run(firmware()));

    ASSERT_EQ(pieces.size(), 137U) << "8492 bytes in pieces of 62";
    EXPECT_EQ(pieces.front(), 62U);
    EXPECT_EQ(pieces.back(), firmware().size());
}

TEST(FalconDriver, UploadsNothingWhereTheFirmwareRuns)
{
    Ft232EmulatorSettings settings;
    settings.falcon.running = true;
    Start start(settings);

    const StartedFalcon started = start.run({});

    EXPECT_EQ(started.attempts, 0);
    EXPECT_EQ(start.openings, 1);
    EXPECT_TRUE(start.emulator.falcon().image().empty());
    EXPECT_LT(start.emulator.now(), 0.05) << "three packets, and 16 in either way of answering";
}

TEST(FalconDriver, WithoutFirmwareSaysWhatIsMissing)
{
    EXPECT_NE(Start().complaint({}).find("--falcon-firmware"), std::string::npos);
}

/// A bridge that has trouble with the event character.
class OddBridge final : public FalconLink {
public:
    enum class Trouble { none, ignoresIt, losesAnswersWithIt };

    OddBridge(std::unique_ptr<FalconLink> link, Trouble trouble) : link_(std::move(link)), trouble_(trouble) {}

    [[nodiscard]] double now() const noexcept override { return link_->now(); }
    void                 control(FtdiRequest request, std::uint16_t value) override
    {
        if (request == FtdiRequest::eventCharacter) isOn_ = (value & 0x0100) != 0;
        if (request != FtdiRequest::eventCharacter || trouble_ != Trouble::ignoresIt) link_->control(request, value);
    }
    void        write(std::span<const std::uint8_t> bytes) override { link_->write(bytes); }
    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        const std::size_t count = link_->read(bytes, timeout);
        return isOn_ && trouble_ == Trouble::losesAnswersWithIt && ++reads_ % 7 == 0 ? 0 : count;
    }

private:
    std::unique_ptr<FalconLink> link_;
    Trouble                     trouble_;
    bool                        isOn_  = false;
    int                         reads_ = 0;
};

TEST(FalconDriver, TheEventCharacterIsTriedAndKeptIfItIsFaster)
{
    using enum OddBridge::Trouble;
    Ft232EmulatorSettings settings;
    settings.falcon.running = true;
    struct Case {
        OddBridge::Trouble trouble;
        bool               isTried, isKept;
    };
    for (const auto& [trouble, isTried, isKept] :
         {Case{none, true, true}, {none, false, false}, {ignoresIt, true, false}, {losesAnswersWithIt, true, false}}) {
        Ft232Emulator       emulator(settings);
        FalconStartSettings how;
        how.triesEventCharacter  = isTried;
        const auto          kind = trouble;
        const StartedFalcon started =
            startFalcon([&] { return std::make_unique<OddBridge>(emulator.connect(), kind); }, {}, how);

        std::array<std::uint8_t, 64> bytes;
        while (started.link->read(bytes, 2e-3) > 0) {
        }                   // what was lost comes no more
        double slowest = 0; // [s]
        for (int n = 0; n < 20; ++n) {
            const double before = started.link->now();
            started.link->write(encode(FalconCommand{}));
            EXPECT_EQ(started.link->read(bytes, 0.1), 16u);
            slowest = std::max(slowest, started.link->now() - before);
        }
        EXPECT_EQ(started.usesEventCharacter, isKept);
        EXPECT_LT(slowest, isKept ? 0.6e-3 : 2e-3) << "wires and transfers, or the timer's";
        EXPECT_GT(slowest, isKept ? 0.4e-3 : 0.9e-3);
        EXPECT_LT(emulator.now(), 0.1) << "a trial is short";
        EXPECT_EQ(emulator.falcon().lastTorque(), -1) << "and without force";
    }
}

TEST(FalconDriver, TriesAgainFromNothingAfterEveryTroubleOfAnUpload)
{
    // Within the first upload; the pauses are longer than it waits for an echo.
    for (const LinkTrouble& trouble :
         {LinkTrouble{LinkTroubleKind::echoMismatch, 0.4, 0.41}, LinkTrouble{LinkTroubleKind::silence, 0.4, 0.41},
          LinkTrouble{LinkTroubleKind::stall, 0.4, 0.55}}) {
        Start start;
        start.emulator.cause(trouble);

        const StartedFalcon started = start.run(firmware());

        EXPECT_EQ(started.attempts, 2) << "kind " << int(trouble.kind);
        EXPECT_EQ(start.emulator.falcon().image(), firmware())
            << "whole, not the rest of it; kind " << int(trouble.kind);
    }
    for (double from : {0.015, 0.5}) { // while it asks, while it uploads
        Start start;
        start.emulator.cause({LinkTroubleKind::unplug, from, from + 9e-3});
        EXPECT_EQ(start.complaint(), "") << "a plug that was loose, at " << from << " s";
        EXPECT_EQ(start.openings, from < 0.1 ? 2 : 3);
    }
}

TEST(FalconDriver, SaysWhichByteFailedAndGivesUpAfterTheAttempts)
{
    Start once, thrice;
    once.settings.attempts   = 1;
    thrice.settings.attempts = 3;
    once.emulator.cause({LinkTroubleKind::echoMismatch, 0.4});
    thrice.emulator.cause({LinkTroubleKind::echoMismatch, 0});

    EXPECT_NE(once.complaint().find("of the firmware came back changed"), std::string::npos);
    EXPECT_NE(thrice.complaint().find("3 attempts"), std::string::npos);
    EXPECT_EQ(thrice.openings, 4) << "one to ask, then each attempt its own";
}

TEST(FalconDriver, ADeadFalconEndsAtTheAttemptsOrTheDeadline)
{
    Start patient, hasty;
    patient.emulator.cause({LinkTroubleKind::silence, 0});
    hasty.emulator.cause({LinkTroubleKind::silence, 0});
    hasty.settings.deadline = 2;

    EXPECT_NE(patient.complaint().find("10 attempts"), std::string::npos);
    EXPECT_LT(patient.emulator.now(), 17) << "30 greetings of 50 ms each";
    EXPECT_NE(hasty.complaint().find("2 s"), std::string::npos);
    EXPECT_LT(hasty.emulator.now(), 2.1) << "looked at with each greeting";
}

TEST(FalconDriver, CancelEndsItWithinATenthOfASecond)
{
    for (double when : {0.05, 0.3, 1.0}) { // while it asks, greets and uploads
        Start           start;
        double          cancelled = -1;
        struct Watching final : FalconLink {
            FalconLink& link;
            Start&      start;
            double      when, *cancelled;
            Watching(FalconLink& l, Start& s, double w, double* c) : link(l), start(s), when(w), cancelled(c) {}
            double now() const noexcept override { return link.now(); }
            void   control(FtdiRequest request, std::uint16_t value) override { link.control(request, value); }
            void   write(std::span<const std::uint8_t> bytes) override
            {
                if (now() > when && *cancelled < 0) {
                    start.cancel = true;
                    *cancelled   = now();
                }
                link.write(bytes);
            }
            std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
            {
                return link.read(bytes, timeout);
            }
        };
        if (when == 1.0) start.emulator.cause({LinkTroubleKind::silence, 0.15, 0.5});

        std::string complaint;
        try {
            static_cast<void>(
                startFalcon([&] { return std::make_unique<Watching>(start.emulator, start, when, &cancelled); },
                            firmware(), start.settings));
        } catch (const Error& error) {
            complaint = error.what();
        }

        EXPECT_NE(complaint.find("cancelled"), std::string::npos) << complaint;
        EXPECT_LT(start.emulator.now() - cancelled, 0.1);
    }
}

TEST(FalconDriver, AnOpenerThatFailsIsAFailedAttempt)
{
    for (const int failures : {2, 100}) {
        Start start;
        start.settings.attempts    = 4;
        start.settings.reopenAfter = 1e-3;
        int         openings       = 0;
        std::string complaint;
        int         attempts = 0;
        try {
            attempts = startFalcon(
                           [&]() -> std::unique_ptr<FalconLink> {
                               ++openings;
                               if (openings > 1 && openings <= 1 + failures) throw Error("it is busy");
                               return start.emulator.connect();
                           },
                           firmware(), start.settings)
                           .attempts;
        } catch (const Error& error) {
            complaint = error.what();
        }

        EXPECT_EQ(attempts, failures == 2 ? 3 : 0) << complaint;
        EXPECT_EQ(complaint.find("4 attempts: it is busy") != std::string::npos, failures == 100) << complaint;
        EXPECT_EQ(openings, failures == 2 ? 4 : 5);
    }
}

TEST(FalconDriver, WaitingToReopenItHeedsTheCancelling)
{
    Start start;
    start.settings.reopenAfter  = 60;
    int               openings  = 0;
    const std::string complaint = refusalOf([&] {
        static_cast<void>(startFalcon(
            [&]() -> std::unique_ptr<FalconLink> {
                if (++openings == 1) return start.emulator.connect();
                start.cancel = true;
                throw Error("it is busy");
            },
            firmware(), start.settings));
    });

    EXPECT_NE(complaint.find("cancelled"), std::string::npos) << complaint;
    EXPECT_EQ(openings, 2);
}

TEST(FalconDriver, AskedWhatItNeedsAFalconStillTakesItsFirmware)
{
    Start      fresh;
    const auto ask = [](Ft232Emulator& emulator) { return askFalcon(*emulator.connect()); };

    EXPECT_EQ(ask(fresh.emulator), FalconReadiness::noFirmware);
    EXPECT_LT(fresh.emulator.now(), 0.1);
    EXPECT_EQ(fresh.run(firmware()).attempts, 1) << "opened anew it listens";
    EXPECT_EQ(ask(fresh.emulator), FalconReadiness::notHomed);

    Ft232EmulatorSettings settings;
    settings.falcon.running = settings.falcon.homed = true;
    Ft232Emulator homed(settings);
    EXPECT_EQ(ask(homed), FalconReadiness::ready);
    EXPECT_LT(homed.now(), 0.01) << "two packets";
    EXPECT_EQ(homed.falcon().command(), FalconCommand{}) << "no force, no lights";
}

TEST(FalconDriver, WithoutFirmwareALinkThatBrokeIsNotBlamedOnIt)
{
    Ft232EmulatorSettings settings;
    settings.falcon.running = true;
    Start start(settings);
    start.emulator.cause({LinkTroubleKind::unplug, 0.011, 0.1});

    const std::string complaint = start.complaint({});

    EXPECT_NE(complaint.find("unplugged"), std::string::npos) << complaint;
}

TEST(FalconDriver, AFalconThatIsNotThereIsTheOpenersError)
{
    EXPECT_THROW(
        static_cast<void>(startFalcon([]() -> std::unique_ptr<FalconLink> { throw Error("no rights"); }, firmware())),
        Error);
}

} // namespace
} // namespace palp
