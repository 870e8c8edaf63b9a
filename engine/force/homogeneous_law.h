#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/force/compliance_table.h"

namespace palp {

/// What each place of an object would feel like if the plate about it were as rigid everywhere as it is there on
/// average: the answer to a contact for which no table is there yet. No plate is solved for it while somebody touches.
/// \thread immutable; at() allocates, locks and throws nothing
class HomogeneousLaw {
public:
    /// What is known about a piece of the surface.
    struct Site {
        glm::dvec3 point{};                ///< [m]
        double     lnCompliance       = 0; ///< of c [m/N]
        double     lnContactStiffness = 0; ///< of k_c [N/m]
        double     stiffening         = 0; ///< b [1/m], if it varies
    };

    /// \param cell      [m] about the distance between sites; above zero
    /// \param stiffens  the sites say how the force stiffens
    HomogeneousLaw(std::vector<Site> sites, double cell, bool stiffens = false);

    /// Returns the mean of the sites within 1.5 cells, weighted by (1 - (distance / 1.5 cells)^2)^2; marked as clamped,
    /// since it is no table's. Empty if there are none.
    [[nodiscard]] std::optional<ComplianceTable::Values> at(const glm::dvec3& place) const noexcept;

private:
    using Key = std::uint64_t; ///< of a cube of one cell

    [[nodiscard]] Key keyOf(const glm::dvec3& place, int dx, int dy, int dz) const noexcept;

    double            cell_; ///< [m]
    bool              stiffens_;
    glm::dvec3        corner_{};
    std::vector<Site> sites_; ///< by their keys
    std::vector<Key>  keys_;  ///< of the sites, rising
};

} // namespace palp
