#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "engine/tools/plot/png.h"

namespace palp {

class SurfaceRenderer;

/// How far a picture may be from the stored one. A driver in software uses the processor's approximate reciprocals,
/// which differ between makers of processors: up to 53 pixels of a window were seen 1 or 2 of 255 levels off. Nobody
/// sees 3 levels in one of a thousand pixels; a shape that moved by a pixel, a missing character and another colour
/// exceed both bounds or one of them, which golden_picture_test.cpp plants and finds.
inline constexpr int    kGoldenLevels = 3;     ///< of 255, in each of red, green and blue
inline constexpr double kGoldenPixels = 0.001; ///< share of all pixels that may differ at all [1]

/// How two pictures of one size differ.
struct PictureDifference {
    std::size_t pixels = 0; ///< how many differ
    int         levels = 0; ///< the largest difference of one channel, of 255
};

/// \pre the pictures have one size
[[nodiscard]] PictureDifference differenceOf(const Image& measured, const Image& expected);

/// Whether two pictures are the same within kGoldenLevels and kGoldenPixels.
[[nodiscard]] ::testing::AssertionResult looksLike(const Image& measured, const Image& expected);

/// Expects that a picture looks like the stored one in the folder, and that the validation layer was silent while it was
/// drawn. Stored pictures hold for the driver that the folder's driver.txt names. Another driver, or the same one on a
/// processor without AVX ("128 bits"), rounds places too and covers other pixels at edges: the test is skipped there.
/// PALPATE_GOLDEN_WRITE=1 stores the pictures anew; look at them before committing.
void expectGolden(const std::filesystem::path& folder, const std::string& name, const Image& image,
                  SurfaceRenderer& renderer);

} // namespace palp
