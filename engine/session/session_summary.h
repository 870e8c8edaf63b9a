#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "device/haptic_device.h"
#include "engine/force/governor.h"
#include "engine/session/duration_histogram.h"
#include "engine/session/tick_record.h"

namespace palp {

/// The summary of a session, for a report.
struct SessionSummary {
    std::uint64_t ticks = 0, contactTicks = 0;
    std::uint64_t patches = 0, failedPatches = 0;
    std::uint64_t staleTicks = 0, oldTable = 0, beyondTable = 0;
    std::uint64_t beyondTheory = 0, patchless = 0; ///< see SessionFlag
    std::uint64_t comingOn        = 0;             ///< ticks in contact with a share of the force; see ForceState
    double        mostForce       = 0;             ///< [N]
    double        mostWholeForce  = 0;             ///< [N] of ticks in contact with all of the force; 0: none felt any
    double        mostDepth       = 0;             ///< [m] of the hand below the proxy, along the normal
    double        leastCompliance = 0, mostCompliance = 0; ///< in use [m/N]; 0: never in contact
    GovernorFault fault = GovernorFault::none;             ///< the last
    /// The first, except while starting up; but one that ended the session.
    DeviceFault       deviceFault = DeviceFault::none;
    std::string       deviceWords;     ///< what the driver knows about the last one beyond its name; may be empty
    std::string       why;             ///< the last patch that failed; may be empty
    std::uint64_t     forceless = 0;   ///< ticks that pressed on the surface without a force
    TickRecord        lastForceless{}; ///< the last of them
    std::string       whyPatchless;    ///< the last patch that failed before the first that did not; may be empty
    DurationHistogram tick;            ///< computing a tick [s]
    DurationHistogram solve;           ///< computing a patch [s]
    DurationHistogram period;          ///< from tick to tick [s]; empty on a virtual clock

    /// Counts a record in.
    void add(const TickRecord& record) noexcept;

    /// Counts a patch in, or one that could not be solved.
    /// \param reason  of the failure, also of one that a second try mended; may be empty
    void addPatch(bool solved, const std::string& reason);

    /// Returns why the last tick without a force had none, as the end of a sentence; empty if all had one.
    [[nodiscard]] std::string whyForceless() const;
};

/// Receives each record of a session as it is made.
using OnTick = std::function<void(const TickRecord&)>;

} // namespace palp
