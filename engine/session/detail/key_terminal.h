#pragma once
#include <termios.h>

namespace palp {

/// The program's terminal, set so that each key is read at once, and set back in the end and while Ctrl-Z stops the
/// program. One at a time.
class KeyTerminal {
public:
    explicit KeyTerminal(bool wanted);
    ~KeyTerminal();
    KeyTerminal(const KeyTerminal&)            = delete;
    KeyTerminal& operator=(const KeyTerminal&) = delete;

    [[nodiscard]] bool isOpen() const noexcept { return open_; }

    /// Returns true if standard input is a terminal and the program is in its foreground: another one would be stopped.
    [[nodiscard]] static bool ours() noexcept;

    /// Stops the program (SIGSTOP), with its terminal as it was before, and returns when it goes on. For signal
    /// handlers too.
    static void stopProgram() noexcept;

private:
    termios before_{}, during_{};
    bool    open_ = false;
};

} // namespace palp
