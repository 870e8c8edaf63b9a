#include "engine/tools/gui/touch_faults.h"

#include "engine/session/force_state.h"
#include "engine/session/servo.h"

namespace palp {

FaultAdvice adviceOn(GovernorFault fault) noexcept
{
    switch (fault) {
    case GovernorFault::none:
        break;
    case GovernorFault::forceNotFinite:
        return {"The computed force was not a finite number.",
                "Start anew; if it recurs, choose a thicker or softer sheet, and report the scene."};
    case GovernorFault::positionNotFinite:
        return {"The device reported a place that is not a finite number.", "Reconnect the device, then start anew."};
    case GovernorFault::velocityNotFinite:
        return {"The device reported a speed that is not a finite number.", "Reconnect the device, then start anew."};
    case GovernorFault::clockNotFinite:
        return {"The clock of the servo gave no finite time.", "Start anew; if it recurs, reboot."};
    case GovernorFault::clockStopped:
        return {"The clock of the servo stood still.", "Start anew; if it recurs, reboot."};
    case GovernorFault::loopStalled:
        return {
            "The servo stood still for more than 0.1 s.",
            "Close programs that keep the processor busy, then start anew; palpate doctor shows how to get real time."};
    case GovernorFault::deviceLost:
        return {"The device did not answer for 20 exchanges.", "Check its cable and its power, then start anew."};
    case GovernorFault::tooFast:
        return {"The hand moved faster than 1.2 m/s.", "Hold it still, then start anew."};
    }
    return {"", ""};
}

GovernorFault governorFault(const TickRecord& record) noexcept
{
    return static_cast<GovernorFault>(record.faults & 0xFFU);
}

std::vector<std::string> notesOn(const TickRecord& record, std::string_view words)
{
    struct Note {
        SessionFlag flag;
        const char* text;
    };
    static constexpr Note kNotes[] = {
        {SessionFlag::noPatch, "The plate has no answer yet, so there is no force: wait, or choose fewer cells."},
        {SessionFlag::oldTable,
         "The plate has not answered for a quarter of a second, so the force is off: lift the hand, or choose fewer "
         "cells."},
        {SessionFlag::beyondTheory,
         "The dent is deeper than half the thickness, or twice it with large on, where theory ends: press less."},
        {SessionFlag::beyondTable,
         "The contact is beyond the table of compliances: move more slowly, or raise the rate."},
        {SessionFlag::proxyLimited, "The proxy ran out of iterations: move more slowly."},
    };
    std::vector<std::string> notes;
    switch (forceState(record)) {
    case ForceState::flows:
    case ForceState::stopped:     // which has its advice
    case ForceState::plateSilent: // a note below says more
        break;
    default:
        notes.push_back(describeForces(record, words));
    }
    for (const Note& note : kNotes)
        if (record.faults & static_cast<std::uint32_t>(note.flag)) notes.emplace_back(note.text);
    return notes;
}

bool needsAttention(const PanelContent& content) noexcept
{
    return !content.faults.empty() || governorFault(content.history.newest()) != GovernorFault::none;
}

} // namespace palp
