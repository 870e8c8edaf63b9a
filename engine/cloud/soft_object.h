#pragma once
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "engine/cloud/extent.h"
#include "engine/cloud/material.h"
#include "engine/cloud/neighbour_index.h"
#include "engine/cloud/point_cloud.h"
#include "engine/cloud/surface_survey.h"
#include "engine/cloud/triangle.h"

namespace palp {

class CoarseObject;
struct BodyNote;
struct CurvatureNotes;
class SurfaceLinks;

/// A touched object: points with a stiffness, the index over them, perhaps a mesh, and the material of the sheet.
///
/// Nothing of it changes while it is touched; a touch returns its deformation as a field beside the object. Copies,
/// repainted(), withMaterial(), withFoundation(), withStiffening() and withHeld() share positions, index, survey, faces
/// and mesh: of a million points only the stiffness is copied.
/// It may be moved and copied freely, because the index holds its own copy of the positions.
/// \thread immutable, so free to share
class SoftObject {
public:
    /// Builds the index and surveys the surface: about a second of one core for a million points, on all cores.
    /// \param faces    of the cloud's points; none: the object is a cloud without a mesh
    /// \param normals  outward, one for each point, 0 where none is known; none: those of the faces, if there are any
    explicit SoftObject(PointCloud cloud, const Material& material = {}, std::vector<Triangle> faces = {},
                        std::span<const glm::vec3> normals = {});

    /// Returns the same points with other stiffnesses of the same kind [Pa] or [N m].
    /// \throws Error as PointCloud does
    [[nodiscard]] SoftObject repainted(std::vector<double> stiffness) const;

    /// Returns the same points, which stand for a mesh: pictures draw its faces in place of the points.
    [[nodiscard]] SoftObject standingFor(SurfaceMesh mesh) const;

    /// Returns the same points, of another thickness or Poisson's ratio.
    [[nodiscard]] SoftObject withMaterial(const Material& material) const;

    /// Returns the same points on a foundation that varies.
    /// \param shape  for each point the foundation below it over that of the scene [1], > 0; empty: 1 everywhere
    [[nodiscard]] SoftObject withFoundation(std::vector<double> shape) const;

    /// Returns the same points, each of which stiffens with depth in its own way.
    /// \param b  [1/m] of each point, 0 to kMostStiffening, see DepthLaw; empty: the material's everywhere
    [[nodiscard]] SoftObject withStiffening(std::vector<double> b) const;

    /// Returns the same points, some of which something holds where they are.
    /// \param share  of each point that is held, 0 to 1; empty: none is
    [[nodiscard]] SoftObject withHeld(std::vector<double> share) const;

    [[nodiscard]] const PointCloud&         cloud() const noexcept { return cloud_; }
    [[nodiscard]] const NeighbourIndex&     index() const noexcept { return *index_; }
    [[nodiscard]] const SurfaceSurvey&      survey() const noexcept { return *survey_; }
    [[nodiscard]] std::span<const Triangle> faces() const noexcept { return *faces_; } ///< may be empty
    [[nodiscard]] const SurfaceMesh& mesh() const noexcept { return *mesh_; } ///< see standingFor(); may be empty
    [[nodiscard]] const Material&    material() const noexcept { return material_; }

    [[nodiscard]] std::size_t                 size() const noexcept { return cloud_.size(); } ///< number of points
    [[nodiscard]] std::span<const glm::dvec3> positions() const noexcept { return cloud_.positions(); } ///< [m]
    [[nodiscard]] double                      spacing() const noexcept { return index_->spacing(); }    ///< [m]

    [[nodiscard]] const Extent& extent() const noexcept { return extent_; }

    /// Returns the object by one point per cube of about this side [m], which is made at the first call; see
    /// CoarseObject.
    /// \thread any; the first call for a side takes up to a second for millions of points
    [[nodiscard]] std::shared_ptr<const CoarseObject> coarse(double side) const;

    /// Returns what is known of the curvature of the surface, to be read and added to by whoever fits it; all objects
    /// of the same points and thickness share it.
    [[nodiscard]] CurvatureNotes& curvatureNotes() const noexcept { return *curvatureNotes_; }

    /// Returns which points a step along the surface leads to, to be found by whoever floods it; all objects of the
    /// same points share it.
    [[nodiscard]] SurfaceLinks& links() const noexcept { return *links_; }

    /// Returns the place of what bodyShellOf() makes of the object.
    [[nodiscard]] BodyNote& bodyNote() const noexcept { return *bodyNote_; }

    /// Returns what withFoundation() took [1]; empty: the foundation is the same everywhere.
    [[nodiscard]] std::span<const double> foundationShape() const noexcept { return *foundationShape_; }

    /// Returns what withStiffening() took [1/m]; empty: material() says it.
    [[nodiscard]] std::span<const double> stiffening() const noexcept { return *stiffening_; }

    /// Returns what withHeld() took [1]; empty: nothing is held.
    [[nodiscard]] std::span<const double> held() const noexcept { return *held_; }

    /// Returns the flexural rigidity D at a point [N m].
    [[nodiscard]] double rigidity(std::size_t point) const noexcept { return cloud_.rigidity(point, material_); }

private:
    /// A coarse object that was made.
    struct Coarse {
        std::shared_ptr<const CoarseObject> object;     ///< of these points
        bool                                own = true; ///< of this stiffness and material too
    };
    struct CoarseObjects {
        std::mutex          mutex;
        std::vector<Coarse> made; ///< a few, one for each side that was asked for
    };

    [[nodiscard]] std::shared_ptr<CoarseObjects> coarseShapes() const;

    PointCloud                                   cloud_;
    Extent                                       extent_;
    std::shared_ptr<const NeighbourIndex>        index_;           ///< never null
    std::shared_ptr<const std::vector<Triangle>> faces_;           ///< never null
    std::shared_ptr<const SurfaceMesh>           mesh_;            ///< never null
    std::shared_ptr<const SurfaceSurvey>         survey_;          ///< never null
    std::shared_ptr<SurfaceLinks>                links_;           ///< never null
    std::shared_ptr<CurvatureNotes>              curvatureNotes_;  ///< never null
    std::shared_ptr<BodyNote>                    bodyNote_;        ///< never null
    std::shared_ptr<const std::vector<double>>   foundationShape_; ///< never null
    std::shared_ptr<const std::vector<double>>   stiffening_;      ///< [1/m] never null
    std::shared_ptr<const std::vector<double>>   held_;            ///< never null
    Material                                     material_;
    std::shared_ptr<CoarseObjects>               coarse_ = std::make_shared<CoarseObjects>(); ///< never null
};

} // namespace palp
