#include "engine/core/progress.h"

#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <system_error>

#include <unistd.h>

namespace palp {
namespace {

constexpr std::chrono::seconds kPatience{2}; // before the line appears

} // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)), onTerminal_(::isatty(STDERR_FILENO) == 1), next_(Clock::now() + kPatience)
{
}

Progress::~Progress()
{
    ticker_ = {}; // stops and joins
    if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::at(std::size_t done, std::size_t total)
{
    if (!onTerminal_ || total == 0) return;
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(200);
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.0f %%", 100.0 * double(done) / double(total));
    draw(percent);
}

void Progress::lasts(const std::string& howLong)
{
    if (onTerminal_) draw(howLong);
}

void Progress::mayLast()
{
    if (!onTerminal_) return;
    const auto drawEachSecond = [this](const std::stop_token& stop) {
        std::mutex                  alone; // nothing is shared; the condition needs a mutex to wait
        std::condition_variable_any tick;
        std::unique_lock            lock(alone);
        for (auto seconds = kPatience;; ++seconds) {
            const auto due = next_ - kPatience + seconds;
            tick.wait_until(lock, stop, due, [] { return false; });
            if (stop.stop_requested()) return;
            draw(std::to_string(seconds.count()) + " s");
        }
    };
    try {
        ticker_ = std::jthread(drawEachSecond);
    } catch (const std::system_error&) { // no thread is left: the work goes on without a line
    }
}

void Progress::draw(const std::string& state)
{
    drawn_ = true;
    std::fprintf(stderr, "\r\033[K%s: %s", what_.c_str(), state.c_str());
    std::fflush(stderr);
}

} // namespace palp
