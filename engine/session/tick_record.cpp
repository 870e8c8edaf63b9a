#include "engine/session/tick_record.h"

#include <array>
#include <cstddef>

namespace palp {
namespace {

using Type = SessionColumn::Type;
using S    = TickRecord;

constexpr std::array kColumns = {
    SessionColumn{"time", Type::float64, 1, offsetof(S, time), "s", "since the session's start", false},
    SessionColumn{"hip", Type::float64, 3, offsetof(S, hip), "m", "where the hand is", false},
    SessionColumn{"hip_velocity", Type::float64, 3, offsetof(S, hipVelocity), "m/s", "filtered, as the device tells",
                  false},
    SessionColumn{"proxy", Type::float64, 3, offsetof(S, proxy), "m", "where the tool is held", false},
    SessionColumn{"force", Type::float64, 3, offsetof(S, force), "N", "on the hand, after the governor", false},
    SessionColumn{"normal", Type::float64, 3, offsetof(S, normal), "1",
                  "of the surface at the proxy; zero without contact", false},
    SessionColumn{"rigidity", Type::float64, 1, offsetof(S, rigidity), "N m", "D at the contact", false},
    SessionColumn{"compliance", Type::float64, 1, offsetof(S, compliance), "m/N", "c in use", false},
    SessionColumn{"w_max", Type::float64, 1, offsetof(S, maxDeflection), "m", "largest deflection of the plate", false},
    SessionColumn{"error_estimate", Type::float64, 1, offsetof(S, errorEstimate), "1",
                  "of the plate's solution, relative", false},
    SessionColumn{"patch_age", Type::float64, 1, offsetof(S, patchAge), "s", "of the plate's answer in use", false},
    SessionColumn{"tick_time", Type::float64, 1, offsetof(S, tickTime), "s", "processor time of the tick", true},
    SessionColumn{"iterations", Type::int32, 1, offsetof(S, iterations), "1", "of the plate's solver", false},
    SessionColumn{
        "faults", Type::uint32, 1, offsetof(S, faults), "1",
        "bits 0 to 7 why the governor stopped, 256 stale patch, 512 beyond the table, 1024 no patch yet, 2048 "
        "proxy limited, 4096 beyond plate theory, 8192 held back by the governor",
        false},
    SessionColumn{"device", Type::uint32, 1, offsetof(S, device), "1",
                  "bits 0 to 7 its fault, 8 homed, 9 in its box, 16 to 31 buttons", false},
    SessionColumn{"missed", Type::int32, 1, offsetof(S, missed), "1",
                  "exchanges with the device without an answer, in a row", false},
};

} // namespace

std::span<const SessionColumn> sessionColumns() noexcept
{
    return kColumns;
}

} // namespace palp
