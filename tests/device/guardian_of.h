#pragma once
#include <cstdlib>
#include <string>

#include <sys/types.h>

namespace palp {

/// Sends its guardian, a program's only child, a signal.
inline bool signalGuardianOf(pid_t program, const char* signal)
{
    const std::string ask = std::string("pkill -") + signal + " -P " + std::to_string(program) + " palpate-guardia";
    return std::system(ask.c_str()) == 0;
}

} // namespace palp
