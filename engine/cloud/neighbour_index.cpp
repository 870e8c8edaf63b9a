#include "engine/cloud/neighbour_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "engine/cloud/embree.h"
#include "engine/cloud/morton.h"
#include "engine/cloud/point_block.h"
#include "engine/core/contract.h"

// How floats give the answers of doubles
// --------------------------------------
// Positions are stored as floats in index units: relative to the cloud's centre and scaled by a power of two to at most
// 1 along each axis. Subtracting and scaling in doubles is exact but for one rounding, so the offset of a cloud does not
// matter; only its size against its spacing does. For a centre c (largest coordinate |c|, index units) every rounding to
// float, of c, of the point and of their difference, is at most 2^-24 of its size, together below
// 2^-23 (|c| + 1) along an axis and below
//
//     slack = 2^-22 (|c| + 1)
//
// for a distance; squaring and adding the floats brings a relative error below 2^-21. So with radius r the points
//
//     float d^2 <= (r - slack)^2 (1 - 2^-20)   are certainly inside,
//     float d^2 >  (r + slack)^2 (1 + 2^-20)   are certainly outside,
//
// and the few between are decided in doubles from the caller's own positions.

namespace palp {
namespace {

constexpr double kRounding = 0x1p-20; ///< [1] relative error of a squared distance in floats, with a reserve of two

/// Beyond this [index units] floats cannot tell the points of a cloud apart any more, or squares might overflow.
constexpr double kFloatReach = 0x1p20;

/// Scaling stops here: below it, slack alone exceeds every distance whose square a double can hold.
constexpr int kMostScaling = 400;

/// Coordinate [index units] of the lanes that fill up the last block: outside every sphere, its square no overflow.
constexpr float kNowhere = 1e18F;

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

/// Index units: (position - centre) scale, a power of two [1/m], within [-1, 1].
struct IndexFrame {
    glm::dvec3 centre{};  ///< [m]
    double     scale = 1; ///< [1/m]

    explicit IndexFrame(std::span<const glm::dvec3> positions)
    {
        glm::dvec3 low  = positions.front();
        glm::dvec3 high = positions.front();
        for (const glm::dvec3& p : positions) {
            low  = glm::dvec3(std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z));
            high = glm::dvec3(std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z));
        }
        centre            = 0.5 * low + 0.5 * high;
        const double half = std::max(largest(high - centre), largest(low - centre));
        if (half > 0) scale = std::ldexp(1.0, std::min(-std::ilogb(half) - 1, kMostScaling));
    }

    [[nodiscard]] glm::dvec3 to(const glm::dvec3& position) const noexcept { return (position - centre) * scale; }
};

/// Order of the points along the Morton curve; equal codes by rising index.
[[nodiscard]] std::vector<std::uint32_t> mortonOrder(std::span<const glm::dvec3> positions, const IndexFrame& frame)
{
    struct Key {
        std::uint64_t code;
        std::uint32_t point;
        bool          operator<(const Key& b) const noexcept
        {
            return code != b.code ? code < b.code : point < b.point;
        }
    };
    const auto cell = [](double x) {
        return static_cast<std::uint32_t>(std::clamp((x + 1) * (0.5 * kMortonCells), 0.0, kMortonCells - 1.0));
    };
    std::vector<Key> keys(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 p = frame.to(positions[i]);
        keys[i]            = {mortonCode(cell(p.x), cell(p.y), cell(p.z)), static_cast<std::uint32_t>(i)};
    }
    if (!std::is_sorted(keys.begin(), keys.end())) std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& key) { return key.point; });
    return order;
}

[[nodiscard]] std::vector<PointBlock> blocksOf(std::span<const glm::dvec3> positions,
                                               std::span<const std::uint32_t> order, const IndexFrame& frame)
{
    std::vector<PointBlock> blocks((order.size() + kBlockPoints - 1) / kBlockPoints);
    for (std::size_t slot = 0; slot < blocks.size() * kBlockPoints; ++slot) {
        PointBlock& block = blocks[slot / kBlockPoints];
        const auto  lane  = slot % kBlockPoints;
        const bool  used  = slot < order.size();
        const auto  p     = used ? glm::vec3(frame.to(positions[order[slot]])) : glm::vec3(kNowhere);
        block.x[lane]     = p.x;
        block.y[lane]     = p.y;
        block.z[lane]     = p.z;
        block.point[lane] = used ? order[slot] : 0;
    }
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
    explicit FloatSphere(const glm::dvec3& centre) : centre_(centre), slack_(0x1p-22 * (largest(centre) + 1)) {}

    [[nodiscard]] Shell shell(double radius) const noexcept
    {
        const double inner = radius - slack_;
        const double outer = radius + slack_;
        return {float(centre_.x), float(centre_.y), float(centre_.z),
                inner > 0 ? float(inner * inner * (1 - kRounding)) : -1.0F, float(outer * outer * (1 + kRounding))};
    }

    /// Radius within which a search through boxes of floats misses no point.
    [[nodiscard]] float searchRadius(double radius) const noexcept
    {
        return float((radius + 2 * slack_) * (1 + kRounding));
    }

    [[nodiscard]] glm::vec3 centre() const noexcept { return glm::vec3(centre_); }

private:
    glm::dvec3 centre_;
    double     slack_;
};

/// The k best of all points offered, in amortised constant time for each: twice k wait before the worse half goes.
class BestSoFar {
public:
    explicit BestSoFar(std::size_t k) : k_(k) { candidates_.reserve(2 * k + kBlockPoints); }

    /// Nothing further away than this [m^2] can be among the k best.
    [[nodiscard]] double bound2() const noexcept { return bound2_; }

    void offer(double distance2, std::uint32_t point)
    {
        if (distance2 <= bound2_) candidates_.push_back({distance2, point});
    }

    /// \return whether the bound has shrunk
    bool prune()
    {
        if (candidates_.size() < 2 * k_) return false;
        const auto worst = candidates_.begin() + std::ptrdiff_t(k_ - 1);
        std::nth_element(candidates_.begin(), worst, candidates_.end());
        const bool shrunk = worst->distance2 < bound2_;
        bound2_           = worst->distance2;
        candidates_.resize(k_);
        return shrunk;
    }

    [[nodiscard]] std::vector<Neighbour> sorted()
    {
        const std::size_t count = std::min(k_, candidates_.size());
        std::partial_sort(candidates_.begin(), candidates_.begin() + std::ptrdiff_t(count), candidates_.end());
        std::vector<Neighbour> best(count);
        for (std::size_t i = 0; i < count; ++i) best[i] = {candidates_[i].point, std::sqrt(candidates_[i].distance2)};
        return best;
    }

private:
    struct Candidate {
        double        distance2; ///< [m^2]
        std::uint32_t point;
        bool          operator<(const Candidate& b) const noexcept
        {
            return distance2 != b.distance2 ? distance2 < b.distance2 : point < b.point;
        }
    };

    std::size_t            k_;
    double                 bound2_ = std::numeric_limits<double>::infinity();
    std::vector<Candidate> candidates_;
};

} // namespace

struct NeighbourIndex::Impl {
    IndexFrame              frame;
    std::vector<PointBlock> blocks;
    std::vector<glm::dvec3> exact; ///< [m] the caller's positions in the order of the blocks
    BoxTree                 tree;
    BlockFilter             filter  = fastestBlockFilter();
    double                  spacing = 0; ///< [m]

    Impl(std::span<const glm::dvec3> positions, const IndexFrame& indexFrame, std::span<const std::uint32_t> order)
        : frame(indexFrame), blocks(blocksOf(positions, order, frame)), tree(boxesOf(blocks, positions.size()))
    {
        exact.reserve(order.size());
        for (const std::uint32_t point : order) exact.push_back(positions[point]);
    }

    [[nodiscard]] std::uint32_t pointAt(std::size_t slot) const noexcept
    {
        return blocks[slot / kBlockPoints].point[slot % kBlockPoints];
    }

    /// Calls decide(slot) for every lane whose bit is set.
    template <class Decide>
    static void eachDoubtful(std::uint32_t block, std::uint32_t lanes, Decide&& decide)
    {
        for (; lanes != 0; lanes &= lanes - 1) decide(std::size_t(block) * kBlockPoints + std::size_t(std::countr_zero(lanes)));
    }
};

namespace {

/// Collects blocks while the tree is walked and filters them a batch at a time, so that a block's way from memory
/// overlaps with the walk; hands points over a batch at a time too, so that a vector need not grow for every block.
class GatherRun {
public:
    GatherRun(std::span<const PointBlock> blocks, std::span<const glm::dvec3> exact, BlockFilter filter,
              const glm::dvec3& centre, double radius, const Shell& shell, std::vector<std::uint32_t>& found)
        : blocks_(blocks), exact_(exact), filter_(filter), centre_(centre), radius2_(radius * radius), shell_(shell),
          found_(found)
    {}

    void add(std::uint32_t block)
    {
        const auto* lines = reinterpret_cast<const char*>(&blocks_[block]);
        for (std::size_t byte = 0; byte < sizeof(PointBlock); byte += kCacheLine) __builtin_prefetch(lines + byte);
        waiting_[waitingCount_++] = block;
        if (waitingCount_ == waiting_.size()) filterWaiting();
    }

    void finish()
    {
        filterWaiting();
        handOver();
    }

private:
    static constexpr std::size_t kCacheLine = 64; ///< [B]

    void filterWaiting()
    {
        for (std::size_t i = 0; i < waitingCount_; ++i) {
            const std::uint32_t number   = waiting_[i];
            const PointBlock&   block    = blocks_[number];
            std::uint32_t       doubtful = 0;
            count_ += filter_(block, shell_, points_.data() + count_, doubtful);
            for (; doubtful != 0; doubtful &= doubtful - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(doubtful));
                if (squaredDistance(exact_[std::size_t(number) * kBlockPoints + lane], centre_) <= radius2_)
                    points_[count_++] = block.point[lane];
            }
            if (count_ + kBlockPoints > points_.size()) handOver();
        }
        waitingCount_ = 0;
    }

    void handOver()
    {
        found_.insert(found_.end(), points_.begin(), points_.begin() + std::ptrdiff_t(count_));
        count_ = 0;
    }

    std::span<const PointBlock>         blocks_;
    std::span<const glm::dvec3>         exact_;
    BlockFilter                         filter_;
    glm::dvec3                          centre_;
    double                              radius2_;
    Shell                               shell_;
    std::vector<std::uint32_t>&         found_;
    std::array<std::uint32_t, 16>       waiting_; // left uninitialised, as points_: each entry is written before it is read
    std::size_t                         waitingCount_ = 0;
    std::array<std::uint32_t, 1024>     points_;
    std::size_t                         count_ = 0;
};

} // namespace

NeighbourIndex::NeighbourIndex(std::span<const glm::dvec3> positions)
{
    PALP_EXPECT(!positions.empty(), "an index needs at least one point");
    PALP_EXPECT(positions.size() <= std::numeric_limits<std::uint32_t>::max(),
                std::to_string(positions.size()) + " points do not fit 32-bit indices");
    const auto bad = std::find_if_not(positions.begin(), positions.end(), finite);
    PALP_EXPECT(bad == positions.end(), "point " + std::to_string(bad - positions.begin()) + " is not finite");

    const IndexFrame frame(positions);
    impl_ = std::make_unique<Impl>(positions, frame, mortonOrder(positions, frame));

    constexpr std::size_t kSamples    = 2000;
    constexpr std::size_t kNeighbours = 6;
    if (positions.size() <= kNeighbours) return;
    const std::size_t   samples = std::min(kSamples, positions.size());
    std::vector<double> sixth(samples);
    for (std::size_t s = 0; s < samples; ++s)
        sixth[s] = nearest(positions[s * positions.size() / samples], kNeighbours + 1).back().distance; // itself is first
    const auto median = sixth.begin() + std::ptrdiff_t(samples / 2);
    std::nth_element(sixth.begin(), median, sixth.end());
    impl_->spacing = *median * std::sqrt(std::numbers::pi / double(kNeighbours));
}

NeighbourIndex::~NeighbourIndex()                                    = default;
NeighbourIndex::NeighbourIndex(NeighbourIndex&&) noexcept            = default;
NeighbourIndex& NeighbourIndex::operator=(NeighbourIndex&&) noexcept = default;

void NeighbourIndex::gather(const glm::dvec3& centre, double radius, std::vector<std::uint32_t>& found) const
{
    PALP_EXPECT(finite(centre), "centre " + text(centre));
    PALP_EXPECT(radius >= 0, "radius " + std::to_string(radius) + " m");

    found.clear();
    const Impl&      index       = *impl_;
    const glm::dvec3 place       = index.frame.to(centre);
    const double     indexRadius = radius * index.frame.scale;
    if (!(largest(place) <= kFloatReach && indexRadius <= kFloatReach)) {
        for (std::size_t slot = 0; slot < index.exact.size(); ++slot)
            if (squaredDistance(index.exact[slot], centre) <= radius * radius) found.push_back(index.pointAt(slot));
        return;
    }
    const FloatSphere sphere(place);
    GatherRun run(index.blocks, index.exact, index.filter, centre, radius, sphere.shell(indexRadius), found);
    index.tree.query(sphere.centre(), sphere.searchRadius(indexRadius), [&run](std::uint32_t block, float&) { run.add(block); });
    run.finish();
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

    BestSoFar         best(std::min(k, index.exact.size()));
    const auto        offer = [&](std::size_t slot) {
        best.offer(squaredDistance(index.exact[slot], centre), index.pointAt(slot));
    };
    const glm::dvec3 place = index.frame.to(centre);
    if (!(largest(place) <= kFloatReach)) {
        for (std::size_t slot = 0; slot < index.exact.size(); ++slot) {
            offer(slot);
            best.prune();
        }
        return best.sorted();
    }
    const FloatSphere sphere(place);
    const double      everything = 2 * (largest(place) + 1); // sqrt(3) would do
    Shell             shell      = sphere.shell(everything);
    shell.inner2                 = -1; // every candidate's distance is wanted in doubles
    index.tree.query(sphere.centre(), sphere.searchRadius(everything), [&](std::uint32_t block, float& radius) {
        std::uint32_t certain[kBlockPoints];
        std::uint32_t doubtful = 0;
        index.filter(index.blocks[block], shell, certain, doubtful);
        Impl::eachDoubtful(block, doubtful, offer);
        if (!best.prune()) return;
        const double bound = std::sqrt(best.bound2()) * index.frame.scale;
        shell.outer2       = sphere.shell(bound).outer2;
        radius             = std::min(radius, sphere.searchRadius(bound));
    });
    return best.sorted();
}

std::size_t NeighbourIndex::size() const noexcept { return impl_->exact.size(); }

double NeighbourIndex::spacing() const noexcept { return impl_->spacing; }

} // namespace palp
