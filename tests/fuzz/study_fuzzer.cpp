#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/tools/study/study_file.h"
#include "tests/fuzz/fuzz_expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzRefusals([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        const auto             file  = palp::fuzzRead([&] { return palp::study::parseStudyFile(text, "fuzz"); });
        const std::string      again = palp::study::studyJson(file);
        palp::fuzzExpect(palp::study::studyJson(palp::study::parseStudyFile(again, "again")) == again);
    });
    return 0;
}
