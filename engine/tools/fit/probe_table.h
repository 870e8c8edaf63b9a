#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace palp::fit {

/// One press of a probe: force over depth, and over time if that was measured.
///
/// Invariant of what readProbes() returns: at least kFewestRows rows, everything finite, depths of 0 or more that do
/// not fall (without times) or times that rise, and a largest force that pushes.
struct Probe {
    std::string               name;
    std::optional<glm::dvec3> place;  ///< [m]
    std::optional<glm::dvec3> normal; ///< outward, of any length [1]
    std::vector<double>       depth;  ///< from the touch into the object [m]
    std::vector<double>       force;  ///< that pushes into it [N]
    std::vector<double>       time;   ///< [s]; empty: not measured

    [[nodiscard]] double deepest() const noexcept;
    [[nodiscard]] double forceRange() const noexcept; ///< largest less smallest force [N]
};

inline constexpr std::size_t kFewestRows = 5; ///< of a probe: two parameters, and something to judge them by

/// Returns whether the file has a header line with the columns depth and force.
[[nodiscard]] bool holdsProbes(const std::filesystem::path& file);

/// Reads probes: lines of numbers with commas below a header line that names the columns. It has `depth` and `force`,
/// and may have `probe` (a name: its rows are one probe; without it all rows are one), `time`, the place `x`, `y`, `z`
/// and the normal `nx`, `ny`, `nz`. A unit follows in brackets, as in "depth [mm]"; without one it is m, N or s. Other
/// columns are not read, and lines that begin with # are comments.
/// \throws Error naming the file, the line, what was expected and found, and what to try
[[nodiscard]] std::vector<Probe> readProbes(const std::filesystem::path& file);

/// Does the same from a text; `name` stands in messages.
[[nodiscard]] std::vector<Probe> parseProbes(std::string_view text, const std::string& name);

} // namespace palp::fit
