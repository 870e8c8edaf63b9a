#include "engine/plate/multigrid/direct_shell.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/plate/curved_bending.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/plate/host/shell_view.h"
#include "engine/plate/multigrid/detail/host_call.h"
#include "engine/plate/multigrid/detail/rim.h"
#include "engine/plate/multigrid/detail/sheet_nodes.h"
#include "engine/plate/shell_energy.h"
#include "engine/plate/thrust.h"

namespace palp {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsFrom(Clock::time_point began)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

/// The entries of a matrix of two fields, w and phi: each node has some with the nodes that a term reaches with it.
class NodeEntries {
public:
    static constexpr int                                      kReached = 13;
    static constexpr std::array<std::array<int, 2>, kReached> kPlaces{{{0, 0},
                                                                       {0, 1},
                                                                       {0, 2},
                                                                       {1, -1},
                                                                       {1, 0},
                                                                       {1, 1},
                                                                       {2, 0},
                                                                       {0, -1},
                                                                       {0, -2},
                                                                       {-1, 1},
                                                                       {-1, 0},
                                                                       {-1, -1},
                                                                       {-2, 0}}};

    explicit NodeEntries(const PlateGrid& grid)
        : reach_(2 * grid.nodesZ() + 2), placeOf_(std::size_t(2 * reach_ + 1), kNone), values_(grid.nodes() * 2 * kEach)
    {
        for (int n = 0; n < kReached; ++n)
            placeOf_[std::size_t(kPlaces[std::size_t(n)][0] * grid.nodesZ() + kPlaces[std::size_t(n)][1] + reach_)] = n;
    }

    /// Adds to the entry of a node of one field with a node of another.
    void add(int field, int node, int otherField, int other, double part)
    {
        at(field, node)[std::size_t(otherField * kReached + placeOf_[std::size_t(other - node + reach_)])] += part;
    }

    [[nodiscard]] double of(int field, int node, int otherField, int place) const
    {
        return values_[(std::size_t(node) * 2 + std::size_t(field)) * kEach +
                       std::size_t(otherField * kReached + place)];
    }

private:
    static constexpr std::size_t kEach = 2 * kReached;

    double* at(int field, int node) { return &values_[(std::size_t(node) * 2 + std::size_t(field)) * kEach]; }

    int                 reach_;
    std::vector<int>    placeOf_;
    std::vector<double> values_;
};

/// Adds a field's own energy, times `scale`.
/// \param known  nodes whose terms count where all of a term's nodes are such
void addEnergy(NodeEntries& entries, const Plate& plate, int field, const Which& known, double scale)
{
    const auto product = [&](const Difference& a, const Difference& b, double k) {
        for (std::size_t m = 0; m < std::size_t(a.count); ++m)
            for (std::size_t n = 0; n < std::size_t(b.count); ++n)
                entries.add(field, a.node[m], field, b.node[n], scale * k * a.factor[m] * b.factor[n]);
    };
    const auto isKnown = [&](const Difference& d) {
        for (std::size_t m = 0; m < std::size_t(d.count); ++m)
            if (!known[std::size_t(d.node[m])]) return false;
        return true;
    };
    visitTerms(plate, [&](const EnergyTerm& term) {
        if (!isKnown(term.p) || !isKnown(term.q)) return;
        product(term.p, term.p, term.kpp);
        if (term.q.count == 0) return;
        product(term.q, term.q, term.kqq);
        product(term.p, term.q, term.kpq);
        product(term.q, term.p, term.kpq);
    });
}

void addCoupling(NodeEntries& entries, const Shell& shell, const Plate& membrane, double scale)
{
    visitCouplingTerms(shell, membrane, [&](const CouplingTerm& term) {
        if (term.stiffness == 0) return;
        for (std::size_t m = 0; m < std::size_t(term.force.count); ++m) {
            const double part = scale * term.stiffness * term.force.factor[m];
            entries.add(0, term.node, 1, term.force.node[m], part);
            entries.add(1, term.force.node[m], 0, term.node, part);
        }
    });
}

double geometricMean(const NodeField& field, const Which& which)
{
    double sum = 0, all = 0;
    for (std::size_t n = 0; n < which.size(); ++n) {
        if (!which[n]) continue;
        sum += std::log(field.values()[n]);
        ++all;
    }
    return std::exp(sum / all);
}

} // namespace

void goOnBeyondSheet(NodeField& deflection, const Shell& shell)
{
    if (const NodeField shares = sharesOfSheet(shell); !shares.values().empty())
        goOn(deflection, shell.bending.grid, onSheet(shares, kLeastSheet));
}

struct DirectShell::Impl {
    Shell              shell;
    const HostKernels& kernels;
    Which              knownW;   ///< nodes with a deflection, those that a side holds included
    Which              sheet;    ///< nodes with something of the sheet
    Which              stressed; ///< nodes with a stress function
    Which isOwnSheet; ///< nodes of the sheet, by which errors are judged: what is nearly loose at a ragged border may
                      ///< be anywhere, and is felt by nobody

    std::optional<CurvedBending> curved; ///< once something was solved for

    Rim                         division;
    std::vector<int>            ofW, ofPhi; ///< unknown by node, or kNone
    int                         unknowns    = 0;
    int                         firstThrust = 0; ///< the first of the last unknowns
    double                      phiUnit     = 1; ///< phi over the unknown [N]
    std::vector<double>         signs;
    std::vector<RimFront>       fronts;
    std::vector<int>            borders;
    std::vector<std::ptrdiff_t> starts;
    std::vector<int>            rows;
    std::vector<double>         values, columns, numbers; ///< numbers: of eight loads at each unknown
    ShellFronts                 view{};
    bool                        isFactored = false;
    double                      setUp      = 0; ///< [ms]
    std::optional<double>       rounding; ///< share that refinement changed of the first loads that it was tried on [1]

    Impl(const Shell& given, std::span<const Footprint> footprints, std::vector<double> memory, const HostKernels& by);
    void number();
    void divide();
    void assemble();
    void addThrusts(std::vector<std::vector<double>>& ofThrusts) const;
    void factor();

    [[nodiscard]] std::optional<FootprintSolution> solve(std::span<const Footprint> footprints, std::size_t whole,
                                                         double tolerance);
    /// Solves for up to eight loads, into `numbers`.
    /// \param refined  by one step of refinement, and `worst` is raised to the share that it changes
    /// \return whether all is finite, as far as that step tells
    [[nodiscard]] bool solveEight(std::span<const Footprint> footprints, bool refined, double& worst);
    void               backSubstitute();
    /// Returns what the numbers leave of the forces, by eights at each unknown.
    [[nodiscard]] std::vector<double> left(const std::vector<double>& forces, const std::vector<double>& x) const;
    [[nodiscard]] NodeField           deflection(const std::vector<double>& x, std::size_t lane) const;
    [[nodiscard]] NodeField           stressFunction(const std::vector<double>& x, std::size_t lane) const;
};

bool DirectShell::pays(const Shell& shell)
{
    return !shell.stressBed.values().empty();
}

DirectShell::Impl::Impl(const Shell& given, std::span<const Footprint> footprints, std::vector<double> memory,
                        const HostKernels& by)
    : shell(given), kernels(by), columns(std::move(memory))
{
    const auto began = Clock::now();
    if (const auto why = whyUnsolvable(shell)) throw Error("the shell cannot be solved: " + *why);
    constexpr double kSome  = 0.1; // share of a sheet at a node that the rest holds well [1]
    const NodeField  shares = sharesOfSheet(shell);
    stressed                = withStress(shell);
    sheet                   = onSheet(shares, kLeastSheet);
    isOwnSheet              = onSheet(shares, kSome);
    knownW = hangingTogether(shell.bending.grid, withDeflection(shell.bending.grid, sheet, stressed), footprints);
    for (std::size_t n = 0; n < knownW.size(); ++n) {
        stressed[n] = stressed[n] && knownW[n];
        sheet[n]    = sheet[n] && knownW[n];
    }
    number();
    divide();
    assemble();
    factor();
    setUp = millisecondsFrom(began);
}

void DirectShell::Impl::number()
{
    const Plate& bending  = shell.bending;
    const Plate  membrane = membraneOf(shell);
    Which        isW = knownW, isPhi = stressed, either = knownW;
    takeOffHeld(isW, bending);
    takeOffHeld(isPhi, membrane);
    if (isStressFree(shell))
        for (const std::size_t pin : pinsOfStress(bending.grid)) isPhi[pin] = 0;
    for (std::size_t n = 0; n < either.size(); ++n) either[n] = isW[n] || isPhi[n];
    phiUnit = std::sqrt(geometricMean(bending.rigidity, knownW) / geometricMean(shell.membraneCompliance, knownW));

    shared::PlateLevel level{};
    level.cellsX = bending.grid.cellsX;
    level.cellsZ = bending.grid.cellsZ;
    level.free   = shared::kSideX0 | shared::kSideX1 | shared::kSideZ0 | shared::kSideZ1; // held nodes are off already
    division.divideThese(level, std::move(either));
    ofW.assign(bending.grid.nodes(), kNone);
    ofPhi = ofW;
    for (const int node : division.nodes()) {
        if (isW[std::size_t(node)]) {
            ofW[std::size_t(node)] = unknowns++;
            signs.push_back(1);
        }
        if (isPhi[std::size_t(node)]) {
            ofPhi[std::size_t(node)] = unknowns++;
            signs.push_back(-1);
        }
    }
    firstThrust = unknowns;
    unknowns += int(shell.thrusts.size());
    signs.resize(std::size_t(unknowns), -1);
}

/// Makes fronts of unknowns of those of nodes. A thrust stretches all of the sheet: it is on each front's border, and
/// an unknown of the last front.
void DirectShell::Impl::divide()
{
    const auto                    nodes     = division.nodes();
    const auto                    ofFronts  = division.fronts();
    const auto                    ofBorders = division.borders();
    std::vector<std::vector<int>> unknownsOf(nodes.size());
    std::vector<int>              firstOf(nodes.size() + 1, firstThrust);
    for (std::size_t n = nodes.size(); n-- > 0;) {
        firstOf[n] = firstOf[n + 1];
        for (const int unknown : {ofW[std::size_t(nodes[n])], ofPhi[std::size_t(nodes[n])]})
            if (unknown != kNone) {
                unknownsOf[n].push_back(unknown);
                firstOf[n] = std::min(firstOf[n], unknown);
            }
    }
    const int      thrusts  = unknowns - firstThrust;
    std::ptrdiff_t entries  = 0;
    int            mostRows = kLoadsTogether;
    for (std::size_t f = 0; f < ofFronts.size(); ++f) {
        const RimFront& of     = ofFronts[f];
        const bool      isLast = f + 1 == ofFronts.size();
        RimFront        front  = of;
        front.first            = firstOf[std::size_t(of.first)];
        front.own              = firstOf[std::size_t(of.first + of.own)] - front.first + (isLast ? thrusts : 0);
        front.borderAt         = std::ptrdiff_t(borders.size());
        front.columnsAt        = entries;
        for (int n = 0; n < of.border; ++n)
            for (const int unknown : unknownsOf[std::size_t(ofBorders[std::size_t(of.borderAt + n)])])
                borders.push_back(unknown);
        for (int t = firstThrust; t < unknowns && !isLast; ++t) borders.push_back(t);
        front.border     = int(std::ptrdiff_t(borders.size()) - front.borderAt);
        front.borderRows = (front.border + kWholeRows - 1) / kWholeRows * kWholeRows;
        const int high   = front.rowsTogether();
        mostRows         = std::max(mostRows, high);
        entries += std::ptrdiff_t(high) * front.own;
        fronts.push_back(front);
    }
    columns.resize(std::size_t(entries) + kLoadsTogether);
    view.fronts     = fronts.data();
    view.borders    = borders.data();
    view.frontCount = int(fronts.size());
    view.unknowns   = unknowns;
    view.mostRows   = mostRows;
    view.signs      = signs.data();
    view.columns    = columns.data();
}

void DirectShell::Impl::addThrusts(std::vector<std::vector<double>>& ofThrusts) const
{
    const Thrusts thrusts(shell);
    for (std::size_t t = 0; t < shell.thrusts.size(); ++t) {
        const ShellLoad&     load = thrusts.loads()[t];
        std::vector<double>& of   = ofThrusts.emplace_back(std::size_t(unknowns), 0.0);
        for (std::size_t n = 0; n < ofW.size(); ++n) {
            if (ofW[n] != kNone) of[std::size_t(ofW[n])] = phiUnit * load.onW.values()[n];
            if (ofPhi[n] != kNone) of[std::size_t(ofPhi[n])] = phiUnit * phiUnit * load.onPhi.values()[n];
        }
        for (std::size_t other = 0; other < shell.thrusts.size(); ++other)
            of[std::size_t(firstThrust) + other] = -phiUnit * phiUnit * thrusts.own(other, t);
    }
}

void DirectShell::Impl::assemble()
{
    const PlateGrid& grid     = shell.bending.grid;
    const Plate      membrane = membraneOf(shell);
    NodeEntries      entries(grid);
    addEnergy(entries, shell.bending, 0, knownW, 1);
    addEnergy(entries, membrane, 1, Which(grid.nodes(), 1), -phiUnit * phiUnit);
    addCoupling(entries, shell, membrane, phiUnit);
    std::vector<std::vector<double>> ofThrusts;
    addThrusts(ofThrusts);

    const auto add = [&](int row, double value) {
        rows.push_back(row);
        values.push_back(value);
    };
    starts.reserve(std::size_t(unknowns) + 1);
    for (const int node : division.nodes())
        for (const int field : {0, 1}) {
            const int own = (field == 0 ? ofW : ofPhi)[std::size_t(node)];
            if (own == kNone) continue;
            starts.push_back(std::ptrdiff_t(rows.size()));
            add(own, entries.of(field, node, field, 0));
            const int i = node / grid.nodesZ(), j = node % grid.nodesZ();
            for (int place = 0; place < NodeEntries::kReached; ++place) {
                const auto [a, b] = NodeEntries::kPlaces[std::size_t(place)];
                if (i + a < 0 || j + b < 0 || i + a > grid.cellsX || j + b > grid.cellsZ) continue;
                const std::size_t other = std::size_t(node + a * grid.nodesZ() + b);
                for (const int otherField : {0, 1}) {
                    const int    row   = (otherField == 0 ? ofW : ofPhi)[other];
                    const double value = entries.of(field, node, otherField, place);
                    if (row > own && value != 0) add(row, value);
                }
            }
            for (std::size_t t = 0; t < ofThrusts.size(); ++t)
                if (const double value = ofThrusts[t][std::size_t(own)]; value != 0) add(firstThrust + int(t), value);
        }
    for (std::size_t t = 0; t < ofThrusts.size(); ++t) {
        starts.push_back(std::ptrdiff_t(rows.size()));
        for (std::size_t other = t; other < ofThrusts.size(); ++other)
            add(firstThrust + int(other), ofThrusts[t][std::size_t(firstThrust) + other]);
    }
    starts.push_back(std::ptrdiff_t(rows.size()));
    view.starts = starts.data();
    view.rows   = rows.data();
    view.values = values.data();
}

void DirectShell::Impl::factor()
{
    std::uint32_t lost = 1;
    callHost(kernels.shellFrontFactor, 0, {&view, &lost});
    isFactored = lost == 0;
    numbers.resize(std::size_t(unknowns) * kLoadsTogether);
}

void DirectShell::Impl::backSubstitute()
{
    callHost(kernels.shellFrontSolve, 0, {&view, numbers.data()});
}

std::vector<double> DirectShell::Impl::left(const std::vector<double>& forces, const std::vector<double>& x) const
{
    std::vector<double> of      = forces;
    const auto          takeOff = [&](int row, int column, double value) {
        double*       to   = &of[std::size_t(row) * kLoadsTogether];
        const double* from = &x[std::size_t(column) * kLoadsTogether];
        for (int lane = 0; lane < kLoadsTogether; ++lane) to[lane] -= value * from[lane];
    };
    for (int column = 0; column < unknowns; ++column)
        for (std::ptrdiff_t n = starts[std::size_t(column)]; n < starts[std::size_t(column) + 1]; ++n) {
            takeOff(rows[std::size_t(n)], column, values[std::size_t(n)]);
            if (rows[std::size_t(n)] != column) takeOff(column, rows[std::size_t(n)], values[std::size_t(n)]);
        }
    return of;
}

NodeField DirectShell::Impl::deflection(const std::vector<double>& x, std::size_t lane) const
{
    NodeField w(shell.bending.grid);
    for (std::size_t n = 0; n < ofW.size(); ++n)
        if (ofW[n] != kNone) w.values()[n] = x[std::size_t(ofW[n]) * kLoadsTogether + lane];
    return w;
}

NodeField DirectShell::Impl::stressFunction(const std::vector<double>& x, std::size_t lane) const
{
    NodeField phi(shell.bending.grid);
    for (std::size_t n = 0; n < ofPhi.size(); ++n) {
        if (ofPhi[n] != kNone) phi.values()[n] = phiUnit * x[std::size_t(ofPhi[n]) * kLoadsTogether + lane];
        for (std::size_t t = 0; t < shell.thrusts.size(); ++t)
            phi.values()[n] +=
                phiUnit * x[(std::size_t(firstThrust) + t) * kLoadsTogether + lane] * shell.thrusts[t].values()[n];
    }
    return phi;
}

bool DirectShell::Impl::solveEight(std::span<const Footprint> footprints, bool refined, double& worst)
{
    std::vector<double> forces(numbers.size(), 0.0);
    for (std::size_t lane = 0; lane < footprints.size(); ++lane)
        for (const Footprint::Part& part : footprints[lane].parts)
            if (const int unknown = ofW[part.node]; unknown != kNone)
                forces[std::size_t(unknown) * kLoadsTogether + lane] = part.force;
    numbers = forces;
    backSubstitute();
    if (!refined) return true;
    std::vector<double> x = numbers;
    numbers               = left(forces, x);
    backSubstitute();
    for (std::size_t n = 0; n < x.size(); ++n) numbers[n] += x[n];
    std::array<double, kLoadsTogether> corrections{}, sizes{};
    for (std::size_t node = 0; node < ofW.size(); ++node)
        for (std::size_t lane = 0; isOwnSheet[node] && ofW[node] != kNone && lane < kLoadsTogether; ++lane) {
            const std::size_t n = std::size_t(ofW[node]) * kLoadsTogether + lane;
            corrections[lane]   = std::max(corrections[lane], std::abs(numbers[n] - x[n]));
            sizes[lane]         = std::max(sizes[lane], std::abs(numbers[n]));
        }
    for (std::size_t lane = 0; lane < footprints.size(); ++lane)
        if (!(corrections[lane] <= worst * sizes[lane])) worst = corrections[lane] / sizes[lane];
    return std::isfinite(worst);
}

std::optional<FootprintSolution> DirectShell::Impl::solve(std::span<const Footprint> footprints, std::size_t whole,
                                                          double tolerance)
{
    // Of the tolerance: beyond the first all loads are refined, not those with the whole one only; below the second
    // none is after the first ones on a factor, whose rounding it is: a hand that moves has others every 30 ms.
    constexpr double kSpare = 0.1, kNothing = 1e-4;
    const auto       began = Clock::now();
    for (const Footprint& footprint : footprints)
        for (const Footprint::Part& part : footprint.parts)
            PALP_EXPECT(part.node < ofW.size(), "a footprint lies on nodes that the shell does not have");
    if (!isFactored || firstThrust == 0) return std::nullopt; // firstThrust: as many unknowns have nodes
    if (!curved) curved.emplace(shell);
    const Shear       shear(shell);
    FootprintSolution solution;
    double            worst   = rounding.value_or(0); // share that refinement changes [1]
    const bool        isExact = rounding && *rounding < kNothing * tolerance;
    solution.responses.resize(footprints.size());
    std::vector<std::size_t> firsts{whole / kLoadsTogether * kLoadsTogether};
    for (std::size_t first = 0; first < footprints.size(); first += kLoadsTogether)
        if (first != firsts.front()) firsts.push_back(first);
    for (const std::size_t first : firsts) {
        const auto some = footprints.subspan(first, std::min<std::size_t>(kLoadsTogether, footprints.size() - first));
        const bool isRefined = (first == firsts.front() && !isExact) || worst > kSpare * tolerance;
        if (!solveEight(some, isRefined, worst)) return std::nullopt;
        for (std::size_t lane = 0; lane < some.size(); ++lane) {
            const std::size_t n = first + lane;
            NodeField         w = deflection(numbers, lane);
            if (!std::ranges::all_of(w.values(), [](double value) { return std::isfinite(value); }))
                return std::nullopt;
            solution.responses[n] = responseOf(footprints[n], w);
            solution.responses[n].work += shear.workOf(w) - squeezeWork(shell, w, footprints[n]);
            solution.responses[n].curved = curved->workOf(w);
            if (n != whole) continue;
            solution.whole.deflection = std::move(w);
            solution.stress           = stressFunction(numbers, lane);
        }
    }
    if (!rounding) rounding = worst;
    if (!(worst * worst <= tolerance)) return std::nullopt; // as large a share is left of it after the step
    goOn(solution.whole.deflection, shell.bending.grid, sheet);
    SolveReport& report      = solution.whole.report;
    report.solver            = compute::kHostProcessor;
    report.iterations        = 0;
    report.errorEstimate     = worst;
    report.setUpMilliseconds = setUp;
    report.milliseconds      = millisecondsFrom(began);
    setUp                    = 0; // is told once
    return solution;
}

DirectShell::DirectShell(const Shell& shell, std::span<const Footprint> footprints, std::vector<double> memory,
                         const HostKernels* kernels)
    : impl_(std::make_unique<Impl>(shell, footprints, std::move(memory), kernels ? *kernels : *hostVariant().kernels))
{
}
DirectShell::~DirectShell()                                 = default;
DirectShell::DirectShell(DirectShell&&) noexcept            = default;
DirectShell& DirectShell::operator=(DirectShell&&) noexcept = default;

const Shell& DirectShell::shell() const noexcept
{
    return impl_->shell;
}

bool DirectShell::has(std::span<const Footprint> footprints) const
{
    return std::ranges::all_of(footprints, [&](const Footprint& footprint) {
        const int node = mostPressed(footprint);
        return node == kNone || (std::size_t(node) < impl_->knownW.size() && impl_->knownW[std::size_t(node)]);
    });
}

std::vector<double> DirectShell::takeMemory()
{
    impl_->isFactored = false;
    return std::move(impl_->columns);
}

std::optional<FootprintSolution> DirectShell::solve(std::span<const Footprint> footprints, std::size_t whole,
                                                    double tolerance)
{
    return impl_->solve(footprints, whole, tolerance);
}

} // namespace palp
