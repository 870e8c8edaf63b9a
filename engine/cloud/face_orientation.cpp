#include "engine/cloud/face_orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/cloud/point_cloud.h"

namespace palp {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Returns whether a triangle passes along an edge from its lower to its higher corner.
bool rises(const Triangle& face, std::uint32_t low, std::uint32_t high)
{
    return (face[0] == low && face[1] == high) || (face[1] == low && face[2] == high) ||
           (face[2] == low && face[0] == high);
}

/// The edges that two triangles share, by the lower of their corners.
class SharedEdges {
public:
    explicit SharedEdges(std::span<const Triangle> faces, std::size_t points) : faces_(faces), begins_(points + 1)
    {
        eachEdge([&](std::uint32_t low, const Edge&) { ++begins_[low + 1]; });
        for (std::size_t p = 1; p < begins_.size(); ++p) begins_[p] += begins_[p - 1];
        edges_.resize(begins_.back());
        std::vector<std::uint64_t> ends(begins_.begin(), begins_.end() - 1);
        eachEdge([&](std::uint32_t low, const Edge& edge) { edges_[ends[low]++] = edge; });
    }

    /// Calls `visit` with the two triangles of each edge that has two, and whether they face the same way.
    template <class Visit>
    void each(Visit&& visit)
    {
        for (std::uint32_t low = 0; low + 1 < begins_.size(); ++low) {
            const auto about = std::span(edges_).subspan(begins_[low], begins_[low + 1] - begins_[low]);
            std::ranges::sort(about, {}, &Edge::high);
            for (std::size_t begin = 0, end = 0; begin < about.size(); begin = end) {
                while (end < about.size() && about[end].high == about[begin].high) ++end;
                if (end - begin != 2) continue;
                const auto [high, one] = about[begin];
                const auto other       = about[begin + 1].face;
                visit(one, other, rises(faces_[one], low, high) != rises(faces_[other], low, high));
            }
        }
    }

private:
    struct Edge {
        std::uint32_t high = 0, face = 0;
    };

    template <class Visit>
    void eachEdge(Visit&& visit) const
    {
        for (std::size_t f = 0; f < faces_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [low, high] = std::minmax({faces_[f][k], faces_[f][(k + 1) % 3]});
                visit(low, {high, std::uint32_t(f)});
            }
    }

    std::span<const Triangle>  faces_;
    std::vector<std::uint64_t> begins_; ///< of the edges of each lower corner, and the end of all
    std::vector<Edge>          edges_;
};

double areaOf(const Triangle& face, std::span<const glm::dvec3> positions)
{
    const glm::dvec3& corner = positions[face[0]];
    return 0.5 * glm::length(glm::cross(positions[face[1]] - corner, positions[face[2]] - corner));
}

/// A neighbour over an edge.
struct Link {
    std::uint32_t face  = kNone;
    bool          alike = true; ///< both face the same way
};
using Links = std::vector<std::array<Link, 3>>; ///< of each triangle, the real ones first

Links linksOf(SharedEdges& edges, std::size_t faces)
{
    Links      links(faces);
    const auto add = [&](std::uint32_t face, const Link& link) {
        *std::ranges::find(links[face], kNone, &Link::face) = link; // a triangle has three edges
    };
    edges.each([&](std::uint32_t one, std::uint32_t other, bool alike) {
        add(one, {other, alike});
        add(other, {one, alike});
    });
    return links;
}

enum class Facing : std::uint8_t {
    unseen,
    asFirst,  ///< as the first triangle of its piece, over the edges between them
    asOthers, ///< the other way
};

/// Calls visit(triangles, facings of all triangles) for the triangles that hang together over edges of two, piece by
/// piece, in the order of their first ones.
template <class Visit>
void eachPiece(const Links& links, Visit&& visit)
{
    using enum Facing;
    std::vector<Facing>        facings(links.size(), unseen);
    std::vector<std::uint32_t> piece;
    for (std::uint32_t first = 0; first < links.size(); ++first) {
        if (facings[first] != unseen) continue;
        facings[first] = asFirst;
        piece.assign(1, first);
        for (std::size_t next = 0; next < piece.size(); ++next) {
            const std::uint32_t face = piece[next];
            for (const Link& link : links[face]) {
                if (link.face == kNone || facings[link.face] != unseen) continue;
                facings[link.face] = (facings[face] == asFirst) == link.alike ? asFirst : asOthers;
                piece.push_back(link.face);
            }
        }
        visit(std::as_const(piece), std::as_const(facings));
    }
}

void turn(Triangle& face)
{
    std::swap(face[1], face[2]);
}

/// A closed surface.
struct ClosedSurface {
    std::vector<std::uint32_t> faces;
    double                     volume = 0; ///< enclosed, below zero if it lies inside out [m^3]
    Bounds                     box;
    bool                       turns = false; ///< it is turned round
};

ClosedSurface surfaceOf(const std::vector<std::uint32_t>& piece, std::span<const Triangle> faces,
                        std::span<const glm::dvec3> positions)
{
    // About a corner of its own, so that a body far from the origin loses no digits.
    const glm::dvec3 middle = positions[faces[piece[0]][0]];
    ClosedSurface    surface{piece, 0, {middle, middle}};
    double           extent = 0; // [m^3] the sum of the parts' sizes
    for (const std::uint32_t face : piece) {
        const auto& [a, b, c] = faces[face];
        const double part =
            glm::dot(positions[a] - middle, glm::cross(positions[b] - middle, positions[c] - middle)) / 6;
        surface.volume += part;
        extent += std::abs(part);
        for (const std::uint32_t corner : {a, b, c}) {
            surface.box.low  = glm::min(surface.box.low, positions[corner]);
            surface.box.high = glm::max(surface.box.high, positions[corner]);
        }
    }
    if (std::abs(surface.volume) < 1e-9 * extent) surface.volume = 0; // a sheet folded back on itself encloses nothing
    return surface;
}

bool liesWithin(const Bounds& inner, const Bounds& outer)
{
    return glm::all(glm::greaterThan(inner.low, outer.low)) && glm::all(glm::lessThan(inner.high, outer.high));
}

/// Marks the corners of a surface whose normals point inward for the larger part of its area.
void markInward(const ClosedSurface& surface, std::span<const Triangle> faces, std::span<const glm::dvec3> positions,
                std::span<const glm::vec3> normals, std::vector<bool>& inward)
{
    double outward = 0; // over triangles and their corners, of twice the area [m^2]
    for (const std::uint32_t face : surface.faces) {
        const auto& [a, b, c] = faces[face];
        const glm::dvec3 area = glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
        for (const std::uint32_t corner : {a, b, c}) outward += glm::dot(area, glm::dvec3(normals[corner]));
    }
    if (outward >= 0) return;
    for (const std::uint32_t face : surface.faces)
        for (const std::uint32_t corner : faces[face]) inward[corner] = true;
}

} // namespace

std::size_t turnToNeighbours(std::span<Triangle> faces, std::span<const glm::dvec3> positions)
{
    SharedEdges edges(faces, positions.size());
    bool        allAlike = true;
    edges.each([&](std::uint32_t, std::uint32_t, bool alike) { allAlike = allAlike && alike; });
    if (allAlike) return 0;

    std::size_t count = 0;
    eachPiece(linksOf(edges, faces.size()), [&](const auto& piece, const auto& facings) {
        double asFirst = 0, asOthers = 0; // [m^2] areas
        for (const std::uint32_t face : piece)
            (facings[face] == Facing::asFirst ? asFirst : asOthers) += areaOf(faces[face], positions);
        // Sums of equal areas differ by rounding, which must not decide.
        const auto wrong = asOthers > asFirst * (1 + 1e-9) ? Facing::asFirst : Facing::asOthers;
        for (const std::uint32_t face : piece) {
            if (facings[face] != wrong) continue;
            turn(faces[face]);
            ++count;
        }
    });
    return count;
}

TurnedOutward turnOutward(std::span<Triangle> faces, std::span<const glm::dvec3> positions,
                          std::span<glm::vec3> normals)
{
    constexpr std::size_t kMostBodies = 100; // that are asked whether they hold another

    SharedEdges edges(faces, positions.size());
    const Links links  = linksOf(edges, faces.size());
    const auto  closed = [&](std::uint32_t face) {
        return std::ranges::all_of(links[face], [](const Link& link) { return link.face != kNone && link.alike; });
    };
    std::vector<ClosedSurface> surfaces;
    eachPiece(links, [&](const auto& piece, const auto&) {
        if (std::ranges::all_of(piece, closed)) surfaces.push_back(surfaceOf(piece, faces, positions));
    });
    std::ranges::stable_sort(surfaces, std::greater(),
                             [](const ClosedSurface& surface) { return surface.box.diagonal(); });

    std::vector<const ClosedSurface*> bodies;
    std::vector<bool>                 inward(normals.size()); // corners
    TurnedOutward                     turned;
    for (ClosedSurface& surface : surfaces) {
        const auto body = std::ranges::find_if(
            bodies, [&](const ClosedSurface* other) { return liesWithin(surface.box, other->box); });
        surface.turns = body != bodies.end() ? (*body)->turns : surface.volume < 0; // a wall as its body
        if (body == bodies.end() && bodies.size() < kMostBodies) bodies.push_back(&surface);
        if (surface.turns) {
            for (const std::uint32_t face : surface.faces) turn(faces[face]);
            turned.faces += surface.faces.size();
        }
        if (!normals.empty()) markInward(surface, faces, positions, normals, inward);
    }
    for (std::size_t corner = 0; corner < normals.size(); ++corner)
        if (inward[corner]) {
            normals[corner] = -normals[corner];
            ++turned.normals;
        }
    return turned;
}

} // namespace palp
