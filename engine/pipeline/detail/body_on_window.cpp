#include "engine/pipeline/detail/body_on_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "engine/body/body_shell.h"
#include "engine/cloud/point_grid.h"
#include "engine/pipeline/detail/bending.h"
#include "engine/plate/load.h"

namespace palp {
namespace {

/// A node of the body near the window.
struct Site {
    glm::dvec3 place{}; ///< in the chart, along x and z [m]; y is 0, so that a grid of points finds it
    glm::dvec3 moved{}; ///< along x, into the surface, along z [m/N]
};

/// Finds where the body's nodes lie in the chart, from the touched points around each of them, which have a place in
/// both.
class SitesInChart {
public:
    SitesInChart(const Patch& patch, const SoftObject& used) : patch_(patch)
    {
        for (std::size_t k = 0; k < patch.touched; ++k) places_.push_back(used.positions()[patch.points[k]]);
        radius_ = kSpacings * patch.spacing;
        grid_.build(places_, radius_);
    }

    [[nodiscard]] std::optional<Site> siteOf(const BodyNode& node, const glm::dvec3& moved) const
    {
        constexpr double kNearly = 0.5; // a sheet's normal against the node's [1]
        Eigen::Matrix3d  matrix = Eigen::Matrix3d::Zero(), right = matrix;
        double           sum = 0, x = 0, z = 0, count = 0;
        const auto       each = [&](const auto& visit) {
            grid_.around(node.place, radius_, [&](std::size_t k, double d2) {
                if (d2 < radius_ * radius_) visit(k, d2);
            });
        };
        each([&](std::size_t k, double d2) {
            const double share = 1 - d2 / (radius_ * radius_);
            sum += share;
            x += share * patch_.positions[k].x;
            z += share * patch_.positions[k].z;
            ++count;
        });
        if (count < kFewest) return {};
        x /= sum;
        z /= sum;
        each([&](std::size_t k, double d2) {
            const double          share = 1 - d2 / (radius_ * radius_);
            const Eigen::Vector3d row(1, (patch_.positions[k].x - x) / radius_, (patch_.positions[k].z - z) / radius_);
            const glm::dvec3      d = (places_[k] - node.place) / radius_;
            matrix += share * row * row.transpose();
            right += share * row * Eigen::RowVector3d(d.x, d.y, d.z);
        });
        const Eigen::LDLT<Eigen::Matrix3d> factors(matrix);
        constexpr double                   kSound = 1e-3; // of the largest [1]
        if (factors.vectorD().minCoeff() < kSound * factors.vectorD().maxCoeff()) return {};
        const Eigen::Matrix3d fit      = factors.solve(right);
        const auto            vectorOf = [&](int row) { return glm::dvec3(fit(row, 0), fit(row, 1), fit(row, 2)); };
        const glm::dvec3 middle = vectorOf(0), east = vectorOf(1), north = vectorOf(2); // of the sheet, from the node
        const double     ee = glm::dot(east, east), en = glm::dot(east, north), nn = glm::dot(north, north);
        const double     det = ee * nn - en * en;
        if (!(det > 0)) return {};
        const double     be = -glm::dot(middle, east), bn = -glm::dot(middle, north);
        const ChartPoint at{x + radius_ * (be * nn - bn * en) / det, z + radius_ * (bn * ee - be * en) / det};
        glm::dvec3       outward = glm::normalize(glm::cross(east, north));
        const Frame&     frame   = patch_.chart.frame;
        if (glm::dot(glm::cross(frame.east, frame.north), frame.normal) < 0) outward = -outward;
        if (std::abs(glm::dot(outward, node.normal)) < kNearly) return {};
        // East and north are at right angles but for what the chart is distorted: both are turned alike.
        const glm::dvec3 e = glm::normalize(east), n = glm::normalize(north);
        const glm::dvec3 half = glm::normalize(e + n), across = glm::normalize(e - n);
        const glm::dvec3 alongX = (half + across) / std::sqrt(2.0), alongZ = (half - across) / std::sqrt(2.0);
        return Site{{at.x, 0, at.z}, {glm::dot(moved, alongX), -glm::dot(moved, outward), glm::dot(moved, alongZ)}};
    }

private:
    static constexpr double kSpacings = 3, kFewest = 6; // [spacings]; points

    const Patch&            patch_;
    std::vector<glm::dvec3> places_;     ///< of the touched points [m]
    double                  radius_ = 0; ///< [m]
    PointGrid               grid_;
};

std::vector<Site> sitesOf(const Patch& patch, const SoftObject& used, const BodyShell& body, const BodyMoves& moves)
{
    const SitesInChart in(patch, used);
    const double       reach = patch.window.grid.sizeX() + 3 * body.mesh().spacing; // [m], > the window's corner
    std::vector<Site>  sites;
    for (std::size_t node = 0; node < body.mesh().nodes.size(); ++node) {
        const BodyNode& of = body.mesh().nodes[node];
        if (!body.isOnHeldPiece(node) || glm::distance(of.place, patch.contact.point) > reach) continue;
        if (const auto site = in.siteOf(of, moves.moved[node])) sites.push_back(*site);
    }
    return sites;
}

/// Returns what the sites say about a place in the chart: a paraboloid through those around; empty where there are too
/// few.
std::optional<glm::dvec3> movedAt(const PointGrid& grid, const std::vector<Site>& sites, const ChartPoint& at,
                                  double spacing)
{
    using Row               = Eigen::Matrix<double, 6, 1>;
    constexpr double kReach = 2.5, kWider = 1.4; // [spacings], [1]
    constexpr int    kFewest = 9, kWidenings = 3;
    double           radius = kReach * spacing;
    for (int attempt = 0; attempt <= kWidenings; ++attempt, radius *= kWider) {
        Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 3> right  = Eigen::Matrix<double, 6, 3>::Zero();
        int                         count  = 0;
        grid.around({at.x, 0, at.z}, radius, [&](std::size_t k, double d2) {
            const double rest = 1 - d2 / (radius * radius);
            if (!(rest > 0)) return;
            const double x = (sites[k].place.x - at.x) / radius, z = (sites[k].place.z - at.z) / radius;
            Row          row;
            row << 1, x, z, x * x, x * z, z * z;
            matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, rest * rest);
            right += rest * rest * row * Eigen::RowVector3d(sites[k].moved.x, sites[k].moved.y, sites[k].moved.z);
            ++count;
        });
        if (count < kFewest) continue;
        const Eigen::LDLT<Eigen::Matrix<double, 6, 6>, Eigen::Lower> factors(matrix);
        constexpr double                                             kSound = 1e-4; // of the largest [1]
        if (!(factors.vectorD().minCoeff() > kSound * factors.vectorD().maxCoeff())) continue;
        const Eigen::Matrix<double, 6, 3> fit = factors.solve(right);
        return glm::dvec3(fit(0, 0), fit(0, 1), fit(0, 2));
    }
    return {};
}

/// Returns 1 at a side of the window and 0 in its inner half [1], smooth to the second derivative.
double fading(double x, double z, const PlateGrid& grid)
{
    const auto inner = [](double at, double size) { // 1 in the inner half
        const double t = std::clamp((0.5 - std::abs(at) / size) / 0.25, 0.0, 1.0);
        return t * t * t * (10 + t * (6 * t - 15));
    };
    return 1 - inner(x, grid.sizeX()) * inner(z, grid.sizeZ());
}

/// Values on a lattice that is a few steps wider than the window, as a smooth function (Catmull and Rom 1974).
class Lattice {
public:
    static constexpr int kSteps = 32, kBeyond = 3; ///< along the window, and to either side of it
    static constexpr int kNodes = kSteps + 2 * kBeyond + 1;

    explicit Lattice(const PlateGrid& grid) : step_(grid.sizeX() / kSteps), values_(std::size_t(kNodes) * kNodes) {}

    [[nodiscard]] ChartPoint place(int i, int j) const
    {
        return {(i - kBeyond - kSteps / 2) * step_, (j - kBeyond - kSteps / 2) * step_};
    }
    [[nodiscard]] std::optional<glm::dvec3>& at(int i, int j)
    {
        return values_[std::size_t(i) * kNodes + std::size_t(j)];
    }

    /// Gives nodes without a value the mean of those around, from one to the next: beyond a border nothing is felt, but
    /// the function reaches across it.
    /// \return false if none has one
    [[nodiscard]] bool fill()
    {
        if (std::ranges::none_of(values_, [](const auto& value) { return value.has_value(); })) return false;
        while (std::ranges::any_of(values_, [](const auto& value) { return !value; })) {
            const auto before = values_;
            for (int i = 0; i < kNodes; ++i)
                for (int j = 0; j < kNodes; ++j)
                    if (!at(i, j)) at(i, j) = meanAround(before, i, j);
        }
        return true;
    }

    /// \pre fill()
    [[nodiscard]] glm::dvec3 at(const ChartPoint& place) const
    {
        const double x = place.x / step_ + kSteps / 2 + kBeyond, z = place.z / step_ + kSteps / 2 + kBeyond;
        const int  i = std::clamp(int(std::floor(x)), 1, kNodes - 3), j = std::clamp(int(std::floor(z)), 1, kNodes - 3);
        const auto u = weights(x - i), v = weights(z - j);
        glm::dvec3 sum{};
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                sum += u[std::size_t(a)] * v[std::size_t(b)] *
                       *values_[std::size_t(i - 1 + a) * kNodes + std::size_t(j - 1 + b)];
        return sum;
    }

private:
    using Values = std::vector<std::optional<glm::dvec3>>;

    static std::optional<glm::dvec3> meanAround(const Values& values, int i, int j)
    {
        glm::dvec3 sum{};
        double     count = 0;
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, kNodes - 1); ++a)
            for (int b = std::max(j - 1, 0); b <= std::min(j + 1, kNodes - 1); ++b)
                if (const auto& value = values[std::size_t(a) * kNodes + std::size_t(b)]) {
                    sum += *value;
                    ++count;
                }
        if (count == 0) return {};
        return sum / count;
    }

    static std::array<double, 4> weights(double t)
    {
        const double t2 = t * t, t3 = t2 * t;
        return {(-t3 + 2 * t2 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (-3 * t3 + 4 * t2 + t) / 2, (t3 - t2) / 2};
    }

    double step_; ///< [m]
    Values values_;
};

/// Returns a field with one more node around, of which `beyond` says what is there, from those at the side and next to
/// it inwards.
template <class Beyond>
NodeField widened(const NodeField& field, const Beyond& beyond)
{
    const int nx = field.nodesX(), nz = field.nodesZ();
    NodeField wide(nx + 2, nz + 2);
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < nz; ++j) wide(i + 1, j + 1) = field(i, j);
    for (int j = 1; j <= nz; ++j) {
        wide(0, j)      = beyond(wide(1, j), wide(2, j), wide(3, j), wide(4, j));
        wide(nx + 1, j) = beyond(wide(nx, j), wide(nx - 1, j), wide(nx - 2, j), wide(nx - 3, j));
    }
    for (int i = 0; i < nx + 2; ++i) {
        wide(i, 0)      = beyond(wide(i, 1), wide(i, 2), wide(i, 3), wide(i, 4));
        wide(i, nz + 1) = beyond(wide(i, nz), wide(i, nz - 1), wide(i, nz - 2), wide(i, nz - 3));
    }
    return wide;
}

/// The strains of a displaced shallow shell at a node, along x, along z and across [1].
struct Strain {
    double x = 0, z = 0, xz = 0;
};

Strain strainOf(const BodyOnWindow& body, const PlateGrid& grid, const CurvatureField& curved, int i, int j)
{
    const auto   alongX = [&](const NodeField& of) { return (of(i + 2, j + 1) - of(i, j + 1)) / (2 * grid.spacingX); };
    const auto   alongZ = [&](const NodeField& of) { return (of(i + 1, j + 2) - of(i + 1, j)) / (2 * grid.spacingZ); };
    const double w      = body.w(i + 1, j + 1);
    return {alongX(body.x) - curved.x(i, j) * w, alongZ(body.z) - curved.z(i, j) * w,
            (alongZ(body.x) + alongX(body.z)) / 2 - curved.xz(i, j) * w};
}

/// Returns the share of the nearest node that nothing holds [1]: what is held does not move.
double freeOf(const Patch& patch, int i, int j)
{
    if (patch.held.values().empty()) return 1;
    return 1 - patch.held(std::clamp(i, 0, patch.window.grid.cellsX), std::clamp(j, 0, patch.window.grid.cellsZ));
}

} // namespace

std::shared_ptr<const BodyOnWindow> bodyOnWindow(const Patch& patch, const SoftObject& object, const SoftObject& used,
                                                 const PatchSettings& settings)
{
    const auto body = bodyShellOf(object);
    if (!body) return {};
    const auto moves = body->under(patch.contact.point, patch.chart.frame.normal, settings.footprintRadius);
    if (!moves) return {};
    const std::vector<Site> sites = sitesOf(patch, used, *body, *moves);
    if (sites.empty()) return {};
    std::vector<glm::dvec3> places;
    for (const Site& site : sites) places.push_back(site.place);
    const double spacing = body->mesh().spacing;
    PointGrid    near;
    near.build(places, spacing);

    const PlateGrid& grid = patch.window.grid;
    Lattice          lattice(grid);
    for (int i = 0; i < Lattice::kNodes; ++i)
        for (int j = 0; j < Lattice::kNodes; ++j) lattice.at(i, j) = movedAt(near, sites, lattice.place(i, j), spacing);
    if (!lattice.fill()) return {};
    auto            result = std::make_shared<BodyOnWindow>();
    const NodeField wide(grid.nodesX() + 2, grid.nodesZ() + 2);
    result->x = result->z = result->w = wide;
    result->spacing                   = spacing;
    for (int i = 0; i < wide.nodesX(); ++i)
        for (int j = 0; j < wide.nodesZ(); ++j) {
            const ChartPoint at{(i - 1) * grid.spacingX - grid.sizeX() / 2, (j - 1) * grid.spacingZ - grid.sizeZ() / 2};
            const double     share = fading(at.x, at.z, grid);
            if (share == 0) continue;
            const glm::dvec3 moved = share * freeOf(patch, i - 1, j - 1) * lattice.at(at);
            result->x(i, j)        = moved.x;
            result->w(i, j)        = moved.y;
            result->z(i, j)        = moved.z;
        }
    return result;
}

double bodyGive(const Patch& patch, const NodeField& load, const NodeField& w, const NodeField& phi)
{
    const BodyOnWindow& body     = *patch.body;
    const PlateGrid&    grid     = patch.window.grid;
    const double        nu       = patch.plate.poissonRatio;
    const auto          mirrored = [](double, double next, double, double) { return next; }; // clamped
    const auto          goingOn  = [](double a, double b, double c, double d) { return 4 * a - 6 * b + 4 * c - d; };
    const NodeField     wide     = widened(w, mirrored);
    const NodeField     stress   = phi.values().empty() ? NodeField() : widened(phi, goingOn);
    double              give     = 0;
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double  area = nodeArea(grid, i, j);
            const Bending own = Bending::at(grid, wide, i + 1, j + 1), of = Bending::at(grid, body.w, i + 1, j + 1);
            give += load(i, j) * body.w(i + 1, j + 1);
            give -= area * patch.plate.rigidity(i, j) *
                    ((own.xx + own.zz) * (of.xx + of.zz) -
                     (1 - nu) * (own.xx * of.zz + own.zz * of.xx - 2 * own.xz * of.xz));
            if (stress.values().empty() || !patch.curvature) continue;
            const Bending second = Bending::at(grid, stress, i + 1, j + 1);
            const Strain  strain = strainOf(body, grid, *patch.curvature, i, j);
            give -= area * (second.zz * strain.x + second.xx * strain.z - 2 * second.xz * strain.xz);
        }
    return give;
}

} // namespace palp
