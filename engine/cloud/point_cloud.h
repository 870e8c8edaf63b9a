#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/material.h"
#include "engine/core/quantity.h"

namespace palp {

/// The quantity that the stiffness of a cloud's points is.
enum class StiffnessKind {
    modulus,  ///< Young's modulus E [Pa]
    rigidity, ///< flexural rigidity D [N m]
    felt      ///< what a probe has measured, force per depth [N/m]: a map, and no object until it is fitted
};
inline constexpr std::array kStiffnessKinds{StiffnessKind::modulus, StiffnessKind::rigidity, StiffnessKind::felt};

/// Returns the unit in which files and reports state a stiffness: "Pa", "N_m" or "N/m".
[[nodiscard]] const char* unitOf(StiffnessKind kind) noexcept;
/// Returns the property that files have for it: "stiffness", "flexural_rigidity" or "felt_stiffness".
[[nodiscard]] const char* propertyOf(StiffnessKind kind) noexcept;
/// Returns what a number with a unit is as such a stiffness.
[[nodiscard]] Dimension dimensionOf(StiffnessKind kind) noexcept;

struct Bounds {
    glm::dvec3 low{};  ///< [m]
    glm::dvec3 high{}; ///< [m]

    [[nodiscard]] glm::dvec3 centre() const noexcept { return 0.5 * (low + high); } ///< [m]
    [[nodiscard]] double     diagonal() const noexcept;                             ///< [m]
};

/// Largest coordinate [m]: no hand feels larger objects, and squared distances overflow 32-bit floats from 1e19 m on.
inline constexpr double kLargestCoordinate = 1e9;

/// Points at rest and a stiffness for each.
///
/// Invariant: at least one point, as many stiffnesses as positions, no coordinate beyond kLargestCoordinate, every
/// stiffness finite and > 0.
/// Never changed after construction: deformation is a field beside the cloud.
/// \thread immutable, so free to share
/// \differs the paper's d_i is "stiffness" without a unit; here the cloud says whether it is E [Pa] or D [N m]
class PointCloud {
public:
    /// \param positions  rest positions [m]
    /// \param stiffness  [Pa], [N m] or [N/m], as `kind` says
    /// \throws Error naming the first point that breaks the invariant
    PointCloud(std::vector<glm::dvec3> positions, std::vector<double> stiffness, StiffnessKind kind);

    /// Makes a cloud of the same points, which both then share, with other stiffnesses of the same kind: a quarter of
    /// the memory is new.
    /// \throws Error as above
    PointCloud(const PointCloud& points, std::vector<double> stiffness);

    [[nodiscard]] std::size_t                 size() const noexcept { return stiffness_.size(); }
    [[nodiscard]] std::span<const glm::dvec3> positions() const noexcept { return *positions_; } ///< [m]
    [[nodiscard]] std::span<const double>     stiffness() const noexcept { return stiffness_; }  ///< as kind() says
    [[nodiscard]] StiffnessKind               kind() const noexcept { return kind_; }
    [[nodiscard]] const Bounds&               bounds() const noexcept { return bounds_; }

    // Of what was felt they are NaN: that depends on the neighbours, see palpate fit.
    [[nodiscard]] double rigidity(std::size_t point, const Material&) const noexcept; ///< [N m]
    [[nodiscard]] double modulus(std::size_t point, const Material&) const noexcept;  ///< [Pa]

private:
    void checkStiffness() const;

    std::shared_ptr<const std::vector<glm::dvec3>> positions_; ///< never null
    std::vector<double>                            stiffness_;
    StiffnessKind                                  kind_;
    Bounds                                         bounds_;
};

} // namespace palp
