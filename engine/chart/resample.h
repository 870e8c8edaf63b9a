#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/chart/chart.h"
#include "engine/core/grid.h"
#include "engine/core/resampling.h"

namespace palp {

/// The part of the chart that bends: a grid of fixed size with the contact on its middle node.
/// \differs the paper bends the neighbourhood, whatever its points span: a clamped plate's compliance grows with its
///          area, so that the scatter of the points would be felt
struct PatchWindow {
    PlateGrid  grid;
    ChartPoint corner; ///< chart position of node (0, 0) [m]

    /// Returns a square of `size` [m] with `cells` cells a side.
    /// \param cells  even, so that the contact is a node
    [[nodiscard]] static PatchWindow square(double size, int cells);

    [[nodiscard]] bool holds(const ChartPoint& p) const noexcept;
    /// Returns the place in the window, edges included, that is nearest to p.
    [[nodiscard]] ChartPoint nearest(const ChartPoint& p) const noexcept;
};

/// A quantity of each point, > 0.
using PointValues = std::span<const double>;

/// What points have their values of: a place, or all around as far as the next point, of which they are the means.
enum class Sampling { places, means };

struct Resampled {
    NodeField   rigidity;              ///< D [N m] at the nodes
    std::size_t nodesWithoutPoint = 0; ///< nodes that had no point nearby and took the nearest one's value
    double      bareFrom = std::numeric_limits<double>::infinity(); ///< of them, the nearest to the window's middle [m]
};

/// Returns how far along either axis the log-mean looks for points: 4 s, where the weight is 3e-4 [m].
///
/// The width s is the spacing of the points, so that some are always near, but no less than half that of the nodes, so
/// that no point falls between them. Points farther than that outside the window do not matter to its rigidity.
///
/// \param pointSpacing  of the cloud [m]
/// \param nodeSpacing   of the grid, the larger one [m]
[[nodiscard]] double kernelReach(double pointSpacing, double nodeSpacing) noexcept;

/// Computes the rigidity at the nodes of a window from scattered values.
///
/// Log-mean: ln D = sum w_i ln D_i / sum w_i,  w = exp(-d^2 / (2 s^2)),  over the points in the square of half
/// side 4 s about the node,  s = max(pointSpacing, h/2), of means resamplingWidthOfMeans(). A node with no point in its
/// square takes the nearest one's value. A node counts as without a point if none lies within 2.5 s: in a random cloud
/// one node in 10^8 has none, so a count above zero means a hole, a border or a far side. Where the points are unevenly
/// close, nodes with no point in their square take the log-mean of a square twice as large, and so on up to the square
/// of the sparsest points; nodes without a point are counted by that last square.
///
/// \param positions     of the points in the chart [m], at least one; may lie outside the window
/// \param rigidities    D of the same points [N m], > 0
/// \param pointSpacing  mean distance of the cloud's points [m], of the closest ones where they are uneven
/// \param sparsest      mean distance where they are farthest apart [m]; 0: as pointSpacing
/// \param sampling      means take a narrower Gaussian, see resamplingWidthOfMeans()
/// \source  Kumari & Chaudhuri 2016, section 2.4 (nearest)
/// \differs log-mean: arithmetic means are 5 to 17 % off in compliance at a step of contrast 100, and the nearest point
///          makes compliance jitter by 0.5 to 2 % while the grid slides
[[nodiscard]] Resampled resampleRigidity(const PatchWindow& window, std::span<const ChartPoint> positions,
                                         std::span<const double> rigidities, Resampling resampling, double pointSpacing,
                                         double sparsest = 0, Sampling sampling = Sampling::places);

/// Computes several quantities of the same points at the nodes, each as resampleRigidity() would alone and to its bits,
/// in less time than one after the other.
/// \param exact  [m] nodes from which every point is farther may take another near one's value, see nearestPoint()
/// \return  in their order; nodesWithoutPoint and bareFrom are the same in all
[[nodiscard]] std::vector<Resampled> resampleAll(const PatchWindow& window, std::span<const ChartPoint> positions,
                                                 std::span<const PointValues> values, Resampling resampling,
                                                 double pointSpacing, double sparsest = 0,
                                                 Sampling sampling = Sampling::places,
                                                 double   exact    = std::numeric_limits<double>::infinity());

} // namespace palp
