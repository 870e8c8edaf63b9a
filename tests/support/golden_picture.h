#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "engine/tools/plot/png.h"

namespace palp {

class SurfaceRenderer;

/// The largest differences of a picture from the stored one. A driver in software uses the processor's approximate
/// reciprocals, which differ between makers of processors: up to 53 pixels of a window were found 1 or 2 of 255 levels
/// off. Differences of 3 levels in one of a thousand pixels are invisible. An edge through the very centre of a pixel
/// covers it on one processor and not on another: 4 pixels of a window by 6 levels, and one by 25, were found; twice as
/// many pass. A shape that moved by a pixel, a missing character and another colour exceed at least one of the bounds,
/// as golden_picture_test.cpp shows.
inline constexpr int         kGoldenLevels      = 3;     ///< of 255, in each of red, green and blue
inline constexpr double      kGoldenPixels      = 0.001; ///< share of all pixels that may differ at all [1]
inline constexpr std::size_t kGoldenStrays      = 8;  ///< number of pixels that may differ by more than kGoldenLevels
inline constexpr int         kGoldenStrayLevels = 50; ///< by which they may

/// The difference of two pictures of one size.
struct PictureDifference {
    std::size_t pixels = 0; ///< number of different pixels
    std::size_t strays = 0; ///< number of those that differ by more than kGoldenLevels
    int         levels = 0; ///< the largest difference of one channel, of 255
};

/// Compares two pictures.
/// \pre the pictures have one size
[[nodiscard]] PictureDifference differenceOf(const Image& measured, const Image& expected);

/// Returns true if two pictures are the same within the bounds above.
[[nodiscard]] ::testing::AssertionResult looksLike(const Image& measured, const Image& expected);

/// Expects that a picture looks like the stored one in the folder, and that the validation layer was silent during the
/// drawing. Stored pictures are valid for the driver that the folder's driver.txt names. Another driver, or the same
/// one on a processor without AVX ("128 bits"), also rounds positions differently and covers other pixels at edges:
/// then the test is skipped, and the program says so once, in a line that the release's gate finds.
/// PALPATE_GOLDEN_WRITE=1 stores the pictures anew; look at them before committing.
void expectGolden(const std::filesystem::path& folder, const std::string& name, const Image& image,
                  SurfaceRenderer& renderer);

} // namespace palp
