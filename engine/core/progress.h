#pragma once
#include <chrono>
#include <cstddef>
#include <string>
#include <thread>

namespace palp {

/// One line on the terminal that shows the progress of long work. It appears after two seconds, and only where standard
/// error is a terminal. The destructor removes it.
/// \thread one
class Progress {
public:
    explicit Progress(std::string what);
    ~Progress();
    Progress(const Progress&)            = delete;
    Progress& operator=(const Progress&) = delete;

    /// Reports progress. The call is cheap enough for every few thousand items.
    void at(std::size_t done, std::size_t total);

    /// Draws the line at once, for work that cannot count its steps and is known to be long.
    void lasts(const std::string& howLong);

    /// Draws the line after two seconds and then the elapsed seconds, from a thread of its own, until the object is
    /// destroyed; for work that cannot count its steps and may be long. No other call may follow.
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
