#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/body/body_mesh.h"
#include "engine/cloud/soft_object.h"

namespace palp {

/// How a whole object moves under a force of 1 N.
struct BodyMoves {
    std::vector<glm::dvec3> moved;    ///< displacement of each node [m/N]
    std::vector<glm::dvec3> turned;   ///< small turn of each node, about this vector [rad/N]
    double                  give = 0; ///< along the force where it acts; as coarse as the mesh [m/N]
};

/// A whole object as a coarse thin shell, clamped where it is held, for what lies beyond a patch window.
///
/// Flat triangles with six freedoms at each node: Felippa's membrane with drilling freedoms and the discrete Kirchhoff
/// plate. It takes some tenths of a second to make, and a press 7 ms.
/// \thread immutable, so free to share
class BodyShell {
public:
    static constexpr std::size_t kNodes = 4000; ///< about

    explicit BodyShell(const SoftObject& object, std::size_t most = kNodes);
    ~BodyShell();
    BodyShell(BodyShell&&) noexcept;
    BodyShell& operator=(BodyShell&&) noexcept;

    [[nodiscard]] const BodyMesh& mesh() const noexcept;

    /// Returns whether something holds any of it and its matrix has its factors, so that it can be pressed.
    [[nodiscard]] bool isHeld() const noexcept;

    /// Returns whether a node is of a piece that is held; the others do not move, and mean nothing.
    [[nodiscard]] bool isOnHeldPiece(std::size_t node) const noexcept;

    /// Presses with 1 N about a place, against `outward`.
    /// \param place    on the surface [m]
    /// \param outward  [1] unit
    /// \param radius   of the fingertip [m]; no less than what the mesh can show is taken
    /// \return  empty if no node of a held piece is near
    [[nodiscard]] std::optional<BodyMoves> under(const glm::dvec3& place, const glm::dvec3& outward,
                                                 double radius) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

/// Returns the coarse shell of an object, made at the first call and kept with it; null if the points determine no
/// surface, or those of a sheet's two faces, or nothing holds it.
/// \thread any; the first call takes some tenths of a second
[[nodiscard]] std::shared_ptr<const BodyShell> bodyShellOf(const SoftObject& object);

} // namespace palp
