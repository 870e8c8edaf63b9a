#pragma once
#include <chrono>
#include <optional>

#include "engine/tools/gui/input.h"
#include "engine/tools/gui/notices.h"
#include "engine/tools/gui/pointer_hand.h"
#include "engine/tools/gui/stage.h"

namespace palp {

/// Touches with the pointer: Space holds the hand on the surface under it, and the wheel sets how deep.
/// Invariant: after letGo() nothing is pressed until Space is pressed anew.
/// \thread the window's
class PointerTouch {
public:
    /// Makes a hand that hovers over the stage's first place.
    /// \param stage  outlives this
    PointerTouch(const Stage& stage, Notices& notices);

    [[nodiscard]] PointerHand& hand() noexcept { return hand_; }

    enum class Outcome { touched, mustBeginAnew };
    /// Presses, moves or releases the hand as the input says.
    /// \param hit    place under the pointer
    /// \param depth  below the surface, which the wheel changes [m]
    /// \return mustBeginAnew if the object may lie between the hand and the place; the next session begins there
    [[nodiscard]] Outcome follow(const WindowInput& input, const std::optional<Hit>& hit, double& depth);

    void letGo();
    /// Declares the place that the hand is on, as the button of a device does.
    void declare();

    /// Moves the hand to the outside of the object, where a session begins.
    /// \pre no session runs
    void begin();

private:
    using Clock = std::chrono::steady_clock;

    const Stage&       stage_;
    Notices&           notices_;
    PointerHand        hand_;
    std::optional<Hit> beginAt_;               ///< of the next session; empty: where the hand is
    bool               awaitsRelease_ = false; ///< of Space
    Clock::time_point  declared_{};
};

} // namespace palp
