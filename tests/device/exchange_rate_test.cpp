// Tests of asking a device how fast it answers, and whether its guardian could be started.
#include "device/exchange_rate.h"

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

        EXPECT_NEAR(rate.perSecond, line.perSecond, 0.1 * line.perSecond) << line.transfer;
        EXPECT_LT(rate.longest, 2 / line.perSecond);
        EXPECT_FALSE(bench.pushes());
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
