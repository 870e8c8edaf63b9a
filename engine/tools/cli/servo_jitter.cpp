#include "engine/tools/cli/servo_jitter.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "engine/core/quantity.h"
#include "engine/core/real_time.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3; // [s]

/// Fills it for a time [s].
void tick(TickLateness& late, double seconds)
{
    static_cast<void>(askForRealTime()); // a finding of its own says what was refused
    Metronome  metronome{std::chrono::milliseconds(1)};
    const auto start = metronome.wait();
    for (auto last = start;;) {
        const auto   now = metronome.wait();
        const double dt  = std::chrono::duration<double>(now - last).count();
        late.add(std::max(0.0, dt - kTick));
        if (std::chrono::duration<double>(now - start).count() >= seconds) return;
        last = now;
    }
}

/// One thread on every core that computes until this ends.
class Load {
public:
    Load()
    {
        for (unsigned n = 0; n < std::max(1U, std::thread::hardware_concurrency()); ++n)
            threads_.emplace_back([this](const std::stop_token& stop) {
                double sum = 0;
                while (!stop.stop_requested()) sum = std::sqrt(sum + 1);
                sink_ = sum;
            });
    }

private:
    std::atomic<double>       sink_ = 0; ///< so that the work is not omitted
    std::vector<std::jthread> threads_;
};

std::string words(const TickLateness& late)
{
    const auto text = [&](double share) { return formatQuantity(late.all.quantile(share), "s"); };
    return text(0.99) + " (p99), " + text(0.999) + " (p99.9), " + formatQuantity(late.all.most(), "s") + " (most)";
}

} // namespace

void TickLateness::add(double late) noexcept
{
    all.add(late);
    ++counts[std::size_t(std::ranges::lower_bound(kBins, late) - kBins.begin())];
}

ServoJitter measureJitter(double seconds, const std::function<void(double)>& onProgress)
{
    ServoJitter jitter;
    jitter.seconds = seconds;
    const auto run = [&](TickLateness& late, double before) {
        std::atomic<bool> over = false;
        std::jthread      servo([&] {
            tick(late, seconds);
            over = true;
        });
        for (const auto start = std::chrono::steady_clock::now(); !over;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            onProgress(before + std::min(0.5, 0.5 * time / seconds));
        }
        servo.join();
    };
    run(jitter.idle, 0);
    {
        const Load load;
        run(jitter.busy, 0.5);
    }
#ifdef __linux__
    munlockall();
#endif
    return jitter;
}

Finding findingOn(const ServoJitter& jitter)
{
    constexpr double kLate = 1e-3; // [s] a tick that is missed: its force is scaled down
    const bool       isOk  = jitter.busy.all.quantile(0.999) < kLate;
    return {"servo", isOk ? Verdict::ok : Verdict::warning,
            "ticks are late by " + words(jitter.idle) + "; with every core busy " + words(jitter.busy),
            isOk ? "" : "a late tick has less force: allow real-time scheduling, and close what keeps the cores busy"};
}

} // namespace palp
