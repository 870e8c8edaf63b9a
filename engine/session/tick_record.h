#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include <glm/vec3.hpp>

namespace palp {

/// The record of one tick of the servo.
struct TickRecord {
    double        time = 0;          ///< [s] since the session's start
    glm::dvec3    hip{};             ///< [m] where the hand is
    glm::dvec3    hipVelocity{};     ///< [m/s] filtered, as the device reports
    glm::dvec3    proxy{};           ///< [m] where the tool is held
    glm::dvec3    force{};           ///< [N] on the hand, after the governor
    glm::dvec3    normal{};          ///< [1] of the surface at the proxy; zero without contact
    double        rigidity      = 0; ///< D at the contact [N m]
    double        compliance    = 0; ///< c in use [m/N]
    double        maxDeflection = 0; ///< [m]
    double        errorEstimate = 0; ///< of the plate's solution, relative [1]
    double        patchAge      = 0; ///< of the plate's answer in use [s]
    double        tickTime      = 0; ///< processor time of the tick [s]
    std::int32_t  iterations    = 0; ///< of the plate's solver
    std::uint32_t faults        = 0; ///< one bit each, see SessionFlag; the low eight are the GovernorFault
    std::uint32_t device        = 0; ///< bits 0 to 7 the DeviceFault, 8 homed, 9 in its box, 16 to 31 buttons
    std::int32_t  missed        = 0; ///< exchanges with the device without an answer, in a row
};
static_assert(std::is_trivially_copyable_v<TickRecord>);
static_assert(sizeof(TickRecord) == 22 * 8 + 16, "no padding: records are compared byte for byte");

/// One field of a record as a file: NAME.npy of shape (n,) or (n, components), and as columns of samples.csv.
struct SessionColumn {
    enum class Type { float64, int32, uint32 };

    std::string_view name;
    Type             type;
    std::size_t      components; ///< 1 or 3
    std::size_t      offset;     ///< in TickRecord [bytes]
    std::string_view unit;
    std::string_view means;
    bool             measured; ///< by the wall clock: it differs from run to run, so replays do not compare it

    [[nodiscard]] std::size_t bytes() const noexcept { return components * (type == Type::float64 ? 8 : 4); }
    /// Returns the type as numpy spells it, little endian.
    [[nodiscard]] std::string_view numpyType() const noexcept
    {
        return type == Type::float64 ? "<f8" : type == Type::int32 ? "<i4" : "<u4";
    }
};

/// Lists all columns; together they are all of a record.
[[nodiscard]] std::span<const SessionColumn> sessionColumns() noexcept;

} // namespace palp
