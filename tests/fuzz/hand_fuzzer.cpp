#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include <glm/geometric.hpp>

#include "engine/session/hand_path.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

/// What must hold of every hand that is accepted: finite, forwards in time, no faster than it says.
void check(const palp::HandPath& hand)
{
    palp::fuzzExpect(hand.waypoints().size() >= 2 && hand.duration() > 0 && hand.fastest() <= palp::HandPath::kFastest);
    for (const palp::HandPose& s : hand.waypoints())
        palp::fuzzExpect(std::isfinite(s.time) && hand.position(s.time) == s.position);
    for (const double t : {-1.0, 0.0, 0.3, 1e9})
        palp::fuzzExpect(std::isfinite(glm::length(hand.position(hand.begin() + t))));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    palp::fuzzRefusals([&] { check(palp::parseHand(stream, "fuzz")); });
    return 0;
}
