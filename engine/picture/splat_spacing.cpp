#include "engine/picture/splat_spacing.h"

#include <cmath>
#include <limits>

namespace palp {
namespace {

constexpr double kWidthPerSpacing = 1.25; // width of a splat: randomly spread points close with it [1]
constexpr double kSmallestWidth   = 0.6;  // of a splat [px]
constexpr double kLargestWidth    = 0.06; // of a splat per side of the picture: fewer points than that show singly [1]
constexpr double kMostWork        = 800;  // splatted pixels per pixel of a cell: some twenty layers of points [1]

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
    boundWork();
}

void SplatSpacing::count(std::span<const glm::dvec3> positions, const CloudCamera& camera)
{

    constexpr float kThickness = 3; // depth of the front layer per side of a cell [1]
    columns_                   = (camera.width + side_ - 1) / side_;
    rows_                      = (camera.height + side_ - 1) / side_;
    front_.assign(std::size_t(columns_) * std::size_t(rows_), std::numeric_limits<float>::infinity());
    counts_.assign(front_.size(), 0);
    all_.assign(front_.size(), 0);
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            float& front = front_[cell(p->x, p->y)];
            front        = std::min(front, float(p->depth));
        }
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            const std::size_t c = cell(p->x, p->y);
            ++all_[c];
            counts_[c] += float(p->depth) <= front_[c] + kThickness * float(side_);
        }
}

void SplatSpacing::measure(double largest)
{
    // Mean over the neighbourhood weighted by the counts themselves, so that cells cut by a silhouette hardly matter.
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

void SplatSpacing::boundWork()
{
    every_.assign(all_.size(), 1);
    for (std::size_t c = 0; c < all_.size(); ++c) {
        const double reach = 2 * kSplatReach * widths_[c];
        every_[c] =
            std::size_t(std::ceil(std::max(1.0, double(all_[c]) * reach * reach / (kMostWork * side_ * side_))));
    }
}

} // namespace palp
