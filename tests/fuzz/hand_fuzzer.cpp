#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/session/hand_path.h"

namespace {

void expect(bool holds)
{
    if (!holds) std::abort();
}

/// What must hold of every hand that is accepted: finite, forwards in time, no faster than it says.
void check(const palp::HandPath& hand)
{
    expect(hand.waypoints().size() >= 2 && hand.duration() > 0 && hand.fastest() <= palp::HandPath::kFastest);
    for (const palp::HandPose& s : hand.waypoints())
        expect(std::isfinite(s.time) && hand.position(s.time) == s.position);
    for (const double t : {-1.0, 0.0, 0.3, 1e9}) expect(std::isfinite(glm::length(hand.position(hand.begin() + t))));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    try {
        check(palp::parseHand(stream, "fuzz"));
    } catch (const palp::Error&) {
        return 0; // a refusal is a right answer
    }
    return 0;
}
