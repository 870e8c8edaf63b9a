#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "engine/tools/render/surface_renderer.h"

namespace palp {

/// A picture is the one in the folder to the byte, and was drawn without a word of the validation layer. Pictures hold
/// for the driver that the folder's driver.txt names; with another one rounding may differ, and the test is skipped.
/// PALPATE_GOLDEN_WRITE=1 writes them anew: look at them before committing.
inline void expectGolden(const std::filesystem::path& folder, const std::string& name, const Image& image,
                         SurfaceRenderer& renderer)
{
    const auto bytesOf = [](const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::filesystem::path file   = folder / name;
    const std::string           driver = renderer.device().name + ", " + renderer.device().driver + "\n";
    const std::string           bytes  = encodePng(image);
    for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << "validation: " << message;
    if (std::getenv("PALPATE_GOLDEN_WRITE")) {
        std::filesystem::create_directories(folder);
        std::ofstream(file, std::ios::binary) << bytes;
        std::ofstream(folder / "driver.txt") << driver;
    }
    if (bytesOf(folder / "driver.txt") != driver)
        GTEST_SKIP() << "drawn by " << bytesOf(folder / "driver.txt") << "and this is " << driver;
    if (bytesOf(file) != bytes) {
        const auto now = std::filesystem::temp_directory_path() / file.filename();
        std::ofstream(now, std::ios::binary) << bytes;
        FAIL() << file << " differs from " << now;
    }
}

} // namespace palp
