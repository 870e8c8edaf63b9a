#include "engine/cloud/mesh_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/cloud/morton.h"
#include "engine/core/contract.h"
#include "engine/core/uniform.h"

namespace palp {
namespace {

/// Height over longest edge from which on a triangle has an area [1]: below it rounding makes the normal.
constexpr double kFlat = 1e-12;

/// Longest edge of a gap that is not halved further, over the distance [1].
constexpr double kSmallestGap = 1.0 / 64;

/// Cosine of the angle between normals from which on two sheets face opposite ways [1], and the distance between them,
/// over that of the points, up to which they count as one [1].
constexpr double kOpposite = -0.5, kOneSheet = 0.02;

/// Least distance over the diagonal of the mesh [1], so that the numbers of cells fit into 20 bits.
constexpr double kLeastDistance = 0x1p-20;

/// Most distances in a row along the longest edges of thin triangles: over `most`, or for each triangle of the mesh
/// [1]. On a fine tube they cost as much as points do, on slivers that lie one on the other ten times as much: half a
/// minute in all, as long as the most points take.
constexpr double kMostAlongThin = 0.2, kAlongEach = 50;

/// Area of a triangle over its longest edge times the distance from which on it is none of the thin ones [1].
constexpr double kThin = 1.0 / 3;

/// Bound of coordinates [m], so that no square overflows; files have a lower one.
constexpr double kMostCoordinate = 1e100;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Points by the cells of space that their discs meet: a place looks into one cell to see all discs that may hold it.
class DiscGrid {
public:
    DiscGrid(const glm::dvec3& low, double distance, std::size_t expected) : low_(low), distance_(distance)
    {
        constexpr std::size_t kCellsPerPoint = 2; // of which half stay empty
        while (keys_.size() < kCellsPerPoint * expected) grow();
        if (keys_.empty()) grow();
    }

    void insert(const glm::dvec3& place, std::uint32_t point)
    {
        const Cell low = cellOf(place - distance_), high = cellOf(place + distance_);
        for (std::uint64_t z = low[2]; z <= high[2]; ++z)
            for (std::uint64_t y = low[1]; y <= high[1]; ++y)
                for (std::uint64_t x = low[0]; x <= high[0]; ++x)
                    if (meets({x, y, z}, place)) append(keyOf({x, y, z}), point, place);
    }

    /// Calls test(point) for the points that are closer to the place than the distance, until it returns true.
    /// \return true if it did
    template <class Test>
    bool anyNear(const glm::dvec3& place, Test&& test) const
    {
        const double most = distance_ * distance_;
        for (std::uint32_t at = firstChunk_[slotOf(keyOf(cellOf(place)))]; at != kNone; at = chunks_[at].next) {
            const Chunk& chunk = chunks_[at];
            for (std::uint32_t k = 0; k < chunk.size; ++k) {
                const glm::dvec3 away = place - chunk.places[k];
                if (glm::dot(away, away) < most && test(chunk.points[k])) return true;
            }
        }
        return false;
    }

private:
    using Cell = std::array<std::uint64_t, 3>;

    struct Chunk {
        std::uint32_t                 next = kNone, size = 0;
        std::array<std::uint32_t, 14> points{};
        std::array<glm::dvec3, 14>    places{}; ///< of the points once more [m], so that they are read in a row
    };

    // Cells are two distances wide, so that a disc meets eight at most. One is left before the lowest.
    [[nodiscard]] Cell cellOf(const glm::dvec3& place) const noexcept
    {
        const auto along = [&](int k) {
            return std::uint64_t(std::max((place[k] - low_[k]) / (2 * distance_) + 1, 0.0));
        };
        return {along(0), along(1), along(2)};
    }

    [[nodiscard]] bool meets(const Cell& cell, const glm::dvec3& place) const noexcept
    {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double begin = low_[k] + 2 * distance_ * (double(cell[std::size_t(k)]) - 1);
            const double away  = std::max({begin - place[k], place[k] - (begin + 2 * distance_), 0.0});
            square += away * away;
        }
        return square <= distance_ * distance_ * (1 + 1e-6); // places round to either side of a wall
    }

    [[nodiscard]] static std::uint64_t keyOf(const Cell& cell) noexcept
    {
        return (cell[0] | cell[1] << 21U | cell[2] << 42U) + 1; // 0 is an empty slot
    }

    [[nodiscard]] std::size_t slotOf(std::uint64_t key) const noexcept
    {
        std::size_t slot = std::size_t((key * 0x9e3779b97f4a7c15ULL) >> shift_); // Fibonacci hashing
        while (keys_[slot] != 0 && keys_[slot] != key) slot = (slot + 1) & (keys_.size() - 1);
        return slot;
    }

    void append(std::uint64_t key, std::uint32_t point, const glm::dvec3& place)
    {
        if (2 * used_ >= keys_.size()) grow();
        const std::size_t slot = slotOf(key);
        if (keys_[slot] == 0) {
            keys_[slot] = key;
            ++used_;
        }
        std::uint32_t& first = firstChunk_[slot];
        if (first == kNone || chunks_[first].size == chunks_[first].points.size()) {
            chunks_.push_back({first, 0, {}, {}});
            first = std::uint32_t(chunks_.size() - 1);
        }
        Chunk& chunk             = chunks_[first];
        chunk.points[chunk.size] = point;
        chunk.places[chunk.size] = place;
        ++chunk.size;
    }

    void grow()
    {
        const auto keys   = std::exchange(keys_, std::vector<std::uint64_t>(keys_.empty() ? 256 : 2 * keys_.size()));
        const auto chunks = std::exchange(firstChunk_, std::vector<std::uint32_t>(keys_.size(), kNone));
        shift_            = 64;
        for (std::size_t size = keys_.size(); size > 1; size /= 2) --shift_;
        for (std::size_t slot = 0; slot < keys.size(); ++slot)
            if (keys[slot] != 0) {
                const std::size_t to = slotOf(keys[slot]);
                keys_[to]            = keys[slot];
                firstChunk_[to]      = chunks[slot];
            }
    }

    glm::dvec3                 low_;      ///< [m]
    double                     distance_; ///< [m]
    std::vector<std::uint64_t> keys_;     ///< a power of two
    std::vector<std::uint32_t> firstChunk_;
    std::vector<Chunk>         chunks_;
    std::size_t                used_  = 0;
    unsigned                   shift_ = 64;
};

/// A triangle of a mesh, in space.
struct Facet {
    glm::dvec3    corner{}, second{}, third{}; ///< [m] the first corner, and the edges to the others
    glm::dvec3    normal{};                    ///< [1]
    double        area    = 0;                 ///< [m^2]; 0: none
    double        longest = 0;                 ///< edge [m]
    std::uint32_t index   = 0;

    [[nodiscard]] glm::dvec3 at(const glm::dvec2& weights) const noexcept
    {
        return corner + weights.x * second + weights.y * third;
    }
};

Facet facetOf(std::span<const glm::dvec3> vertices, const Triangle& face, std::uint32_t index)
{
    Facet facet;
    facet.index  = index;
    facet.corner = vertices[face[0]];
    facet.second = vertices[face[1]] - facet.corner;
    facet.third  = vertices[face[2]] - facet.corner;
    facet.longest =
        std::max({glm::length(facet.second), glm::length(facet.third), glm::length(facet.third - facet.second)});
    if (!(facet.longest > 0)) return facet;
    const glm::dvec3 cross =
        glm::cross(facet.second / facet.longest, facet.third / facet.longest); // does not underflow
    const double length = glm::length(cross);
    if (!(length > kFlat)) return facet;
    facet.normal = cross / length;
    facet.area   = 0.5 * length * facet.longest * facet.longest;
    return facet;
}

/// A mesh whose triangles with an area are put into the order of space.
struct Surface {
    std::span<const glm::dvec3> vertices; ///< [m]
    std::span<const Triangle>   faces;
    std::vector<std::uint32_t>  order;          ///< indices of faces that have an area
    glm::dvec3                  low{}, high{};  ///< of these [m]
    double                      area       = 0; ///< [m^2]
    std::size_t                 degenerate = 0;

    [[nodiscard]] Facet facet(std::uint32_t face) const noexcept { return facetOf(vertices, faces[face], face); }
};

void sortInSpace(Surface& surface)
{
    const glm::dvec3                                     size = surface.high - surface.low;
    const double                                         edge = std::max({size.x, size.y, size.z});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> codes;
    codes.reserve(surface.order.size());
    for (const std::uint32_t face : surface.order) {
        const glm::dvec3 cell = (surface.facet(face).at({1.0 / 3, 1.0 / 3}) - surface.low) / edge * 0x1p20;
        codes.emplace_back(mortonCode(std::uint32_t(cell.x), std::uint32_t(cell.y), std::uint32_t(cell.z)), face);
    }
    std::ranges::sort(codes);
    for (std::size_t n = 0; n < codes.size(); ++n) surface.order[n] = codes[n].second;
}

Surface surfaceOf(std::span<const glm::dvec3> vertices, std::span<const Triangle> faces)
{
    PALP_EXPECT(faces.size() < kNone, "a mesh has fewer than 2^32 - 1 triangles, not " + std::to_string(faces.size()));
    Surface surface{vertices, faces, {}};
    for (std::uint32_t n = 0; n < faces.size(); ++n) {
        for (const std::uint32_t corner : faces[n]) {
            const auto what = [&] { return "triangle " + std::to_string(n) + ", vertex " + std::to_string(corner); };
            PALP_EXPECT(corner < vertices.size(), what());
            const glm::dvec3& p = vertices[corner];
            PALP_EXPECT(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kMostCoordinate, what());
        }
        const double area = surface.facet(n).area;
        if (!(area > 0)) {
            ++surface.degenerate;
            continue;
        }
        const glm::dvec3& start = vertices[faces[n][0]];
        if (surface.order.empty()) surface.low = surface.high = start;
        for (const std::uint32_t corner : faces[n]) {
            surface.low  = glm::min(surface.low, vertices[corner]);
            surface.high = glm::max(surface.high, vertices[corner]);
        }
        surface.area += area;
        surface.order.push_back(n);
    }
    return surface;
}

/// Returns the distance that keeps the number of points in bounds [m], and the time: the sum of the long sides of thin
/// triangles, less what their area pays for, is so many distances at most.
double boundedDistance(const Surface& surface, const ScatterSettings& settings)
{
    double distance = std::max(settings.distance, kLeastDistance * glm::length(surface.high - surface.low));
    distance        = std::max(distance, std::sqrt(surface.area / double(settings.most)));
    double thin     = 0; // [m]
    for (const std::uint32_t face : surface.order) {
        const Facet facet = surface.facet(face);
        if (facet.longest > distance) thin += std::max(0.0, facet.longest - facet.area / (kThin * distance));
    }
    const double most = std::max(kMostAlongThin * double(settings.most), kAlongEach * double(surface.order.size()));
    return std::max(distance, thin / most);
}

/// A part of a triangle, by the weights of its corners.
struct Gap {
    std::array<glm::dvec2, 3> corners{}; ///< [1]
};

/// One attempt to fill a mesh with points at a distance.
class Scatter {
public:
    Scatter(const Surface& surface, double distance, const ScatterSettings& settings)
        : surface_(surface), distance_(distance), most_(settings.most), random_(settings.seed),
          grid_(surface.low, distance, std::min(settings.most, std::size_t(surface.area / (distance * distance)) + 1))
    {
        const auto expected = std::min(settings.most, std::size_t(surface.area / (distance * distance)) + 1);
        points_.positions.reserve(expected);
        points_.normals.reserve(expected);
        points_.triangles.reserve(expected);
        points_.weights.reserve(expected);
    }

    /// \return nothing if there are too many points
    std::optional<MeshPoints> run()
    {
        for (const std::uint32_t face : surface_.order) {
            fill(surface_.facet(face));
            if (points_.size() > most_) return std::nullopt;
        }
        points_.distance   = distance_;
        points_.area       = surface_.area;
        points_.degenerate = surface_.degenerate;
        return std::move(points_);
    }

private:
    /// Halves what no disc covers until a dart fits or a disc covers it.
    void fill(const Facet& facet)
    {
        gaps_.assign(1, Gap{{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)}});
        while (!gaps_.empty() && points_.size() <= most_) {
            const Gap gap = gaps_.back();
            gaps_.pop_back();
            const std::array<glm::dvec3, 3> at{facet.at(gap.corners[0]), facet.at(gap.corners[1]),
                                               facet.at(gap.corners[2])};
            if (covered(facet, at)) continue;
            const auto [edge, square] = longestEdge(at);
            const double length       = std::sqrt(square);
            if (length <= distance_) offer(facet, placeIn(gap));
            if (length <= kSmallestGap * distance_) {
                offer(facet, (gap.corners[0] + gap.corners[1] + gap.corners[2]) / 3.0);
                continue;
            }
            halve(gap, edge);
        }
    }

    /// Puts the halves of a gap on the heap of gaps. A gap that rounding does not let be halved is given up.
    void halve(const Gap& gap, std::size_t edge)
    {
        const glm::dvec2 a = gap.corners[edge], b = gap.corners[(edge + 1) % 3], c = gap.corners[(edge + 2) % 3];
        const glm::dvec2 middle = 0.5 * (a + b);
        if (middle == a || middle == b) return;
        Gap one{{a, middle, c}}, other{{middle, b, c}};
        if (random_() < 0.5) std::swap(one, other);
        gaps_.push_back(one);
        gaps_.push_back(other);
    }

    /// Returns the weights of a random place in a triangle.
    [[nodiscard]] glm::dvec2 somewhere()
    {
        const double u = random_(), v = random_(); // one after the other, which arguments of a call are not
        return u + v > 1 ? glm::dvec2(1 - u, 1 - v) : glm::dvec2(u, v);
    }

    [[nodiscard]] glm::dvec2 placeIn(const Gap& gap)
    {
        const glm::dvec2 in = somewhere();
        return gap.corners[0] + in.x * (gap.corners[1] - gap.corners[0]) + in.y * (gap.corners[2] - gap.corners[0]);
    }

    /// Returns the longest edge, which begins at that corner, and the square of its length [m^2].
    [[nodiscard]] static std::pair<std::size_t, double> longestEdge(const std::array<glm::dvec3, 3>& at)
    {
        std::pair<std::size_t, double> longest{0, -1.0};
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3 edge = at[(k + 1) % 3] - at[k];
            if (const double square = glm::dot(edge, edge); square > longest.second) longest = {k, square};
        }
        return longest;
    }

    /// Returns true if the disc of a point holds the place.
    [[nodiscard]] bool holds(std::uint32_t point, const glm::dvec3& place, const glm::dvec3& normal) const
    {
        const glm::dvec3  away  = place - points_.positions[point];
        const glm::dvec3& other = points_.normals[point];
        if (!(glm::dot(away, away) < distance_ * distance_)) return false;
        if (glm::dot(normal, other) > kOpposite) return true;
        return std::max(std::abs(glm::dot(away, normal)), std::abs(glm::dot(away, other))) <= kOneSheet * distance_;
    }

    /// Returns true if one disc holds all corners, and so, because it is convex, all of the gap.
    [[nodiscard]] bool covered(const Facet& facet, const std::array<glm::dvec3, 3>& at) const
    {
        return grid_.anyNear(at[0], [&](std::uint32_t point) {
            return holds(point, at[0], facet.normal) && holds(point, at[1], facet.normal) &&
                   holds(point, at[2], facet.normal);
        });
    }

    /// Makes a point of the place if no disc holds it.
    void offer(const Facet& facet, const glm::dvec2& weights)
    {
        const glm::dvec3 place = facet.at(weights);
        if (grid_.anyNear(place, [&](std::uint32_t point) { return holds(point, place, facet.normal); })) return;
        grid_.insert(place, std::uint32_t(points_.size()));
        points_.positions.push_back(place);
        points_.normals.push_back(facet.normal);
        points_.triangles.push_back(facet.index);
        points_.weights.push_back(weights);
    }

    const Surface&   surface_;
    double           distance_; ///< [m]
    std::size_t      most_;
    Uniform          random_;
    DiscGrid         grid_;
    MeshPoints       points_;
    std::vector<Gap> gaps_; ///< last in, first out
};

/// Returns at(weights, the values of the three corners) of each point.
template <typename At>
std::vector<double> eachPoint(const MeshPoints& points, std::span<const Triangle> faces, std::span<const double> values,
                              At at)
{
    std::vector<double> result;
    result.reserve(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
        const Triangle& face = faces[points.triangles[n]];
        result.push_back(at(points.weights[n], values[face[0]], values[face[1]], values[face[2]]));
    }
    return result;
}

} // namespace

double scatterDistance(std::span<const glm::dvec3> vertices, std::span<const Triangle> faces,
                       const ScatterSettings& settings)
{
    return boundedDistance(surfaceOf(vertices, faces), settings);
}

MeshPoints scatterOver(std::span<const glm::dvec3> vertices, std::span<const Triangle> faces,
                       const ScatterSettings& settings)
{
    PALP_EXPECT(settings.distance > 0 && std::isfinite(settings.distance) && settings.most > 0,
                "points are scattered at a distance above 0, not " + std::to_string(settings.distance));
    Surface surface = surfaceOf(vertices, faces);
    if (!surface.order.empty()) sortInSpace(surface);
    MeshPoints none;
    none.wanted = none.distance = settings.distance;
    none.degenerate             = surface.degenerate;
    if (surface.order.empty()) return none;
    for (double distance = boundedDistance(surface, settings);; distance *= 2)
        if (auto points = Scatter(surface, distance, settings).run()) {
            points->wanted = settings.distance;
            return std::move(*points);
        }
}

std::vector<double> interpolated(const MeshPoints& points, std::span<const Triangle> faces,
                                 std::span<const double> values)
{
    return eachPoint(points, faces, values, [](const glm::dvec2& weight, double a, double b, double c) {
        return a + weight.x * (b - a) + weight.y * (c - a);
    });
}

std::vector<double> logInterpolated(const MeshPoints& points, std::span<const Triangle> faces,
                                    std::span<const double> values)
{
    return eachPoint(points, faces, values, [](const glm::dvec2& weight, double a, double b, double c) {
        return a * std::exp(weight.x * std::log(b / a) + weight.y * std::log(c / a));
    });
}

} // namespace palp
