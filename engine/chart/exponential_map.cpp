#include "engine/chart/exponential_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <queue>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/point_grid.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

// Weight of an edge as long as its step, and of one across the way from the origin, over that of a short one along it
// [1]. Both are small, so that a prediction comes and goes gently while the origin slides; neither is zero, so that a
// point with a single neighbour has a weight.
constexpr double kLongest = 0.01, kAcross = 0.01;

void expectPiece(const glm::dvec3& origin, std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
                 std::span<const double> steps, double reach)
{
    constexpr double kTolerance = 1e-6; // [1] of the squared length: callers may have rounded to single precision
    const auto       finite     = [](const glm::dvec3& p) { return std::isfinite(p.x + p.y + p.z); };
    const auto       which      = [&](const char* what, std::size_t i) {
        return std::string(what) + " " + std::to_string(i) + " of " + std::to_string(positions.size());
    };
    PALP_EXPECT(finite(origin), "the origin is not finite");
    PALP_EXPECT(reach >= 0, "the reach is " + std::to_string(reach) + " m");
    PALP_EXPECT(normals.size() == positions.size() && steps.size() == positions.size(),
                std::to_string(positions.size()) + " positions, " + std::to_string(normals.size()) + " normals, " +
                    std::to_string(steps.size()) + " steps");
    PALP_EXPECT(positions.size() <= std::numeric_limits<std::uint32_t>::max(),
                std::to_string(positions.size()) + " points");
    for (std::size_t i = 0; i < positions.size(); ++i) {
        PALP_EXPECT(finite(positions[i]), which("position", i) + " is not finite");
        PALP_EXPECT(std::abs(glm::dot(normals[i], normals[i]) - 1) < kTolerance,
                    which("normal", i) + " has length " + std::to_string(glm::length(normals[i])) + ", not 1");
        PALP_EXPECT(std::isfinite(steps[i]) && steps[i] >= 0,
                    which("step", i) + " is " + std::to_string(steps[i]) + " m");
    }
}

/// The neighbours of each point: those that the longer of the two steps spans.
class Neighbours {
public:
    Neighbours(std::span<const glm::dvec3> positions, std::span<const double> steps)
    {
        double mean = 0; // [m]
        for (const double step : steps) mean += step / double(steps.size());
        // Where a surface lies across all axes, one cube in sixteen or more has a point.
        const int along = std::clamp(int(std::cbrt(16.0 * double(positions.size()))), 32, 1000);
        PointGrid grid;
        grid.build(positions, mean, along);

        // Each point finds those within its own step. Where that of the other is shorter, the other does not find it.
        constexpr std::size_t kUsual = 13; // points of a disc of two spacings
        Pairs                 oneSided;
        begin_.reserve(positions.size() + 1);
        found_.reserve((kUsual + 3) * positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const std::size_t begin = found_.size();
            begin_.push_back(std::uint32_t(begin));
            grid.findNear(positions[i], steps[i], found_);
            for (std::size_t k = begin; k < found_.size(); ++k) {
                const std::uint32_t j = found_[k];
                if (steps[j] < steps[i] && !within(positions[i], positions[j], steps[j])) oneSided.emplace_back(j, i);
            }
        }
        begin_.push_back(std::uint32_t(found_.size()));
        if (!oneSided.empty()) insert(oneSided);
    }

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t i) const
    {
        return {found_.data() + begin_[i], found_.data() + begin_[i + 1]};
    }

private:
    using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

    [[nodiscard]] static bool within(const glm::dvec3& a, const glm::dvec3& b, double radius)
    {
        const glm::dvec3 d = a - b;
        return d.x * d.x + d.y * d.y + d.z * d.z <= radius * radius;
    }

    /// Adds the second of each pair to the list of the first.
    void insert(Pairs& pairs)
    {
        std::ranges::sort(pairs);
        std::vector<std::uint32_t> all;
        all.reserve(found_.size() + pairs.size());
        auto next = pairs.begin();
        for (std::size_t i = 0; i + 1 < begin_.size(); ++i) {
            const auto own = of(i);
            begin_[i]      = std::uint32_t(all.size());
            all.insert(all.end(), own.begin(), own.end());
            for (; next != pairs.end() && next->first == i; ++next) all.push_back(next->second);
        }
        begin_.back() = std::uint32_t(all.size());
        found_        = std::move(all);
    }

    std::vector<std::uint32_t> begin_; ///< of each point's list in found_, and the end of the last
    std::vector<std::uint32_t> found_;
};

/// A point that has its place in the chart.
struct Site {
    glm::dvec3 place; ///< [m]
    Frame      frame; ///< carried from the origin
    ChartPoint chart;
};

/// What a site tells a neighbour.
struct Prediction {
    ChartPoint edge; ///< from the site, in the chart [m]
    glm::dvec3 east; ///< [1] of the neighbour's frame
};

/// Returns (arc / chord - 1) / (4 s^2) for s the sine of half the arc's angle, with s^2 <= 1/2: the series of
/// asin(s) / s, whose first term omitted is 1e-3 of the arc at a right angle and 1e-7 at half a radian.
double arcOverChord(double s2)
{
    return 0.25 * (1.0 / 6 + s2 * (3.0 / 40 + s2 * (15.0 / 336 + s2 * (105.0 / 3456))));
}

/// Half way along the edge the normal is m = (n0 + n1) / |n0 + n1|. The frame carried there, without twisting, sees the
/// edge as (x, z); and sees the change of the normal n1 - n0, which is square to m, as `bend`. The component along the
/// bend is the chord of an arc and becomes the arc; on a cylinder that is exact.
/// \param cosine  n0 . n1, > 0
Prediction predict(const Site& site, const glm::dvec3& place, const glm::dvec3& normal, double cosine)
{
    const glm::dvec3 edge     = place - site.place;
    const double     eastward = glm::dot(site.frame.east, normal), northward = glm::dot(site.frame.north, normal);
    const double     sum  = std::sqrt(2 * (1 + cosine)); // |n0 + n1|, twice the cosine of the half angle
    const double     over = 1 / (sum * (1 + sum / 2)), overSum = over * (1 + sum / 2);
    const double     rise = glm::dot(site.frame.normal, edge);
    const double     tilt = (rise + (rise + glm::dot(normal, edge)) * overSum) * over;
    const double     x    = glm::dot(site.frame.east, edge) - tilt * eastward;
    const double     z    = glm::dot(site.frame.north, edge) - tilt * northward;

    const double bendX = 2 * overSum * eastward, bendZ = 2 * overSum * northward;
    const double longer = arcOverChord((1 - cosine) / 2) * (x * bendX + z * bendZ);
    return {{x + longer * bendX, z + longer * bendZ}, site.frame.east - overSum * bendX * (site.frame.normal + normal)};
}

/// The weighted sum of the predictions of a point.
struct Estimate {
    double     weight = 0;
    ChartPoint chart; ///< [m]
    glm::dvec3 east{};

    [[nodiscard]] ChartPoint place() const { return {chart.x / weight, chart.z / weight}; }
};

/// A point, with all that a prediction needs in two lines of cache.
struct alignas(64) Node {
    glm::dvec3 place;  ///< [m]
    glm::dvec3 normal; ///< [1]
    double     step;   ///< [m]
    Estimate   estimate;
    bool       placed = false; ///< it has its place in the chart
};

/// Returns what a prediction counts [1]: less the longer its edge is, and less across the way from the origin.
double weightOf(const ChartPoint& edge, const ChartPoint& at, double step2)
{
    const double length2 = edge.x * edge.x + edge.z * edge.z, all2 = length2 * (at.x * at.x + at.z * at.z);
    const double along = at.x * edge.x + at.z * edge.z;
    if (!(all2 * step2 > 0)) return 1; // a repeated point, or the origin itself
    const double rest = step2 - (1 - kLongest) * std::min(length2, step2);
    return rest * (kAcross * all2 + along * along) / (step2 * all2);
}

/// The search from the origin outwards.
class Front {
public:
    Front(std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals, std::span<const double> steps)
    {
        nodes_.reserve(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) nodes_.push_back({positions[i], normals[i], steps[i], {}});
    }

    /// Lets a site predict the place of a point, unless that has one.
    /// \param siteStep  [m]
    void tell(const Site& site, double siteStep, std::size_t to)
    {
        Node& node = nodes_[to];
        if (node.placed) return;
        const double cosine = glm::dot(site.frame.normal, node.normal);
        if (cosine <= 0) return;
        const auto [edge, east] = predict(site, node.place, node.normal, cosine);
        const ChartPoint at{site.chart.x + edge.x, site.chart.z + edge.z};
        const double     step = std::max(siteStep, node.step);

        Estimate& estimate = node.estimate;
        if (estimate.weight > 0) {
            // Where two ways around an object meet, the shorter one came first.
            const double offX = estimate.weight * at.x - estimate.chart.x;
            const double offZ = estimate.weight * at.z - estimate.chart.z, most = estimate.weight * step;
            if (offX * offX + offZ * offZ > most * most || glm::dot(east, estimate.east) <= 0) return;
        } else {
            queue_.push({std::sqrt(at.x * at.x + at.z * at.z), std::uint32_t(to)});
        }
        const double weight = weightOf(edge, at, step * step);
        estimate.weight += weight;
        estimate.chart.x += weight * at.x;
        estimate.chart.z += weight * at.z;
        estimate.east += weight * east;
    }

    /// Returns the next point whose neighbours nearer to the origin have told it all; of equally far ones the first.
    [[nodiscard]] std::optional<std::size_t> next()
    {
        if (queue_.empty()) return {};
        const std::size_t i = queue_.top().point;
        queue_.pop();
        return i;
    }

    /// Returns whether a point has a prediction.
    [[nodiscard]] bool hasHeard(std::size_t i) const { return nodes_[i].estimate.weight > 0; }

    /// Keeps the place of a point as it is.
    void keep(std::size_t i) { nodes_[i].placed = true; }

    /// Returns such a point at the mean of its predictions.
    [[nodiscard]] Site siteOf(std::size_t i) const
    {
        const Node&      node = nodes_[i];
        const glm::dvec3 sum  = node.estimate.east;
        const glm::dvec3 east = glm::normalize(sum - glm::dot(node.normal, sum) * node.normal);
        return {node.place, {node.normal, east, glm::cross(node.normal, east)}, node.estimate.place()};
    }

private:
    struct Entry {
        double        distance; ///< of the first prediction [m]
        std::uint32_t point;
    };

    struct IsLater {
        bool operator()(const Entry& a, const Entry& b) const noexcept
        {
            return a.distance > b.distance || (a.distance == b.distance && a.point > b.point);
        }
    };

    std::vector<Node>                                       nodes_;
    std::priority_queue<Entry, std::vector<Entry>, IsLater> queue_;
};

/// Lets the origin predict the places of its neighbours.
void begin(Front& front, const Site& origin, std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
           std::span<const double> steps)
{
    const auto distance2 = [&](std::size_t i) {
        const glm::dvec3 d = positions[i] - origin.place;
        return glm::dot(d, d);
    };
    double      least2  = std::numeric_limits<double>::infinity();
    std::size_t nearest = positions.size();
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (distance2(i) < least2 && glm::dot(normals[i], origin.frame.normal) > 0) {
            least2  = distance2(i);
            nearest = i;
        }
    if (nearest == positions.size()) return;

    const double step = std::max(steps[nearest], std::sqrt(least2)); // [m]
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double longer = std::max(step, steps[i]);
        if (i == nearest || distance2(i) <= longer * longer) front.tell(origin, step, i);
    }
}

} // namespace

std::vector<std::optional<ChartPoint>> exponentialMap(const glm::dvec3& origin, const Frame& frame,
                                                      std::span<const glm::dvec3> positions,
                                                      std::span<const glm::dvec3> normals,
                                                      std::span<const double> steps, double reach, double careful)
{
    PALP_EXPECT(careful >= 0, "the careful square's half side is " + std::to_string(careful) + " m");
    expectPiece(origin, positions, normals, steps, reach);
    std::vector<std::optional<ChartPoint>> chart(positions.size());
    if (positions.empty()) return chart;

    const Neighbours neighbours(positions, steps);
    Front            front(positions, normals, steps);
    begin(front, {origin, frame, {}}, positions, normals, steps);
    while (const auto i = front.next()) {
        const Site site = front.siteOf(*i);
        if (std::hypot(site.chart.x, site.chart.z) > reach) continue;
        chart[*i] = site.chart;
        front.keep(*i);
        const bool outside = std::max(std::abs(site.chart.x), std::abs(site.chart.z)) > careful;
        for (const std::uint32_t j : neighbours.of(*i))
            if (!outside || !front.hasHeard(j)) front.tell(site, steps[*i], j);
    }
    return chart;
}

} // namespace palp
