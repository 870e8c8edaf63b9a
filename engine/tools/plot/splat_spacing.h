#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/tools/plot/cloud_surface.h"

namespace palp {

/// Radius of a splat in widths: its weight (1 - r^2)^3 ends there. [1]
inline constexpr double kSplatReach = 2.5;

/// How far apart the points of the front layer lie on the screen, and so how wide their splats are. Counted on a coarse
/// grid of cells.
class SplatSpacing {
public:
    SplatSpacing(std::span<const glm::dvec3> positions, const CloudCamera& camera);

    /// Distance of neighbouring points. [px]
    [[nodiscard]] double typical() const { return typical_; }
    /// The widest splat. [px]
    [[nodiscard]] double widest() const { return *std::max_element(widths_.begin(), widths_.end()); }
    /// Width of the splat of a point. [px]
    [[nodiscard]] double width(const CloudCamera::Pixel& point) const;

    /// Whether a point need not be drawn, because its place is so crowded that others stand for it: bounds the time.
    /// \param number  of the point in the cloud
    [[nodiscard]] bool skips(std::size_t number, const CloudCamera::Pixel& point) const;

private:
    void count(std::span<const glm::dvec3> positions, const CloudCamera& camera);
    void measure(double largest);
    void boundWork(std::span<const glm::dvec3> positions, const CloudCamera& camera, double largest);

    [[nodiscard]] std::size_t square(const CloudCamera::Pixel& p) const
    {
        return std::size_t(int(p.y) / crowdSide_) * std::size_t(crowdColumns_) + std::size_t(int(p.x) / crowdSide_);
    }

    [[nodiscard]] std::size_t cell(double x, double y) const
    {
        const int column = std::clamp(int(x / side_), 0, columns_ - 1), row = std::clamp(int(y / side_), 0, rows_ - 1);
        return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
    }

    int                 side_ = 0, columns_ = 0, rows_ = 0; // of a cell [px], of the grid [1]
    std::vector<float>  front_;                             // nearest depth per cell [px]
    std::vector<double> counts_;                            // points of the front layer per cell [1]
    std::vector<double> widths_;                            // [px]
    double              typical_ = 1;                       // distance of neighbouring points [px]

    int                      crowdSide_ = 1, crowdColumns_ = 0; // of finer squares [px], [1]
    std::vector<std::size_t> every_;                            // per square: one of how many points is drawn [1]
};

} // namespace palp
