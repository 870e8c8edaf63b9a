#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "device/haply/haply_message.h"
#include "device/haply/web_socket.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

/// Whatever a service says: what is believed of it is finite, and a name that is taken can stand in a command.
void check(const std::string& json)
{
    palp::HaplyState state;
    const bool       good =
        palp::fuzzRead([&] { return palp::takeHaplyState(json, "049D", state); }) == palp::HaplyVerdict::good;
    ++(good ? palp::fuzzVerdicts.accepted : palp::fuzzVerdicts.refused);
    if (good)
        palp::fuzzExpect(std::isfinite(glm::length(state.position) +
                                       glm::length(state.velocity.value_or(glm::dvec3(0))) +
                                       glm::length(state.rendered.value_or(glm::dvec3(0)))) &&
                         std::abs(glm::length(state.orientation) - 1) < 1e-6);
    for (const palp::HaplyDescription& device : palp::fuzzRead([&] { return palp::haplyDevices(json); }))
        palp::fuzzExpect(palp::isHaplyId(device.id));
    palp::fuzzExpect(palp::haplyEvent(json, "049D").words != nullptr);
    static_cast<void>(palp::dialectOf(palp::versionIn(json)));
    static_cast<void>(palp::forceScaleIn(json));
}

/// The same bytes as frames of either side, in pieces.
void readFrames(const std::uint8_t* data, std::size_t size, palp::WebSocketSide from)
{
    palp::WebSocketReader reader(from);
    try {
        for (std::size_t at = 0; at < size; at += 7) {
            reader.feed({data + at, std::min<std::size_t>(7, size - at)});
            while (const auto message = reader.next()) check(message->payload);
        }
    } catch (const palp::WebSocketError&) { // a refusal is a right answer
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    check(text);
    try {
        if (const auto head = palp::readHttpHead(text)) static_cast<void>(head->field("sec-websocket-accept"));
    } catch (const palp::WebSocketError&) {
    }
    readFrames(data, size, palp::WebSocketSide::server);
    readFrames(data, size, palp::WebSocketSide::client);
    std::vector<std::uint8_t> frame(data, data + size);
    palp::kHaplyZero.silence(frame);
    palp::fuzzExpect(!palp::kHaplyZero.pushes(frame));
    return 0;
}
