#include "engine/contact/detail/point_tree.h"

#include <cmath>
#include <future>
#include <numeric>
#include <thread>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"

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

/// Keeps those points that come first in their cube.
void thin(std::span<const glm::dvec3> positions, double side, std::vector<std::uint32_t>& points)
{
    struct Place {
        std::int64_t  x, y, z;
        std::uint32_t point;
        auto          operator<=>(const Place&) const = default;
    };
    constexpr double   kFar = 0x1p62; // cubes; beyond, among the strays of so wide a cloud, all are one
    std::vector<Place> places;
    places.reserve(points.size());
    for (const std::uint32_t i : points) {
        const glm::dvec3 c = glm::clamp(glm::floor(positions[i] / side), -kFar, kFar);
        places.push_back({std::int64_t(c.x), std::int64_t(c.y), std::int64_t(c.z), i});
    }
    std::sort(places.begin(), places.end());
    points.clear();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Place &a = places[i], &b = places[i > 0 ? i - 1 : 0];
        if (i == 0 || a.x != b.x || a.y != b.y || a.z != b.z) points.push_back(a.point);
    }
}

} // namespace

struct PointTree::Builder {
    PointTree&                  tree;
    std::span<const glm::dvec3> positions;
    std::span<const double>     spacings;
    std::span<const PointMark>  marks;
    std::vector<std::uint8_t>   shown; ///< level by point
    std::vector<std::uint32_t>  order;

    /// Some nodes that follow each other, and their points.
    struct Part {
        std::vector<Node>         nodes;
        std::vector<NearPoint>    points;
        std::vector<std::uint8_t> shownUntil;

        void reserve(std::size_t count)
        {
            points.reserve(count);
            shownUntil.reserve(count);
        }
        void append(Part&& other)
        {
            for (Node& node : other.nodes) {
                node.next += std::uint32_t(nodes.size());
                node.first += std::uint32_t(points.size());
            }
            nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
            points.insert(points.end(), other.points.begin(), other.points.end());
            shownUntil.insert(shownUntil.end(), other.shownUntil.begin(), other.shownUntil.end());
        }
    };

    /// Sets the level up to which each point is shown.
    void setLevels()
    {
        const auto ownLevel = [&](std::size_t i) {
            return std::clamp(int(std::floor(std::log2(spacings[i] / tree.least_))), 0, kMostLevels);
        };
        shown.resize(positions.size());
        int top = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            shown[i] = std::uint8_t(ownLevel(i));
            top      = std::max(top, int(shown[i]));
        }
        tree.levels_ = top + kSpareLevels + 1;
        std::vector<std::vector<std::uint32_t>> own(std::size_t(tree.levels_));
        for (std::size_t i = 0; i < positions.size(); ++i) own[shown[i]].push_back(std::uint32_t(i));
        // Of the points that level m - 1 shows and that are closer than the cubes of level m, one per cube goes on.
        std::vector<std::uint32_t> going;
        for (int m = 1; m < tree.levels_; ++m) {
            const auto& joining = own[std::size_t(m - 1)];
            going.insert(going.end(), joining.begin(), joining.end());
            thin(positions, std::ldexp(tree.least_, m), going);
            for (const std::uint32_t i : going) shown[i] = std::uint8_t(m);
        }
    }

    /// Adds the node of a part of `order` and all below it. A large half is built by another thread, into a part of its
    /// own that then follows: the tree does not depend on the number of threads.
    void add(Part& part, std::size_t from, std::size_t to, unsigned threads)
    {
        Node   node{positions[order[from]], positions[order[from]], 0, 0, 0, 0, 0};
        double least = spacings[order[from]];
        for (std::size_t k = from; k < to; ++k) {
            const std::uint32_t i = order[k];
            node.low              = glm::min(node.low, positions[i]);
            node.high             = glm::max(node.high, positions[i]);
            node.ball             = std::max(node.ball, kBall * spacings[i]);
            node.level            = std::max(node.level, shown[i]);
            least                 = std::min(least, spacings[i]);
        }
        const glm::dvec3 size = node.high - node.low;
        if (to - from > kStacked && glm::length(size) < least) to = keepSome(from, to);
        const std::size_t here = part.nodes.size();
        part.nodes.push_back(node);
        if (to - from <= kLeaf) {
            part.nodes[here].first = std::uint32_t(part.points.size());
            part.nodes[here].count = std::uint16_t(to - from);
            for (std::size_t k = from; k < to; ++k) {
                const std::uint32_t i = order[k];
                part.points.push_back({positions[i], spacings[i], marks.empty() ? PointMark() : marks[i]});
                part.shownUntil.push_back(shown[i]);
            }
        } else {
            const int  axis   = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const auto middle = from + (to - from) / 2;
            const auto at     = [&](std::size_t k) { return order.begin() + std::ptrdiff_t(k); };
            std::nth_element(at(from), at(middle), at(to), [&](std::uint32_t a, std::uint32_t b) {
                const double x = positions[a][axis], y = positions[b][axis];
                return x != y ? x < y : a < b;
            });
            if (threads > 1 && to - from > kWorthAThread) {
                Part far;
                auto other = std::async(std::launch::async, [&] {
                    far.reserve(to - middle);
                    add(far, middle, to, threads / 2);
                });
                add(part, from, middle, threads - threads / 2);
                other.get();
                part.append(std::move(far));
            } else {
                add(part, from, middle, 1);
                add(part, middle, to, 1);
            }
        }
        part.nodes[here].next = std::uint32_t(part.nodes.size());
    }

    /// Keeps the points that are shown longest, and an even choice of the others; returns the new end.
    std::size_t keepSome(std::size_t from, std::size_t to)
    {
        const auto at = [&](std::size_t k) { return order.begin() + std::ptrdiff_t(k); };
        std::sort(at(from), at(to),
                  [&](std::uint32_t a, std::uint32_t b) { return shown[a] != shown[b] ? shown[a] > shown[b] : a < b; });
        const std::size_t count = to - from;
        for (std::size_t k = 1; k < kStacked; ++k) order[from + k] = order[from + k * count / kStacked];
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
    Builder builder{*this, positions, spacings, marks, {}, std::vector<std::uint32_t>(positions.size())};
    builder.setLevels();
    std::iota(builder.order.begin(), builder.order.end(), 0U);
    Builder::Part whole;
    whole.reserve(positions.size());
    builder.add(whole, 0, positions.size(), std::max(1U, std::thread::hardware_concurrency()));
    nodes_      = std::move(whole.nodes);
    points_     = std::move(whole.points);
    shownUntil_ = std::move(whole.shownUntil);
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
