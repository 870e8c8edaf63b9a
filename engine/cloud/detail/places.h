#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Numbers the different places among positions by their first occurrence.
/// \return  the place of each position; empty if all differ
[[nodiscard]] std::vector<std::uint32_t> placesOf(std::span<const glm::dvec3> positions);

} // namespace palp
