#include "engine/tools/render/mesh_refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// Cosine of the angle from which on faces meet at a crease [1]: 40 degrees. A cylinder of ten sides is still round.
constexpr double kSmooth = 0.766;

glm::dvec3 doubleArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    return glm::cross(b - a, c - a);
}

/// One round of halving.
class Halving {
public:
    Halving(CreasedMesh& mesh, double limit)
        : mesh_(mesh), limit_(limit * limit), nextPlace_(std::ranges::max(mesh.placeOf) + 1)
    {
    }

    /// Returns the number of triangles afterwards.
    [[nodiscard]] std::size_t count() const
    {
        std::size_t all = 0;
        for (const Triangle& face : mesh_.faces)
            all += 1 + std::size_t(isLong(face[0], face[1])) + std::size_t(isLong(face[1], face[2])) +
                   std::size_t(isLong(face[2], face[0]));
        return all;
    }

    void run(std::size_t expected)
    {
        finer_.reserve(expected);
        for (const Triangle& face : mesh_.faces) split(face);
        mesh_.faces = std::move(finer_);
    }

private:
    [[nodiscard]] bool isLong(std::uint32_t a, std::uint32_t b) const
    {
        const glm::dvec3 edge = mesh_.positions[b] - mesh_.positions[a];
        return glm::dot(edge, edge) > limit_;
    }

    [[nodiscard]] double square(std::uint32_t a, std::uint32_t b) const
    {
        const glm::dvec3 edge = mesh_.positions[b] - mesh_.positions[a];
        return glm::dot(edge, edge);
    }

    static std::uint64_t keyOf(std::uint32_t a, std::uint32_t b)
    {
        return std::uint64_t(std::min(a, b)) << 32U | std::max(a, b);
    }

    std::uint32_t middleOf(std::uint32_t a, std::uint32_t b)
    {
        const auto [found, isNew] = middles_.try_emplace(keyOf(a, b), std::uint32_t(mesh_.positions.size()));
        if (!isNew) return found->second;
        const auto place = places_.try_emplace(keyOf(mesh_.placeOf[a], mesh_.placeOf[b]), nextPlace_);
        if (place.second) ++nextPlace_;
        const glm::dvec3 middle = 0.5 * mesh_.positions[a] + 0.5 * mesh_.positions[b];
        const glm::dvec3 other =
            glm::dot(mesh_.normals[a], mesh_.normals[b]) < 0 ? -mesh_.normals[b] : mesh_.normals[b];
        mesh_.positions.push_back(middle);
        mesh_.normals.push_back(glm::normalize(mesh_.normals[a] + other));
        mesh_.placeOf.push_back(place.first->second);
        return found->second;
    }

    void split(Triangle face)
    {
        const auto long3 = [&] {
            return std::array{isLong(face[0], face[1]), isLong(face[1], face[2]), isLong(face[2], face[0])};
        };
        std::array<bool, 3> is  = long3();
        const auto          all = std::ranges::count(is, true);
        // One long edge becomes the first one; of two the short one does.
        for (int turn = 0; turn < 2 && (all == 1 ? !is[0] : all == 2 && is[0]); ++turn) {
            std::rotate(face.begin(), face.begin() + 1, face.end());
            is = long3();
        }
        const auto [a, b, c] = face;
        if (all == 0) {
            finer_.push_back(face);
        } else if (all == 1) {
            const std::uint32_t ab = middleOf(a, b);
            finer_.insert(finer_.end(), {{a, ab, c}, {ab, b, c}});
        } else if (all == 2) {
            const std::uint32_t bc = middleOf(b, c), ca = middleOf(c, a);
            finer_.push_back({c, ca, bc});
            if (square(a, bc) <= square(b, ca)) // the quadrangle that is left is cut along its shorter diagonal
                finer_.insert(finer_.end(), {{a, b, bc}, {a, bc, ca}});
            else
                finer_.insert(finer_.end(), {{a, b, ca}, {b, bc, ca}});
        } else {
            const std::uint32_t ab = middleOf(a, b), bc = middleOf(b, c), ca = middleOf(c, a);
            finer_.insert(finer_.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
    }

    CreasedMesh&                                     mesh_;
    double                                           limit_; ///< square of the longest edge that stays [m^2]
    std::vector<Triangle>                            finer_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_, places_; ///< by corners, by places
    std::uint32_t                                    nextPlace_;
};

double longestEdgeOf(const CreasedMesh& mesh)
{
    double longest = 0;
    for (const Triangle& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, glm::distance(mesh.positions[face[k]], mesh.positions[face[(k + 1) % 3]]));
    return longest;
}

/// Faces about a vertex that meet smoothly.
struct Sector {
    glm::dvec3                 sum{}; ///< of their normals, by area [m^2]
    std::vector<std::uint32_t> faces;

    [[nodiscard]] bool holds(const glm::dvec3& normal) const
    {
        return std::abs(glm::dot(sum, normal)) >= kSmooth * glm::length(sum) * glm::length(normal);
    }
    void add(std::uint32_t face, const glm::dvec3& normal)
    {
        sum += glm::dot(sum, normal) < 0 ? -normal : normal; // faces may be turned round
        faces.push_back(face);
    }
};

/// Puts the corners of a place one after the other.
void sortByPlace(CreasedMesh& mesh)
{
    std::vector<std::uint32_t> order(mesh.placeOf.size()), now(order.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t corner) { return mesh.placeOf[corner]; });
    CreasedMesh sorted;
    for (const std::uint32_t corner : order) {
        now[corner] = std::uint32_t(sorted.placeOf.size());
        sorted.positions.push_back(mesh.positions[corner]);
        sorted.normals.push_back(mesh.normals[corner]);
        sorted.placeOf.push_back(mesh.placeOf[corner]);
    }
    for (const auto& [a, b, c] : mesh.faces) sorted.faces.push_back({now[a], now[b], now[c]});
    mesh = std::move(sorted);
}

} // namespace

Fans::Fans(std::span<const Triangle> all, std::size_t corners) : first(corners + 1), faces(3 * all.size())
{
    for (const Triangle& face : all)
        for (const std::uint32_t corner : face) ++first[corner + 1];
    for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t n = 0; n < all.size(); ++n)
        for (const std::uint32_t corner : all[n]) faces[next[corner]++] = n;
}

glm::dvec3 meanNormal(std::span<const glm::dvec3> positions, std::span<const Triangle> all,
                      std::span<const std::uint32_t> faces)
{
    glm::dvec3 sum(0);
    for (const std::uint32_t face : faces) {
        const auto& [a, b, c]   = all[face];
        const glm::dvec3 normal = doubleArea(positions[a], positions[b], positions[c]);
        sum += glm::dot(sum, normal) < 0 ? -normal : normal;
    }
    const double length = glm::length(sum);
    return length > 0 ? sum / length : glm::dvec3(0, 0, 1); // faces without an area have no normal
}

CreasedMesh creased(const SurfaceMesh& mesh)
{
    const Fans          fans(mesh.faces, mesh.vertices.size());
    CreasedMesh         result;
    std::vector<Sector> sectors;
    result.faces = mesh.faces;
    for (std::uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
        sectors.clear();
        for (const std::uint32_t face : fans.of(vertex)) {
            const auto& [a, b, c]   = mesh.faces[face];
            const glm::dvec3 normal = doubleArea(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
            auto at = std::ranges::find_if(sectors, [&](const Sector& sector) { return sector.holds(normal); });
            if (at == sectors.end()) at = sectors.insert(sectors.end(), Sector{});
            at->add(face, normal);
        }
        for (const Sector& sector : sectors) {
            for (const std::uint32_t face : sector.faces)
                for (std::size_t k = 0; k < 3; ++k)
                    if (mesh.faces[face][k] == vertex) result.faces[face][k] = std::uint32_t(result.placeOf.size());
            result.positions.push_back(mesh.vertices[vertex]);
            result.normals.push_back(meanNormal(mesh.vertices, mesh.faces, sector.faces));
            result.placeOf.push_back(vertex);
        }
    }
    return result;
}

CreasedMesh refined(CreasedMesh mesh, double longest, std::size_t most)
{
    for (double now = longestEdgeOf(mesh); now > longest; now = longestEdgeOf(mesh)) {
        Halving           halving(mesh, std::max(longest, now / 2));
        const std::size_t count = halving.count();
        if (count > most) break;
        halving.run(count);
    }
    sortByPlace(mesh);
    return mesh;
}

} // namespace palp
