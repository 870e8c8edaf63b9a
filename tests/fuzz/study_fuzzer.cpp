#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/tools/study/study_file.h"
#include "tests/fuzz/fuzz_expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzRefusals([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        const nlohmann::json   file = palp::study::parseStudyFile(text, "fuzz");
        palp::fuzzExpect(file.at("participant").is_string() && file.at("plan").is_string() &&
                         file.at("clouds").is_array());
        palp::fuzzExpect(palp::study::parseStudyFile(file.dump(), "again") == file);
    });
    return 0;
}
