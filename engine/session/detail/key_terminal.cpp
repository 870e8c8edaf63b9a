#include "engine/session/detail/key_terminal.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace palp {
namespace {

std::atomic<const KeyTerminal*> current = nullptr; ///< null: the terminal is as it was
static_assert(std::atomic<const KeyTerminal*>::is_always_lock_free, "a signal handler reads it");

} // namespace

KeyTerminal::KeyTerminal(bool wanted)
{
    if (!wanted || !ours() || ::tcgetattr(STDIN_FILENO, &before_) != 0) return;
    during_ = before_;
    during_.c_lflag &= ~tcflag_t(ICANON | ECHO);
    during_.c_cc[VMIN] = during_.c_cc[VTIME] = 0;
    open_                                    = ::tcsetattr(STDIN_FILENO, TCSADRAIN, &during_) == 0;
    if (open_) current = this;
}

KeyTerminal::~KeyTerminal()
{
    if (!open_) return;
    current = nullptr;
    if (ours()) ::tcsetattr(STDIN_FILENO, TCSADRAIN, &before_);
}

bool KeyTerminal::ours() noexcept
{
    return ::isatty(STDIN_FILENO) != 0 && ::tcgetpgrp(STDIN_FILENO) == ::getpgrp();
}

void KeyTerminal::stopProgram() noexcept
{
    if (const KeyTerminal* const now = current; now && ours()) ::tcsetattr(STDIN_FILENO, TCSANOW, &now->before_);
    raise(SIGSTOP);
    if (const KeyTerminal* const now = current; now && ours()) ::tcsetattr(STDIN_FILENO, TCSANOW, &now->during_);
}

} // namespace palp
