#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// The record of one tick of the servo.
struct TickRecord {
    double        time = 0;                ///< [s] since the session's start
    glm::dvec3    hip{};                   ///< [m] where the hand is
    glm::dvec3    hipVelocity{};           ///< [m/s] filtered, as the device reports
    glm::dvec3    proxy{};                 ///< [m] where the tool is held
    glm::dvec3    force{};                 ///< [N] on the hand, after the governor
    double        answerTime = 0;          ///< [s] of the session, when the device's newest answer came
    double        answerAge  = 0;          ///< [s] of its position at that time; 0 where the device does not tell it
    glm::dvec3    wanted{};                ///< [N] on the hand, before the governor
    glm::dvec3    normal{};                ///< [1] of the surface at the proxy; zero without contact
    glm::dquat    orientation{1, 0, 0, 0}; ///< of the grip, a unit quaternion; the device's own if it senses none
    double        rigidity       = 0;      ///< D at the contact [N m]
    double        compliance     = 0;      ///< c in use [m/N]
    double        stiffness      = 0;      ///< rendered: what the tank let through [N/m]
    double        maxDeflection  = 0;      ///< [m]
    double        errorEstimate  = 0;      ///< of the plate's solution, relative [1]
    double        patchAge       = 0;      ///< of the plate's answer in use [s]
    double        tankEnergy     = 0;      ///< [J] in the tank
    double        observerEnergy = 0;      ///< [J] E of the passivity observer
    double        tickTime       = 0;      ///< processor time of the tick [s]
    std::int32_t  iterations     = 0;      ///< of the plate's solver
    std::int32_t  missed         = 0;      ///< exchanges with the device without an answer, in a row
    std::uint32_t faults         = 0;      ///< one bit each, see SessionFlag; the low eight are the GovernorFault
    std::uint32_t actions        = 0;      ///< one bit each, see GovernorAction
    std::uint32_t device  = 0; ///< bits 0 to 7 the DeviceFault, 8 homed, 9 in its box, 11 clutched, 16 to 31 buttons
    std::uint32_t answers = 0; ///< of the device so far, modulo 2^32
    double        grip    = 0; ///< [rad] by which the grip is open; 0 if the device senses none
};
static_assert(std::is_trivially_copyable_v<TickRecord>);
static_assert(sizeof(TickRecord) == 34 * 8 + 24 + 8, "no padding: records are compared byte for byte");

/// One field of a record: of a row of ticks.npy and of a streamed datagram, and columns of an exported table.
struct SessionColumn {
    /// How it is stored. float32 is a double in the record: diagnostics, which no replay reads.
    enum class Type { float64, float32, int32, uint32 };

    std::string_view name;
    Type             type;
    std::size_t      components; ///< 1, 3 or 4
    std::size_t      offset;     ///< in TickRecord [bytes]
    std::string_view unit;
    std::string_view means;
    bool             measured; ///< by the wall clock: it differs from run to run, so replays do not compare it

    /// Return the size of a component [bytes]: as stored, and in a TickRecord.
    [[nodiscard]] constexpr std::size_t storedBytes() const noexcept { return type == Type::float64 ? 8 : 4; }
    [[nodiscard]] constexpr std::size_t recordBytes() const noexcept
    {
        return type == Type::float64 || type == Type::float32 ? 8 : 4;
    }
    /// Returns the type as numpy spells it, little endian.
    [[nodiscard]] std::string_view numpyType() const noexcept
    {
        switch (type) {
        case Type::float64:
            return "<f8";
        case Type::float32:
            return "<f4";
        case Type::int32:
            return "<i4";
        case Type::uint32:
            return "<u4";
        }
        return {};
    }
    /// Returns the name of a component: "force_z", or the column's own if there is only one.
    [[nodiscard]] std::string componentName(std::size_t component) const
    {
        return std::string(name) + (components > 1 ? std::string("_") + "xyzw"[component] : std::string());
    }
};

/// Lists all columns, in the order in which they are stored; together they are all of a record.
[[nodiscard]] std::span<const SessionColumn> sessionColumns() noexcept;

/// The size of a stored record, a row [bytes].
[[nodiscard]] std::size_t tickRowBytes() noexcept;

/// Stores a record as a row: its columns one after the other, without gaps, little endian.
/// \param row  tickRowBytes() bytes
void packTick(const TickRecord& record, char* row) noexcept;

/// Reads a stored component into its record.
/// \param stored  storedBytes() bytes
void unpackComponent(const SessionColumn& column, std::size_t component, const char* stored,
                     TickRecord& record) noexcept;

/// Returns the record that comes back when this one is stored: columns of type float32 are rounded.
[[nodiscard]] TickRecord asStored(const TickRecord& record) noexcept;

} // namespace palp
