#include "engine/contact/detail/point_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <thread>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/cloud/morton.h"
#include "engine/core/contract.h"
#include "engine/core/parallel.h"

namespace palp {
namespace {

/// Number of points that stay of those stacked in less than a spacing. A sheet has 1 there, a volume 2.
constexpr std::size_t kStacked = 32;

/// Where the spacings differ by a smaller factor, all points are always shown [1]: those of a random sheet differ by 7.
constexpr double kUniform = 16;

/// A search with the spacing s needs no points closer than s over this [1]; with the levels' factor of two it finds up
/// to 16 times as many as a uniform sheet has.
constexpr double kFiner = 2;

/// Number of levels beyond the sparsest point: where a volume is full of points, even a coarse level has many.
constexpr int kSpareLevels = 3;
constexpr int kMostLevels  = 100;

/// Points whose part of the tree is worth a thread.
constexpr std::size_t kWorthAThread = 50'000;

/// A point and the cube of side `least` in which it lies, by the number of the cube along a Morton curve: those of
/// larger cubes are the same without the last bits.
struct Place {
    std::uint64_t cube  = 0;
    std::uint32_t point = 0;

    bool operator<(const Place& b) const noexcept { return cube != b.cube ? cube < b.cube : point < b.point; }
};

/// Returns the points along the curve. The cubes are counted from the middle of the points, so that those of a few
/// strays, and not those of an object with strays, are too far away to be told apart.
std::vector<Place> alongCurve(std::span<const glm::dvec3> positions, double least)
{
    constexpr std::size_t kSamples = 1000;
    const std::size_t     stride   = (positions.size() + kSamples - 1) / kSamples;
    glm::dvec3            middle{}; // [m]
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> along;
        for (std::size_t i = 0; i < positions.size(); i += stride) along.push_back(positions[i][axis]);
        std::nth_element(along.begin(), along.begin() + std::ptrdiff_t(along.size() / 2), along.end());
        middle[axis] = along[along.size() / 2];
    }
    constexpr double   kHalf = kMortonCells / 2;
    std::vector<Place> places(positions.size());
    inParallel(positions.size(), kWorthAThread, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 c = glm::clamp(glm::floor((positions[i] - middle) / least) + kHalf, 0.0, 2 * kHalf - 1);
            places[i] = {mortonCode(std::uint32_t(c.x), std::uint32_t(c.y), std::uint32_t(c.z)), std::uint32_t(i)};
        }
    });
    sortInParallel(places);
    return places;
}

} // namespace

struct PointTree::Builder {
    PointTree&                  tree;
    std::span<const glm::dvec3> positions;
    std::span<const double>     spacings;
    std::span<const PointMark>  marks;
    std::vector<std::uint8_t>   shown; ///< level by point
    std::vector<std::uint32_t>  order; ///< of the points, by what number; in the tree's order at last

    /// Puts the points where they lie along the curve, and numbers them so: what a part of the tree reads then lies
    /// together, in whatever order they came.
    void takePoints()
    {
        inParallel(order.size(), kWorthAThread, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const std::uint32_t i = order[k];
                tree.points_[k]       = {positions[i], spacings[i], marks.empty() ? PointMark() : marks[i]};
                tree.shownUntil_[k]   = shown[i];
            }
        });
        std::iota(order.begin(), order.end(), 0U);
    }

    /// Moves the points to where they lie in the tree, along the cycles of the permutation.
    void sortPoints()
    {
        for (std::size_t first = 0; first < order.size(); ++first) {
            const NearPoint    point = tree.points_[first];
            const std::uint8_t level = tree.shownUntil_[first];
            std::size_t        to    = first;
            for (std::size_t from = order[to]; from != first; to = from, from = order[to]) {
                tree.points_[to]     = tree.points_[from];
                tree.shownUntil_[to] = tree.shownUntil_[from];
                order[to]            = std::uint32_t(to);
            }
            tree.points_[to]     = point;
            tree.shownUntil_[to] = level;
            order[to]            = std::uint32_t(to);
        }
    }

    /// Sets the level up to which each point is shown, and an order in which neighbours follow each other.
    void setLevels()
    {
        shown.resize(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i)
            shown[i] = std::uint8_t(std::clamp(std::ilogb(spacings[i] / tree.least_), 0, kMostLevels));
        tree.levels_ = *std::max_element(shown.begin(), shown.end()) + kSpareLevels + 1;

        std::vector<Place> places = alongCurve(positions, tree.least_);
        order.reserve(places.size());
        for (const Place& place : places) order.push_back(place.point);
        for (int m = 1; m < tree.levels_; ++m) thin(places, m);
    }

    /// Of the points that level m - 1 shows and that are closer than the cubes of level m, one per cube goes on.
    void thin(std::vector<Place>& places, int m)
    {
        const auto cube = [m](const Place& place) { return place.cube >> std::min(3 * m, 63); };
        auto       kept = places.begin();
        for (auto from = places.begin(), to = from; from != places.end(); from = to) {
            constexpr std::uint32_t kNone = 0xffffffff;
            std::uint32_t           first = kNone;
            for (to = from; to != places.end() && cube(*to) == cube(*from); ++to)
                if (shown[to->point] < m) first = std::min(first, to->point);
            for (auto place = from; place != to; ++place)
                if (shown[place->point] >= m || place->point == first) *kept++ = *place;
            if (first != kNone) shown[first] = std::uint8_t(m);
        }
        places.erase(kept, places.end());
    }

    /// Adds the node of a part of `order` and all below it. The points of a leaf lie where they lie in `order`. A large
    /// half is built by another thread; its nodes then follow: the tree does not depend on the number of threads.
    void add(std::vector<Node>& nodes, std::size_t from, std::size_t to, unsigned threads)
    {
        const std::vector<NearPoint>& points = tree.points_;
        const glm::dvec3              first  = points[order[from]].position;
        Node                          node{first, first, 0, 0, 0, 0, 0};
        double                        least = points[order[from]].spacing, most = 0;
        for (std::size_t k = from; k < to; ++k) {
            const NearPoint& point = points[order[k]];
            node.low               = glm::min(node.low, point.position);
            node.high              = glm::max(node.high, point.position);
            node.level             = std::max(node.level, tree.shownUntil_[order[k]]);
            least                  = std::min(least, point.spacing);
            most                   = std::max(most, point.spacing);
        }
        node.ball             = kBall * most;
        const glm::dvec3 size = node.high - node.low;
        if (to - from > kStacked && glm::length(size) < least) to = keepSome(from, to);
        const std::size_t here = nodes.size();
        nodes.push_back(node);
        if (to - from <= kLeaf) {
            nodes[here].first = std::uint32_t(from);
            nodes[here].count = std::uint16_t(to - from);
        } else {
            const int  axis   = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const auto middle = from + (to - from) / 2;
            const auto at     = [&](std::size_t k) { return order.begin() + std::ptrdiff_t(k); };
            std::nth_element(at(from), at(middle), at(to), [&](std::uint32_t a, std::uint32_t b) {
                const double x = points[a].position[axis], y = points[b].position[axis];
                return x != y ? x < y : a < b;
            });
            if (threads > 1 && to - from > kWorthAThread) {
                std::vector<Node> far;
                auto              other = beside([&] { add(far, middle, to, threads / 2); });
                add(nodes, from, middle, threads - threads / 2);
                other.get();
                for (Node& one : far) one.next += std::uint32_t(nodes.size());
                nodes.insert(nodes.end(), far.begin(), far.end());
            } else {
                add(nodes, from, middle, 1);
                add(nodes, middle, to, 1);
            }
        }
        nodes[here].next = std::uint32_t(nodes.size());
    }

    /// Keeps the points that are shown longest, and an even choice of the others; returns the new end.
    std::size_t keepSome(std::size_t from, std::size_t to)
    {
        const auto  at    = [&](std::size_t k) { return order.begin() + std::ptrdiff_t(k); };
        const auto& level = tree.shownUntil_;
        std::sort(at(from), at(to),
                  [&](std::uint32_t a, std::uint32_t b) { return level[a] != level[b] ? level[a] > level[b] : a < b; });
        const std::size_t count = to - from;
        for (std::size_t k = 1; k < kStacked; ++k) std::swap(order[from + k], order[from + k * count / kStacked]);
        return from + kStacked;
    }
};

PointTree::PointTree(std::span<const glm::dvec3> positions, std::span<const double> spacings,
                     std::span<const PointMark> marks)
{
    PALP_EXPECT(!positions.empty() && positions.size() == spacings.size(), "one spacing per point");
    PALP_EXPECT(marks.empty() || marks.size() == positions.size(), "one mark per point");
    least_   = *std::min_element(spacings.begin(), spacings.end());
    largest_ = *std::max_element(spacings.begin(), spacings.end());
    PALP_EXPECT(least_ > 0, "a spacing is not positive");
    Builder builder{*this, positions, spacings, marks, {}, {}};
    builder.setLevels();
    points_.resize(positions.size());
    shownUntil_.resize(positions.size());
    builder.takePoints();
    // Halves go on until a leaf holds its eight: so many nodes, unless points are stacked.
    nodes_.reserve(2 * std::bit_ceil((positions.size() + kLeaf - 1) / kLeaf));
    builder.add(nodes_, 0, positions.size(), std::max(1U, std::thread::hardware_concurrency()));
    builder.sortPoints();
}

bool PointTree::mixed() const noexcept
{
    return largest_ >= kUniform * least_;
}

int PointTree::level(double scale) const noexcept
{
    if (!mixed() || !(scale > kFiner * least_)) return 0;
    return std::min(int(std::floor(std::log2(scale / (kFiner * least_)))), levels_ - 1);
}

double PointTree::cell(int level) const noexcept
{
    return level > 0 ? std::ldexp(least_, level) : 0;
}

double PointTree::firstTouch(const glm::dvec3& from, const glm::dvec3& to) const noexcept
{
    const glm::dvec3 way   = to - from;
    const double     way2  = glm::dot(way, way);
    double           share = 1;
    // Tests the way, up to what was found so far, against the node's box with its largest ball around.
    const auto meets = [&](const Node& node) {
        double begin = 0, end = share;
        for (int k = 0; k < 3; ++k) {
            const double low = node.low[k] - node.ball - from[k], high = node.high[k] + node.ball - from[k];
            if (way[k] == 0) {
                if (low > 0 || high < 0) return false;
                continue;
            }
            const double a = low / way[k], b = high / way[k];
            begin = std::max(begin, std::min(a, b));
            end   = std::min(end, std::max(a, b));
        }
        return begin <= end;
    };
    walk(meets, [&](std::size_t i) {
        // |from + t way - p|^2 = radius^2; at the lesser root the way comes to touch.
        const glm::dvec3 d            = from - points_[i].position;
        const double     radius       = kBall * points_[i].spacing;
        const double     half         = glm::dot(d, way);
        const double     outside      = glm::dot(d, d) - radius * radius;
        const double     discriminant = half * half - way2 * outside;
        if (half < 0 && outside > 0 && discriminant >= 0)
            share = std::min(share, outside / (std::sqrt(discriminant) - half));
        return true;
    });
    return share;
}

} // namespace palp
