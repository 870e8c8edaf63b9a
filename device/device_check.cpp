#include "device/device_check.h"

#include <array>
#include <chrono>
#include <cmath>

#include <sys/socket.h>
#include <unistd.h>

#include "device/detail/guardian.h"
#include "device/falcon/falcon_codec.h"
#include "engine/core/contract.h"

namespace palp {

Finding checkGuardian()
{
    const char*        part = "guardian";
    std::array<int, 2> line{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, line.data()) != 0)
        return {part, Verdict::missing, "there is no socket to try it on", "raise the limit of open files"};
    Finding    finding{part, Verdict::ok, "", ""};
    const auto begin = std::chrono::steady_clock::now();
    try {
        const Guardian guardian({.fd = line[0]}, kFalconZero, "a trial");
        const double   took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        finding.found       = "it starts, in " + std::to_string(std::lround(1e3 * took)) + " ms";
    } catch (const Error& error) {
        finding = {part, Verdict::missing, error.what(), "without it no Falcon or bridge is driven"};
    }
    for (const int end : line) close(end);
    return finding;
}

} // namespace palp
