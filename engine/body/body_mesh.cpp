#include "engine/body/body_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/body/detail/flat_fit.h"
#include "engine/cloud/coarse_object.h"
#include "engine/cloud/surface_links.h"

namespace palp {
namespace {

constexpr std::uint32_t kNone   = std::numeric_limits<std::uint32_t>::max();
constexpr double        kIsHeld = 0.5; ///< share of a point from which on it is held [1]
constexpr double        kPoints = 1.5; ///< least spacing of nodes, in spacings of the points [1]
constexpr double kDensity       = 0.7; ///< nodes to a square of their spacing, of a random choice with no room left [1]

/// A vector that a point lies outwards along, and how far beyond it the border is.
struct Outline {
    std::uint32_t rank = 0;
    glm::dvec3    outwards{}; ///< [m]
};

class Making {
public:
    Making(const SoftObject& object, std::size_t most) : object_(object), places_(object.index().positionsByRank())
    {
        pointOf_ = object.index().pointsByRank();
        isHeld_.resize(places_.size());
        double area = 0;
        for (std::uint32_t rank = 0; rank < places_.size(); ++rank) {
            isHeld_[rank] = !object.held().empty() && object.held()[pointOf_[rank]] >= kIsHeld;
            if (!isHeld_[rank]) area += spacingOf(rank) * spacingOf(rank);
        }
        mesh_.spacing = std::max(std::sqrt(kDensity * area / double(most)), kPoints * object.spacing());
        std::vector<std::uint32_t> all(places_.size());
        for (std::uint32_t rank = 0; rank < all.size(); ++rank) all[rank] = rank;
        object.links().prepare(all);
        joinLinks();
        reached_.assign(places_.size(), 0);
        nodeAt_.assign(places_.size(), kNone);
        nearest_.assign(places_.size(), {kNone, std::numeric_limits<double>::infinity()});
    }

    BodyMesh made()
    {
        chooseNodes();
        for (std::uint32_t rank = 0; rank < places_.size(); ++rank)
            if (nearest_[rank].first != kNone) addRigidity(rank, nearest_[rank].first);
        for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) mesh_.nodes[n].rigidity = std::exp(ln_[n] / count_[n]);
        findTriangles();
        evenOut();
        return std::move(mesh_);
    }

private:
    [[nodiscard]] double spacingOf(std::uint32_t rank) const { return object_.survey().spacingOfRank(rank); }

    /// Makes each step one that leads back as well.
    void joinLinks()
    {
        links_.resize(places_.size());
        for (std::uint32_t rank = 0; rank < places_.size(); ++rank)
            for (const std::uint32_t to : object_.links().from(rank)) {
                links_[rank].push_back(to);
                links_[to].push_back(rank);
            }
        for (auto& of : links_) {
            std::ranges::sort(of);
            of.erase(std::ranges::unique(of).begin(), of.end());
        }
    }

    /// Calls visit(rank, distance [m]) for the points that steps along the surface lead to within a radius [m] of one,
    /// itself among them, without leaving what is held or entering it.
    template <class Visit>
    void eachAlong(std::uint32_t from, double radius, const Visit& visit)
    {
        ++round_;
        queue_.assign(1, from);
        reached_[from] = round_;
        for (std::size_t k = 0; k < queue_.size(); ++k) {
            const std::uint32_t rank = queue_[k];
            visit(rank, glm::length(places_[rank] - places_[from]));
            for (const std::uint32_t next : links_[rank]) {
                if (reached_[next] == round_ || isHeld_[next] != isHeld_[from]) continue;
                if (glm::length(places_[next] - places_[from]) > radius) continue;
                reached_[next] = round_;
                queue_.push_back(next);
            }
        }
    }

    /// Returns how far and where to what is held begins from a point that is beside it [m]: half way between the points
    /// that are held and those that are not; nothing elsewhere.
    [[nodiscard]] std::optional<glm::dvec3> towardsHeld(std::uint32_t rank) const
    {
        constexpr double kBeside = 1.5, kWide = 0.75; // [spacings]
        glm::dvec3       sum{};
        glm::dvec3       nearest{};
        double           least = kBeside * spacingOf(rank); // [m]
        for (const std::uint32_t next : links_[rank]) {
            const glm::dvec3 d      = places_[next] - places_[rank];
            const double     length = glm::length(d);
            if (!isHeld_[next] || !(length > 0 && length < kBeside * spacingOf(rank))) continue;
            sum += d / length;
            if (length < least) nearest = d;
            least = std::min(least, length);
        }
        if (nearest == glm::dvec3(0)) return {};
        constexpr double kOneSided = 0.1; // of a strip between two supports the nearest says which [1]
        const glm::dvec3 out       = glm::normalize(glm::length(sum) > kOneSided ? sum : nearest);
        double           free = 0, held = kBeside * spacingOf(rank); // how far they reach, and from where [m]
        for (const std::uint32_t next : links_[rank]) {
            const glm::dvec3 d     = places_[next] - places_[rank];
            const double     along = glm::dot(d, out);
            if (glm::length(d - along * out) > kWide * spacingOf(rank)) continue;
            (isHeld_[next] ? held : free) = isHeld_[next] ? std::clamp(along, 0.0, held) : std::max(free, along);
        }
        return (free + held) / 2 * out;
    }

    /// Returns how far and where to the border lies from a point of the object's rim [m]; nothing elsewhere: where a
    /// third of the directions has no point.
    [[nodiscard]] std::optional<glm::dvec3> towardsBorder(std::uint32_t rank)
    {
        constexpr double kReach = 2.5, kGap = 2 * std::numbers::pi / 3, kBeyond = 0.5,
                         kWide          = 0.75; // [spacings], [rad]
        const double            spacing = spacingOf(rank);
        const FlatFrame         frame   = FlatFrame::about(places_[rank], object_.survey().normalOfRank(rank));
        std::vector<glm::dvec2> around;
        eachAlong(rank, kReach * spacing, [&](std::uint32_t next, double) {
            if (next != rank) around.push_back(frame.laid(places_[next]));
        });
        if (around.size() < 2) return {};
        std::vector<double> angles;
        for (const glm::dvec2& p : around) angles.push_back(std::atan2(p.y, p.x));
        std::ranges::sort(angles);
        double gap = angles.front() + 2 * std::numbers::pi - angles.back(), middle = angles.back() + gap / 2;
        for (std::size_t k = 0; k + 1 < angles.size(); ++k)
            if (angles[k + 1] - angles[k] > gap) {
                gap    = angles[k + 1] - angles[k];
                middle = angles[k] + gap / 2;
            }
        if (gap < kGap) return {};
        const glm::dvec2 out{std::cos(middle), std::sin(middle)};
        double           farthest = 0; // of the points beside it
        for (const glm::dvec2& p : around)
            if (std::abs(p.x * out.y - p.y * out.x) < kWide * spacing) farthest = std::max(farthest, glm::dot(p, out));
        return frame.lifted((farthest + kBeyond * spacing) * out);
    }

    /// Returns the way from a point to the border as those around have it: a parabola along the border. What is held
    /// would else be held as far as its points reach out: a bowl on a stem of 8 mm was 3 % too stiff by that.
    [[nodiscard]] glm::dvec3 smoothed(const Outline& of, std::span<const Outline> outline) const
    {
        if (!(glm::length(of.outwards) > 0)) return of.outwards;
        constexpr double kReach = 2.5, kAlike = 0.5; // [spacings of points]; cosine of 60 degrees [1]
        const double     radius = std::max(kReach * spacingOf(of.rank), 1.5 * mesh_.spacing);
        const glm::dvec3 out    = glm::normalize(of.outwards);
        const glm::dvec3 along  = glm::cross(out, object_.survey().normalOfRank(of.rank));
        CurveFit         fit;
        for (const Outline& other : outline) {
            const glm::dvec3 d  = places_[other.rank] + other.outwards - places_[of.rank];
            const double     d2 = glm::dot(d, d) / (radius * radius);
            if (!(d2 < 1) || glm::dot(other.outwards, out) < kAlike * glm::length(other.outwards)) continue;
            fit.add(glm::dot(d, along) / radius, glm::dot(d, out), (1 - d2) * (1 - d2));
        }
        return fit.atMiddle().value_or(glm::length(of.outwards)) * out;
    }

    void chooseNodes()
    {
        std::vector<Outline>       held, free;
        std::vector<std::uint32_t> rest;
        for (std::uint32_t rank = 0; rank < places_.size(); ++rank) {
            if (isHeld_[rank]) continue;
            if (const auto out = towardsHeld(rank))
                held.push_back({rank, *out});
            else if (const auto beyond = towardsBorder(rank))
                free.push_back({rank, *beyond});
            else
                rest.push_back(rank);
        }
        for (const Outline& of : shuffled(held))
            if (hasRoom(of.rank)) add(of.rank, smoothed(of, held), true, true);
        for (const Outline& of : shuffled(free))
            if (hasRoom(of.rank)) add(of.rank, smoothed(of, free), true, false);
        for (const std::uint32_t rank : shuffled(rest))
            if (hasRoom(rank)) add(rank, {}, false, false);
    }

    /// Returns them in an order that leads nowhere, always the same.
    template <class Value>
    [[nodiscard]] static std::vector<Value> shuffled(const std::vector<Value>& values)
    {
        std::vector<std::pair<std::uint32_t, std::size_t>> order;
        for (std::size_t k = 0; k < values.size(); ++k)
            order.emplace_back((std::uint32_t(k) ^ 0x9e3779b9U) * 2654435769U, k);
        std::ranges::sort(order);
        std::vector<Value> result;
        for (const auto& [key, k] : order) result.push_back(values[k]);
        return result;
    }

    /// Returns whether no node is near a point, so that it may become one.
    [[nodiscard]] bool hasRoom(std::uint32_t rank) const
    {
        return nearest_[rank].second >= mesh_.spacing && glm::length(object_.survey().normalOfRank(rank)) > 0;
    }

    void add(std::uint32_t rank, const glm::dvec3& outwards, bool outline, bool held)
    {
        const auto              node = std::uint32_t(mesh_.nodes.size());
        std::vector<glm::dvec3> around;
        const FlatFrame         frame   = FlatFrame::about(places_[rank], object_.survey().normalOfRank(rank));
        constexpr double        kWide   = 2.5; // spacings of the points that a fit reaches at least [1]
        const double            reach   = std::max(kWide * spacingOf(rank), mesh_.spacing / 2);
        constexpr double        kCovers = 2; // spacings of nodes that the points of a node lie within [1]
        eachAlong(rank, std::max(reach, kCovers * mesh_.spacing), [&](std::uint32_t next, double distance) {
            if (distance < nearest_[next].second) nearest_[next] = {node, distance};
            if (distance < reach) around.push_back(places_[next]);
        });
        nodeAt_[rank] = node;
        rankOf_.push_back(rank);
        fits_.push_back(flatFit(frame, around, reach));
        mesh_.nodes.push_back({fits_.back().place({}) + outwards, fits_.back().normal({}), 0, held});
        isFixed_.push_back(outline);
        ln_.push_back(0);
        count_.push_back(0);
        addRigidity(rank, node);
        nearest_[rank] = {kNone, 0}; // counted
    }

    void addRigidity(std::uint32_t rank, std::uint32_t node)
    {
        ln_[node] += std::log(object_.rigidity(pointOf_[rank]));
        ++count_[node];
    }

    void findTriangles()
    {
        // A circle without a node within is no wider than a spacing of these, and what points leave between them.
        constexpr double                                  kReach = 2.1, kWidest = 1.4; // [such circles' radii]
        const double                                      widest = mesh_.spacing + object_.spacing(); // [m]
        std::map<std::array<std::uint32_t, 3>, int>       votes;
        std::vector<std::pair<std::uint32_t, glm::dvec2>> around;
        for (std::uint32_t node = 0; node < mesh_.nodes.size(); ++node) {
            const FlatFrame frame = FlatFrame::about(mesh_.nodes[node].place, mesh_.nodes[node].normal);
            around.clear();
            eachAlong(rankOf_[node], kReach * kWidest * widest, [&](std::uint32_t rank, double) {
                if (nodeAt_[rank] != kNone && nodeAt_[rank] != node)
                    around.emplace_back(nodeAt_[rank], frame.unrolled(mesh_.nodes[nodeAt_[rank]].place));
            });
            eachOfStar(around, kWidest * widest, [&](std::uint32_t a, std::uint32_t b) {
                std::array<std::uint32_t, 3> corners{node, a, b};
                std::ranges::sort(corners);
                ++votes[corners];
            });
        }
        for (const auto& [corners, count] : votes) mesh_.triangles.push_back({corners, count / 3.0});
    }

    /// Moves nodes along the surface to the middle of their neighbours, so that triangles are less slender.
    void evenOut()
    {
        constexpr int           kTimes = 3;
        std::vector<glm::dvec3> sums(mesh_.nodes.size());
        std::vector<double>     counts(mesh_.nodes.size());
        for (int time = 0; time < kTimes; ++time) {
            std::ranges::fill(sums, glm::dvec3(0));
            std::ranges::fill(counts, 0.0);
            for (const BodyTriangle& triangle : mesh_.triangles)
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::uint32_t of = triangle.nodes[k];
                    for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
                        sums[of] += triangle.share * mesh_.nodes[triangle.nodes[other]].place;
                        counts[of] += triangle.share;
                    }
                }
            for (std::size_t node = 0; node < sums.size(); ++node) {
                if (isFixed_[node] || !(counts[node] > 0)) continue;
                const glm::dvec2 along   = fits_[node].frame.laid(sums[node] / counts[node]);
                mesh_.nodes[node].place  = fits_[node].place(along);
                mesh_.nodes[node].normal = fits_[node].normal(along);
            }
        }
    }

    /// Calls visit(a, b) for each triangle of a Delaunay triangulation that the origin is a corner of, a and b the
    /// others': seen through a circle about the origin, circles through it are lines, so these are the sides of the
    /// hull that have the origin within.
    /// \param widest  radius of its circle [m]; a wider one spans a gap
    template <class Visit>
    static void eachOfStar(std::span<const std::pair<std::uint32_t, glm::dvec2>> around, double widest,
                           const Visit& visit)
    {
        std::vector<std::pair<std::uint32_t, glm::dvec2>> seen;
        for (const auto& [node, p] : around)
            if (const double d2 = glm::dot(p, p); d2 > 0) seen.emplace_back(node, p / d2);
        if (seen.size() < 2) return;
        const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
        std::ranges::sort(seen, [](const auto& a, const auto& b) {
            return std::pair(a.second.x, a.second.y) < std::pair(b.second.x, b.second.y);
        });
        std::vector<std::size_t> hull; // counter-clockwise
        const auto               grow = [&](std::size_t from, std::size_t k) {
            while (hull.size() >= from + 2 && cross(seen[hull.back()].second - seen[hull[hull.size() - 2]].second,
                                                                  seen[k].second - seen[hull[hull.size() - 2]].second) <= 0)
                hull.pop_back();
            hull.push_back(k);
        };
        for (std::size_t k = 0; k < seen.size(); ++k) grow(0, k);
        const std::size_t upper = hull.size() - 1;
        for (std::size_t k = seen.size() - 1; k-- > 0;) grow(upper, k);
        for (std::size_t k = 0; k + 1 < hull.size(); ++k) {
            const auto& [a, p] = seen[hull[k]];
            const auto& [b, q] = seen[hull[k + 1]];
            const double away  = cross(p, q) / glm::length(q - p); // of the line from the origin, > 0 with it within
            if (away * 2 * widest > 1) visit(a, b);
        }
    }

    const SoftObject&                             object_;
    std::span<const glm::dvec3>                   places_; ///< by rank [m]
    std::vector<std::uint32_t>                    pointOf_;
    std::vector<bool>                             isHeld_;
    std::vector<std::vector<std::uint32_t>>       links_;
    std::vector<std::uint32_t>                    reached_, queue_;
    std::uint32_t                                 round_ = 0;
    std::vector<std::uint32_t>                    nodeAt_;     ///< by rank
    std::vector<std::pair<std::uint32_t, double>> nearest_;    ///< node and its distance [m], by rank
    std::vector<std::uint32_t>                    rankOf_;     ///< by node
    std::vector<FlatFit>                          fits_;       ///< about its point, by node
    std::vector<bool>                             isFixed_;    ///< at a border, by node
    std::vector<double>                           ln_, count_; ///< sums of ln D and how many, by node
    BodyMesh                                      mesh_;
};

} // namespace

BodyMesh bodyMesh(const SoftObject& object, std::size_t most)
{
    // Of more points than these, cubes are taken that hold nine or so: a mesh needs no more.
    constexpr std::size_t kDense = 60'000, kPerNode = 9;
    if (object.survey().spacings().empty()) return {};
    if (object.size() <= kDense) return Making(object, most).made();
    double area = 0;
    for (const double spacing : object.survey().spacings()) area += spacing * spacing;
    const auto coarse = object.coarse(std::sqrt(area / double(kPerNode * most)));
    return Making(coarse->object(), most).made();
}

} // namespace palp
