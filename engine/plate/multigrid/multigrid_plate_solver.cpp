#include "engine/plate/multigrid/multigrid_plate_solver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/compute/command_list.h"
#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/core/quantity.h"
#include "engine/plate/multigrid/grid_hierarchy.h"
#include "engine/plate/multigrid/plate_passes.h"
#include "engine/plate/rigidity_unit.h"
#include "engine/plate/scattered_points.h"

// One submission is a list of passes, recorded once:
//
//   prepare   rigidity -> coarser rigidities -> divisors, tiles where it jumps -> factor of the coarsest level
//   cold      loads -> coarser loads; coarsest answer; level by level upwards: interpolate, a step or two of conjugate
//             gradients; then kStepsPerList steps on the finest level
//   warm      the residual of the last answer, then kStepsPerList steps
//   more      kStepsPerList further steps
//   sample    rigidity from scattered points, then prepare
//   lift      the answer to those points
//
// Lists are recorded once with, or without, extra sweeps of the tiles in which the rigidity jumps. The steps on the
// finest level are dispatched indirectly: when the estimate is small enough a kernel sets all their sizes to zero, and
// the rest of the list runs empty. The host looks only between lists.

namespace palp {
namespace {

using compute::Binding;
using compute::Buffer;
using compute::CommandList;
using compute::Groups;
using compute::Intent;
using compute::Kernel;
using Clock = std::chrono::steady_clock;

constexpr int kSlots        = 3; ///< results in mapped memory: one is written, one is read, one is in between [1]
constexpr int kStepsPerList = 4; ///< [1]

constexpr int kMostGroups = 65535; ///< along x of a dispatch, on every device [1]

constexpr double kRounding      = 1e-7; ///< of rigidities and answer to floats, twice 6e-8 rounded [1]
constexpr double kFloatRounding = 5e-5; ///< of conjugate gradients in floats, at contrast 1000 and free sides [1]

std::string shortest(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// What the host writes for a buffer of the device: into it where it can, or else into memory that a list copies.
class Staging {
public:
    Staging(compute::Context& context, const Buffer& target) : target_(&target)
    {
        if (!target.mapped()) own_.emplace(context, target.name() + " from the host", target.bytes(), Intent::upload);
    }

    [[nodiscard]] std::span<float> floats() const { return (own_ ? *own_ : *target_).as<float>(); }

    void record(CommandList& list) const
    {
        if (own_) list.copy(*own_, *target_);
    }

private:
    const Buffer*         target_;
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
    double                   stiffness; ///< see GridHierarchy [N/m]
    PlatePasses              passes;

    Buffer              units; ///< metres per unit of the shaders' deflection, per load
    Staging             hostRigidity, hostLoads, hostUnits;
    Buffer              hostState;
    std::vector<Buffer> results;

    /// What scattered points need, once there are some.
    struct FromPoints {
        ScatteredPoints                           points;
        Buffer                                    rigidity; ///< at the nodes, for the host
        std::array<std::optional<CommandList>, 2> sample;   ///< by Resampling
        std::optional<CommandList>                lift;
        CommandList*                              pending   = nullptr; ///< to run before the next solve
        bool                                      knowJumps = false;   ///< of the points before

        explicit FromPoints(const Impl& of)
            : points(of.context, of.k, of.plate.grid, of.loads),
              rigidity(of.context, "sampled rigidity", 4 * of.plate.grid.nodes(), Intent::readback)
        {
        }
    };
    std::optional<FromPoints> fromPoints; ///< empty while the rigidity is the host's

    /// Recorded when first needed.
    struct Lists {
        std::array<std::optional<CommandList>, kSlots> cold, warm, more;
        int                                            dispatchesPerCycle = 0;
        PlateWork coldWork, warmWork, stepsWork; ///< before the steps on the finest level; kStepsPerList of these
    };
    std::optional<CommandList> prepareList;
    std::array<Lists, 3>       lists;                   ///< by how the rigidity jumps
    Jumps                      jumps     = Jumps::none; ///< which of them are used
    int                        slot      = 0;
    bool                       hasAnswer = false;
    std::vector<double>        forceUnits; ///< of the last answers, per load [N]

    Impl(compute::Context& device, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted)
        : Impl(device, kernels, given, wanted, gridHierarchy(given, largest(given.rigidity)))
    {
    }

    Impl(compute::Context& device, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted,
         GridHierarchy grids)
        : context(device), k(kernels), plate(withoutRigidity(given)), settings(rounded(wanted)),
          unitRigidity(largest(given.rigidity)), loads(std::uint32_t(wanted.loads)), stiffness(grids.stiffness),
          passes(device, kernels, std::move(grids), loads),
          units(context, "metres per unit", 4 * std::size_t(loads), Intent::device),
          hostRigidity(context, passes.levels[0].rigidity), hostLoads(context, passes.levels[0].load),
          hostUnits(context, units), hostState(context, "state for the host", passes.state.bytes(), Intent::readback)
    {
        for (int s = 0; s < kSlots; ++s)
            results.emplace_back(context, "deflection " + std::to_string(s), 4 * plate.grid.nodes() * loads,
                                 Intent::readback);
    }

    /// The device compares in floats, and host and device must agree on when a solve is finished.
    static Settings rounded(Settings wanted)
    {
        wanted.tolerance = double(float(wanted.tolerance));
        return wanted;
    }

    /// The device has it.
    static Plate withoutRigidity(const Plate& given)
    {
        return {given.grid, given.edges, given.poissonRatio, given.foundation, {}};
    }

    static double largest(const NodeField& field) { return extremesOf(field.values()).most; }

    // --- lists

    void finestSteps(CommandList& list, std::uint32_t begins)
    {
        PlatePasses::Recorder pass{passes, list, true};
        passes.steps(pass, 0, kStepsPerList, k.smoothing.finest, begins, settings.tolerance);
        list.dispatch(k.result, {passes.levels[0].answer, units, results[std::size_t(slot)]},
                      shared::VectorPush{std::uint32_t(passes.nodes()), passes.partials(), 0},
                      passes.inOrder(k.result, 0));
        list.copy(passes.state, hostState);
        list.timestamp();
        list.end();
    }

    void beginSolve(CommandList& list)
    {
        list.timestamp();
        hostLoads.record(list);
        hostUnits.record(list);
        passes.allow(list);
    }

    void recordPrepare()
    {
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        hostRigidity.record(list);
        passes.prepare(pass);
        list.end();
        prepareList.emplace(std::move(list));
    }

    CommandList recordCold()
    {
        Lists&                now = lists[std::size_t(jumps)];
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        beginSolve(list);
        passes.work = {};
        if (passes.levels.size() == 1) {
            list.fill(passes.levels[0].answer, 0);
            passes.start(pass, 0);
        } else {
            passes.nest(pass);
        }
        now.coldWork = std::exchange(passes.work, {});
        finestSteps(list, 2);
        now.stepsWork          = passes.work;
        now.dispatchesPerCycle = passes.dispatchesPerCycle();
        return list;
    }

    CommandList recordWarm()
    {
        Lists&                now = lists[std::size_t(jumps)];
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        beginSolve(list);
        passes.work = {};
        passes.start(pass, 0);
        now.warmWork = std::exchange(passes.work, {});
        finestSteps(list, 2);
        now.stepsWork          = passes.work;
        now.dispatchesPerCycle = passes.dispatchesPerCycle();
        return list;
    }

    CommandList recordMore()
    {
        CommandList list(context);
        list.timestamp();
        finestSteps(list, 1);
        return list;
    }

    CommandList recordSample(Resampling sampling)
    {
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        const Buffer&         rigidity = passes.levels[0].rigidity;
        if (sampling == Resampling::nearest)
            fromPoints->points.recordNearest(list, rigidity);
        else
            fromPoints->points.recordLogMean(list, rigidity);
        list.copy(rigidity, fromPoints->rigidity);
        passes.prepare(pass);
        list.end();
        return list;
    }

    CommandList recordLift()
    {
        CommandList list(context);
        fromPoints->points.recordLift(list, passes.levels[0].answer, units);
        list.end();
        return list;
    }

    /// Runs the list of this slot, recording it if need be; what points need goes with it.
    CommandList& run(std::array<std::optional<CommandList>, kSlots> Lists::*which, CommandList (Impl::*record)())
    {
        auto& mine = (lists[std::size_t(jumps)].*which)[std::size_t(slot)];
        if (!mine) mine.emplace((this->*record)());
        std::vector<CommandList*> all{&*mine};
        if (fromPoints) {
            if (!fromPoints->lift) fromPoints->lift.emplace(recordLift());
            if (fromPoints->pending) all.insert(all.begin(), std::exchange(fromPoints->pending, nullptr));
            all.push_back(&*fromPoints->lift);
        }
        context.run(all);
        hostState.makeVisibleToHost();
        return *mine;
    }

    // --- a solve

    [[nodiscard]] double stateOf(std::uint32_t load, int word) const
    {
        const std::size_t at = std::size_t(load) * shared::kStateWords + std::size_t(word);
        return k.doubles ? hostState.as<double>()[at] : double(hostState.as<float>()[at]);
    }

    [[nodiscard]] double worst(int word) const
    {
        double most = 0;
        for (std::uint32_t load = 0; load < loads; ++load) {
            const double value = stateOf(load, word);
            if (!(value <= most)) most = value; // a NaN is the worst
        }
        return most;
    }

    [[nodiscard]] const FromPoints& sampled() const
    {
        PALP_EXPECT(fromPoints && !fromPoints->pending, "no solve has run with a rigidity from points");
        return *fromPoints;
    }

    /// Largest force of each load [N].
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

    /// Whether forces like these can be counted in the units of the last answers.
    [[nodiscard]] bool fitUnits(const std::vector<double>& largest) const
    {
        constexpr double kMost = 1e3; // keeps seven digits of the smaller forces far from the ends of floats
        for (std::size_t n = 0; n < largest.size(); ++n)
            if (!(largest[n] <= kMost * forceUnits[n] && kMost * largest[n] >= forceUnits[n])) return false;
        return true;
    }

    /// Forces in units of each load's largest one; but a start from the last answers keeps their units.
    void upload(std::span<const NodeField> nodalForces, const std::vector<double>& scales)
    {
        const std::size_t nodes = plate.grid.nodes();
        for (std::size_t n = 0; n < nodalForces.size(); ++n) {
            const double scale  = scales[n] > 0 ? 1 / scales[n] : 0;
            const double metres = scales[n] / stiffness;
            if (scale > 0 && !(metres > double(std::numeric_limits<float>::min()) &&
                               metres < double(std::numeric_limits<float>::max())))
                throw Error("plate: forces of " + formatQuantity(scales[n], "N") + " on a rigidity of " +
                            formatQuantity(unitRigidity, "N m") + " give deflections that 32 bits cannot hold");
            float*        to   = hostLoads.floats().data() + n * nodes;
            const double* from = nodalForces[n].values().data();
            for (std::size_t m = 0; m < nodes; ++m) to[m] = float(from[m] * scale);
            hostUnits.floats()[n] = float(metres);
        }
        forceUnits = scales;
    }

    void uploadRigidity(const NodeField& rigidity)
    {
        if (const auto why = whyUnsolvable(plate, rigidity)) throw Error("plate: " + *why);
        const Extremes of = inRigidityUnits(rigidity.values(), unitRigidity, hostRigidity.floats());
        fromPoints.reset();
        if (!prepareList) recordPrepare();
        context.run(*prepareList);
        expectJumps(passes.foundJumps() ? jumpsOf(of.most / of.least) : Jumps::none);
    }

    void samplePoints(PlatePoints given, Resampling sampling)
    {
        const bool first = !fromPoints;
        if (first) fromPoints.emplace(*this);
        given.unit = unitRigidity;
        bool grew  = false;
        try {
            grew = fromPoints->points.set(given);
        } catch (...) {
            if (first) fromPoints.reset(); // the rigidity stays the host's
            throw;
        }
        if (grew) {
            fromPoints->pending = nullptr;
            for (auto& list : fromPoints->sample) list.reset();
            fromPoints->lift.reset();
        }
        auto& list = fromPoints->sample[std::size_t(sampling)];
        if (!list) list.emplace(recordSample(sampling));
        fromPoints->pending      = &*list;
        const auto [least, most] = std::minmax_element(given.rigidities.begin(), given.rigidities.end());
        const bool mayJump       = *most > double(shared::kJump) * *least;
        const bool jump          = mayJump && (!fromPoints->knowJumps || passes.foundJumps());
        expectJumps(jump ? jumpsOf(*most / *least) : Jumps::none);
        fromPoints->knowJumps = true;
    }

    /// \param contrast  largest over least rigidity [1]
    static Jumps jumpsOf(double contrast)
    {
        constexpr double kStrong =
            3000; // from where on more sweeps of the tiles cost less time than the steps they save
        return contrast > kStrong ? Jumps::strong : Jumps::some;
    }

    void expectJumps(Jumps expected)
    {
        jumps = expected;
        passes.expectJumps(expected);
    }

    [[nodiscard]] std::vector<PlateSolution> solve(std::span<const NodeField> nodalForces, Start how)
    {
        const auto                began   = Clock::now();
        const std::vector<double> largest = largestForces(nodalForces);
        const bool                warm    = how == Start::warm && hasAnswer && fitUnits(largest);
        upload(nodalForces, warm ? forceUnits : largest);
        slot              = (slot + 1) % kSlots;
        hasAnswer         = false; // whatever happens below
        CommandList* list = warm ? &run(&Lists::warm, &Impl::recordWarm) : &run(&Lists::cold, &Impl::recordCold);
        int          done = int(worst(shared::kStateSteps));
        std::optional<double> deviceMilliseconds = 0;
        for (;;) {
            const auto times = list->timestampsMilliseconds();
            deviceMilliseconds =
                times.empty() ? std::nullopt : std::optional(deviceMilliseconds.value_or(0) + times.back());
            const double estimate = worst(shared::kStateEstimate);
            if (std::isnan(estimate))
                throw Error("plate: the solver broke down; the rigidity or the load is out of range");
            if (!(estimate > settings.tolerance) || done >= settings.maxIterations) break;
            list = &run(&Lists::more, &Impl::recordMore);
            done += int(worst(shared::kStateSteps));
        }
        SolveReport report;
        report.device        = context.device().name;
        report.iterations    = done;
        report.errorEstimate = std::hypot(worst(shared::kStateEstimate), k.doubles ? kRounding : kFloatRounding);
        report.converged     = worst(shared::kStateEstimate) <= settings.tolerance && !passes.isTooSoft();
        const Lists& used    = lists[std::size_t(jumps)];
        report.workUnits     = passes.workUnits(warm ? used.warmWork : used.coldWork) +
                           done * passes.workUnits(used.stepsWork) / kStepsPerList;
        report.deviceMilliseconds          = deviceMilliseconds;
        report.milliseconds                = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
        std::vector<PlateSolution> answers = read(report);
        hasAnswer                          = true;
        return answers;
    }

    [[nodiscard]] std::vector<PlateSolution> read(const SolveReport& report) const
    {
        const Buffer& result = results[std::size_t(slot)];
        result.makeVisibleToHost();
        std::vector<PlateSolution> answers;
        const std::size_t          nodes = plate.grid.nodes();
        for (std::uint32_t load = 0; load < loads; ++load) {
            const float* from = result.as<float>().data() + load * nodes;
            NodeField    w(plate.grid.nodesX(), plate.grid.nodesZ(), std::vector<double>(from, from + nodes));
            if (!extremesOf(w.values()).finite)
                throw Error("plate: the deflection is not finite; the rigidity or the load is out of range");
            answers.push_back({std::move(w), report});
        }
        return answers;
    }
};

MultigridPlateSolver::MultigridPlateSolver(compute::Context& context, const PlateKernels& kernels, const Plate& plate,
                                           const Settings& settings)
{
    if (const auto why = whyUnsolvable(plate)) throw Error("plate: " + *why);
    const double least = kernels.all().doubles ? kLeastTolerance : kLeastFloatTolerance;
    if (!(settings.tolerance >= least && settings.tolerance < 1))
        throw Error("plate: expected a tolerance of at least " + shortest(least) + " and below 1, found " +
                    shortest(settings.tolerance));
    const std::size_t most = std::size_t(kMostGroups) * kernels.all().update.workgroup().x;
    if (plate.grid.nodes() > most)
        throw Error("plate: " + std::to_string(plate.grid.nodes()) + " nodes are more than the " +
                    std::to_string(most) + " that the solver takes; try fewer cells");
    PALP_EXPECT(settings.loads >= 1 && settings.maxIterations >= 1, "loads and iterations are at least 1");
    impl_ = std::make_unique<Impl>(context, kernels.all(), plate, settings);
    impl_->uploadRigidity(plate.rigidity);
}

MultigridPlateSolver::~MultigridPlateSolver()                                          = default;
MultigridPlateSolver::MultigridPlateSolver(MultigridPlateSolver&&) noexcept            = default;
MultigridPlateSolver& MultigridPlateSolver::operator=(MultigridPlateSolver&&) noexcept = default;

void MultigridPlateSolver::setRigidity(const NodeField& rigidity)
{
    impl_->uploadRigidity(rigidity);
}

void MultigridPlateSolver::setRigidity(const PlatePoints& points, Resampling sampling)
{
    impl_->samplePoints(points, sampling);
}

std::span<const float> MultigridPlateSolver::mappedDeflections() const
{
    const Buffer& result = impl_->results[std::size_t(impl_->slot)];
    result.makeVisibleToHost();
    return result.as<const float>();
}

std::span<const float> MultigridPlateSolver::pointDeflections(int load) const
{
    return impl_->sampled().points.deflection(std::uint32_t(load));
}

std::size_t MultigridPlateSolver::nodesWithoutPoint() const
{
    return impl_->sampled().points.nodesWithoutPoint();
}

NodeField MultigridPlateSolver::sampledRigidity() const
{
    const Buffer& rigidity = impl_->sampled().rigidity;
    rigidity.makeVisibleToHost();
    NodeField D(impl_->plate.grid);
    for (std::size_t n = 0; n < D.values().size(); ++n)
        D.values()[n] = double(rigidity.as<const float>()[n]) * impl_->unitRigidity;
    return D;
}

std::vector<PlateSolution> MultigridPlateSolver::solve(std::span<const NodeField> nodalForces, Start start)
{
    return impl_->solve(nodalForces, start);
}

PlateSolution MultigridPlateSolver::solve(const NodeField& nodalForce, Start start)
{
    return std::move(impl_->solve({&nodalForce, 1}, start).front());
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
