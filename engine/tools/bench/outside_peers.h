#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/tools/bench/direct_solver.h"

namespace palp::bench {

/// A k-d tree over points in space.
class RadiusSearch {
public:
    virtual ~RadiusSearch() = default;

    /// Replaces `found` by the points within radius [m], with their squared distances [m^2], in any order.
    virtual void gather(const glm::dvec3& centre, double radius,
                        std::vector<std::pair<std::uint32_t, float>>& found) const = 0;
    /// Fills `found` with the nearest points, as many as it holds.
    virtual void nearest(const glm::dvec3& centre, std::span<std::uint32_t> found) const = 0;
};

/// Libraries that people would use instead of Palpate and that Palpate itself does not need. A library that was not
/// found is an empty function, and `...Note` says what to install.
///
/// There are two definitions of outsidePeers(). The one that `palpate` is linked with has none of them. The one of
/// `palpate_peers`, which is never installed, has those that CMake found. See third_party_notes.md on licences.
struct OutsidePeers {
    std::function<std::unique_ptr<DirectSolver>(const PlateMatrix&)> cholmod;
    std::string                                                      cholmodNote; ///< if found, version and BLAS

    std::function<std::unique_ptr<RadiusSearch>(std::span<const glm::dvec3>, std::size_t leaf)> radiusSearch;
    /// Does the work of palp::nearestPoint() from the bare points, by a tree in the plane.
    std::function<std::vector<std::uint32_t>(const PlateGrid&, const ChartPoint& origin, std::span<const ChartPoint>,
                                             std::size_t leaf)>
                nearestMap;
    std::string nanoflannNote;
};

[[nodiscard]] const OutsidePeers& outsidePeers();

} // namespace palp::bench
