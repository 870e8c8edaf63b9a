#pragma once
#include <array>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <unistd.h>

namespace palp {

/// Standard error on a terminal of its own, while the object lives.
class Terminal {
public:
    Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)), before_(::dup(STDERR_FILENO))
    {
        if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
        const int slave = ::open(::ptsname(master_), O_RDWR | O_NOCTTY);
        if (slave < 0) return;
        good_ = ::dup2(slave, STDERR_FILENO) >= 0;
        ::close(slave);
    }
    ~Terminal()
    {
        ::dup2(before_, STDERR_FILENO);
        ::close(before_);
        if (master_ >= 0) ::close(master_);
    }
    Terminal(const Terminal&)            = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] bool good() const { return good_; }

    /// What was written since the last call.
    [[nodiscard]] std::string text() const
    {
        std::array<char, 4096> bytes{};
        const ssize_t          count = ::read(master_, bytes.data(), bytes.size());
        return {bytes.data(), std::size_t(count > 0 ? count : 0)};
    }

private:
    int  master_, before_;
    bool good_ = false;
};

} // namespace palp
