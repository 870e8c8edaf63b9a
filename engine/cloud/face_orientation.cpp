#include "engine/cloud/face_orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
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

} // namespace

std::size_t turnToNeighbours(std::span<Triangle> faces, std::span<const glm::dvec3> positions)
{
    SharedEdges edges(faces, positions.size());
    bool        allAlike = true;
    edges.each([&](std::uint32_t, std::uint32_t, bool alike) { allAlike = allAlike && alike; });
    if (allAlike) return 0;

    std::vector<std::array<Link, 3>> links(faces.size());
    const auto                       add = [&](std::uint32_t face, const Link& link) {
        *std::ranges::find(links[face], kNone, &Link::face) = link; // a triangle has three edges
    };
    edges.each([&](std::uint32_t one, std::uint32_t other, bool alike) {
        add(one, {other, alike});
        add(other, {one, alike});
    });
    enum : std::uint8_t { unseen, kept, turned };
    std::vector<std::uint8_t>  states(faces.size(), unseen);
    std::vector<std::uint32_t> piece;
    std::size_t                count = 0;
    for (std::uint32_t first = 0; first < faces.size(); ++first) {
        if (states[first] != unseen) continue;
        states[first] = kept;
        piece.assign(1, first);
        double area[2] = {0, 0}; // [m^2] of the triangles that face as the first does, and of the others
        for (std::size_t next = 0; next < piece.size(); ++next) {
            const std::uint32_t face = piece[next];
            area[states[face] == turned] += areaOf(faces[face], positions);
            for (const Link& link : links[face]) {
                if (link.face == kNone || states[link.face] != unseen) continue;
                states[link.face] = (states[face] == kept) == link.alike ? kept : turned;
                piece.push_back(link.face);
            }
        }
        // Sums of equal areas differ by rounding, which must not decide.
        const auto wrong = area[1] > area[0] * (1 + 1e-9) ? kept : turned;
        for (const std::uint32_t face : piece) {
            if (states[face] != wrong) continue;
            std::swap(faces[face][1], faces[face][2]);
            ++count;
        }
    }
    return count;
}

namespace {

/// Triangles that hang together over edges of two.
struct Piece {
    std::vector<std::uint32_t> faces;
    std::size_t                shared = 0;    ///< edges
    bool                       alike  = true; ///< all face as their neighbours do
    double                     volume = 0;    ///< enclosed, below zero if it lies inside out [m^3]; closed pieces'
    Bounds                     box;           ///< closed pieces'

    [[nodiscard]] bool isClosed() const { return alike && 2 * shared == 3 * faces.size(); }
};

/// Returns the pieces of a mesh, in the order of their first triangles.
std::vector<Piece> piecesOf(std::span<const Triangle> faces, std::size_t points)
{
    SharedEdges                edges(faces, points);
    std::vector<std::uint32_t> root(faces.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto rootOf = [&root](std::uint32_t face) {
        while (root[face] != face) face = root[face] = root[root[face]];
        return face;
    };
    edges.each([&](std::uint32_t one, std::uint32_t other, bool) {
        const std::uint32_t a = rootOf(one), b = rootOf(other);
        root[std::max(a, b)] = std::min(a, b);
    });
    std::vector<Piece>         pieces;
    std::vector<std::uint32_t> pieceOf(faces.size());
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
        const std::uint32_t first = rootOf(face);
        if (first == face) {
            pieceOf[face] = std::uint32_t(pieces.size());
            pieces.emplace_back();
        }
        pieceOf[face] = pieceOf[first];
        pieces[pieceOf[face]].faces.push_back(face);
    }
    edges.each([&](std::uint32_t one, std::uint32_t, bool alike) {
        Piece& piece = pieces[pieceOf[one]];
        ++piece.shared;
        piece.alike = piece.alike && alike;
    });
    return pieces;
}

void measure(Piece& piece, std::span<const Triangle> faces, std::span<const glm::dvec3> positions)
{
    // About a corner of its own, so that a body far from the origin loses no digits.
    const glm::dvec3 middle = positions[faces[piece.faces[0]][0]];
    double           extent = 0; // [m^3] the sum of the parts' sizes
    piece.box               = {middle, middle};
    for (const std::uint32_t face : piece.faces) {
        const auto& [a, b, c] = faces[face];
        const double part =
            glm::dot(positions[a] - middle, glm::cross(positions[b] - middle, positions[c] - middle)) / 6;
        piece.volume += part;
        extent += std::abs(part);
        for (const std::uint32_t corner : {a, b, c}) {
            piece.box.low  = glm::min(piece.box.low, positions[corner]);
            piece.box.high = glm::max(piece.box.high, positions[corner]);
        }
    }
    if (std::abs(piece.volume) < 1e-9 * extent) piece.volume = 0; // a sheet folded back on itself encloses nothing
}

bool liesWithin(const Bounds& inner, const Bounds& outer)
{
    return glm::all(glm::greaterThan(inner.low, outer.low)) && glm::all(glm::lessThan(inner.high, outer.high));
}

/// Marks the corners of a piece whose normals point inward for the larger part of its area.
void markInward(const Piece& piece, std::span<const Triangle> faces, std::span<const glm::dvec3> positions,
                std::span<const glm::vec3> normals, std::vector<bool>& inward)
{
    double outward = 0; // over triangles and their corners, of twice the area [m^2]
    for (const std::uint32_t face : piece.faces) {
        const auto& [a, b, c] = faces[face];
        const glm::dvec3 area = glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
        for (const std::uint32_t corner : {a, b, c}) outward += glm::dot(area, glm::dvec3(normals[corner]));
    }
    if (outward >= 0) return;
    for (const std::uint32_t face : piece.faces)
        for (const std::uint32_t corner : faces[face]) inward[corner] = true;
}

} // namespace

TurnedOutward turnOutward(std::span<Triangle> faces, std::span<const glm::dvec3> positions,
                          std::span<glm::vec3> normals)
{
    constexpr std::size_t kMostBodies = 100; // that are asked whether they hold another

    std::vector<Piece> pieces = piecesOf(faces, positions.size());
    std::erase_if(pieces, [](const Piece& piece) { return !piece.isClosed(); });
    for (Piece& piece : pieces) measure(piece, faces, positions);
    std::ranges::stable_sort(pieces, std::greater(), [](const Piece& piece) { return piece.box.diagonal(); });
    std::vector<const Piece*> bodies;
    std::vector<bool>         turns(pieces.size()); // a body for itself, a wall as its body does
    std::vector<std::size_t>  bodyAt;
    std::vector<bool>         inward(normals.size()); // corners
    TurnedOutward             turned;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const auto body =
            std::ranges::find_if(bodies, [&](const Piece* other) { return liesWithin(pieces[k].box, other->box); });
        turns[k] = body != bodies.end() ? turns[bodyAt[std::size_t(body - bodies.begin())]] : pieces[k].volume < 0;
        if (body == bodies.end() && bodies.size() < kMostBodies) {
            bodies.push_back(&pieces[k]);
            bodyAt.push_back(k);
        }
        if (turns[k]) {
            for (const std::uint32_t face : pieces[k].faces) std::swap(faces[face][1], faces[face][2]);
            turned.faces += pieces[k].faces.size();
        }
        if (!normals.empty()) markInward(pieces[k], faces, positions, normals, inward);
    }
    for (std::size_t corner = 0; corner < normals.size(); ++corner)
        if (inward[corner]) {
            normals[corner] = -normals[corner];
            ++turned.normals;
        }
    return turned;
}

} // namespace palp
