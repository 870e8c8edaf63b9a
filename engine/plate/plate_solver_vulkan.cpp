#include "engine/plate/plate_solver_vulkan.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/plate_push.h"
#include "engine/core/contract.h"
#include "engine/gpu/command_list.h"
#include "engine/gpu/context.h"
#include "engine/plate/grid_hierarchy.h"
#include "engine/plate/plate_passes.h"
#include "engine/plate/rigidity_unit.h"
#include "engine/plate/scattered_points.h"

// One submission is a list of passes, recorded once:
//
//   prepare   rigidity -> coarser rigidities -> divisors, tiles where it jumps -> factor of the coarsest level
//   cold      loads -> coarser loads; coarsest answer; level by level upwards: interpolate, two steps of conjugate
//             gradients with V(1,1); then kStepsPerList steps with V(2,2) on the finest level
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

using gpu::Binding;
using gpu::Buffer;
using gpu::CommandList;
using gpu::Groups;
using gpu::Intent;
using gpu::Kernel;
using Clock = std::chrono::steady_clock;

constexpr int kSlots        = 3; ///< results in mapped memory: one is written, one is read, one is in between [1]
constexpr int kStepsPerList = 4; ///< even, because directions take turns in two buffers [1]
constexpr int kSweeps       = 2; ///< before and after the correction, on the finest level's cycles [1]

constexpr double kRounding = 1e-7; ///< of rigidities and answer to floats, twice 6e-8 rounded [1]

constexpr double kJump = 3.0; ///< points that vary by less make no jump, see compute_shaders/shared/jump_tiles.h [1]

} // namespace

struct VulkanPlateSolver::Impl {
    gpu::Context&            context;
    const PlateKernels::All& k;
    Plate                    plate;
    Settings                 settings;
    double                   unitRigidity;
    std::uint32_t            loads;
    double                   stiffness; ///< see GridHierarchy [N/m]
    PlatePasses              passes;

    Buffer              units; ///< metres per unit of the shaders' deflection, per load
    Buffer              hostRigidity, hostLoads, hostUnits, hostState;
    std::vector<Buffer> results;

    /// What scattered points need, once there are some.
    struct FromPoints {
        ScatteredPoints                           points;
        Buffer                                    rigidity; ///< at the nodes, for the host
        std::array<std::optional<CommandList>, 2> sample;   ///< by Sampling
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

    std::vector<CommandList>                     prepareList; ///< one, or none before it is recorded
    std::array<std::vector<CommandList>, kSlots> coldList, warmList, moreList;
    int                                          slot      = 0;
    bool                                         jumps     = false; ///< what the lists are recorded for
    bool                                         hasAnswer = false;
    std::optional<double>                        deviceMilliseconds;

    PlateWork coldWork, warmWork, stepsWork; ///< before the steps on the finest level; kStepsPerList of these

    Impl(gpu::Context& device, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted)
        : Impl(device, kernels, given, wanted, gridHierarchy(given, largest(given.rigidity)))
    {
    }

    Impl(gpu::Context& device, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted,
         GridHierarchy grids)
        : context(device), k(kernels), plate(given), settings(wanted), unitRigidity(largest(given.rigidity)),
          loads(std::uint32_t(wanted.loads)), stiffness(grids.stiffness),
          passes(device, kernels, std::move(grids), loads),
          units(context, "metres per unit", 4 * std::size_t(loads), Intent::device),
          hostRigidity(context, "rigidity from the host", 4 * plate.grid.nodes(), Intent::upload),
          hostLoads(context, "loads from the host", 4 * plate.grid.nodes() * loads, Intent::upload),
          hostUnits(context, "units from the host", 4 * std::size_t(loads), Intent::upload),
          hostState(context, "state for the host", passes.state.bytes(), Intent::readback)
    {
        for (int s = 0; s < kSlots; ++s)
            results.emplace_back(context, "deflection " + std::to_string(s), 4 * plate.grid.nodes() * loads,
                                 Intent::readback);
    }

    static double largest(const NodeField& field)
    {
        return *std::max_element(field.values().begin(), field.values().end());
    }

    // --- lists

    void finestSteps(CommandList& list, std::uint32_t begins)
    {
        PlatePasses::Recorder pass{passes, list, true};
        passes.steps(pass, 0, kStepsPerList, kSweeps, begins, settings.tolerance);
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
        list.copy(hostLoads, passes.levels[0].load);
        list.copy(hostUnits, units);
        passes.allow(list);
    }

    void recordPrepare()
    {
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        list.copy(hostRigidity, passes.levels[0].rigidity);
        passes.prepare(pass);
        list.end();
        prepareList.push_back(std::move(list));
    }

    CommandList recordCold()
    {
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
        coldWork = std::exchange(passes.work, {});
        finestSteps(list, 2);
        stepsWork = passes.work;
        return list;
    }

    CommandList recordWarm()
    {
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        beginSolve(list);
        passes.work = {};
        passes.start(pass, 0);
        warmWork = std::exchange(passes.work, {});
        finestSteps(list, 2);
        stepsWork = passes.work;
        return list;
    }

    CommandList recordMore()
    {
        CommandList list(context);
        list.timestamp();
        finestSteps(list, 1);
        return list;
    }

    CommandList recordSample(Sampling sampling)
    {
        CommandList           list(context);
        PlatePasses::Recorder pass{passes, list};
        const Buffer&         rigidity = passes.levels[0].rigidity;
        if (sampling == Sampling::nearest)
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
    CommandList& run(std::array<std::vector<CommandList>, kSlots>& lists, CommandList (Impl::*record)())
    {
        auto& mine = lists[std::size_t(slot)];
        if (mine.empty()) mine.push_back((this->*record)());
        std::vector<CommandList*> all{&mine.front()};
        if (fromPoints) {
            if (!fromPoints->lift) fromPoints->lift.emplace(recordLift());
            if (fromPoints->pending) all.insert(all.begin(), std::exchange(fromPoints->pending, nullptr));
            all.push_back(&*fromPoints->lift);
        }
        context.run(all);
        hostState.makeVisibleToHost();
        return mine.front();
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

    void upload(std::span<const NodeField> nodalForces)
    {
        PALP_EXPECT(nodalForces.size() == loads,
                    std::to_string(nodalForces.size()) + " loads for a solver of " + std::to_string(loads));
        const std::size_t nodes = plate.grid.nodes();
        for (std::size_t n = 0; n < nodalForces.size(); ++n) {
            PALP_EXPECT(nodalForces[n].on(plate.grid), "the load's grid is not the plate's");
            double most = 0;
            for (double f : nodalForces[n].values()) {
                if (!std::isfinite(f))
                    throw Error("plate: expected finite forces, found a load that is not a number or infinite");
                most = std::max(most, std::abs(f));
            }
            const double scale = most > 0 ? 1 / most : 0;
            float*       to    = hostLoads.as<float>().data() + n * nodes;
            for (std::size_t m = 0; m < nodes; ++m) to[m] = float(nodalForces[n].values()[m] * scale);
            hostUnits.as<float>()[n] = float(most / stiffness);
        }
    }

    void uploadRigidity(const NodeField& rigidity)
    {
        plate.rigidity = rigidity;
        if (const auto why = whyUnsolvable(plate)) throw Error("plate: " + *why);
        float* to = hostRigidity.as<float>().data();
        for (std::size_t n = 0; n < plate.grid.nodes(); ++n)
            to[n] = inRigidityUnits(rigidity.values()[n], unitRigidity);
        fromPoints.reset();
        if (prepareList.empty()) recordPrepare();
        context.run(prepareList.front());
        expectJumps(passes.foundJumps());
    }

    void samplePoints(PlatePoints given, Sampling sampling)
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
            for (auto& list : fromPoints->sample) list.reset();
            fromPoints->lift.reset();
        }
        auto& list = fromPoints->sample[sampling == Sampling::nearest];
        if (!list) list.emplace(recordSample(sampling));
        fromPoints->pending      = &*list;
        const auto [least, most] = std::minmax_element(given.rigidities.begin(), given.rigidities.end());
        const bool mayJump       = *most > kJump * *least;
        expectJumps(mayJump && (!fromPoints->knowJumps || passes.foundJumps()));
        fromPoints->knowJumps = true;
    }

    /// Lists are recorded with or without the extra sweeps that jumps want; anew when that changes.
    void expectJumps(bool expected)
    {
        if (expected == jumps) return;
        jumps = expected;
        passes.expectJumps(expected);
        for (auto* lists : {&coldList, &warmList, &moreList})
            for (auto& recorded : *lists) recorded.clear();
    }

    [[nodiscard]] std::vector<PlateSolution> solve(std::span<const NodeField> nodalForces, Start how)
    {
        const auto began = Clock::now();
        upload(nodalForces);
        slot               = (slot + 1) % kSlots;
        const bool warm    = how == Start::warm && hasAnswer;
        hasAnswer          = false; // whatever happens below
        CommandList* list  = warm ? &run(warmList, &Impl::recordWarm) : &run(coldList, &Impl::recordCold);
        int          done  = int(worst(shared::kStateSteps));
        deviceMilliseconds = 0;
        for (;;) {
            const auto times = list->timestampsMilliseconds();
            deviceMilliseconds =
                times.empty() ? std::nullopt : std::optional(deviceMilliseconds.value_or(0) + times.back());
            const double estimate = worst(shared::kStateEstimate);
            if (std::isnan(estimate))
                throw Error("plate: the solver broke down; the rigidity or the load is out of range");
            if (!(estimate > settings.tolerance) || done >= settings.maxIterations) break;
            list = &run(moreList, &Impl::recordMore);
            done += int(worst(shared::kStateSteps));
        }
        SolveReport report;
        report.device        = context.device().name;
        report.iterations    = done;
        report.errorEstimate = std::hypot(worst(shared::kStateEstimate), kRounding);
        report.converged     = worst(shared::kStateEstimate) <= settings.tolerance && !passes.isTooSoft();
        report.workUnits =
            passes.workUnits(warm ? warmWork : coldWork) + done * passes.workUnits(stepsWork) / kStepsPerList;
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
            NodeField    w(plate.grid);
            const float* from = result.as<float>().data() + load * nodes;
            for (std::size_t n = 0; n < nodes; ++n) {
                w.values()[n] = double(from[n]);
                if (!std::isfinite(from[n]))
                    throw Error("plate: the deflection is not finite; the rigidity or the load is out of range");
            }
            answers.push_back({std::move(w), report});
        }
        return answers;
    }
};

VulkanPlateSolver::VulkanPlateSolver(gpu::Context& context, const PlateKernels& kernels, const Plate& plate,
                                     const Settings& settings)
{
    if (const auto why = whyUnsolvable(plate)) throw Error("plate: " + *why);
    const double least = kernels.all().doubles ? kLeastTolerance : kLeastFloatTolerance;
    if (!(settings.tolerance >= least && settings.tolerance < 1))
        throw Error("plate: expected a tolerance from " + std::to_string(least) + " to 1, found " +
                    std::to_string(settings.tolerance));
    PALP_EXPECT(settings.loads >= 1 && settings.maxIterations >= 1, "loads and iterations are at least 1");
    impl_ = std::make_unique<Impl>(context, kernels.all(), plate, settings);
    impl_->uploadRigidity(plate.rigidity);
}

VulkanPlateSolver::~VulkanPlateSolver()                                       = default;
VulkanPlateSolver::VulkanPlateSolver(VulkanPlateSolver&&) noexcept            = default;
VulkanPlateSolver& VulkanPlateSolver::operator=(VulkanPlateSolver&&) noexcept = default;

void VulkanPlateSolver::setRigidity(const NodeField& rigidity)
{
    impl_->uploadRigidity(rigidity);
}

void VulkanPlateSolver::setRigidity(const PlatePoints& points, Sampling sampling)
{
    impl_->samplePoints(points, sampling);
}

std::span<const float> VulkanPlateSolver::mappedDeflections() const
{
    const Buffer& result = impl_->results[std::size_t(impl_->slot)];
    result.makeVisibleToHost();
    return result.as<const float>();
}

std::span<const float> VulkanPlateSolver::pointDeflections(int load) const
{
    return impl_->sampled().points.deflection(std::uint32_t(load));
}

std::size_t VulkanPlateSolver::nodesWithoutPoint() const
{
    return impl_->sampled().points.nodesWithoutPoint();
}

NodeField VulkanPlateSolver::sampledRigidity() const
{
    const Buffer& rigidity = impl_->sampled().rigidity;
    rigidity.makeVisibleToHost();
    NodeField D(impl_->plate.grid);
    for (std::size_t n = 0; n < D.values().size(); ++n)
        D.values()[n] = double(rigidity.as<const float>()[n]) * impl_->unitRigidity;
    return D;
}

std::vector<PlateSolution> VulkanPlateSolver::solve(std::span<const NodeField> nodalForces, Start start)
{
    return impl_->solve(nodalForces, start);
}

PlateSolution VulkanPlateSolver::solve(const NodeField& nodalForce, Start start)
{
    return std::move(impl_->solve({&nodalForce, 1}, start).front());
}

std::optional<double> VulkanPlateSolver::deviceMilliseconds() const noexcept
{
    return impl_->deviceMilliseconds;
}

int VulkanPlateSolver::dispatchesPerCycle() const noexcept
{
    return impl_->passes.dispatchesPerCycle();
}

int VulkanPlateSolver::levels() const noexcept
{
    return int(impl_->passes.levels.size());
}

} // namespace palp
