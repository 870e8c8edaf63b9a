#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "engine/session/scene.h"
#include "tests/soak/faulty_solver.h"

namespace palp::soak {

/// What a session of the soak was.
struct EpisodeReport {
    std::uint64_t              ticks    = 0;
    std::uint64_t              pressing = 0; ///< ticks with a force
    std::uint64_t              judged   = 0; ///< ticks without contact so near the surface that its side was known
    std::uint64_t              troubles = 0; ///< of the device, the clock and the files
    std::string                hand;         ///< one of kHands
    std::string                what;         ///< the hand and its rates, for a person
    std::optional<std::string> wrong{};      ///< the first thing that must not be
};

/// Runs one session in virtual time: any hand on this object, with faults of device, clock and files at random
/// instants. The same arguments give the same ticks.
[[nodiscard]] EpisodeReport runEpisode(const Scene& scene, const SoftObject& object, Deformation& deformation,
                                       FaultySolver& solver, std::uint64_t seed);

} // namespace palp::soak
