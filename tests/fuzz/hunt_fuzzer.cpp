#include <string_view>

#include "engine/tools/study/hunt.h"
#include "tests/fuzz/fuzz_expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzRefusals([&] {
        const auto        hunt = palp::study::parseHunt({reinterpret_cast<const char*>(data), size}, "fuzz");
        const std::string text = palp::study::huntJson(hunt);
        palp::fuzzExpect(palp::study::huntJson(palp::study::parseHunt(text, "again")) == text);
    });
    return 0;
}
