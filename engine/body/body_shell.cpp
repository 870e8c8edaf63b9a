#include "engine/body/body_shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

#include "engine/body/detail/flat_fit.h"
#include "engine/body/detail/shell_triangle.h"
#include "engine/body/two_faces.h"
#include "engine/cloud/body_note.h"

namespace palp {
namespace {

constexpr int kFreedoms = 6; ///< of a node
constexpr int kFixed    = -1;

using Matrix = Eigen::SparseMatrix<double>;

/// Returns which piece each node is of, by the number of a node of that.
std::vector<std::uint32_t> piecesOf(const BodyMesh& mesh)
{
    std::vector<std::uint32_t> of(mesh.nodes.size());
    std::iota(of.begin(), of.end(), 0U);
    const auto rootOf = [&](std::uint32_t node) {
        while (of[node] != node) node = of[node] = of[of[node]];
        return node;
    };
    for (const BodyTriangle& triangle : mesh.triangles)
        for (const std::uint32_t node : triangle.nodes) of[rootOf(node)] = rootOf(triangle.nodes[0]);
    for (std::uint32_t node = 0; node < of.size(); ++node) of[node] = rootOf(node);
    return of;
}

/// The share of a force that a node bears.
struct Borne {
    std::size_t node  = 0;
    double      share = 0; ///< [1]
};

/// Returns whether a triangle is next to none.
bool isSliver(const std::array<glm::dvec3, 3>& corners)
{
    constexpr double kNone   = 1e-6; // of the square of its longest side [1]
    double           longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, glm::distance(corners[k], corners[(k + 1) % 3]));
    return !(glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) > kNone * longest * longest);
}

} // namespace

struct BodyShell::Impl {
    BodyMesh                                mesh;
    std::vector<bool>                       onHeldPiece;
    std::vector<std::vector<std::uint32_t>> beside;  ///< nodes that triangles join to each
    std::vector<int>                        firstOf; ///< number of each node's first unknown, or kFixed
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> factors;
    bool                                                                 isSound = false;

    explicit Impl(const SoftObject& object, std::size_t most) : mesh(bodyMesh(object, most))
    {
        findHeldPieces();
        beside.resize(mesh.nodes.size());
        for (const BodyTriangle& triangle : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k)
                for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
                    beside[triangle.nodes[k]].push_back(triangle.nodes[other]);
        int unknowns = 0;
        firstOf.assign(mesh.nodes.size(), kFixed);
        for (std::size_t node = 0; node < firstOf.size(); ++node) {
            if (!onHeldPiece[node] || mesh.nodes[node].held) continue;
            firstOf[node] = unknowns;
            unknowns += kFreedoms;
        }
        if (unknowns == 0) return;
        factors.compute(assembled(unknowns, object.material()));
        isSound = factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all(); // not if NaN
    }

    void findHeldPieces()
    {
        constexpr int                    kFewest = 3; // of them: one alone is a stray point
        const std::vector<std::uint32_t> of      = piecesOf(mesh);
        std::vector<int>                 held(mesh.nodes.size());
        for (std::size_t node = 0; node < of.size(); ++node) held[of[node]] += mesh.nodes[node].held;
        onHeldPiece.resize(mesh.nodes.size());
        for (std::size_t node = 0; node < of.size(); ++node) onHeldPiece[node] = held[of[node]] >= kFewest;
    }

    [[nodiscard]] Matrix assembled(int unknowns, const Material& material) const
    {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(mesh.triangles.size() * 180);
        for (const BodyTriangle& triangle : mesh.triangles) {
            std::array<glm::dvec3, 3> corners;
            double                    ln = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = mesh.nodes[triangle.nodes[k]].place;
                ln += std::log(mesh.nodes[triangle.nodes[k]].rigidity) / 3;
            }
            if (!onHeldPiece[triangle.nodes[0]] || isSliver(corners)) continue;
            const TriangleStiffness own =
                shellTriangle(corners, material.modulus(std::exp(ln)), material.poissonRatio, material.thickness);
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    const int row    = firstOf[triangle.nodes[std::size_t(a)]];
                    const int column = firstOf[triangle.nodes[std::size_t(b)]];
                    if (row == kFixed || column == kFixed || column > row) continue;
                    for (int i = 0; i < kFreedoms; ++i)
                        for (int j = 0; j < (row == column ? i + 1 : kFreedoms); ++j)
                            entries.emplace_back(
                                row + i, column + j,
                                triangle.share * own[std::size_t(kFreedoms * a + i)][std::size_t(kFreedoms * b + j)]);
                }
        }
        Matrix matrix(unknowns, unknowns);
        matrix.setFromTriplets(entries.begin(), entries.end());
        return matrix;
    }

    /// Returns the node of the touched wall that is nearest to a place, if any is within a distance [m].
    [[nodiscard]] std::optional<std::uint32_t> nodeAt(const glm::dvec3& place, const glm::dvec3& outward,
                                                      double reach) const
    {
        constexpr double             kAlong = 0.3; // cosine of 73 degrees
        std::optional<std::uint32_t> nearest;
        for (std::uint32_t node = 0; node < mesh.nodes.size(); ++node) {
            const double away = glm::distance(mesh.nodes[node].place, place);
            if (!(away < reach) || std::abs(glm::dot(mesh.nodes[node].normal, outward)) < kAlong) continue;
            nearest = node;
            reach   = away;
        }
        return nearest;
    }

    /// Returns the nodes within a distance [m] of a place that triangles lead to from one.
    [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t first, const glm::dvec3& place, double reach) const
    {
        std::vector<std::uint32_t> found{first};
        for (std::size_t k = 0; k < found.size(); ++k)
            for (const std::uint32_t next : beside[found[k]])
                if (glm::distance(mesh.nodes[next].place, place) < reach &&
                    std::ranges::find(found, next) == found.end())
                    found.push_back(next);
        return found;
    }

    /// Returns how the nodes about a place bear a force on it: of the same wall, and together as far along it as the
    /// place is.
    [[nodiscard]] std::vector<Borne> borneBy(const glm::dvec3& place, const glm::dvec3& outward, double radius) const
    {
        constexpr double kWide = 2, kFarther = 1.5; // [spacings], [1]
        double           reach = std::max(radius, kWide * mesh.spacing);
        for (int attempt = 0; attempt < 3; ++attempt, reach *= kFarther) {
            const auto first = nodeAt(place, outward, reach);
            if (!first) continue;
            if (!onHeldPiece[*first]) return {};
            const FlatFrame              frame = FlatFrame::about(place, outward);
            std::vector<Borne>           borne;
            Eigen::Matrix3d              matrix = Eigen::Matrix3d::Zero();
            std::vector<Eigen::Vector3d> rows;
            for (const std::uint32_t node : around(*first, place, reach)) {
                const glm::dvec3 d    = mesh.nodes[node].place - place;
                const double     rest = 1 - glm::dot(d, d) / (reach * reach);
                const glm::dvec2 flat = frame.laid(mesh.nodes[node].place) / reach;
                borne.push_back({node, rest * rest});
                rows.emplace_back(1, flat.x, flat.y);
                matrix += borne.back().share * rows.back() * rows.back().transpose();
            }
            constexpr double                                     kSound = 1e-3; // of the largest [1]
            const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
            if (borne.size() < 3 || solver.eigenvalues()[0] < kSound * solver.eigenvalues()[2]) continue;
            const Eigen::Vector3d fit = matrix.ldlt().solve(Eigen::Vector3d(1, 0, 0));
            for (std::size_t k = 0; k < borne.size(); ++k) borne[k].share *= fit.dot(rows[k]);
            return borne;
        }
        return {};
    }
};

BodyShell::BodyShell(const SoftObject& object, std::size_t most) : impl_(std::make_unique<const Impl>(object, most)) {}
BodyShell::~BodyShell()                               = default;
BodyShell::BodyShell(BodyShell&&) noexcept            = default;
BodyShell& BodyShell::operator=(BodyShell&&) noexcept = default;

const BodyMesh& BodyShell::mesh() const noexcept
{
    return impl_->mesh;
}

bool BodyShell::isHeld() const noexcept
{
    return impl_->isSound;
}

bool BodyShell::isOnHeldPiece(std::size_t node) const noexcept
{
    return impl_->onHeldPiece[node];
}

std::optional<BodyMoves> BodyShell::under(const glm::dvec3& place, const glm::dvec3& outward, double radius) const
{
    if (!impl_->isSound) return {};
    const auto borne = impl_->borneBy(place, outward, radius);
    if (borne.empty()) return {};
    Eigen::VectorXd force = Eigen::VectorXd::Zero(impl_->factors.rows());
    for (const auto& [node, share] : borne)
        if (const int first = impl_->firstOf[node]; first != kFixed)
            for (int k = 0; k < 3; ++k) force[first + k] -= share * outward[k];
    const Eigen::VectorXd moves = impl_->factors.solve(force);
    BodyMoves             result{std::vector<glm::dvec3>(impl_->mesh.nodes.size()),
                     std::vector<glm::dvec3>(impl_->mesh.nodes.size()), force.dot(moves)};
    for (std::size_t node = 0; node < impl_->firstOf.size(); ++node) {
        const int first = impl_->firstOf[node];
        if (first == kFixed) continue;
        result.moved[node]  = {moves[first], moves[first + 1], moves[first + 2]};
        result.turned[node] = {moves[first + 3], moves[first + 4], moves[first + 5]};
    }
    return result;
}

std::shared_ptr<const BodyShell> bodyShellOf(const SoftObject& object)
{
    BodyNote&             note = object.bodyNote();
    const std::lock_guard lock(note.mutex);
    if (note.isMade) return note.shell;
    if (!object.held().empty() && !hasTwoFaces(object)) {
        auto shell = std::make_shared<const BodyShell>(object);
        if (shell->isHeld()) note.shell = std::move(shell);
    }
    note.isMade = true;
    return note.shell;
}

} // namespace palp
