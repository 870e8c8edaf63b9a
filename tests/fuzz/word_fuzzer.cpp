#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/haply/haply_record.h"
#include "device/hid/bridge_lines.h"
#include "engine/cloud/material.h"
#include "engine/core/quantity.h"
#include "engine/session/udp_address.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

void read(char reader, const std::string& word)
{
    switch (reader) {
    case 'p': {
        const glm::dvec3 point = palp::parsePoint(word, "fuzz", 1e3);
        palp::fuzzExpect(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
        break;
    }
    case 'u': {
        const palp::UdpAddress read = palp::parseUdpAddress(word, "fuzz", "127.0.0.1");
        palp::fuzzExpect(read.port > 0 && palp::parseUdpAddress(read.text(), "again").host == read.host);
        break;
    }
    case 'h':
        palp::fuzzExpect(palp::parseHaplyPath(word).port > 0);
        break;
    case 'l':
        if (const auto line = palp::parseBridgeLine(word))
            palp::fuzzExpect(!line->place.empty() && (line->kind == palp::BridgeLine::Kind::udp) == (line->port > 0));
        break;
    case 'r': {
        const palp::Relaxation read = palp::parseRelaxation(word, "fuzz");
        palp::fuzzExpect(palp::relaxationText(palp::parseRelaxation(palp::relaxationText(read), "again")) ==
                         palp::relaxationText(read));
        break;
    }
    default:
        palp::fuzzExpect(std::isfinite(palp::parseQuantity(word, palp::Dimension(unsigned(reader) % 10), "fuzz", 1e3)));
    }
}

} // namespace

// Words of a command line, a line each. A line's first character says which reader gets the rest.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    for (std::string_view rest(reinterpret_cast<const char*>(data), size); !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        if (!line.empty()) palp::fuzzRefusals([&] { read(line[0], std::string(line.substr(1))); });
    }
    return 0;
}
