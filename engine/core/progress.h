#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace palp {

/// One line on the terminal for work that lasts: nothing in the first two seconds, nothing where standard error is
/// not a terminal. The line is wiped when the object goes.
/// \thread one
class Progress {
public:
    explicit Progress(std::string what);
    ~Progress();
    Progress(const Progress&)            = delete;
    Progress& operator=(const Progress&) = delete;

    /// Cheap enough to be called every few thousand items.
    void at(std::size_t done, std::size_t total);

    /// For work that cannot count its steps and is known to last: draws the line at once.
    void lasts(const std::string& howLong);

private:
    using Clock = std::chrono::steady_clock;
    std::string       what_;
    bool              onTerminal_;
    bool              drawn_ = false;
    Clock::time_point next_;
};

} // namespace palp
