#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/session/marker.h"
#include "tests/fuzz/fuzz_expect.h"

// Datagrams one after another, each ended by a zero.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    for (std::string_view rest(reinterpret_cast<const char*>(data), size); !rest.empty();) {
        const std::string_view one = rest.substr(0, rest.find('\0'));
        rest.remove_prefix(std::min(rest.size(), one.size() + 1));
        const std::string text = palp::markerText(one);
        palp::fuzzExpect(!text.empty() && text.size() <= palp::kMostOfMarker && palp::markerText(text) == text);
        palp::fuzzExpectSentence(text);
    }
    return 0;
}
