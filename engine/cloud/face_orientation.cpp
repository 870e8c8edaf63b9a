#include "engine/cloud/face_orientation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

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

/// Returns whether each edge belongs to two triangles that face the same way.
bool isClosed(std::span<const Triangle> faces, std::size_t points)
{
    std::size_t shared   = 0;
    bool        allAlike = true;
    SharedEdges(faces, points).each([&](std::uint32_t, std::uint32_t, bool alike) {
        ++shared;
        allAlike = allAlike && alike;
    });
    return allAlike && 2 * shared == 3 * faces.size();
}

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

bool turnOutward(std::span<Triangle> faces, std::span<const glm::dvec3> positions)
{
    if (faces.empty()) return false;
    // About a corner of its own, so that a body far from the origin loses no digits.
    const glm::dvec3& middle = positions[faces[0][0]];
    double            volume = 0, extent = 0; // six times what is enclosed, and the sum of its parts' sizes [m^3]
    for (const Triangle& face : faces) {
        const double part =
            glm::dot(positions[face[0]] - middle, glm::cross(positions[face[1]] - middle, positions[face[2]] - middle));
        volume += part;
        extent += std::abs(part);
    }
    // What encloses nothing, as a sheet folded back on itself, has the sign of its rounding.
    if (!(volume < -1e-9 * extent) || !isClosed(faces, positions.size())) return false;
    for (Triangle& face : faces) std::swap(face[1], face[2]);
    return true;
}

} // namespace palp
