#pragma once
#include "engine/session/deformation.h"
#include "engine/session/hand_path.h"
#include "engine/session/session_summary.h"

namespace palp {

/// A whole session on one thread and its own clock: a tick a millisecond, a patch every 1/rate seconds that is in use
/// one period after the touch it was solved for, as a thread of its own would have it. The same scene, hand and device
/// give the same samples, bit for bit, but for tickTime.
///
/// \param seconds   how long [s]
/// \param onSample  sees every sample; may be empty
/// \param deformation  of the same scene and cloud
SessionSummary runVirtual(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index,
                          Deformation& deformation, const HandPath& hand, double seconds, const OnSample& onSample);

} // namespace palp
