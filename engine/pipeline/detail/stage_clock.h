#pragma once
#include <chrono>

namespace palp {

/// Adds the time until its scope ends to a stage.
class StageClock {
public:
    explicit StageClock(double& milliseconds) : milliseconds_(milliseconds) {}
    StageClock(const StageClock&)            = delete;
    StageClock& operator=(const StageClock&) = delete;
    ~StageClock() { milliseconds_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;

    double&           milliseconds_;
    Clock::time_point start_ = Clock::now();
};

} // namespace palp
