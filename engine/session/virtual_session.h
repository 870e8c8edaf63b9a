#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "engine/session/deformation.h"
#include "engine/session/duration_histogram.h"
#include "engine/session/hand_path.h"
#include "engine/session/recording.h"

namespace palp {

/// What a session did, for a report.
struct SessionSummary {
    std::uint64_t     ticks = 0, contactTicks = 0;             ///< [1]
    std::uint64_t     patches = 0, failedPatches = 0;          ///< [1]
    std::uint64_t     staleTicks = 0, beyondTable = 0;         ///< [1]
    std::uint64_t     beyondTheory    = 0;                     ///< [1] see SessionFlag
    double            mostForce       = 0;                     ///< [N]
    double            mostDepth       = 0;                     ///< [m] of the hand below the proxy
    double            leastCompliance = 0, mostCompliance = 0; ///< in use [m/N]; 0: never in contact
    GovernorFault     fault = GovernorFault::none;             ///< the last
    std::string       why;                                     ///< the last patch that failed; may be empty
    DurationHistogram tick;                                    ///< computing a tick [s]
    DurationHistogram solve;                                   ///< computing a patch [s]
};

/// Each sample of a session as it is made.
using OnSample = std::function<void(const SessionSample&)>;

/// A whole session on one thread and its own clock: a tick a millisecond, a patch every 1/rate seconds that is in use
/// one period after the touch it was solved for, as a thread of its own would have it. The same scene, hand and device
/// give the same samples, bit for bit, but for tickTime.
///
/// \param seconds   how long [s]
/// \param onSample  sees every sample; may be empty
/// \throws Error as Deformation's constructor does
SessionSummary runVirtual(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index,
                          const HandPath& hand, double seconds, const OnSample& onSample);

} // namespace palp
