#pragma once
#include <csignal>
#include <cstdio>
#include <string>

#include <sys/types.h>

namespace palp {

/// Returns the process of its guardian, a program's only child; -1 if there is none. It takes milliseconds.
inline pid_t guardianOf(pid_t program)
{
    pid_t             found = -1;
    const std::string ask   = "pgrep -P " + std::to_string(program) + " palpate-guardia";
    if (std::FILE* const answer = ::popen(ask.c_str(), "r")) {
        if (std::fscanf(answer, "%d", &found) != 1) found = -1;
        ::pclose(answer);
    }
    return found;
}

} // namespace palp
