#pragma once
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "engine/core/enum_names.h"
#include "engine/pipeline/patch.h"
#include "engine/tools/render/camera.h"
#include "engine/tools/render/cloud_skin.h"
#include "engine/tools/render/mesh_skin.h"
#include "engine/tools/render/patch_surface.h"
#include "engine/tools/render/view_scene.h"

namespace palp {

enum class ViewPaint {
    deflection, ///< into the surface [m]
    stiffness,  ///< the cloud's own, modulus or rigidity
    plain       ///< one colour
};
constexpr auto namesOf(ViewPaint)
{
    using enum ViewPaint;
    return std::to_array<NamedValue<ViewPaint>>(
        {{deflection, "deflection"}, {stiffness, "stiffness"}, {plain, "plain"}});
}

/// The additional marks of a touch.
struct Overlays {
    bool outline   = true;  ///< of the patch
    bool arrows    = true;  ///< force and normal
    bool markers   = true;  ///< proxy, HIP and stylus
    bool ghost     = false; ///< dots where the dent's points are at rest
    bool sphere    = false; ///< the near half of the fitted sphere
    bool projected = false; ///< dots where the patch's points lie on that sphere
    bool curvature = false; ///< crosses along the principal curvatures that a shell bent with
};

/// The look of a touch.
struct TouchLook {
    ViewPaint paint        = ViewPaint::deflection;
    ColourMap map          = ColourMap::viridis;
    Ground    ground       = Ground::light;
    double    exaggeration = 1; ///< factor on every displacement [1]
    double    deepest      = 0; ///< end of the colours of deflections [m]; 0: this touch's own
    double    strongest    = 0; ///< force whose arrow has the full length [N]; 0: this touch's own
    Overlays  overlays{};
};

/// The places of hand and proxy, instead of those of a hand at rest.
struct TouchHand {
    glm::dvec3                hip{};   ///< [m]
    glm::dvec3                force{}; ///< on the hand [N]
    std::optional<glm::dvec3> proxy{}; ///< on the surface at rest [m]; empty: where the patch's contact is
    /// How the grip is turned, as TickRecord::orientation: at none the stylus points along z. Empty: it is not sensed.
    std::optional<glm::dquat> turn{};
};

/// A cloud and a touch of it as a scene to draw; of a cloud that stands for a mesh, the mesh.
class TouchView {
public:
    /// \param object    outlives the view
    /// \param settings  of the touches: shapes measure a share of their window and fingertip
    /// \throws as CloudSkin
    TouchView(const SoftObject& object, const PatchSettings& settings);

    /// Takes other stiffnesses of the same points from now on.
    /// \param stiffness  outlives their use [Pa] or [N m]
    void repaint(std::span<const double> stiffness) { stiffness_ = stiffness; }

    /// Makes the scene of the cloud under a force, or at rest without a patch.
    /// \param patch  of the cloud, deformed; may be null
    /// \param force  that presses [N]
    /// \param hand   empty: at rest, where the load is that of the hand's depth
    /// \param load   [N] that makes the dent, see Press; empty: the force
    void show(const Patch* patch, double force, const TouchLook& look, const std::optional<TouchHand>& hand = {},
              std::optional<double> load = {});

    /// Takes other settings of the same cloud from now on.
    void use(const PatchSettings& settings);

    /// Returns the normals at rest; those of closed objects point outwards [1].
    [[nodiscard]] std::span<const glm::dvec3> restNormals() const noexcept { return restNormals_; }
    [[nodiscard]] std::span<const double>     radii() const noexcept { return skin_.cores(); } ///< of closed discs [m]

    /// Returns the scene, valid until the next show(); the caller sets title and note.
    [[nodiscard]] ViewScene& scene() noexcept { return scene_; }

private:
    /// The values that identify the patch that was shown last.
    struct Shown {
        glm::dvec3  contact{};      ///< [m]
        double      compliance = 0; ///< [m/N]
        std::size_t points     = 0; ///< 0: none was shown
    };
    void findRelief();
    void take(const Patch* patch);
    void bend(double load, double exaggeration);
    void paint(double load, const TouchLook& look);
    void drawMesh(const TouchLook& look);
    /// A force and the load that dents as deep.
    struct Pressed {
        double force = 0, load = 0; ///< [N]
    };
    void addHand(const Patch& patch, Pressed by, const TouchLook& look, const std::optional<TouchHand>& hand);
    void addStylus(const std::optional<TouchHand>& hand);
    void addOutline(double load, double exaggeration);
    void addFit(const Patch& patch, const Overlays& overlays);
    void addGhost(Ground ground);

    const SoftObject&         object_;
    double                    bent_;      ///< width of what bends under a touch [m]
    double                    fingertip_; ///< its radius [m]
    CloudSkin                 skin_;
    std::vector<glm::dvec3>   restNormals_; // [1]
    std::vector<std::uint8_t> oneSided_;
    std::vector<glm::dvec3>   normals_, positions_;   // [1], [m]
    std::vector<double>       relief_;                // at rest [1]
    std::vector<double>       deflections_, hollows_; // [m], [1]
    std::span<const double>   stiffness_;             // [Pa] or [N m]

    Shown                      shown_;
    PatchSurface               surface_; // of that patch
    std::optional<MeshSkin>    mesh_;    // of an object that stands for one
    std::vector<std::uint32_t> moved_;   // points that are not at rest in positions_
    ViewScene                  scene_;
};

/// Looks obliquely at the contact from outside so that the dent shows its depth; the patch fills the picture.
[[nodiscard]] Camera cameraAt(const Patch& patch, double aspect);

/// Returns a round force that dents the patch by about a third of a thickness: deep enough to be seen, within theory.
/// [N]
[[nodiscard]] double forceThatShows(const Patch& patch, double thickness);

} // namespace palp
