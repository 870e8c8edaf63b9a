#include "engine/session/tick_record.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace palp {
namespace {

using Type = SessionColumn::Type;
using S    = TickRecord;

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");
static_assert(offsetof(glm::dquat, x) == 0 && offsetof(glm::dquat, w) == 24, "a quaternion is stored as x, y, z, w");

// What a replay computes with is stored to the bit. The rest is stored as float32: 7 digits, more than any
// of these numbers means. The order is that of the stored row: 15 doubles, 19 floats, 2 and 4 whole numbers; what
// later versions have added follows at the end, so that readers of datagrams find the rest where it was.
constexpr std::array kColumns = {
    SessionColumn{"time", Type::float64, 1, offsetof(S, time), "s", "since the session's start", false},
    SessionColumn{"hip", Type::float64, 3, offsetof(S, hip), "m", "where the hand is", false},
    SessionColumn{"hip_velocity", Type::float64, 3, offsetof(S, hipVelocity), "m/s", "filtered, as the device tells",
                  false},
    SessionColumn{"proxy", Type::float64, 3, offsetof(S, proxy), "m", "where the tool is held", false},
    SessionColumn{"force", Type::float64, 3, offsetof(S, force), "N", "on the hand, after the governor", false},
    SessionColumn{"answer_time", Type::float64, 1, offsetof(S, answerTime), "s",
                  "of the session, when the device's newest answer came", false},
    SessionColumn{"answer_age", Type::float64, 1, offsetof(S, answerAge), "s",
                  "of that answer's position when it came; 0 where the device does not tell it", false},
    SessionColumn{"wanted", Type::float32, 3, offsetof(S, wanted), "N", "force on the hand before the governor", false},
    SessionColumn{"normal", Type::float32, 3, offsetof(S, normal), "1",
                  "of the surface at the proxy; zero without contact", false},
    SessionColumn{
        "orientation", Type::float32, 4, offsetof(S, orientation), "1",
        "of the grip in the scene, a unit quaternion x, y, z, w; that of the device's frame if it senses none", false},
    SessionColumn{"rigidity", Type::float32, 1, offsetof(S, rigidity), "N m", "D at the contact", false},
    SessionColumn{"compliance", Type::float32, 1, offsetof(S, compliance), "m/N", "c in use", false},
    SessionColumn{"stiffness", Type::float32, 1, offsetof(S, stiffness), "N/m",
                  "rendered: what cap and tank let through", false},
    SessionColumn{"w_max", Type::float32, 1, offsetof(S, maxDeflection), "m", "largest deflection of the plate", false},
    SessionColumn{"error_estimate", Type::float32, 1, offsetof(S, errorEstimate), "1",
                  "of the plate's solution, relative", false},
    SessionColumn{"patch_age", Type::float32, 1, offsetof(S, patchAge), "s", "of the plate's answer in use", false},
    SessionColumn{"tank_energy", Type::float32, 1, offsetof(S, tankEnergy), "J", "in the tank that pays for stiffness",
                  false},
    SessionColumn{"observer_energy", Type::float32, 1, offsetof(S, observerEnergy), "J",
                  "of the passivity observer: what the hand has put in and not got back", false},
    SessionColumn{"tick_time", Type::float32, 1, offsetof(S, tickTime), "s", "processor time of the tick", true},
    SessionColumn{"iterations", Type::int32, 1, offsetof(S, iterations), "1", "of the plate's solver", false},
    SessionColumn{"missed", Type::int32, 1, offsetof(S, missed), "1",
                  "exchanges with the device without an answer, in a row", false},
    SessionColumn{
        "faults", Type::uint32, 1, offsetof(S, faults), "1",
        "bits 0 to 7 why the governor stopped, 256 stale patch, 512 beyond the table, 1024 no patch yet, 2048 "
        "proxy limited, 4096 beyond plate theory, 8192 held back by the governor, 16384 the table is too old to feel",
        false},
    SessionColumn{"actions", Type::uint32, 1, offsetof(S, actions), "1",
                  "of the governor: 1 not homed, 2 outside of the box, 4 stale, 8 damped, 16 active, 32 clamped, 64 "
                  "slewed, 128 waiting, 256 engaging, 512 releasing, 1024 late, 2048 weight not carried whole, 4096 "
                  "let go before a stop, 8192 clutched, 16384 the place jumped",
                  false},
    SessionColumn{
        "device", Type::uint32, 1, offsetof(S, device), "1",
        "bits 0 to 7 its fault, 8 homed, 9 in its box, 10 the session lets go, 11 its clutch is held, 16 to 31 buttons",
        false},
    SessionColumn{"answers", Type::uint32, 1, offsetof(S, answers), "1", "of the device so far, modulo 2^32", false},
    SessionColumn{"grip", Type::float32, 1, offsetof(S, grip), "rad",
                  "angle by which the grip is open; 0 if the device senses none", false},
};

constexpr std::size_t kRowBytes = [] {
    std::size_t bytes = 0;
    for (const SessionColumn& column : kColumns) bytes += column.components * column.storedBytes();
    return bytes;
}();
static_assert([] { // every byte of a record belongs to a column
    std::size_t bytes = 0;
    for (const SessionColumn& column : kColumns) bytes += column.components * column.recordBytes();
    return bytes == sizeof(TickRecord);
}());

} // namespace

std::span<const SessionColumn> sessionColumns() noexcept
{
    return kColumns;
}

std::size_t tickRowBytes() noexcept
{
    return kRowBytes;
}

void packTick(const TickRecord& record, char* row) noexcept
{
    for (const SessionColumn& column : kColumns) {
        const char* const from = reinterpret_cast<const char*>(&record) + column.offset;
        if (column.type != Type::float32) {
            std::memcpy(row, from, column.components * column.storedBytes());
            row += column.components * column.storedBytes();
            continue;
        }
        for (std::size_t k = 0; k < column.components; ++k, row += sizeof(float)) {
            double value = 0;
            std::memcpy(&value, from + k * sizeof value, sizeof value);
            const auto rounded = static_cast<float>(value);
            std::memcpy(row, &rounded, sizeof rounded);
        }
    }
}

void unpackComponent(const SessionColumn& column, std::size_t component, const char* stored,
                     TickRecord& record) noexcept
{
    char* const to = reinterpret_cast<char*>(&record) + column.offset + component * column.recordBytes();
    if (column.type != Type::float32) {
        std::memcpy(to, stored, column.storedBytes());
        return;
    }
    float value = 0;
    std::memcpy(&value, stored, sizeof value);
    const double wide = value;
    std::memcpy(to, &wide, sizeof wide);
}

TickRecord asStored(const TickRecord& record) noexcept
{
    std::array<char, kRowBytes> row;
    packTick(record, row.data());
    TickRecord  stored;
    const char* from = row.data();
    for (const SessionColumn& column : kColumns)
        for (std::size_t k = 0; k < column.components; ++k, from += column.storedBytes())
            unpackComponent(column, k, from, stored);
    return stored;
}

} // namespace palp
