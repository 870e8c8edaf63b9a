#include "tests/support/golden_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "engine/tools/render/surface_renderer.h"
#include "tests/support/png_reader.h"

namespace palp {
namespace {

std::string bytesOf(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

} // namespace

PictureDifference differenceOf(const Image& measured, const Image& expected)
{
    PictureDifference difference;
    for (std::size_t n = 0; n < expected.pixels.size(); ++n) {
        const Rgb8 one = measured.pixels.at(n), other = expected.pixels[n];
        if (one == other) continue;
        ++difference.pixels;
        const int levels = std::max(
            {std::abs(one.red - other.red), std::abs(one.green - other.green), std::abs(one.blue - other.blue)});
        difference.levels = std::max(difference.levels, levels);
        if (levels > kGoldenLevels) ++difference.strays;
    }
    return difference;
}

::testing::AssertionResult looksLike(const Image& measured, const Image& expected)
{
    if (measured.width != expected.width || measured.height != expected.height)
        return ::testing::AssertionFailure() << "it has " << measured.width << " x " << measured.height
                                             << " pixels, expected " << expected.width << " x " << expected.height;
    const PictureDifference difference = differenceOf(measured, expected);
    const auto              allowed    = std::size_t(kGoldenPixels * double(expected.pixels.size()));
    if (difference.pixels <= allowed && difference.strays <= kGoldenStrays && difference.levels <= kGoldenStrayLevels)
        return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << difference.pixels << " pixels differ by up to " << difference.levels
                                         << " levels, " << difference.strays << " of them by more than "
                                         << kGoldenLevels << "; allowed are " << allowed << " pixels and "
                                         << kGoldenStrays << " of them by more, up to " << kGoldenStrayLevels
                                         << ", because processors round differently";
}

void expectGolden(const std::filesystem::path& folder, const std::string& name, const Image& image,
                  SurfaceRenderer& renderer)
{
    const std::filesystem::path file   = folder / name;
    const std::string           driver = renderer.processor().name + ", " + renderer.processor().driver;
    for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << "validation: " << message;
    if (std::getenv("PALPATE_GOLDEN_WRITE")) {
        std::filesystem::create_directories(folder);
        std::ofstream(file, std::ios::binary) << encodePng(image);
        std::ofstream(folder / "driver.txt") << driver << "\n";
    }
    if (const std::string stored = bytesOf(folder / "driver.txt"); stored != driver + "\n") {
        const std::string because = "drawn by " + stored.substr(0, stored.find('\n')) + ", and this is " + driver;
        // Of a program of shader tests ctest does not tell what was skipped: the release's gate looks for this line.
        static bool said = false;
        if (!std::exchange(said, true))
            std::cout << "skipped: pictures are not compared with those of " << folder.string() << ": " << because
                      << std::endl;
        GTEST_SKIP() << because;
    }
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    const Image stored = test::decodePng(bytesOf(file));
    if (const auto same = looksLike(image, stored); !same) {
        const auto now = std::filesystem::temp_directory_path() / file.filename();
        std::ofstream(now, std::ios::binary) << encodePng(image);
        FAIL() << file << " differs from " << now << ": " << same.message();
    }
}

} // namespace palp
