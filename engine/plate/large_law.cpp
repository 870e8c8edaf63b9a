#include "engine/plate/large_law.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/plate/load.h"
#include "engine/plate/report_text.h"
#include "engine/plate/shell_energy.h"
#include "engine/plate/thrust.h"

namespace palp {
namespace {

constexpr int kMost = 3; ///< shapes of the reduced model

using Numbers = std::array<double, kMost>;

// --- a polynomial of degree four in at most three numbers:  V = 1/2 R aa + 1/2 C aaa + 1/2 G aaaa

struct Quartic {
    std::array<Numbers, kMost>                                       two{};
    std::array<std::array<Numbers, kMost>, kMost>                    three{};
    std::array<std::array<std::array<Numbers, kMost>, kMost>, kMost> four{};

    struct Local {
        double                     value = 0;
        Numbers                    slope{};
        std::array<Numbers, kMost> second{};
    };

    /// Returns value and derivatives at `a`; the coefficients must be symmetric.
    [[nodiscard]] Local at(const Numbers& a) const
    {
        Local here;
        for (std::size_t i = 0; i < kMost; ++i)
            for (std::size_t j = 0; j < kMost; ++j) {
                double cubic = 0, quartic = 0;
                for (std::size_t k = 0; k < kMost; ++k) {
                    cubic += three[i][j][k] * a[k];
                    for (std::size_t l = 0; l < kMost; ++l) quartic += four[i][j][k][l] * a[k] * a[l];
                }
                here.value += (two[i][j] + cubic + quartic) * a[i] * a[j] / 2;
                here.slope[i] += (two[i][j] + 1.5 * cubic + 2 * quartic) * a[j];
                here.second[i][j] = two[i][j] + 3 * cubic + 6 * quartic;
            }
        return here;
    }

    void makeSymmetric()
    {
        const Quartic raw          = *this;
        constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
        for (std::size_t i = 0; i < kMost; ++i)
            for (std::size_t j = 0; j < kMost; ++j) {
                two[i][j] = (raw.two[i][j] + raw.two[j][i]) / 2;
                for (std::size_t k = 0; k < kMost; ++k) {
                    const std::array<std::size_t, 3> at{i, j, k};
                    three[i][j][k] = 0;
                    for (const auto& o : orders) three[i][j][k] += raw.three[at[o[0]]][at[o[1]]][at[o[2]]] / 6;
                    for (std::size_t l = 0; l < kMost; ++l) // g_ij . g_kl: pairs are symmetric already
                        four[i][j][k][l] = (raw.four[i][j][k][l] + raw.four[i][k][j][l] + raw.four[i][l][j][k]) / 3;
                }
            }
    }

    /// Returns the same polynomial of other numbers b, where a = change b.
    [[nodiscard]] Quartic changed(const std::array<Numbers, kMost>& change) const
    {
        Quartic result;
        for (std::size_t code = 0; code < 81 * 81; ++code) {
            const std::size_t i = code % 3, j = code / 3 % 3, k = code / 9 % 3, l = code / 27 % 3;
            const std::size_t p = code / 81 % 3, q = code / 243 % 3, r = code / 729 % 3, s = code / 2187;
            const double      both = change[p][i] * change[q][j];
            if (k == 0 && l == 0 && r == 0 && s == 0) result.two[i][j] += two[p][q] * both;
            if (l == 0 && s == 0) result.three[i][j][k] += three[p][q][r] * both * change[r][k];
            result.four[i][j][k][l] += four[p][q][r][s] * both * change[r][k] * change[s][l];
        }
        return result;
    }
};

// --- the shapes

/// Adds a multiple of a field to another.
void add(NodeField& to, double times, const NodeField& field)
{
    for (std::size_t n = 0; n < to.values().size(); ++n) to.values()[n] += times * field.values()[n];
}

/// Solves what belongs to a shell.
class Solves {
public:
    Solves(const Shell& shell, PlateSolver& solver, double tolerance)
        : shell_(shell), membrane_(membraneOf(shell)), anchored_(membrane_), solver_(solver), tolerance_(tolerance),
          flat_(std::ranges::all_of(
              std::array{&shell.curvatureX, &shell.curvatureZ, &shell.curvatureXZ},
              [](const NodeField* k) { return std::ranges::all_of(k->values(), [](double v) { return v == 0; }); })),
          thrusts_(shell)
    {
        // A phi that no side holds may float: no load of slopes or curvature moves it. So soft a ground changes its
        // second derivatives by 1e-5 at most, because its slowest wave resists by 182 C / a^4.
        constexpr double kGround = 1e-5 * 182;
        const double     a       = std::max(shell.bending.grid.sizeX(), shell.bending.grid.sizeZ());
        if (isStressFree(shell))
            anchored_.foundation = kGround * geometricMean(shell.membraneCompliance.values()) / std::pow(a, 4);
        if (!shell.thrusts.empty()) findThrusts();
    }

    [[nodiscard]] const Plate& membrane() const { return membrane_; }
    [[nodiscard]] bool         flat() const { return flat_; }

    /// Returns the phi that loads of the membrane give: C^-1 of them, and thrusts.
    [[nodiscard]] std::vector<NodeField> relax(std::span<const NodeField> loads) const
    {
        std::vector<NodeField> fields = relaxWithoutThrust(loads);
        for (std::size_t n = 0; n < fields.size() && !ofThrusts_.empty(); ++n) addThrusts(fields[n], loads[n]);
        return fields;
    }

    /// Returns w under forces on the linear shell.
    [[nodiscard]] NodeField bend(const NodeField& forces) const
    {
        const Footprint     all(forces);
        const PlateSolution of = flat_ ? solver_.solve(shell_.bending, forces, tolerance_)
                                       : solver_.solveFootprints(shell_, {&all, 1}, 0, tolerance_, tolerance_).whole;
        demandConverged(of.report);
        return of.deflection;
    }

private:
    [[nodiscard]] std::vector<NodeField> relaxWithoutThrust(std::span<const NodeField> loads) const
    {
        std::vector<NodeField> fields;
        for (PlateSolution& of : solver_.solveAll(anchored_, loads, tolerance_)) {
            demandConverged(of.report);
            fields.push_back(std::move(of.deflection));
        }
        return fields;
    }

    /// Adds the thrusts that go with a load, which the membrane without them answers by phi.
    void addThrusts(NodeField& phi, const NodeField& load) const
    {
        std::vector<double> right;
        for (const NodeField& of : ofThrusts_) right.push_back(dot(load, of));
        const std::vector<double> y = thrusts_.numbers(stretched_, right);
        for (std::size_t t = 0; t < y.size(); ++t) add(phi, y[t], ofThrusts_[t]);
    }

    static void demandConverged(const SolveReport& report)
    {
        if (!report.converged)
            throw Error("a shape of deep dents is not solved as well as asked for: " + errorText(report));
    }

    /// Finds the phi of each thrust T with what the membrane answers to it, T - C^-1 C T, and minus what that is by
    /// under the others' stresses.
    void findThrusts()
    {
        std::vector<NodeField> loads;
        for (const ShellLoad& load : thrusts_.loads()) loads.push_back(load.onPhi); // -C T
        ofThrusts_ = relaxWithoutThrust(loads);
        for (const NodeField& load : loads)
            for (const NodeField& answer : ofThrusts_) stretched_.push_back(-dot(load, answer));
        for (std::size_t t = 0; t < ofThrusts_.size(); ++t) add(ofThrusts_[t], 1, shell_.thrusts[t]);
    }

    const Shell&           shell_;
    Plate                  membrane_, anchored_;
    PlateSolver&           solver_;
    double                 tolerance_;
    bool                   flat_;
    Thrusts                thrusts_;
    std::vector<NodeField> ofThrusts_;
    std::vector<double>    stretched_; ///< [1/(N m)]
};

/// The shapes w_i, the stresses f_i that curvature gives them, and the stresses g_ij of their slopes.
struct Shapes {
    std::vector<NodeField>                          w, f, right; ///< right: A w_i + B f_i
    std::array<std::array<NodeField, kMost>, kMost> g,
        stretch; ///< i <= j; half of what their slopes load the membrane with

    [[nodiscard]] const NodeField& slopes(std::size_t i, std::size_t j) const
    {
        return g[std::min(i, j)][std::max(i, j)];
    }
};

/// Adds a shape, and finds the stresses of it alone and with those before.
void addShape(Shapes& shapes, const Shell& shell, const Solves& solves, NodeField w, NodeField right)
{
    const std::size_t      n = shapes.w.size();
    std::vector<NodeField> loads;
    shapes.w.push_back(std::move(w));
    shapes.right.push_back(std::move(right));
    for (std::size_t i = 0; i <= n; ++i) {
        loads.push_back(stretchOf(shell, solves.membrane(), shapes.w[i], shapes.w[n]));
        for (double& value : loads.back().values()) value /= 2;
    }
    if (!solves.flat()) loads.push_back(couplingLoad(shell, shapes.w[n]));
    std::vector<NodeField> fields = solves.relax(loads);
    for (std::size_t i = 0; i <= n; ++i) {
        shapes.g[i][n]       = std::move(fields[i]);
        shapes.stretch[i][n] = std::move(loads[i]);
    }
    shapes.f.push_back(solves.flat() ? NodeField(shell.bending.grid) : std::move(fields[n + 1]));
}

/// Returns the energy of a sum of the shapes; phi is the one that goes with it.
Quartic energyOf(const Shapes& shapes)
{
    Quartic           energy;
    const std::size_t n = shapes.w.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            energy.two[i][j] = dot(shapes.w[j], shapes.right[i]);
            if (j < i) continue;
            const NodeField& half = shapes.stretch[i][j];
            for (std::size_t k = 0; k < n; ++k) {
                energy.three[k][i][j] = energy.three[k][j][i] = 2 * dot(shapes.f[k], half);
                for (std::size_t l = 0; l < n; ++l)
                    energy.four[i][j][k][l] = energy.four[j][i][k][l] = dot(shapes.slopes(k, l), half);
            }
        }
    energy.makeSymmetric();
    return energy;
}

/// Returns how shapes are mixed from the depth and from numbers that leave it as it is, all of the size of a depth: the
/// first of the result are those of the depth.
std::array<Numbers, kMost> byDepth(const Shapes& shapes, const NodeField& load, const Quartic& energy)
{
    std::array<Numbers, kMost> mix{};
    const double               first = dot(load, shapes.w[0]);
    mix[0][0]                        = 1 / first;
    for (std::size_t k = 1; k < shapes.w.size(); ++k) {
        const double part = dot(load, shapes.w[k]) / first; // of the first in it
        const double own  = energy.two[k][k] - 2 * part * energy.two[0][k] + part * part * energy.two[0][0];
        const double size = own > 0 ? std::sqrt(energy.two[0][0] / own) / first : 0;
        mix[k][k]         = size;
        mix[0][k]         = -part * size;
    }
    return mix;
}

/// Returns -H^-1 of the slope in the numbers beside the depth; H is made definite where it is not.
std::pair<double, double> stepOf(const Quartic::Local& here, double stiffness)
{
    double       a = here.second[1][1], b = here.second[1][2], c = here.second[2][2];
    const double middle = (a + c) / 2, least = middle - std::hypot((a - c) / 2, b);
    const double more = std::max(0.0, 1e-9 * stiffness - least);
    a += more;
    c += more;
    const double det = a * c - b * b;
    return {-(c * here.slope[1] - b * here.slope[2]) / det, -(a * here.slope[2] - b * here.slope[1]) / det};
}

/// Lowers the energy at a depth as far as it goes.
Quartic::Local leastAt(const Quartic& energy, Numbers& at)
{
    Quartic::Local here      = energy.at(at);
    const double   stiffness = energy.two[0][0];
    for (int n = 0; n < 50; ++n) {
        auto [y, z] = stepOf(here, stiffness);
        Quartic::Local there;
        Numbers        next = at;
        for (int half = 0; half < 30; ++half, y /= 2, z /= 2) {
            next  = {at[0], at[1] + y, at[2] + z};
            there = energy.at(next);
            if (!(there.value > here.value)) break;
        }
        if (there.value > here.value) break;
        at   = next;
        here = there;
        if (std::abs(y) + std::abs(z) < 1e-12 * at[0]) break;
    }
    return here;
}

/// Returns how the force changes with the depth while the other numbers follow.
double tangentOf(const Quartic::Local& here, double stiffness)
{
    Quartic::Local pulled = here;
    pulled.slope          = {0, here.second[1][0], here.second[2][0]};
    const auto [y, z]     = stepOf(pulled, stiffness);
    return here.second[0][0] + here.second[0][1] * y + here.second[0][2] * z;
}

/// Returns the forces that a sum of the shapes leaves over, of those on the nodes: none where it satisfies all
/// equations.
/// \param parts  of the shapes
/// \param force  of the load [N]
NodeField leftOver(const Shapes& shapes, const Shell& shell, const Solves& solves, const NodeField& load,
                   const Numbers& parts, double force)
{
    const PlateGrid& grid = shell.bending.grid;
    NodeField        left(grid), w(grid), phi(grid), ofSlopes(grid);
    add(left, force, load);
    for (std::size_t i = 0; i < shapes.w.size(); ++i) {
        add(left, -parts[i], shapes.right[i]);
        add(w, parts[i], shapes.w[i]);
        add(phi, parts[i], shapes.f[i]);
        for (std::size_t j = 0; j < shapes.w.size(); ++j) add(ofSlopes, parts[i] * parts[j], shapes.slopes(i, j));
    }
    add(phi, 1, ofSlopes);
    add(left, -1, stretchForces(shell, solves.membrane(), phi, w));
    if (!solves.flat()) add(left, -1, couplingForces(shell, ofSlopes));
    return left;
}

/// Returns forces without those beyond a border, where next to nothing resists, and a shape would be made of it.
NodeField onSheet(const Shell& shell, NodeField forces)
{
    constexpr double kResists = 3e-3; // share of the sheet that may be pushed like the sheet [1]
    const NodeField  shares   = sharesOfSheet(shell);
    for (std::size_t n = 0; n < shares.values().size(); ++n)
        forces.values()[n] *= std::min(1.0, shares.values()[n] / kResists);
    return forces;
}

/// Adds the answer of the linear shell to what the best sum of the shapes at a depth leaves over.
void addWhatIsMissing(Shapes& shapes, const Shell& shell, const NodeField& load, const Solves& solves, double depth)
{
    const Quartic                    raw    = energyOf(shapes);
    const std::array<Numbers, kMost> mix    = byDepth(shapes, load, raw);
    const Quartic                    energy = raw.changed(mix);
    Numbers                          at{depth}, parts{};
    const double                     force = leastAt(energy, at).slope[0];
    for (std::size_t i = 0; i < kMost; ++i)
        for (std::size_t k = 0; k < kMost; ++k) parts[i] += mix[i][k] * at[k];
    NodeField right = onSheet(shell, leftOver(shapes, shell, solves, load, parts, force));
    NodeField w     = solves.bend(right);
    addShape(shapes, shell, solves, std::move(w), std::move(right));
}

/// Finds the shapes: the linear one, and what the best sum of those before misses at half of the reach and at all of
/// it. For a flat sheet, whose first correction is of the third order, the latter is enough: 1 % at most.
Shapes shapesOf(const Shell& shell, const NodeField& load, const NodeField& linear, const Solves& solves, double reach)
{
    Shapes shapes;
    addShape(shapes, shell, solves, linear, load);
    if (!solves.flat()) addWhatIsMissing(shapes, shell, load, solves, reach / 2);
    addWhatIsMissing(shapes, shell, load, solves, reach);
    return shapes;
}

} // namespace

LargeLaw largeLaw(const Shell& shell, const NodeField& load, const NodeField& linear, double reach, PlateSolver& solver,
                  double tolerance)
{
    PALP_EXPECT(reach > 0, "a law of no reach");
    const Solves  solves(shell, solver, tolerance);
    const Shapes  shapes = shapesOf(shell, load, linear, solves, reach);
    const Quartic raw    = energyOf(shapes);
    const Quartic energy = raw.changed(byDepth(shapes, load, raw));

    LargeLaw law{.step = reach / LargeLaw::kSteps};
    Numbers  at{};
    for (std::size_t n = 0; n < law.force.size(); ++n) {
        at[0]                     = double(n) * law.step;
        const Quartic::Local here = leastAt(energy, at);
        law.force[n]              = here.slope[0];
        law.tangent[n]            = std::max(0.0, tangentOf(here, energy.two[0][0]));
        if (n == 0 || law.force[n] >= law.force[n - 1]) continue; // it never falls
        law.force[n]   = law.force[n - 1];
        law.tangent[n] = 0;
    }
    return law;
}

double LargeLaw::forceAt(double depth) const noexcept
{
    const double along = depth / step;
    if (along >= kSteps) return force.back() + tangent.back() * (depth - reach());
    const auto   n = std::size_t(std::max(along, 0.0));
    const double t = along - double(n), u = 1 - t;
    return u * u * (1 + 2 * t) * force[n] + t * t * (1 + 2 * u) * force[n + 1] +
           step * t * u * (u * tangent[n] - t * tangent[n + 1]);
}

double LargeLaw::tangentAt(double depth) const noexcept
{
    const double along = depth / step;
    if (along >= kSteps) return tangent.back();
    const auto n = std::size_t(std::max(along, 0.0));
    return std::lerp(tangent[n], tangent[n + 1], along - double(n));
}

double LargeLaw::depthOf(double wanted) const noexcept
{
    if (wanted >= force.back())
        return tangent.back() > 0 ? reach() + (wanted - force.back()) / tangent.back() : reach();
    double low = 0, high = reach();
    for (int n = 0; n < 60; ++n) {
        const double middle                     = (low + high) / 2;
        (forceAt(middle) < wanted ? low : high) = middle;
    }
    return (low + high) / 2;
}

} // namespace palp
