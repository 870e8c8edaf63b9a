#include "engine/cloud/neighbour_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/cloud/detail/embree.h"
#include "engine/cloud/detail/point_block.h"
#include "engine/cloud/morton.h"
#include "engine/core/contract.h"
#include "engine/core/parallel.h"

// How floats give the answers of doubles
// --------------------------------------
// Positions are stored as floats in index units: relative to the middle of the cloud and scaled by a power of two.
// Subtracting and scaling in doubles costs one rounding of the result, so the cloud's distance from the origin does not
// matter. With u = 2^-24, the error of a float, a centre c and a point p at distance d, the error of the difference
// along an axis is at most u |c| from rounding c, u |p| <= u (|c| + |d|) from rounding p, and u |d| from subtracting;
// over three axes, with |c| the largest coordinate,
//
//     2 u (sqrt(3) |c| + d)  <  slack + 2^-23 d,    slack = 2^-22 |c|,
//
// and squaring and adding the floats adds 2^-22 d^2. So with radius r the points
//
//     float d^2 <= (r - slack)^2 (1 - 2^-20)   are certainly inside,
//     float d^2 >  (r + slack)^2 (1 + 2^-20)   are certainly outside,
//
// and the few between are decided in doubles from the caller's own positions.
//
// Where very many points lie within the slack of each other that would be all of them, for each search. So many points
// in one cell of the curve, which is as wide as the slack about them, have an index of their own, with index units of
// their size, and so on within it.

namespace palp {
namespace {

constexpr double kRounding = 0x1p-20; ///< [1] relative error of a squared distance in floats, with a reserve of two

/// Coordinates up to here are searched by floats [index units]. Further out floats could no longer tell the points of a
/// cloud apart; and squares stay far from overflow.
constexpr double kFloatReach = 0x1p20;

/// Least slack [index units]: keeps squares of floats far from underflow.
constexpr double kLeastSlack = 0x1p-60;

/// Largest scaling: in clouds of 1e-120 m even kLeastSlack must be a length whose square a double can hold, and in
/// clouds of 1e150 m, which kFloatReach then leaves to doubles alone, the whole extent.
constexpr int kMostScaling  = 400;
constexpr int kLeastScaling = -480;

/// Coordinate [index units] of the lanes that fill up the last block: outside every sphere, its square no overflow.
constexpr float kNowhere = 1e18F;

constexpr std::size_t kPiece = 50'000; ///< least points of a thread

/// As many points in one cell of the curve are a clump [1]. Fewer cost each search less than another tree; no cloud
/// that is about as dense everywhere has them.
constexpr std::uint32_t kClump = 256;

[[nodiscard]] double squaredDistance(const glm::dvec3& a, const glm::dvec3& b) noexcept
{
    const glm::dvec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

[[nodiscard]] double largest(const glm::dvec3& v) noexcept
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

[[nodiscard]] bool finite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

[[nodiscard]] std::string text(const glm::dvec3& v)
{
    return std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z);
}

/// Index units: (position - centre) scale, a power of two [1/m]. Nearly all points come to lie within [-1, 1], and all
/// within kFloatReach: a few strays, as scanners make them, must not cost the others their digits.
struct IndexFrame {
    glm::dvec3 centre{};  ///< [m] median of the points along each axis
    double     scale = 1; ///< [1/m]
    double     reach = 0; ///< [index units] largest coordinate of all points

    explicit IndexFrame(std::span<const glm::dvec3> positions)
    {
        constexpr std::size_t kSamples = 1000; // the quantiles below need no more
        constexpr double      kMost    = 0.9;  // quantile that strays do not reach
        const std::size_t     stride   = (positions.size() + kSamples - 1) / kSamples;

        double size = 0; // [m] twice the distance from the centre that most points keep
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> along;
            for (std::size_t i = 0; i < positions.size(); i += stride) along.push_back(positions[i][axis]);
            centre[axis] = quantile(along, 0.5);
            for (double& x : along) x = std::abs(x - centre[axis]);
            size = std::max(size, 2 * quantile(along, kMost));
        }
        double all = 0; // [m]
        for (const glm::dvec3& p : positions) all = std::max(all, largest(p - centre));
        size = std::max({size, 2 * all / kFloatReach, std::numeric_limits<double>::min()}); // which underflow makes 0
        if (all > 0) scale = std::ldexp(1.0, std::clamp(-std::ilogb(size) - 1, kLeastScaling, kMostScaling));
        reach = all * scale;
    }

    /// Returns true if floats serve to search around a place [index units].
    [[nodiscard]] bool searchable(const glm::dvec3& place) const noexcept
    {
        return reach <= kFloatReach && largest(place) <= kFloatReach;
    }

    [[nodiscard]] static double quantile(std::vector<double>& values, double share)
    {
        const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return *at;
    }

    [[nodiscard]] glm::dvec3 to(const glm::dvec3& position) const noexcept { return (position - centre) * scale; }

    /// Returns where a point [index units] comes along a curve: strays after all others, on one of their own with wider
    /// cells, so that an object that lies off is not one heap.
    [[nodiscard]] std::uint64_t code(const glm::dvec3& p) const noexcept
    {
        static_assert(kMortonCells <= 1 << 21, "three of them leave a bit");
        constexpr std::uint64_t kStray = std::uint64_t(1) << 63;
        const bool              stray  = largest(p) > 1;
        const glm::dvec3        in     = stray ? p / reach : p;
        return mortonCode(cell(in.x), cell(in.y), cell(in.z)) | (stray ? kStray : 0);
    }

    /// Returns the cell [1] of a coordinate from -1 to 1.
    [[nodiscard]] static std::uint32_t cell(double x) noexcept
    {
        return static_cast<std::uint32_t>(std::clamp((x + 1) * (0.5 * kMortonCells), 0.0, kMortonCells - 1.0));
    }
};

/// Returns a radius [m] that holds k points of a surface nearly always: k and twice the square root of k, the standard
/// deviation if the points are random. It is a first guess, which is checked.
[[nodiscard]] double likelyRadius(std::size_t k, double spacing) noexcept
{
    const double points = double(k) + 2 * std::sqrt(double(k)) + 2;
    return spacing * std::sqrt(points / std::numbers::pi);
}

/// Points along the Morton curve.
struct CurveOrder {
    struct Cell {
        std::size_t begin = 0, end = 0; ///< in `points`
    };
    std::vector<std::uint32_t> points; ///< equal codes by rising index
    std::vector<Cell>          clumps; ///< cells of at least kClump points
};

[[nodiscard]] CurveOrder mortonOrder(std::span<const glm::dvec3> positions, const IndexFrame& frame)
{
    struct Key {
        std::uint64_t code;
        std::uint32_t point;
        bool operator<(const Key& b) const noexcept { return code != b.code ? code < b.code : point < b.point; }
    };
    std::vector<Key> keys(positions.size());
    inParallel(positions.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            keys[i] = {frame.code(frame.to(positions[i])), static_cast<std::uint32_t>(i)};
        }
    });
    if (!std::is_sorted(keys.begin(), keys.end())) sortInParallel(keys);
    CurveOrder order;
    order.points.resize(keys.size());
    std::transform(keys.begin(), keys.end(), order.points.begin(), [](const Key& key) { return key.point; });
    constexpr std::size_t kStep = kClump / 2; // a clump holds two points that are this far from each other
    for (std::size_t i = 0; i + kStep < keys.size(); i += kStep) {
        const std::uint64_t code = keys[i].code;
        if (code != keys[i + kStep].code) continue;
        const auto  isThere = [&](const Key& key) { return key.code == code; };
        std::size_t begin = i, end = i + kStep;
        while (begin > 0 && isThere(keys[begin - 1])) --begin;
        while (end < keys.size() && isThere(keys[end])) ++end;
        if (end - begin >= kClump) order.clumps.push_back({begin, end});
        i = std::max(i, (end - 1) / kStep * kStep); // the next one begins behind it
    }
    return order;
}

[[nodiscard]] std::vector<PointBlock> blocksOf(std::span<const glm::dvec3>    positions,
                                               std::span<const std::uint32_t> order, const IndexFrame& frame)
{
    std::vector<PointBlock> blocks((order.size() + kBlockPoints - 1) / kBlockPoints);
    inParallel(blocks.size() * kBlockPoints, kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slot = begin; slot < end; ++slot) {
            PointBlock& block = blocks[slot / kBlockPoints];
            const auto  lane  = slot % kBlockPoints;
            const bool  used  = slot < order.size();
            const auto  p     = used ? glm::vec3(frame.to(positions[order[slot]])) : glm::vec3(kNowhere);
            block.x[lane]     = p.x;
            block.y[lane]     = p.y;
            block.z[lane]     = p.z;
            block.point[lane] = used ? order[slot] : 0;
        }
    });
    return blocks;
}

[[nodiscard]] std::vector<BoxTree::Box> boxesOf(std::span<const PointBlock> blocks, std::size_t points)
{
    std::vector<BoxTree::Box> boxes(blocks.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const std::size_t used = std::min<std::size_t>(kBlockPoints, points - b * kBlockPoints);
        const auto        axis = [used](const float* v, float& low, float& high) {
            const auto [least, most] = std::minmax_element(v, v + used);
            low                      = *least;
            high                     = *most;
        };
        axis(blocks[b].x, boxes[b].low.x, boxes[b].high.x);
        axis(blocks[b].y, boxes[b].low.y, boxes[b].high.y);
        axis(blocks[b].z, boxes[b].low.z, boxes[b].high.z);
    }
    return boxes;
}

/// The sphere about a centre in index units, as floats see it.
class FloatSphere {
public:
    explicit FloatSphere(const glm::dvec3& centre) : centre_(centre), slack_(0x1p-22 * largest(centre) + kLeastSlack) {}

    [[nodiscard]] Shell shell(double radius) const noexcept
    {
        const double inner = radius - slack_;
        const double outer = radius + slack_;
        return {float(centre_.x), float(centre_.y), float(centre_.z),
                inner > 0 ? float(inner * inner * (1 - kRounding)) : -1.0F, float(outer * outer * (1 + kRounding))};
    }

    /// Returns the radius within which a search through boxes of floats misses no point.
    [[nodiscard]] float searchRadius(double radius) const noexcept
    {
        return float((radius + 2 * slack_) * (1 + kRounding));
    }

    /// Returns the largest distance of a point whose squared distance came out as this.
    [[nodiscard]] double largestDistance(float distance2) const noexcept
    {
        return std::sqrt(double(distance2)) * (1 + kRounding) + slack_;
    }

    [[nodiscard]] glm::vec3 centre() const noexcept { return glm::vec3(centre_); }

private:
    glm::dvec3 centre_;
    double     slack_;
};

/// The slots that may be among the k nearest, by distances of floats. Twice as many are kept as are needed before the
/// further half is dropped, so that each costs constant time on average.
class Candidates {
public:
    explicit Candidates(std::size_t k) : k_(k) { keys_.reserve(kWaiting * k); }

    void add(float distance2, std::uint32_t slot)
    {
        // Bits of floats that are not negative sort as the floats do.
        keys_.push_back(std::uint64_t(std::bit_cast<std::uint32_t>(distance2)) << 32 | slot);
    }

    [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }
    [[nodiscard]] bool        full() const noexcept { return keys_.size() >= full_; }

    void clear() noexcept { keys_.clear(); }

    /// Returns how many candidates have a squared distance, as floats measured it, of at most `inner2`.
    [[nodiscard]] std::size_t within(float inner2) const noexcept
    {
        return std::size_t(
            std::count_if(keys_.begin(), keys_.end(), [=](std::uint64_t key) { return distance2(key) <= inner2; }));
    }

    /// Drops the candidates that are certainly not among the k nearest of at least k.
    /// \return  radius [index units] that holds the k nearest candidates
    double prune(const FloatSphere& sphere)
    {
        const auto kth = keys_.begin() + std::ptrdiff_t(k_ - 1);
        std::nth_element(keys_.begin(), kth, keys_.end());
        const double radius = sphere.largestDistance(distance2(*kth));
        const float  outer2 = sphere.shell(radius).outer2;
        keys_.erase(std::partition(kth, keys_.end(), [&](std::uint64_t key) { return distance2(key) <= outer2; }),
                    keys_.end());
        full_ = std::max(full_, kWaiting * keys_.size()); // grows if many points are equally far
        return radius;
    }

    template <class Visit>
    void each(Visit&& visit) const
    {
        for (const std::uint64_t key : keys_) visit(static_cast<std::uint32_t>(key));
    }

private:
    static constexpr std::size_t kWaiting = 2; ///< candidates that wait for pruning, per neighbour wanted

    [[nodiscard]] static float distance2(std::uint64_t key) noexcept
    {
        return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
    }

    std::size_t                k_;
    std::size_t                full_ = kWaiting * k_;
    std::vector<std::uint64_t> keys_; ///< distance before slot
};

bool nearer(const Neighbour& a, const Neighbour& b) noexcept
{
    return a.distance != b.distance ? a.distance < b.distance : a.point < b.point;
}

/// Sorts by squared distance and index in linear time where the squared distances are evenly spread, as they are on a
/// surface, whose area grows with the square of the radius: a bucket for each then holds about one.
void sortByDistance(std::vector<Neighbour>& found)
{
    constexpr std::size_t kFew  = 32; // below it a comparison sort is as fast, measured
    const auto            most  = std::max_element(found.begin(), found.end(), nearer);
    const double          scale = found.size() < kFew ? 0 : double(found.size() - 1) / most->distance;
    if (!(scale > 0 && std::isfinite(scale))) return std::sort(found.begin(), found.end(), nearer);

    const auto bucketOf = [&](const Neighbour& n) {
        return std::min(found.size() - 1, std::size_t(n.distance * scale));
    };
    std::vector<std::uint32_t> end(found.size() + 1, 0); // of each bucket, once all are placed
    for (const Neighbour& n : found) ++end[bucketOf(n) + 1];
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Neighbour> sorted(found.size());
    for (const Neighbour& n : found) sorted[end[bucketOf(n)]++] = n;
    for (std::size_t bucket = 0, begin = 0; bucket < found.size(); begin = end[bucket++])
        if (end[bucket] > begin + 1)
            std::sort(sorted.begin() + std::ptrdiff_t(begin), sorted.begin() + end[bucket], nearer);
    found = std::move(sorted);
}

/// Keeps the k nearest.
/// \param found  any order; the k best stay, nearest first, equal distances by rising index
void keepNearest(std::vector<Neighbour>& found, std::size_t k)
{
    if (found.size() > 2 * k) {
        std::nth_element(found.begin(), found.begin() + std::ptrdiff_t(k), found.end(), nearer);
        found.resize(k);
    }
    sortByDistance(found);
    found.resize(k);
}

} // namespace

struct NeighbourIndex::Impl {
    /// Whole blocks of points so close together that the floats of the others do not tell them apart.
    struct Clump {
        std::uint32_t         firstBlock = 0, endBlock = 0;
        glm::dvec3            low{}, high{}; ///< [m]
        std::unique_ptr<Impl> index;         ///< its slots are those of the blocks; its points do not count
    };

    IndexFrame                 frame;
    std::vector<PointBlock>    blocks;
    std::vector<glm::dvec3>    exact;  ///< [m] the caller's positions in the order of the blocks
    std::vector<Clump>         clumps; ///< by rising block; usually there are none
    std::vector<std::uint32_t> boxes;  ///< what each box of the tree is: a block, or of a clump the first; if any are
    BoxTree                    tree;
    BlockFilter                filter  = blockFilters().front();
    double                     spacing = 0; ///< [m]

    Impl(std::span<const glm::dvec3> positions, const IndexFrame& indexFrame, std::span<const std::uint32_t> order,
         std::vector<Clump> clumpsInOrder, const BoxTree::Device& device)
        : frame(indexFrame), blocks(blocksOf(positions, order, frame)), clumps(std::move(clumpsInOrder)),
          tree(device, treeBoxes(positions.size()))
    {
        exact.reserve(order.size());
        for (const std::uint32_t point : order) exact.push_back(positions[point]);
    }

    [[nodiscard]] static std::unique_ptr<Impl> make(std::span<const glm::dvec3> positions,
                                                    const BoxTree::Device&      device);

    /// Makes the indices of clumps, and orders their points by them.
    [[nodiscard]] static std::vector<Clump> clumpsOf(std::span<const glm::dvec3> positions, const IndexFrame& frame,
                                                     CurveOrder& order, const BoxTree::Device& device);

    /// Returns the boxes of the blocks, with one for each clump, and notes which is which.
    [[nodiscard]] std::vector<BoxTree::Box> treeBoxes(std::size_t points);

    /// Returns the clump that begins with a block; null if that is a block like others.
    [[nodiscard]] const Clump* clumpAt(std::uint32_t block) const noexcept
    {
        const auto clump = std::ranges::lower_bound(clumps, block, {}, &Clump::firstBlock);
        return clump != clumps.end() && clump->firstBlock == block ? &*clump : nullptr;
    }

    /// Appends the slots, counted from `first`, within a radius [m], until there are more than `most`. Allocates only
    /// if the capacity does not suffice.
    void appendSlots(const glm::dvec3& centre, double radius, std::uint32_t first, std::size_t most,
                     std::vector<std::uint32_t>& slots) const;
    void appendClump(const Clump& clump, const glm::dvec3& centre, double radius, std::uint32_t first, std::size_t most,
                     std::vector<std::uint32_t>& slots) const;

    /// Adds to the `best`, at most k, a heap with the furthest in front; their distances are squared [m^2]. `first` is
    /// that of our slots among those of the whole index.
    void addNearest(const glm::dvec3& centre, std::size_t k, const Impl& whole, std::uint32_t first,
                    std::vector<Neighbour>& best) const;

    [[nodiscard]] std::uint32_t pointAt(std::size_t slot) const noexcept
    {
        return blocks[slot / kBlockPoints].point[slot % kBlockPoints];
    }

    /// Calls process(block numbers, search radius) for the blocks that reach into the sphere, a batch at a time, so
    /// that their way from memory overlaps with the walk through the tree. `process` may shrink the search radius.
    template <class Process>
    void eachBatch(const FloatSphere& sphere, double radius, Process&& process) const
    {
        constexpr std::size_t             kBatch     = 16; // measured: 8 to 32 make no difference
        constexpr std::size_t             kCacheLine = 64; // [B]
        std::array<std::uint32_t, kBatch> batch;           // each entry is written before it is read
        std::size_t                       count  = 0;
        float                             search = sphere.searchRadius(radius);
        tree.query(sphere.centre(), search, [&](std::uint32_t block, float& shrinking) {
            const auto* bytes = reinterpret_cast<const char*>(&blocks[block]);
            for (std::size_t line = 0; line < sizeof(PointBlock); line += kCacheLine) __builtin_prefetch(bytes + line);
            batch[count++] = block;
            if (count < kBatch) return;
            process(std::span<const std::uint32_t>(batch), shrinking);
            count = 0;
        });
        process(std::span<const std::uint32_t>(batch.data(), count), search);
    }

    /// Returns the sphere that floats can search; empty where they cannot tell places apart, and all points have to be
    /// measured in doubles.
    [[nodiscard]] std::optional<FloatSphere> sphereFor(const glm::dvec3& centre, double radius) const
    {
        PALP_EXPECT(finite(centre), "centre " + text(centre));
        PALP_EXPECT(radius >= 0, "radius " + std::to_string(radius) + " m");
        const glm::dvec3 place = frame.to(centre);
        if (frame.searchable(place) && radius * frame.scale <= kFloatReach) return FloatSphere(place);
        return {};
    }

    /// Calls visit(slot) for all points within a radius, one after the other.
    template <class Visit>
    void eachWithin(const glm::dvec3& centre, double radius, Visit&& visit) const
    {
        for (std::size_t slot = 0; slot < exact.size(); ++slot)
            if (squaredDistance(exact[slot], centre) <= radius * radius) visit(slot);
    }

    void gather(const FloatSphere& sphere, const glm::dvec3& centre, double radius,
                std::vector<std::uint32_t>& found) const;

    /// \param most  returns false if that many or fewer are not all, or if they lie in very many blocks
    bool gatherRanks(const FloatSphere& sphere, const glm::dvec3& centre, double radius, std::size_t most,
                     std::vector<std::uint32_t>& found) const;

    /// Fills `candidates` with at least the k nearest.
    /// \return  false unless all of them are within `start` [index units]
    [[nodiscard]] bool findCandidates(const FloatSphere& sphere, double start, std::size_t k,
                                      Candidates& candidates) const;
};

std::unique_ptr<NeighbourIndex::Impl> NeighbourIndex::Impl::make(std::span<const glm::dvec3> positions,
                                                                 const BoxTree::Device&      device)
{
    const IndexFrame frame(positions);
    CurveOrder       order = mortonOrder(positions, frame);
    auto             inner = clumpsOf(positions, frame, order, device);
    return std::make_unique<Impl>(positions, frame, order.points, std::move(inner), device);
}

std::vector<NeighbourIndex::Impl::Clump> NeighbourIndex::Impl::clumpsOf(std::span<const glm::dvec3> positions,
                                                                        const IndexFrame& frame, CurveOrder& order,
                                                                        const BoxTree::Device& device)
{
    std::vector<Clump>      clumps;
    std::vector<glm::dvec3> inner; // [m]
    for (const CurveOrder::Cell& cell : order.clumps) {
        const auto firstBlock = std::uint32_t((cell.begin + kBlockPoints - 1) / kBlockPoints);
        const auto endBlock   = std::uint32_t(cell.end / kBlockPoints);
        const auto begin      = order.points.begin() + std::ptrdiff_t(firstBlock) * kBlockPoints;
        const auto end        = order.points.begin() + std::ptrdiff_t(endBlock) * kBlockPoints;
        inner.clear();
        glm::dvec3 low(INFINITY), high(-INFINITY);
        for (auto point = begin; point != end; ++point) {
            inner.push_back(positions[*point]);
            low  = glm::min(low, inner.back());
            high = glm::max(high, inner.back());
        }
        // Points at one place cannot be told apart, nor can those closer than the finest index units.
        const double wide = std::max(1.0, largest(frame.to(inner.front())) > 1 ? frame.reach : 0);
        if (low == high || IndexFrame(inner).scale <= 2 * frame.scale / wide) continue;
        auto index = make(inner, device);

        std::vector<std::uint32_t> points(inner.size());
        for (std::size_t slot = 0; slot < points.size(); ++slot) points[slot] = begin[index->pointAt(slot)];
        std::ranges::copy(points, begin);
        clumps.push_back({firstBlock, endBlock, low, high, std::move(index)});
    }
    return clumps;
}

std::vector<BoxTree::Box> NeighbourIndex::Impl::treeBoxes(std::size_t points)
{
    std::vector<BoxTree::Box> ofBlocks = boxesOf(blocks, points), ofTree;
    if (clumps.empty()) return ofBlocks;
    for (std::uint32_t block = 0; block < blocks.size(); ++block) {
        boxes.push_back(block);
        ofTree.push_back(ofBlocks[block]);
        const Clump* clump = clumpAt(block);
        if (!clump) continue;
        for (; block + 1 < clump->endBlock; ++block) {
            ofTree.back().low  = glm::min(ofTree.back().low, ofBlocks[block + 1].low);
            ofTree.back().high = glm::max(ofTree.back().high, ofBlocks[block + 1].high);
        }
    }
    return ofTree;
}

void NeighbourIndex::Impl::appendSlots(const glm::dvec3& centre, double radius, std::uint32_t first, std::size_t most,
                                       std::vector<std::uint32_t>& slots) const
{
    const auto sphere = sphereFor(centre, radius);
    if (!sphere)
        return eachWithin(centre, radius, [&](std::size_t slot) { slots.push_back(first + std::uint32_t(slot)); });
    const Shell  shell   = sphere->shell(radius * frame.scale);
    const double radius2 = radius * radius;

    // Blocks wait until they are many, and come in rising order then: of all but huge balls so do the slots.
    std::array<std::uint32_t, 2048> waiting; // each entry is written before it is read
    std::size_t                     count  = 0;
    const auto                      append = [&] {
        std::sort(waiting.begin(), waiting.begin() + std::ptrdiff_t(count));
        for (std::size_t k = 0; k < count && slots.size() <= most; ++k) {
            if (const Clump* clump = clumpAt(waiting[k])) {
                appendClump(*clump, centre, radius, first, most, slots);
                continue;
            }
            const std::uint32_t from = waiting[k] * kBlockPoints;
            float               distance2[kBlockPoints];
            for (auto near = filter.measure(blocks[waiting[k]], shell, distance2); near != 0; near &= near - 1) {
                const auto lane = std::uint32_t(std::countr_zero(near));
                if (distance2[lane] <= shell.inner2 || squaredDistance(exact[from + lane], centre) <= radius2)
                    slots.push_back(first + from + lane);
            }
        }
        count = 0;
    };
    tree.query(sphere->centre(), sphere->searchRadius(radius * frame.scale), [&](std::uint32_t box, float& search) {
        waiting[count++] = boxes.empty() ? box : boxes[box];
        if (count == waiting.size()) append();
        if (slots.size() > most) search = 0;
    });
    append();
}

void NeighbourIndex::Impl::appendClump(const Clump& clump, const glm::dvec3& centre, double radius, std::uint32_t first,
                                       std::size_t most, std::vector<std::uint32_t>& slots) const
{
    constexpr double kRound  = 1e-12; // [1] more than the squares below round by
    const glm::dvec3 nearest = glm::clamp(centre, clump.low, clump.high);
    const glm::dvec3 away    = glm::max(glm::abs(centre - clump.low), glm::abs(centre - clump.high));
    const double     radius2 = radius * radius;
    if (squaredDistance(nearest, centre) * (1 - kRound) > radius2) return;
    first += clump.firstBlock * kBlockPoints;
    if (glm::dot(away, away) * (1 + kRound) > radius2)
        return clump.index->appendSlots(centre, radius, first, most, slots);
    const std::size_t room  = most < slots.size() ? 0 : most - slots.size(); // one more says that there are more
    const std::size_t count = std::min(clump.index->exact.size(), room + (room < SIZE_MAX));
    slots.resize(slots.size() + count);
    std::iota(slots.end() - std::ptrdiff_t(count), slots.end(), first);
}

void NeighbourIndex::Impl::addNearest(const glm::dvec3& centre, std::size_t k, const Impl& whole, std::uint32_t first,
                                      std::vector<Neighbour>& best) const
{
    const auto add = [&](std::size_t slot) {
        const Neighbour other{whole.pointAt(first + slot), squaredDistance(exact[slot], centre)};
        if (best.size() == k) {
            if (!nearer(other, best.front())) return;
            std::ranges::pop_heap(best, nearer);
            best.pop_back();
        }
        best.push_back(other);
        std::ranges::push_heap(best, nearer);
    };
    const auto bound = [&] { return best.size() < k ? double(INFINITY) : best.front().distance; };

    const glm::dvec3 place = frame.to(centre);
    if (!frame.searchable(place)) {
        for (std::size_t slot = 0; slot < exact.size(); ++slot) add(slot);
        return;
    }
    const FloatSphere sphere(place);
    const double      everything = 2 * (largest(place) + frame.reach); // sqrt(3) would do
    double            reach      = std::min(everything, std::sqrt(bound()) * frame.scale);
    Shell             shell      = sphere.shell(reach);
    tree.query(sphere.centre(), sphere.searchRadius(reach), [&](std::uint32_t box, float& search) {
        constexpr double    kRound = 1e-12; // [1] more than a square rounds by
        const std::uint32_t block  = boxes.empty() ? box : boxes[box];
        if (const Clump* clump = clumpAt(block)) {
            const glm::dvec3 nearest = glm::clamp(centre, clump->low, clump->high);
            if (squaredDistance(nearest, centre) * (1 - kRound) <= bound())
                clump->index->addNearest(centre, k, whole, first + block * kBlockPoints, best);
        } else {
            float distance2[kBlockPoints];
            for (auto near = filter.measure(blocks[block], shell, distance2); near != 0; near &= near - 1)
                add(std::size_t(block) * kBlockPoints + std::size_t(std::countr_zero(near)));
        }
        reach  = std::min(reach, std::sqrt(bound()) * frame.scale);
        shell  = sphere.shell(reach);
        search = std::min(search, sphere.searchRadius(reach));
    });
}

void NeighbourIndex::Impl::gather(const FloatSphere& sphere, const glm::dvec3& centre, double radius,
                                  std::vector<std::uint32_t>& found) const
{
    // Points are handed over some hundred at a time: growing a vector costs as much as filtering a block.
    std::array<std::uint32_t, 1024> points; // each entry is written before it is read
    std::size_t                     count    = 0;
    const auto                      handOver = [&] {
        found.insert(found.end(), points.begin(), points.begin() + std::ptrdiff_t(count));
        count = 0;
    };
    const Shell  shell   = sphere.shell(radius * frame.scale);
    const double radius2 = radius * radius;
    eachBatch(sphere, radius * frame.scale, [&](std::span<const std::uint32_t> numbers, float&) {
        for (const std::uint32_t number : numbers) {
            if (count + kBlockPoints > points.size()) handOver();
            std::uint32_t doubtful = 0;
            count += filter.gather(blocks[number], shell, points.data() + count, doubtful);
            for (; doubtful != 0; doubtful &= doubtful - 1) {
                const std::size_t slot = std::size_t(number) * kBlockPoints + std::size_t(std::countr_zero(doubtful));
                if (squaredDistance(exact[slot], centre) <= radius2) points[count++] = pointAt(slot);
            }
        }
    });
    handOver();
}

bool NeighbourIndex::Impl::gatherRanks(const FloatSphere& sphere, const glm::dvec3& centre, double radius,
                                       std::size_t most, std::vector<std::uint32_t>& found) const
{
    constexpr std::size_t   kFewPoints = 4; // in a block of a ball, if it has very many of them
    constexpr std::uint32_t kWhole     = 0xffffffff;
    const Shell             shell      = sphere.shell(radius * frame.scale);
    const double            radius2    = radius * radius;
    const auto              surely     = [&](float distance2) { return distance2 <= shell.inner2; };
    tree.query(sphere.centre(), sphere.searchRadius(radius * frame.scale), [&](std::uint32_t block, float& search) {
        found.push_back(block);
        if (found.size() > most / kFewPoints) search = 0;
    });
    if (found.size() > most / kFewPoints) return false;
    std::sort(found.begin(), found.end());
    // The blocks wait at the end of the room for all of their points: those of one never reach the next.
    const std::size_t blocksNear = found.size(), from = blocksNear * (kBlockPoints - 1);
    found.resize(blocksNear * kBlockPoints);
    std::copy_backward(found.begin(), found.begin() + std::ptrdiff_t(blocksNear), found.end());
    std::uint32_t* to = found.data();
    for (std::size_t k = 0; k < blocksNear; ++k) {
        const std::uint32_t number = found[from + k], first = number * kBlockPoints;
        float               distance2[kBlockPoints];
        std::uint32_t       inside = filter.measure(blocks[number], shell, distance2);
        if (inside == kWhole && std::all_of(distance2, distance2 + kBlockPoints, surely)) {
            for (std::uint32_t lane = 0; lane < kBlockPoints; ++lane) *to++ = first + lane;
            continue;
        }
        for (; inside != 0; inside &= inside - 1) {
            const auto lane = std::uint32_t(std::countr_zero(inside));
            if (surely(distance2[lane]) || squaredDistance(exact[first + lane], centre) <= radius2)
                *to++ = first + lane;
        }
    }
    found.resize(std::size_t(to - found.data()));
    return found.size() <= most;
}

bool NeighbourIndex::Impl::findCandidates(const FloatSphere& sphere, double start, std::size_t k,
                                          Candidates& candidates) const
{
    candidates.clear();
    Shell  shell = sphere.shell(start);
    double bound = start;
    eachBatch(sphere, start, [&](std::span<const std::uint32_t> numbers, float& search) {
        for (const std::uint32_t number : numbers) {
            float distance2[kBlockPoints];
            for (auto near = filter.measure(blocks[number], shell, distance2); near != 0; near &= near - 1) {
                const auto lane = std::uint32_t(std::countr_zero(near));
                candidates.add(distance2[lane], number * kBlockPoints + lane);
            }
        }
        if (!candidates.full()) return;
        bound  = std::min(bound, candidates.prune(sphere));
        shell  = sphere.shell(bound);
        search = std::min(search, sphere.searchRadius(bound));
    });
    // Usually the guess was good and nothing had to go: then it is enough that k are certainly within `start`.
    if (bound == start) return candidates.within(sphere.shell(start).inner2) >= k;
    return candidates.size() >= k && candidates.prune(sphere) <= start;
}

NeighbourIndex::NeighbourIndex(std::span<const glm::dvec3> positions)
{
    PALP_EXPECT(!positions.empty(), "an index needs at least one point");
    PALP_EXPECT(positions.size() <= std::numeric_limits<std::uint32_t>::max(),
                std::to_string(positions.size()) + " points do not fit 32-bit indices");
    const auto bad = std::find_if_not(positions.begin(), positions.end(), finite);
    PALP_EXPECT(bad == positions.end(), "point " + std::to_string(bad - positions.begin()) + " is not finite");

    impl_          = Impl::make(positions, BoxTree::newDevice());
    impl_->spacing = medianSixthDistance() * std::sqrt(std::numbers::pi / 6);
}

double NeighbourIndex::medianSixthDistance() const
{
    constexpr std::size_t kSamples    = 2000;
    constexpr std::size_t kNeighbours = 6;
    const auto&           points      = impl_->exact;
    if (points.size() <= kNeighbours) return 0;
    const std::size_t   samples = std::min(kSamples, points.size());
    std::vector<double> sixth;
    for (std::size_t s = 0; s < samples; ++s) {
        const std::size_t slot = s * points.size() / samples;
        // Equal points follow each other here. A search among very many of them would sort them all by index.
        const auto from = points.begin() + std::ptrdiff_t(std::min(slot, points.size() - 1 - kNeighbours));
        const bool coincide =
            std::all_of(from, from + kNeighbours + 1, [&](const auto& p) { return p == points[slot]; });
        sixth.push_back(coincide ? 0 : nearest(points[slot], kNeighbours + 1).back().distance); // itself is the first
    }
    const auto median = sixth.begin() + std::ptrdiff_t(samples / 2);
    std::nth_element(sixth.begin(), median, sixth.end());
    return *median;
}

NeighbourIndex::~NeighbourIndex()                                    = default;
NeighbourIndex::NeighbourIndex(NeighbourIndex&&) noexcept            = default;
NeighbourIndex& NeighbourIndex::operator=(NeighbourIndex&&) noexcept = default;

void NeighbourIndex::gather(const glm::dvec3& centre, double radius, std::vector<std::uint32_t>& found) const
{
    found.clear();
    const Impl& index = *impl_;
    if (const auto sphere = index.sphereFor(centre, radius)) {
        if (index.clumps.empty()) return index.gather(*sphere, centre, radius, found);
        index.appendSlots(centre, radius, 0, SIZE_MAX, found);
        for (std::uint32_t& slot : found) slot = index.pointAt(slot);
    } else
        index.eachWithin(centre, radius, [&](std::size_t slot) { found.push_back(index.pointAt(slot)); });
}

std::vector<std::uint32_t> NeighbourIndex::gather(const glm::dvec3& centre, double radius) const
{
    std::vector<std::uint32_t> found;
    gather(centre, radius, found);
    return found;
}

std::vector<Neighbour> NeighbourIndex::nearest(const glm::dvec3& centre, std::size_t k) const
{
    PALP_EXPECT(finite(centre), "centre " + text(centre));
    const Impl& index = *impl_;
    if (k == 0) return {};

    k = std::min(k, index.exact.size());
    std::vector<Neighbour> found;
    const auto             measure = [&](std::size_t slot) {
        found.push_back({index.pointAt(slot), squaredDistance(index.exact[slot], centre)}); // squared until sorted
    };
    const glm::dvec3 place = index.frame.to(centre);
    if (!index.clumps.empty()) {
        index.addNearest(centre, k, index, 0, found);
    } else if (index.frame.searchable(place)) {
        const FloatSphere sphere(place);
        Candidates        candidates(k);
        const double      everything = 2 * (largest(place) + index.frame.reach); // sqrt(3) would do
        const double      guess      = likelyRadius(k, spacing()) * index.frame.scale;
        if (!(guess > 0 && guess < everything && index.findCandidates(sphere, guess, k, candidates)))
            (void)index.findCandidates(sphere, everything, k, candidates);
        found.reserve(candidates.size());
        candidates.each(measure);
    } else {
        found.reserve(index.exact.size());
        for (std::size_t slot = 0; slot < index.exact.size(); ++slot) measure(slot);
    }
    keepNearest(found, k);
    for (Neighbour& neighbour : found) neighbour.distance = std::sqrt(neighbour.distance);
    return found;
}

std::size_t NeighbourIndex::size() const noexcept
{
    return impl_->exact.size();
}

std::vector<std::uint32_t> NeighbourIndex::pointsByRank() const
{
    std::vector<std::uint32_t> points(size());
    for (std::size_t rank = 0; rank < points.size(); ++rank) points[rank] = impl_->pointAt(rank);
    return points;
}

std::vector<std::uint32_t> NeighbourIndex::cubes(double side) const
{
    PALP_EXPECT(side > 0, "side " + std::to_string(side) + " m");
    constexpr int kMostHalvings = 21;                                      // of the cube that holds nearly all points
    const double  finest        = 2 / (kMortonCells * impl_->frame.scale); // [m]
    const int     level         = int(std::lround(std::clamp(std::log2(side / finest), 0.0, double(kMostHalvings))));
    std::vector<std::uint32_t> edges;
    glm::uvec3                 last{};
    for (std::size_t rank = 0; rank < size(); ++rank) {
        const glm::dvec3 p = impl_->frame.to(impl_->exact[rank]);
        const glm::uvec3 cube{IndexFrame::cell(p.x) >> level, IndexFrame::cell(p.y) >> level,
                              IndexFrame::cell(p.z) >> level};
        if (rank == 0 || cube != last || largest(p) > 1) edges.push_back(std::uint32_t(rank));
        last = cube;
    }
    edges.push_back(std::uint32_t(size()));
    return edges;
}

std::span<const glm::dvec3> NeighbourIndex::positionsByRank() const noexcept
{
    return impl_->exact;
}

void NeighbourIndex::gatherRanks(const glm::dvec3& centre, double radius, std::vector<std::uint32_t>& found) const
{
    (void)gatherRanks(centre, radius, SIZE_MAX, found);
}

bool NeighbourIndex::gatherRanks(const glm::dvec3& centre, double radius, std::size_t most,
                                 std::vector<std::uint32_t>& found) const
{
    found.clear();
    const Impl& index  = *impl_;
    const auto  sphere = index.sphereFor(centre, radius);
    if (sphere && index.clumps.empty()) return index.gatherRanks(*sphere, centre, radius, most, found);
    index.appendSlots(centre, radius, 0, most, found);
    if (found.size() > most) return false;
    if (!std::ranges::is_sorted(found)) std::ranges::sort(found);
    return true;
}

void NeighbourIndex::pointsOf(std::span<const std::uint32_t> ranks, std::vector<std::uint32_t>& points) const
{
    points.resize(ranks.size());
    for (std::size_t k = 0; k < ranks.size(); ++k) points[k] = impl_->pointAt(ranks[k]);
}

double NeighbourIndex::spacing() const noexcept
{
    return impl_->spacing;
}

} // namespace palp
