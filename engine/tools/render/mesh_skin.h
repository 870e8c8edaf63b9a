#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/soft_object.h"
#include "engine/tools/render/mesh_refine.h"
#include "engine/tools/render/patch_surface.h"

namespace palp {

/// The faces of an object whose points are scattered over a mesh, bent as the points are.
///
/// A touch moves points; each corner of a face follows those around it on its side of the surface, by a plane fitted to
/// their displacements, whose weights are made once. Large faces are halved until they can show a dent, and faces that
/// meet at an edge keep it.
class MeshSkin {
public:
    /// \param object  one with a mesh
    /// \param most    triangles up to which faces are halved
    explicit MeshSkin(const SoftObject& object, std::size_t most = kMostTriangles);

    /// Takes the points that a force moves, of one answer of the plate.
    void take(const PatchSurface& surface);

    /// Moves corners and turns normals, from rest.
    void bend(double force, double exaggeration);

    /// Takes the values of the points, above zero, of which some changed since the last call. Corners have the mean of
    /// their logarithms, no lower and no higher than the points around them.
    void paint(std::span<const double> points);

    /// Takes how far the surroundings of the points rise above them at rest.
    /// \param sides  normals to whose side they rise [1]
    void relieve(std::span<const double> relief, std::span<const glm::dvec3> sides);

    [[nodiscard]] std::span<const glm::dvec3> positions() const noexcept { return positions_; }     ///< [m]
    [[nodiscard]] std::span<const glm::dvec3> normals() const noexcept { return normals_; }         ///< [1]
    [[nodiscard]] std::span<const double>     deflections() const noexcept { return deflections_; } ///< [m]
    [[nodiscard]] std::span<const double>     hollows() const noexcept { return hollows_; }         ///< [1]
    [[nodiscard]] std::span<const double>     painted() const noexcept { return painted_; }         ///< see paint()
    [[nodiscard]] std::span<const double>     radii() const noexcept { return radii_; } ///< spacing of points [m]
    [[nodiscard]] std::span<const Triangle>   faces() const noexcept { return mesh_.faces; }

private:
    static constexpr std::size_t kMostTriangles = 1'000'000;

    /// A point that a corner follows.
    struct Follows {
        std::uint32_t point  = 0;
        float         weight = 0; ///< [1]; of all of a corner 1 together
    };
    void                                   bind(const SoftObject& object);
    void                                   invert(std::size_t points);
    [[nodiscard]] std::span<const Follows> followed(std::size_t corner) const noexcept
    {
        return std::span(follows_).subspan(first_[corner], first_[corner + 1] - first_[corner]);
    }
    template <class Value>
    [[nodiscard]] double       valueOf(std::size_t corner, Value&& value) const;
    std::vector<std::uint32_t> cornersNear(std::span<const std::uint32_t> points);
    void                       addSiblings(std::vector<std::uint32_t>& corners);
    void                       join(std::vector<double>& values) const;
    void                       findTurning();

    CreasedMesh                mesh_; ///< at rest
    Fans                       fans_;
    std::vector<std::uint32_t> first_;                       ///< for each corner where its points begin; one more
    std::vector<Follows>       follows_;                     ///< corner by corner
    std::vector<std::uint32_t> firstCorner_, cornersOf_;     ///< for each point the corners that follow it
    std::vector<std::uint8_t>  marked_;                      ///< of the corners; 0 between calls
    std::vector<glm::dvec3>    positions_, normals_;         ///< of the corners now [m], [1]
    std::vector<double>        deflections_, hollows_;       ///< [m], [1]
    std::vector<double>        relief_, painted_, radii_;    ///< [1], [Pa] or [N m], [m]
    std::vector<double>        logarithms_, paintedFrom_;    ///< of the points
    std::vector<double>        pointResponse_, pointHollow_; ///< of the points, 0 between calls [m/N], [1/N]

    std::vector<std::uint32_t> moving_;  ///< corners
    std::vector<std::uint32_t> turning_; ///< corners of the faces there
    std::vector<glm::dvec3>    flat_;    ///< of the turning corners: the mean normal of their faces at rest [1]
    std::vector<double>        responses_, dentHollows_; ///< of the moving corners [m/N], [1/N]
    glm::dvec3                 inward_{};                ///< [1]
};

} // namespace palp
