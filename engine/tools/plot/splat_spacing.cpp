#include "engine/tools/plot/splat_spacing.h"

#include <cmath>
#include <limits>

namespace palp {
namespace {

constexpr double kWidthPerSpacing = 1.25; // width of a splat: randomly spread points close with it [1]
constexpr double kSmallestWidth   = 0.6;  // of a splat [px]
constexpr double kLargestWidth    = 0.06; // of a splat per side of the picture: fewer points than that show singly [1]

bool onPicture(const CloudCamera::Pixel& p, const CloudCamera& camera)
{
    return p.x >= 0 && p.y >= 0 && p.x < camera.width && p.y < camera.height;
}

} // namespace

SplatSpacing::SplatSpacing(std::span<const glm::dvec3> positions, const CloudCamera& camera)
{
    constexpr int    kFirstSide = 4; // [px]
    constexpr double kEnough    = 6; // points in a cell that give a spacing [1]
    const int        largest    = std::max(camera.width, camera.height);
    for (side_ = kFirstSide;; side_ *= 2) {
        count(positions, camera);
        double total = 0; // of points, of a crowded cell no more than a share
        for (double n : counts_) total += std::min(n, 2 * kEnough);
        const auto empty = std::count(counts_.begin(), counts_.end(), 0.0);
        if (total >= kEnough * double(std::ptrdiff_t(counts_.size()) - empty) || side_ >= largest) break;
    }
    measure(kLargestWidth * largest);
    boundWork(positions, camera, kLargestWidth * largest);
}

void SplatSpacing::count(std::span<const glm::dvec3> positions, const CloudCamera& camera)
{

    constexpr float kThickness = 3; // depth of the front layer per side of a cell [1]
    columns_                   = (camera.width + side_ - 1) / side_;
    rows_                      = (camera.height + side_ - 1) / side_;
    front_.assign(std::size_t(columns_) * std::size_t(rows_), std::numeric_limits<float>::infinity());
    counts_.assign(front_.size(), 0);

    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            float& front = front_[cell(p->x, p->y)];
            front        = std::min(front, float(p->depth));
        }
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            const std::size_t c = cell(p->x, p->y);

            counts_[c] += float(p->depth) <= front_[c] + kThickness * float(side_);
        }
}

void SplatSpacing::measure(double largest)
{
    // Mean over the neighbourhood weighted by the counts themselves, so that cells cut by a silhouette hardly matter.
    // A heap of points in one place says little about the spacing around it.
    constexpr double    kHeap = 4; // relative to the typical count [1]
    std::vector<double> filled;
    for (double n : counts_)
        if (n > 0) filled.push_back(n);
    if (!filled.empty()) {
        const auto middle = filled.begin() + std::ptrdiff_t(filled.size() / 2);
        std::nth_element(filled.begin(), middle, filled.end());
        for (double& n : counts_) n = std::min(n, kHeap * *middle);
    }
    widths_.assign(counts_.size(), 0);
    std::vector<double> spacings;
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            double sum = 0, sumOfSquares = 0;
            for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
                for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
                    const double n = counts_[std::size_t(r) * std::size_t(columns_) + std::size_t(c)];
                    sum += n;
                    sumOfSquares += n * n;
                }
            const std::size_t here = std::size_t(row) * std::size_t(columns_) + std::size_t(column);
            if (sum > 0) widths_[here] = side_ / std::sqrt(sumOfSquares / sum);
            if (counts_[here] > 0) spacings.push_back(widths_[here]);
        }
    if (!spacings.empty()) {
        const auto middle = spacings.begin() + std::ptrdiff_t(spacings.size() / 2);
        std::nth_element(spacings.begin(), middle, spacings.end());
        typical_ = *middle;
    }
    constexpr double kNarrowest = 0.6, kWidest = 3; // relative to the typical spacing [1]
    const auto       widthFor = [&](double spacing) {
        return std::clamp(kWidthPerSpacing * std::clamp(spacing, kNarrowest * typical_, kWidest * typical_),
                                kSmallestWidth, std::max(kSmallestWidth, largest));
    };
    for (double& width : widths_) width = widthFor(width > 0 ? width : typical_);
}

// Linear between the centres of the cells: a jump of the width would show as an edge.
double SplatSpacing::width(const CloudCamera::Pixel& point) const
{
    const double u    = std::clamp(point.x / side_ - 0.5, 0.0, double(columns_ - 1));
    const double v    = std::clamp(point.y / side_ - 0.5, 0.0, double(rows_ - 1));
    const int    left = int(u), top = int(v), right = std::min(left + 1, columns_ - 1),
              bottom = std::min(top + 1, rows_ - 1);
    const auto at    = [&](int row, int column) {
        return widths_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
    };
    const double s = u - left, t = v - top;
    return ((1 - t) * ((1 - s) * at(top, left) + s * at(top, right)) +
            t * ((1 - s) * at(bottom, left) + s * at(bottom, right)));
}

void SplatSpacing::boundWork(std::span<const glm::dvec3> positions, const CloudCamera& camera, double largest)
{
    // Squares of half a splat's width hold about 0.4 points of every layer.
    constexpr double kMostPerSquare = 8; // twenty layers [1]
    crowdSide_                      = std::max(1, int(0.5 * std::min(kWidthPerSpacing * typical_, largest)));
    crowdColumns_                   = camera.width / crowdSide_ + 1;
    std::vector<std::size_t> counts(std::size_t(crowdColumns_) * std::size_t(camera.height / crowdSide_ + 1), 0);
    every_.assign(counts.size(), 1);
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) ++counts[square(*p)];
    for (std::size_t c = 0; c < counts.size(); ++c)
        every_[c] = std::max<std::size_t>(1, std::size_t(std::ceil(double(counts[c]) / kMostPerSquare)));
}

bool SplatSpacing::skips(std::size_t number, const CloudCamera::Pixel& point) const
{
    const std::size_t c = point.x < 0 || point.y < 0 ? every_.size() : square(point);
    return c < every_.size() && point.x < crowdSide_ * crowdColumns_ && number % every_[c] != 0;
}

} // namespace palp
