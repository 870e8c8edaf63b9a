#include "engine/core/progress.h"

#include <cstdio>

#include <unistd.h>

namespace palp {

Progress::Progress(std::string what)
    : what_(std::move(what)), onTerminal_(::isatty(STDERR_FILENO) == 1), next_(Clock::now() + std::chrono::seconds(2))
{
}

Progress::~Progress()
{
    if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::at(std::size_t done, std::size_t total)
{
    if (!onTerminal_ || total == 0) return;
    const auto now = Clock::now();
    if (now < next_) return;
    next_  = now + std::chrono::milliseconds(200);
    drawn_ = true;
    std::fprintf(stderr, "\r\033[K%s: %.0f %%", what_.c_str(), 100.0 * double(done) / double(total));
    std::fflush(stderr);
}

void Progress::lasts(const std::string& howLong)
{
    if (!onTerminal_) return;
    drawn_ = true;
    std::fprintf(stderr, "\r\033[K%s: %s", what_.c_str(), howLong.c_str());
    std::fflush(stderr);
}

} // namespace palp
