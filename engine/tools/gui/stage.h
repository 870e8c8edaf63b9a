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

/// What lies before the user: an object, its picture, its paint, and the plate that bends it. \thread the window's, but
/// for solver()
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

    /// Other values for the same object: no file is read again, and its paint stays.
    /// \pre no session runs
    /// \throws Error, and nothing has changed
    void change(const Scene& scene);

    [[nodiscard]] const StiffnessPainting& painting() const noexcept { return painting_; }
    [[nodiscard]] const SoftObject&        painted() const noexcept { return *painted_; } ///< as it is now

    /// Returns where the object lies under a pointer. \param at  in a picture of that size [px]
    [[nodiscard]] std::optional<Hit> hitAt(const Camera& camera, const glm::dvec2& at, const glm::dvec2& size) const;

    /// A dab of a brush, or whatever else changes the stiffness: shown at once and felt with the next patch.
    template <class Change>
    void paint(Change change)
    {
        change(painting_);
        takePaint();
    }

    /// For the deformation's thread: with the newest paint. Must not outlive this.
    [[nodiscard]] PatchSolver solver();

private:
    void takePaint();

    Scene             scene_;
    LoadedObject      loaded_;
    TouchView         view_;
    StiffnessPainting painting_;
    HandPlace         place_;

    std::shared_ptr<const SoftObject>         painted_; ///< of the window's thread
    Latest<std::shared_ptr<const SoftObject>> fresh_;   ///< to the deformation's
    std::shared_ptr<const SoftObject>         solved_;  ///< of the deformation's
    std::unique_ptr<Deformation>              deformation_;
    std::string                               solvedOn_;
};

/// The scene's hand place; where that is off the object, the point of the object that lies uppermost.
[[nodiscard]] HandPlace startPlace(const Scene& scene, const SoftObject& object);

} // namespace palp
