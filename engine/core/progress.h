#pragma once
#include <chrono>
#include <cstddef>
#include <string>
#include <thread>

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

    /// For work that cannot count its steps and may last: draws the line after two seconds and then the seconds that
    /// went by, from a thread of its own, until the object goes. No other call may follow.
    void mayLast();

private:
    using Clock = std::chrono::steady_clock;
    void draw(const std::string& state);

    std::string       what_;
    bool              onTerminal_;
    bool              drawn_ = false;
    Clock::time_point next_;
    std::jthread      ticker_; ///< of mayLast()
};

} // namespace palp
