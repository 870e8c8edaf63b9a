#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "engine/chart/resample.h"

namespace palp {

/// What the sums are compiled for; all give the same bits.
enum class Instructions { portable, avx2, avx512 };

/// Returns what this processor has, the fastest last.
[[nodiscard]] std::vector<Instructions> logMeanInstructions();

/// Gaussian-weighted sums at the nodes of a window, of the points in the square of half side kResamplingReach widths
/// about each; see resampleRigidity().
class LogMeanSums {
public:
    /// Most quantities whose sums are made at once: a point's weights are made once for both.
    static constexpr std::size_t kTogether = 2;

    /// \param values  one to kTogether quantities of the points, > 0, each in a unit of its own
    /// \param width   standard deviation of the Gaussian [m]
    /// \param with    one of logMeanInstructions()
    LogMeanSums(const PatchWindow& window, std::span<const ChartPoint> positions, std::span<const PointValues> values,
                double width, Instructions with = logMeanInstructions().back());
    LogMeanSums(const LogMeanSums&)            = delete;
    LogMeanSums& operator=(const LogMeanSums&) = delete;
    ~LogMeanSums()                             = default;

    /// Computes exp of the mean of the logarithms of one quantity along one row of nodes; not a number where no point
    /// reaches.
    void means(int i, std::size_t quantity, std::span<double> row) const;

private:
    PlateGrid           grid_;
    Instructions        with_;
    std::size_t         stride_; ///< of a row of one sum, whole registers, with a margin that they may run into
    std::size_t         sumsPerRow_;
    std::vector<double> storage_; ///< of the sums
    /// For each row of nodes, and a few more, those of w [1], then those of w ln v of each; a row begins with a
    /// register.
    double* sums_ = nullptr;
};

/// Returns true if a quick test shows that every node of a window has a point nearby, as resampleRigidity() counts it;
/// false where a node has none, or where only the distances themselves can tell.
///
/// A point lies within half a spacing of its nearest node along either axis. It is thus near to all nodes around that
/// one which are near to the farthest corner of its cell: cells are marked, and the marks grown.
[[nodiscard]] bool surelyCovered(const PatchWindow& window, std::span<const ChartPoint> positions, double width);

} // namespace palp
