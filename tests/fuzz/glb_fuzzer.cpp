#include "tests/fuzz/cloud_fuzzer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzCloud(data, size, palp::CloudFormat::glb);
    return 0;
}
