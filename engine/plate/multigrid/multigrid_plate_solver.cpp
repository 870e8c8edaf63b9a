#include "engine/plate/multigrid/multigrid_plate_solver.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/footprint_layout.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/compute/command_list.h"
#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/core/quantity.h"
#include "engine/plate/detail/rigidity_unit.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/multigrid/detail/plate_passes.h"
#include "engine/plate/multigrid/detail/worst.h"

// Each command list is recorded once:
//
//   prepare   rigidity -> coarser rigidities -> divisors, tiles where it jumps -> factor of the coarsest level
//   begin     loads -> coarser loads; coarsest answer; level by level upwards: interpolate, a step or two of conjugate
//             gradients; then a few steps on the finest level, see kStepsOfLists
//   resume    further steps
//
// The last two are recorded with, or without, extra sweeps of the tiles in which the rigidity jumps. The steps on the
// finest level are dispatched indirectly: when the estimate is small enough, a kernel sets all their sizes to zero, and
// the rest of the list runs empty. The host reads the estimate only between lists.

namespace palp {
namespace {

using compute::Binding;
using compute::Buffer;
using compute::CommandList;
using compute::Groups;
using compute::Intent;
using compute::Kernel;
using Clock = std::chrono::steady_clock;

/// Steps of a list: what a list has left when the solve is finished runs empty, which costs hardware a microsecond for
/// each dispatch. The shortest one that holds the steps of the last solve is run; the answer is the same whichever it
/// is.
constexpr std::array kStepsOfLists{1, 2, 4};
constexpr int        kMostGroups = 65535; ///< along x of a dispatch, on every processor

constexpr double kRounding = 1e-7; ///< error of rigidities and answer in floats, twice 6e-8 rounded [1]

/// Error of conjugate gradients in floats, up to contrast 1000 where the rigidity jumps, and whatever the contrast
/// where it does not [1]. Beyond, it grows with the contrast: measured on discs in plates that one side, two or all
/// hold, 20 to 64 cells, up to 4.8e-5 at 1000, 4.3e-4 at 1e4, 3.5e-3 at 1e5 and 2.6e-2 at 1e6.
constexpr double kFloatRounding = 5e-5, kRoundedContrast = 1000;

/// Exact rims take less time than sweeps of tiles if their factors do not take more work [multiplications per node],
/// per load that is solved with them. Where strong jumps need many sweeps more work pays.
constexpr double kRimWork = 300, kStrongRimWork = 5000;

/// Memory that the host writes for a buffer: the buffer itself where it is mapped, else memory that a list copies.
class Staging {
public:
    Staging(compute::Context& context, const Buffer& target) : Staging(context, Binding(target, 0, target.bytes())) {}
    Staging(compute::Context& context, const Binding& target) : target_(target)
    {
        const Buffer& all = *target.buffer;
        if (!all.mapped()) own_.emplace(context, all.name() + " from the host", target.bytes, Intent::upload);
    }

    [[nodiscard]] std::span<float> floats() const
    {
        return own_
                   ? own_->as<float>()
                   : target_.buffer->as<float>().subspan(target_.offset / sizeof(float), target_.bytes / sizeof(float));
    }

    void record(CommandList& list) const
    {
        if (own_) list.copy(*own_, 0, *target_.buffer, target_.offset, target_.bytes);
    }

private:
    Binding               target_;
    std::optional<Buffer> own_;
};

} // namespace

struct MultigridPlateSolver::Impl {
    compute::Context&        context;
    const PlateKernels::All& k;
    Plate                    plate;
    Settings                 settings;
    double                   unitRigidity;
    std::uint32_t            loads;
    double                   stiffness;                         ///< see GridHierarchy [N/m]
    double                   roundingInFloats = kFloatRounding; ///< see MultigridPlateSolver
    PlatePasses              passes;

    Buffer                units; ///< metres per unit of the shaders' deflection, per load
    Staging               hostRigidity, hostLoads, hostUnits;
    Buffer                hostState;
    std::optional<Buffer> ownResult; ///< see result()

    /// The lists of a solve, recorded when they are first needed.
    struct Lists {
        std::array<std::optional<CommandList>, kStepsOfLists.size()> begin, resume; ///< by their steps
        int                                                          dispatchesPerCycle = 0;
        int       nestedDispatches = 0, stepDispatches = 0, lastDispatches = 0;
        PlateWork nestedWork, stepsWork; ///< before the steps on the finest level; the steps
        int       steps = 0;             ///< of which stepsWork is
    };
    /// Memory for loads on few nodes: what the host writes and reads.
    struct FootprintBuffers {
        Buffer  words; ///< see shared/footprint_layout.h
        Staging hostWords;
        Buffer  responses; ///< 3 numbers per load, which the kernel writes where the host reads them

        FootprintBuffers(compute::Context& context, std::size_t count, std::size_t responseBytes)
            : words(context, "footprints", 4 * count, Intent::processor), hostWords(context, words),
              responses(context, "responses", responseBytes, Intent::readback)
        {
        }
    };
    std::optional<FootprintBuffers> footprints; ///< once they are asked for
    std::vector<double>             works;      ///< of a unit of each load along a unit of its deflection [N m]

    std::optional<CommandList> prepareList;
    std::array<Lists, 4>       lists;                            ///< by how the rigidity jumps
    Jumps                      jumps     = Jumps::none;          ///< chooses among them
    int                        lastSteps = kStepsOfLists.back(); ///< of the last solve

    Impl(compute::Context& processor, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted)
        : Impl(processor, kernels, given, wanted,
               gridHierarchy(given, rigidityUnit(largest(given.rigidity)), kernels.coarsestCells))
    {
    }

    Impl(compute::Context& processor, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted,
         GridHierarchy grids)
        : context(processor), k(kernels), plate(withoutRigidity(given)), settings(rounded(wanted)),
          unitRigidity(rigidityUnit(largest(given.rigidity))), loads(std::uint32_t(wanted.loads)),
          stiffness(grids.stiffness), passes(processor, kernels, std::move(grids), loads),
          units(context, "metres per unit", 4 * std::size_t(loads), Intent::processor),
          hostRigidity(context, passes.levels[0].rigidity), hostLoads(context, passes.levels[0].load),
          hostUnits(context, units), hostState(context, "state for the host", passes.state.bytes(), Intent::readback),
          ownResult(passes.levels[0].forces.mapped()
                        ? std::nullopt
                        : std::optional<Buffer>(std::in_place, context, "deflection", 4 * plate.grid.nodes() * loads,
                                                Intent::readback))
    {
    }

    /// Returns the memory of the deflection in floats [m]. Where the host sees all memory it is that of A p, which no
    /// step needs once it is taken.
    [[nodiscard]] const Buffer& result() const { return ownResult ? *ownResult : passes.levels[0].forces; }

    /// The kernels compare in floats, and host and kernels must agree on when a solve is finished.
    static Settings rounded(Settings wanted)
    {
        wanted.tolerance = double(float(wanted.tolerance));
        return wanted;
    }

    /// The processor keeps the rigidity.
    static Plate withoutRigidity(const Plate& given)
    {
        return {given.grid, given.edges, given.poissonRatio, given.foundation, {}};
    }

    static double largest(const NodeField& field) { return extremesOf(field.values()).most; }

    // --- lists

    void recordFinestSteps(CommandList& list, std::uint32_t begins, int steps)
    {
        PlatePasses::Recorder pass{passes, list, true};
        const int             before = list.dispatches();
        passes.takeGradientSteps(pass, 0, steps, k.smoothing.finest, begins, settings.tolerance);
        if (steps == kStepsOfLists.back()) {
            lists[std::size_t(jumps)].stepDispatches = (list.dispatches() - before) / steps;
            lists[std::size_t(jumps)].lastDispatches = (list.dispatches() - before) % steps;
        }
        list.dispatch(k.result, {passes.levels[0].answer, units, result()},
                      shared::VectorPush{std::uint32_t(passes.nodes()), passes.partials(), 0},
                      passes.inOrder(k.result, 0));
        if (footprints) {
            list.dispatch(k.footprints,
                          {passes.levels[0].left, passes.levels[0].answer, footprints->words, footprints->responses},
                          shared::VectorPush{std::uint32_t(passes.nodes()), 0, 0}, {1, 1, loads});
        }
        list.copy(passes.state, hostState);
        list.timestamp();
        list.end();
    }

    void recordPrepare()
    {
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        hostRigidity.record(list);
        passes.prepareRigidity(pass);
        list.end();
        prepareList.emplace(std::move(list));
    }

    CommandList recordBegin(int steps)
    {
        Lists&                now = lists[std::size_t(jumps)];
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        list.timestamp();
        hostLoads.record(list);
        hostUnits.record(list);
        if (footprints) footprints->hostWords.record(list);
        passes.enableSteps(list);
        passes.work = {};
        if (passes.levels.size() == 1) {
            list.fill(passes.levels[0].answer, 0);
            passes.computeResidual(pass, 0);
        } else {
            passes.iterateNested(pass);
        }
        now.nestedWork       = std::exchange(passes.work, {});
        now.nestedDispatches = list.dispatches();
        recordFinestSteps(list, 2, steps);
        now.stepsWork          = passes.work;
        now.steps              = steps;
        now.dispatchesPerCycle = passes.dispatchesPerCycle();
        return list;
    }

    CommandList recordResume(int steps)
    {
        CommandList list(context);
        list.timestamp();
        recordFinestSteps(list, 1, steps);
        return list;
    }

    /// Returns which list holds so many steps. In software none runs empty: there it is always the longest.
    [[nodiscard]] std::size_t listFor(int steps) const
    {
        std::size_t which = 0;
        while (which + 1 < kStepsOfLists.size() && (!k.fused || kStepsOfLists[which] < steps)) ++which;
        return which;
    }

    /// Runs a list for the present jumps that holds so many steps, recording it if necessary.
    CommandList& run(decltype(Lists::begin) Lists::*which, CommandList (Impl::*record)(int), int steps)
    {
        const std::size_t at   = listFor(steps);
        auto&             list = (lists[std::size_t(jumps)].*which)[at];
        if (!list) list.emplace((this->*record)(kStepsOfLists[at]));
        context.run(*list);
        hostState.makeVisibleToHost();
        return *list;
    }

    // --- a solve

    /// The place of a load's numbers in the memory of all of them: the first node's, and how far apart those of two
    /// nodes are.
    struct Place {
        std::size_t first, apart;
    };

    [[nodiscard]] Place placeOf(std::size_t load) const
    {
        const auto together = std::size_t(k.together);
        return {load / together * together * plate.grid.nodes() + load % together, together};
    }

    [[nodiscard]] double stateOf(std::uint32_t load, int word) const
    {
        const std::size_t at = std::size_t(load) * shared::kStateWords + std::size_t(word);
        return k.doubles ? hostState.as<double>()[at] : double(hostState.as<float>()[at]);
    }

    [[nodiscard]] double worst(int word) const
    {
        std::vector<double> values;
        for (std::uint32_t load = 0; load < loads; ++load) values.push_back(stateOf(load, word));
        return worstOf(values);
    }

    /// Returns the largest force of each load [N].
    [[nodiscard]] std::vector<double> largestForces(std::span<const NodeField> nodalForces) const
    {
        PALP_EXPECT(nodalForces.size() == loads,
                    std::to_string(nodalForces.size()) + " loads for a solver of " + std::to_string(loads));
        std::vector<double> all;
        for (const NodeField& load : nodalForces) {
            PALP_EXPECT(load.on(plate.grid), "the load's grid is not the plate's");
            const Extremes of = extremesOf(load.values());
            if (!of.finite) throw Error("plate: expected finite forces, found a load that is not a number or infinite");
            all.push_back(std::max(std::abs(of.least), std::abs(of.most)));
        }
        return all;
    }

    /// Returns forces in units of each load's largest one.
    void upload(std::span<const NodeField> nodalForces)
    {
        const std::vector<double> scales = largestForces(nodalForces);
        const std::size_t         nodes  = plate.grid.nodes();
        for (std::size_t n = 0; n < nodalForces.size(); ++n) {
            const double  scale = perUnit(n, scales[n]);
            const Place   at    = placeOf(n);
            float*        to    = hostLoads.floats().data() + at.first;
            const double* from  = nodalForces[n].values().data();
            for (std::size_t m = 0; m < nodes; ++m) to[m * at.apart] = float(from[m] * scale);
        }
    }

    /// Takes the largest force [N] of a load as its unit; returns units per newton.
    double perUnit(std::size_t load, double largest)
    {
        const double metres = largest / stiffness;
        if (largest > 0 &&
            !(metres > double(std::numeric_limits<float>::min()) && metres < double(std::numeric_limits<float>::max())))
            throw Error("plate: forces of " + formatQuantity(largest, "N") + " on a rigidity of " +
                        formatQuantity(unitRigidity, "N m") + " give deflections that 32 bits cannot hold");
        hostUnits.floats()[load] = float(metres);
        return largest > 0 ? 1 / largest : 0;
    }

    /// Writes the same from loads on few nodes, and the parts of which their works are summed.
    void upload(std::span<const Footprint> given)
    {
        PALP_EXPECT(given.size() == loads,
                    std::to_string(given.size()) + " footprints for a solver of " + std::to_string(loads));
        makeFootprints(given);
        const std::span<float> forces = hostLoads.floats();
        std::ranges::fill(forces, 0.0F);
        works.assign(given.size(), 0);
        std::uint32_t* const words = reinterpret_cast<std::uint32_t*>(footprints->hostWords.floats().data());
        std::size_t          next  = shared::kFootprintHead * given.size();
        for (std::size_t n = 0; n < given.size(); ++n) {
            double largest = 0;
            for (const Footprint::Part& part : given[n].parts) {
                PALP_EXPECT(part.node < plate.grid.nodes(), "a footprint lies on nodes that the plate does not have");
                if (!std::isfinite(part.force + part.changeX + part.changeZ))
                    throw Error("plate: expected finite forces, found a footprint that is not a number or infinite");
                largest = std::max(largest, std::abs(part.force));
            }
            const double scale                    = perUnit(n, largest);
            const Place  at                       = placeOf(n);
            works[n]                              = largest * largest / stiffness;
            words[shared::kFootprintHead * n]     = std::uint32_t(next);
            words[shared::kFootprintHead * n + 1] = std::uint32_t(given[n].parts.size());
            for (const Footprint::Part& part : given[n].parts) {
                const float force                       = float(part.force * scale);
                forces[at.first + part.node * at.apart] = force;
                words[next]                             = part.node;
                words[next + 1]                         = std::bit_cast<std::uint32_t>(force);
                words[next + 2]                         = std::bit_cast<std::uint32_t>(float(part.changeX * scale));
                words[next + 3]                         = std::bit_cast<std::uint32_t>(float(part.changeZ * scale));
                next += shared::kPartWords;
            }
        }
    }

    /// Makes room for these footprints. Lists that were recorded for less are recorded anew.
    void makeFootprints(std::span<const Footprint> given)
    {
        std::size_t words = shared::kFootprintHead * given.size();
        for (const Footprint& footprint : given) words += shared::kPartWords * footprint.parts.size();
        if (footprints && 4 * words <= footprints->words.bytes()) return;
        for (Lists& recorded : lists) recorded = {};
        footprints.reset();
        footprints.emplace(context, words, k.realBytes() * shared::kResponseWords * loads);
    }

    void uploadRigidity(const NodeField& rigidity, const NodeField& foundationShape)
    {
        const std::vector<double>& shape = foundationShape.values();
        PALP_EXPECT(shape.empty() == (passes.level(0).shapeAt == 0), "a foundation has a shape, or none, for good");
        if (const auto why = whyUnsolvable(plate, rigidity, foundationShape)) throw Error("plate: " + *why);
        const std::span<float> to = hostRigidity.floats();
        const Extremes         of = inRigidityUnits(rigidity.values(), unitRigidity, to.first(plate.grid.nodes()));
        std::ranges::transform(shape, to.last(shape.size()).begin(), [](double s) { return float(s); });
        if (!prepareList) recordPrepare();
        context.run(*prepareList);
        const double contrast = of.most / of.least;
        expectJumps(passes.foundJumps() ? jumpsOf(contrast) : Jumps::none);
        if (k.rims && jumps != Jumps::none && contrast > kRimContrast && factorRims()) expectJumps(Jumps::rims);
        roundingInFloats = kFloatRounding * (passes.foundJumps() ? std::max(1.0, contrast / kRoundedContrast) : 1);
    }

    /// \param contrast  largest over least rigidity [1]
    static Jumps jumpsOf(double contrast)
    {
        constexpr double kStrong = 3000; // beyond it, more sweeps of the tiles cost less time than the steps they save
        return contrast > kStrong ? Jumps::strong : Jumps::some;
    }

    [[nodiscard]] double rounding() const noexcept { return k.doubles ? kRounding : roundingInFloats; }

    /// Returns whether no number of steps is enough.
    [[nodiscard]] bool isBeyondRounding() const { return rounding() > settings.tolerance || passes.isTooSoft(); }

    /// Where a stiff island lies in the rim, floats hide how the soft part holds it, from a contrast of 1e4 on.
    bool factorRims()
    {
        const bool strong = jumps == Jumps::strong;
        return passes.factorRims(strong, strong ? kStrongRimWork : kRimWork * loads);
    }

    void expectJumps(Jumps expected)
    {
        jumps = expected;
        passes.expectJumps(expected);
    }

    [[nodiscard]] std::vector<PlateSolution> solve(std::span<const NodeField> nodalForces)
    {
        const auto began = Clock::now();
        upload(nodalForces);
        return readAnswers(iterate(began));
    }

    [[nodiscard]] Responses solve(std::span<const Footprint> given)
    {
        const auto began = Clock::now();
        upload(given);
        Responses responses{{}, iterate(began)};
        footprints->responses.makeVisibleToHost();
        for (std::size_t n = 0; n < given.size(); ++n)
            responses.of.push_back({response(n, shared::kResponseWork), response(n, shared::kResponseChangeX),
                                    response(n, shared::kResponseChangeZ)});
        return responses;
    }

    [[nodiscard]] double response(std::size_t load, int word) const
    {
        const Buffer&     from  = footprints->responses;
        const std::size_t at    = load * shared::kResponseWords + std::size_t(word);
        const double      value = works[load] * (k.doubles ? from.as<double>()[at] : double(from.as<float>()[at]));
        if (!std::isfinite(value))
            throw SolverBrokeDown("plate: the deflection is not finite; the rigidity or the load is out of range");
        return value;
    }

    /// Takes steps for the loads that were uploaded, until the estimate is small enough.
    [[nodiscard]] SolveReport iterate(Clock::time_point began)
    {
        constexpr int kBeyond = 2; // steps that are tried where it takes more than the last solve did
        // Where the rigidity jumps a first step is not judged, see takeGradientSteps(): a list that ends with it would
        // be, by the host.
        const int             least = jumps == Jumps::none ? 1 : 2;
        CommandList*          list  = &run(&Lists::begin, &Impl::recordBegin, std::max(lastSteps, least));
        int                   done  = int(worst(shared::kStateSteps));
        std::optional<double> processorMilliseconds = 0;
        for (;;) {
            const auto times = list->timestampsMilliseconds();
            processorMilliseconds =
                times.empty() ? std::nullopt : std::optional(processorMilliseconds.value_or(0) + times.back());
            const double estimate = worst(shared::kStateEstimate);
            if (std::isnan(estimate))
                throw SolverBrokeDown("plate: the solver broke down; the rigidity or the load is out of range");
            if (!(estimate > settings.tolerance) || done >= settings.maxIterations) break;
            if (!k.doubles && isBeyondRounding()) break; // the host, which has doubles, will do better
            list = &run(&Lists::resume, &Impl::recordResume, done < lastSteps ? lastSteps - done : kBeyond);
            done += int(worst(shared::kStateSteps));
        }
        lastSteps = done;
        SolveReport report;
        report.solver        = context.processor().name;
        report.iterations    = done;
        report.errorEstimate = std::hypot(worst(shared::kStateEstimate), rounding());
        report.converged     = worst(shared::kStateEstimate) <= settings.tolerance && !isBeyondRounding();
        const Lists& used    = lists[std::size_t(jumps)];
        report.workUnits     = passes.workUnits(used.nestedWork) + done * passes.workUnits(used.stepsWork) / used.steps;
        report.processorMilliseconds = processorMilliseconds;
        report.milliseconds          = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
        return report;
    }

    [[nodiscard]] std::vector<PlateSolution> readAnswers(const SolveReport& report) const
    {
        std::vector<PlateSolution> answers;
        for (std::uint32_t load = 0; load < loads; ++load) answers.push_back({readAnswer(load), report});
        return answers;
    }

    [[nodiscard]] NodeField readAnswer(std::size_t load) const
    {
        result().makeVisibleToHost();
        const Place  at   = placeOf(load);
        const float* from = result().as<float>().data() + at.first;
        NodeField    w(plate.grid);
        for (double& value : w.values()) {
            value = double(*from);
            from += at.apart;
        }
        if (!extremesOf(w.values()).finite)
            throw SolverBrokeDown("plate: the deflection is not finite; the rigidity or the load is out of range");
        return w;
    }
};

MultigridPlateSolver::MultigridPlateSolver(compute::Context& context, const PlateKernels& kernels, const Plate& plate,
                                           const Settings& settings)
{
    if (const auto why = whyUnsolvable(plate)) throw Error("plate: " + *why);
    const double least = kernels.all().doubles ? kLeastTolerance : kLeastFloatTolerance;
    if (!(settings.tolerance >= least && settings.tolerance < 1))
        throw Error("plate: expected a tolerance of at least " + shortNumber(least) + " and below 1, found " +
                    shortNumber(settings.tolerance));
    const std::size_t most = std::size_t(kMostGroups) * kernels.all().update.workgroup().x;
    if (plate.grid.nodes() > most)
        throw Error("plate: " + std::to_string(plate.grid.nodes()) + " nodes are more than the " +
                    std::to_string(most) + " that the solver takes; try fewer cells");
    PALP_EXPECT(settings.loads >= 1 && settings.maxIterations >= 1, "loads and iterations are at least 1");
    PALP_EXPECT(settings.loads % kernels.all().together == 0, "loads lie side by side by eights");
    impl_ = std::make_unique<Impl>(context, kernels.all(), plate, settings);
    impl_->uploadRigidity(plate.rigidity, plate.foundationShape);
}

MultigridPlateSolver::~MultigridPlateSolver()                                          = default;
MultigridPlateSolver::MultigridPlateSolver(MultigridPlateSolver&&) noexcept            = default;
MultigridPlateSolver& MultigridPlateSolver::operator=(MultigridPlateSolver&&) noexcept = default;

void MultigridPlateSolver::setRigidity(const NodeField& rigidity, const NodeField& foundationShape)
{
    impl_->uploadRigidity(rigidity, foundationShape);
}

std::vector<PlateSolution> MultigridPlateSolver::solve(std::span<const NodeField> nodalForces)
{
    return impl_->solve(nodalForces);
}

PlateSolution MultigridPlateSolver::solve(const NodeField& nodalForce)
{
    return std::move(impl_->solve({&nodalForce, 1}).front());
}

MultigridPlateSolver::Responses MultigridPlateSolver::solveFootprints(std::span<const Footprint> loads)
{
    return impl_->solve(loads);
}

NodeField MultigridPlateSolver::deflectionOf(std::size_t load) const
{
    PALP_EXPECT(load < impl_->loads, "there is no load " + std::to_string(load));
    return impl_->readAnswer(load);
}

double MultigridPlateSolver::unitRigidity() const noexcept
{
    return impl_->unitRigidity;
}

double MultigridPlateSolver::rounding() const noexcept
{
    return impl_->rounding();
}

double MultigridPlateSolver::roundingInFloats() const noexcept
{
    return impl_->roundingInFloats;
}

MultigridPlateSolver::CommandCounts MultigridPlateSolver::commands()
{
    Impl::Lists& now = impl_->lists[std::size_t(impl_->jumps)];
    if (!now.begin.back()) now.begin.back().emplace(impl_->recordBegin(kStepsOfLists.back()));
    return {impl_->prepareList->dispatches(),
            impl_->prepareList->copies(),
            now.nestedDispatches,
            now.stepDispatches,
            now.dispatchesPerCycle,
            now.lastDispatches};
}

int MultigridPlateSolver::dispatchesPerCycle() const noexcept
{
    return impl_->lists[std::size_t(impl_->jumps)].dispatchesPerCycle;
}

int MultigridPlateSolver::levels() const noexcept
{
    return int(impl_->passes.levels.size());
}

} // namespace palp
