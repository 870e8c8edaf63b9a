#pragma once
#include <atomic>

namespace palp {

/// Makes Ctrl-C and a request to end, from now on, set the returned flag, so that a session ends in order: zero force
/// and a complete recording. A second one ends the program; one within 0.3 s is the first once more, as timeout(1)
/// sends it to a program and to its group. Ctrl-Z (SIGTSTP) stops the program only once each session in real time has
/// sent zero force, see ZeroBeforeStop.
[[nodiscard]] const std::atomic<bool>& catchInterrupts();

/// A session that is asked before the program stops, while this object lives. Without catchInterrupts() nobody asks.
/// \thread one; it allocates and locks nothing
class ZeroBeforeStop {
public:
    ZeroBeforeStop() noexcept;
    ~ZeroBeforeStop(); ///< stops the program if that was asked for
    ZeroBeforeStop(const ZeroBeforeStop&)            = delete;
    ZeroBeforeStop& operator=(const ZeroBeforeStop&) = delete;

    [[nodiscard]] bool isAsked() const noexcept;

    /// Stops the program, now that the force is zero, and returns when it goes on.
    void stop() noexcept;
};

} // namespace palp
