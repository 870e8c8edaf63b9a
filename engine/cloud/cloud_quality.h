#pragma once
#include <cstddef>
#include <vector>

#include "engine/cloud/soft_object.h"

namespace palp {

/// The distribution of a length over a surface: each point counts by the area that it stands for.
struct Spread {
    double least   = 0; ///< [m]
    double low     = 0; ///< 5 % of the area have less [m]
    double typical = 0; ///< the median [m]
    double high    = 0; ///< 95 % of the area have less [m]
    double most    = 0; ///< [m]
};

/// How well the points of an object describe its surface. Everything is 0 for an object without one.
struct CloudQuality {
    Spread      spacing;      ///< see SurfaceSurvey
    double      byPoints = 0; ///< median of the spacing where each point counts alike [m]
    double      area     = 0; ///< of the surface, holes apart: the sum of the squared spacings [m^2]; not of lines
    double      noise = 0, noise95 = 0; ///< median, and what 95 % of the points stay below [m]
    double      noisy = 0, noisy95 = 0; ///< the same, of the noise over the spacing of the same point [1]
    double      sided  = 0;             ///< share of the points whose outward side is known [1]
    std::size_t strays = 0; ///< points that have no other within three spacings: nothing of a surface is felt there
    double      border = 0; ///< share of the points at a border or beside a hole, see cloudQuality() [1]
    /// The longest edge of the box around each border that hangs together, the largest first [m]: the outer ones of an
    /// open sheet, and its holes.
    std::vector<double> borderWidths{};
    double              inLines      = 0; ///< share of the points that lie in lines [1]
    double              alongLine    = 0; ///< median distance of neighbours in a line [m]
    double              betweenLines = 0; ///< median distance from a line to the next [m]; 0: none is near
    double depthStep = 0; ///< distance of the few depths that a camera tells apart, see cloudQuality() [m]; else 0

    /// Returns how much coarser the sparse parts are than the dense ones, 5 % of the area apart at either end [1].
    [[nodiscard]] double unevenness() const noexcept { return spacing.low > 0 ? spacing.high / spacing.low : 1; }
    /// Returns whether the points lie in lines, as those of a line scanner or of the contours in a stack of slices.
    [[nodiscard]] bool areLines() const noexcept { return inLines > 0.5; }
    /// Returns how many points lie on a disc of that radius [m], on average where the spacing is typical.
    [[nodiscard]] double pointsUnder(double radius) const noexcept;
};

/// The free angle from which on a point is at a border or beside a hole [degrees]. Of the 28 points in the
/// neighbourhood of a random sheet, one neighbourhood in 2000 leaves as much by chance; a straight border leaves 180.
inline constexpr double kFreeAngle = 120;

/// Measures an object.
///
/// A point is at a border if its neighbours, seen along its normal, leave an angle of more than kFreeAngle free. Its
/// neighbours are the points within three spacings, its own or theirs, so that a step in density is no border; the
/// other side of a thin body does not count. Beside a round hole the free angle shows from a radius of three spacings
/// on; smaller ones are bridged by the touch too.
/// A point lies in a line if its two nearest points lie on a line through it and much closer than the spacing. The
/// spacing of lines is about half of the distance between them: see SurfaceSurvey.
/// Depth has steps where one coordinate takes few values, not much closer than the points are, and points that face
/// along it are taken for the faces of thin bodies.
/// \thread pure; on all cores: about 2 us of one core a point
[[nodiscard]] CloudQuality cloudQuality(const SoftObject& object);

} // namespace palp
