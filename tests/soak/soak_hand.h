#pragma once
#include <array>
#include <string>

#include "engine/core/contract.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/session_hand.h"
#include "tests/soak/chance.h"

namespace palp::soak {

inline constexpr std::array kHands{"press", "circle", "scan", "arm", "falcon-emulator", "haply-emulator", "wild"};

/// Returns a hand that goes anywhere about the place, up to 3 cm deep, at up to 1.5 m/s.
inline HandPath wildPath(const HandPlace& place, double seconds, Chance& chance)
{
    std::vector<HandPose> poses{{0, place.point + 0.02 * place.outward}};
    while (poses.back().time < seconds) {
        const glm::dvec3 way(chance.from(-0.03, 0.03), chance.from(-0.03, 0.03), chance.from(-0.03, 0.03));
        const glm::dvec3 to   = place.point + chance.from(-0.03, 0.03) * place.outward + way;
        const double     took = glm::distance(to, poses.back().position) / chance.scaleFrom(0.02, 1.5);
        poses.push_back({poses.back().time + std::max(took, 1e-3), to});
        if (chance.is(0.3)) poses.push_back({poses.back().time + chance.from(0.01, 1), to}); // it rests there
    }
    return HandPath(std::move(poses));
}

/// Opens any hand on an object.
inline SessionHand anyHand(const Scene& scene, const SoftObject& object, double seconds, Chance& chance,
                           std::string& name)
{
    name = chance.is(0.25) ? "wild" : kHands[std::size_t(chance.below(int(kHands.size())))];
    HandChoice choice{.hand    = name,
                      .speed   = chance.scaleFrom(0.01, 0.5),
                      .radius  = chance.scaleFrom(1e-3, 0.02),
                      .depth   = chance.scaleFrom(1e-4, 6 * scene.material.thickness),
                      .seconds = seconds};
    if (name != "wild") {
        try {
            return openHand(choice, scene, object);
        } catch (const Error&) { // such a path leaves the device's workspace
            name += ", refused: wild";
        }
    }
    SessionHand hand;
    hand.path   = std::make_unique<const HandPath>(wildPath(handPlace(scene, object), seconds, chance));
    hand.device = std::make_unique<ScriptedHand>(*hand.path);
    return hand;
}

} // namespace palp::soak
