// Tests of asking a device how fast it answers, and whether its guardian could be started.
#include "device/exchange_rate.h"

#include "device/arm_device.h"
#include "device/device_check.h"
#include "tests/device/falcon_bench.h"

namespace palp {
namespace {

struct Line {
    double transfer;  // [s]
    double perSecond; // [1/s] in step with a servo of 1 kHz, or slower where a round trip takes longer
};

TEST(ExchangeRates, AreThoseOfTheLine)
{
    for (const Line& line : {Line{125e-6, 1000}, Line{1e-3, 442}}) {
        Ft232EmulatorSettings settings = runningFalcon();
        settings.transferTime          = line.transfer;
        FalconBench bench(settings);

        const ExchangeRate rate = measureExchanges(
            *bench.device, 0.5, [&] { return bench.now = std::max(bench.now + 1e-3, bench.emulator.now()); });

        EXPECT_NEAR(rate.perSecond, line.perSecond, 0.01 * line.perSecond) << "whole answers in half a second";
        EXPECT_LT(rate.longest, 2 / line.perSecond);
        EXPECT_FALSE(bench.pushes());
    }
}

TEST(ExchangeRates, AnAnswersAgeIsThatOfItsPosition)
{
    for (const int ticks : {1, 3, 6}) {
        ArmDevice arm({.delayTicks = ticks});
        arm.open();
        double             now  = 0;
        const ExchangeRate rate = measureExchanges(arm, 0.5, [&] { return now += 1e-3; });
        EXPECT_NEAR(rate.age, (ticks - 1) * 1e-3, 1e-9) << "a force acts with the next tick; what is more is age";
        EXPECT_NEAR(rate.perSecond, 1000, 1e-6);
        EXPECT_NEAR(rate.longest, 1e-3, 1e-9);
    }
}

TEST(ExchangeRates, ADeviceThatDoesNotAnswerHasNone)
{
    FalconBench bench;
    bench.emulator.cause({LinkTroubleKind::silence});
    const ExchangeRate rate = measureExchanges(
        *bench.device, 0.5, [&] { return bench.now = std::max(bench.now + 1e-3, bench.emulator.now()); });
    EXPECT_EQ(rate.perSecond, 0);
}

TEST(ExchangeRates, TheGuardianCanBeTried)
{
    const Finding finding = checkGuardian();
    EXPECT_EQ(finding.verdict, Verdict::ok) << finding.found << "; " << finding.help;
}

} // namespace
} // namespace palp
