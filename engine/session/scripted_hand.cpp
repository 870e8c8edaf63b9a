#include "engine/session/scripted_hand.h"

#include <limits>

namespace palp {

ScriptedHand::ScriptedHand(const HandPath& hand) : hand_(hand)
{
    info_.model           = "scripted hand";
    info_.workspaceRadius = std::numeric_limits<double>::infinity();
    info_.isSimulation    = true;
    info_.rotates         = hand.turns();
}

HapticState ScriptedHand::read(double now) noexcept
{
    HapticState state;
    state.time     = now;
    state.sequence = ++sequence_;
    state.position = hand_.position(hand_.begin() + now);
    motion_.add(now, state.position);
    state.velocity    = motion_.velocity();
    state.buttons     = hand_.buttons(hand_.begin() + now);
    state.orientation = hand_.orientation(hand_.begin() + now);
    state.homed = state.inBox = true;
    state.fault               = DeviceFault::none;
    return state;
}

} // namespace palp
