#pragma once
#include <memory>
#include <string>

#include "engine/cloud/stiffness_painting.h"
#include "engine/core/latest.h"
#include "engine/session/deformation.h"
#include "engine/session/hand_path.h"
#include "engine/tools/gui/pick.h"
#include "engine/tools/render/touch_view.h"

namespace palp {

/// The object before the user, its picture, its paint, and the plate that bends it.
/// \thread the window's, except for solver()
class Stage {
public:
    /// \throws Error as loadObject(), Deformation and CloudSkin do
    explicit Stage(const Scene& scene);
    Stage(const Stage&)            = delete;
    Stage& operator=(const Stage&) = delete;

    [[nodiscard]] const Scene&           scene() const noexcept { return scene_; }
    [[nodiscard]] const SoftObject&      object() const noexcept { return loaded_.object; } ///< as it was loaded
    [[nodiscard]] const CloudFileReport& report() const noexcept { return loaded_.report; }
    [[nodiscard]] TouchView&             view() noexcept { return view_; }
    [[nodiscard]] const HandPlace&       place() const noexcept { return place_; } ///< where the hand starts
    [[nodiscard]] const std::string&     solvedOn() const noexcept { return solvedOn_; }

    /// Takes other values for the same object: no file is read again, and its paint stays.
    /// \pre no session runs
    /// \throws Error for values that cannot be used; then nothing has changed
    void change(const Scene& scene);

    [[nodiscard]] const StiffnessPainting& painting() const noexcept { return painting_; }
    [[nodiscard]] const SoftObject&        painted() const noexcept { return *painted_; } ///< as it is now

    /// Returns the place of the object under a pointer.
    /// \param at  in a picture of that size [px]
    [[nodiscard]] std::optional<Hit> hitAt(const Camera& camera, const glm::dvec2& at, const glm::dvec2& size) const;

    /// Applies a dab of a brush, or another change of the stiffness: shown at once and felt with the next patch.
    template <class Change>
    void paint(Change change)
    {
        change(painting_);
        takePaint();
    }

    /// Returns what answers until the first table, of the paint as it is now. It must not outlive this.
    /// \pre no session runs
    [[nodiscard]] const HomogeneousLaw* firstLaw();

    /// Returns the solver for the deformation's thread, with the newest paint. It must not outlive this.
    [[nodiscard]] PatchSolver solver();

private:
    void takePaint();
    void solveFresh();

    Scene             scene_;
    LoadedObject      loaded_;
    TouchView         view_;
    StiffnessPainting painting_;
    HandPlace         place_;

    std::shared_ptr<const SoftObject>         painted_; ///< of the window's thread
    Latest<std::shared_ptr<const SoftObject>> fresh_;   ///< to the deformation's
    std::shared_ptr<const SoftObject>         solved_;  ///< of the deformation's
    std::unique_ptr<Deformation>              deformation_;
    bool                                      lawIsOld_ = false; ///< painted since its first law
    std::string                               solvedOn_;
};

/// Returns the scene's hand place, or the object's uppermost point if that place is off the object.
[[nodiscard]] HandPlace startPlace(const Scene& scene, const SoftObject& object);

} // namespace palp
