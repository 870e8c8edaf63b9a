#include "engine/plate/plate_solver_vulkan.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/gpu/command_list.h"
#include "engine/gpu/context.h"
#include "engine/plate/grid_hierarchy.h"
#include "engine/plate/plate_kernels.h"

// One submission is a list of passes, recorded once:
//
//   prepare   rigidity -> coarser rigidities -> divisors, tiles where it jumps -> factor of the coarsest level
//   cold      loads -> coarser loads; coarsest answer; level by level upwards: interpolate, two steps of conjugate
//             gradients with V(1,1); then kStepsPerList steps with V(2,2) on the finest level
//   warm      the residual of the last answer, then kStepsPerList steps
//   more      kStepsPerList further steps
//
// Lists are recorded for the number of tiles in which the rigidity jumps, and anew where another rigidity has other
// numbers. The steps on the finest level are dispatched indirectly: when the estimate is small enough a kernel sets all
// their sizes to zero, and the rest of the list runs empty. The host looks only between lists.

namespace palp {
namespace {

using gpu::Binding;
using gpu::Buffer;
using gpu::CommandList;
using gpu::Groups;
using gpu::Intent;
using gpu::Kernel;
using Clock = std::chrono::steady_clock;

constexpr int           kSlots = 3; ///< results in mapped memory: one is written, one is read, one is in between [1]
constexpr int           kStepsPerList = 4; ///< even, because directions take turns in two buffers [1]
constexpr int           kNestedSteps  = 2; ///< on each coarser level of the nested iteration [1]
constexpr int           kNestedSweeps = 1; ///< of its cycles [1]
constexpr int           kSweeps       = 2; ///< before and after the correction, on the finest level's cycles [1]
constexpr int           kTileSweeps   = 6; ///< extra ones where the rigidity jumps, before and after the correction [1]
constexpr std::uint32_t kMostPartials = 16384; ///< sums that a dot product is split into [1]
constexpr std::uint32_t kTermsPerSum  = 64;    ///< that a sum has at least, unless there are too few partials [1]

std::size_t nodesOf(const shared::PlateLevel& g)
{
    return std::size_t(g.cellsX + 1) * std::size_t(g.cellsZ + 1);
}

std::size_t tilesOf(const shared::PlateLevel& g)
{
    return std::size_t(shared::tilesX(g)) * std::size_t(shared::tilesZ(g));
}

/// Everything a level keeps on the device. `real` arrays are doubles where the device has them.
struct LevelBuffers {
    Buffer rigidity, divisor, tableX, tableZ;
    Buffer force, w[2], residual; ///< of the cycle, floats
    Buffer marks, tiles;          ///< where the rigidity jumps: a flag per tile; how many tiles, then their numbers
    Buffer load;                  ///< of the nested iteration, floats
    Buffer answer, left, direction[2], forces; ///< x, r, p, A p of conjugate gradients, real
};

} // namespace

struct VulkanPlateSolver::Impl {
    gpu::Context&            context;
    const PlateKernels::All& k;
    Plate                    plate;
    Settings                 settings;
    double                   unitRigidity;
    GridHierarchy            grids;
    std::uint32_t            loads;
    std::uint32_t            partials;

    std::vector<LevelBuffers>  levels;
    Buffer                     zeroes, band, factor, sums, state, units;
    Buffer                     hostRigidity, hostLoads, hostUnits, arguments, hostArguments, hostState, hostTiles;
    std::vector<std::uint32_t> jumpTiles; ///< per level, with a jump of rigidity; what the lists were recorded for [1]
    std::vector<Buffer>        results;

    std::map<std::array<std::uint32_t, 3>, std::size_t> argumentAt;  ///< groups -> byte offset in `arguments`
    std::vector<CommandList>                            prepareList; ///< one, or none before it is recorded
    std::array<std::vector<CommandList>, kSlots>        coldList, warmList, moreList;
    int                                                 slot      = 0;
    bool                                                hasAnswer = false;
    std::optional<double>                               deviceMilliseconds;

    double work     = 0; ///< of what has been recorded since it was last set to 0 [applications on the finest grid]
    double coldWork = 0, warmWork = 0, stepWork = 0;

    Impl(gpu::Context& device, const PlateKernels::All& kernels, const Plate& given, const Settings& wanted)
        : context(device), k(kernels), plate(given), settings(wanted), unitRigidity(largest(given.rigidity)),
          grids(gridHierarchy(given, unitRigidity)), loads(std::uint32_t(wanted.loads)),
          partials(
              std::uint32_t(std::clamp<std::size_t>(given.grid.nodes() / kTermsPerSum, kTermsPerSum, kMostPartials))),
          levels(makeLevels()), zeroes(floats("zeroes", fieldSize(0))), band(floats("band", bandSize())),
          factor(floats("factor", bandSize())), sums(reals("partial sums", 2 * std::size_t(loads) * partials)),
          state(reals("state", std::size_t(shared::kStateWords) * loads)), units(floats("metres per unit", loads)),
          hostRigidity(context, "rigidity from the host", 4 * plate.grid.nodes(), Intent::upload),
          hostLoads(context, "loads from the host", 4 * fieldSize(0), Intent::upload),
          hostUnits(context, "units from the host", 4 * std::size_t(loads), Intent::upload),
          arguments(context, "groups of dispatches", kArgumentBytes, Intent::device),
          hostArguments(context, "groups from the host", kArgumentBytes, Intent::upload),
          hostState(context, "state for the host", state.bytes(), Intent::readback),
          hostTiles(context, "numbers of tiles for the host", 4 * levels.size(), Intent::readback),
          jumpTiles(levels.size(), 0)
    {
        for (int s = 0; s < kSlots; ++s)
            results.emplace_back(context, "deflection " + std::to_string(s), 4 * fieldSize(0), Intent::readback);
        std::memset(hostArguments.mapped(), 0, kArgumentBytes);
        uploadTables();
    }

    static constexpr std::size_t kArgumentBytes = 12 * 256; ///< for 256 sizes of dispatches; a solver has about 60

    static double largest(const NodeField& field)
    {
        return *std::max_element(field.values().begin(), field.values().end());
    }

    // --- memory

    [[nodiscard]] const shared::PlateLevel& level(std::size_t l) const { return grids.levels[l].plate; }
    [[nodiscard]] std::size_t               fieldSize(std::size_t l) const { return nodesOf(level(l)) * loads; }
    [[nodiscard]] std::size_t               bandSize() const
    {
        const auto& coarsest = grids.levels.back().plate;
        return nodesOf(coarsest) * std::size_t(shared::halfBand(coarsest) + 1);
    }
    Buffer floats(const std::string& name, std::size_t count) { return {context, name, 4 * count, Intent::device}; }
    Buffer reals(const std::string& name, std::size_t count)
    {
        return {context, name, k.realBytes() * count, Intent::device};
    }

    std::vector<LevelBuffers> makeLevels()
    {
        std::vector<LevelBuffers> made;
        for (std::size_t l = 0; l < grids.levels.size(); ++l) {
            const std::string of    = " of level " + std::to_string(l);
            const std::size_t nodes = nodesOf(level(l)), field = fieldSize(l);
            const auto&       tables = grids.levels[l];
            made.push_back({floats("rigidity" + of, nodes),
                            floats("divisor" + of, nodes),
                            floats("table x" + of, std::max<std::size_t>(1, tables.tableX.size())),
                            floats("table z" + of, std::max<std::size_t>(1, tables.tableZ.size())),
                            floats("force" + of, field),
                            {floats("w0" + of, field), floats("w1" + of, field)},
                            floats("residual" + of, field),
                            floats("marks" + of, tilesOf(level(l))),
                            floats("tiles" + of, 1 + tilesOf(level(l))),
                            floats("load" + of, field),
                            reals("answer" + of, field),
                            reals("left" + of, field),
                            {reals("direction 0" + of, field), reals("direction 1" + of, field)},
                            reals("forces" + of, field)});
        }
        return made;
    }

    void uploadTables()
    {
        std::vector<Buffer> staging;
        CommandList         list(context);
        const auto          upload = [&](const std::vector<float>& from, const Buffer& to) {
            if (from.empty()) return;
            staging.emplace_back(context, "table from the host", 4 * from.size(), Intent::upload);
            std::memcpy(staging.back().mapped(), from.data(), 4 * from.size());
            list.copy(staging.back(), to);
        };
        for (std::size_t l = 0; l < levels.size(); ++l) {
            upload(grids.levels[l].tableX, levels[l].tableX);
            upload(grids.levels[l].tableZ, levels[l].tableZ);
        }
        list.fill(zeroes, 0);
        for (const LevelBuffers& b : levels)
            for (const Buffer* w : {&b.w[0], &b.w[1]}) list.fill(*w, 0); // held nodes stay at 0
        list.end();
        context.run(list);
    }

    // --- passes

    /// One pass; `stoppable` ones become empty once the solve is finished.
    struct Recorder {
        Impl&        s;
        CommandList& list;
        bool         stoppable = false;

        void operator()(const Kernel& kernel, const gpu::Bindings& bindings, const gpu::Push& push, Groups groups)
        {
            if (stoppable)
                list.dispatchIndirect(kernel, bindings, push, s.arguments, s.argumentsFor(groups));
            else
                list.dispatch(kernel, bindings, push, groups);
        }
    };

    std::size_t argumentsFor(Groups groups)
    {
        const auto [found, isNew] = argumentAt.try_emplace({groups.x, groups.y, groups.z}, 12 * argumentAt.size());
        PALP_EXPECT(found->second < kArgumentBytes, "more sizes of dispatches than were foreseen");
        if (isNew) std::memcpy(static_cast<char*>(hostArguments.mapped()) + found->second, found->first.data(), 12);
        return found->second;
    }

    Groups everyNode(const Kernel& kernel, std::size_t l) const
    {
        return kernel.groupsOver(std::uint32_t(level(l).cellsZ + 1), std::uint32_t(level(l).cellsX + 1), loads);
    }
    Groups everySecondNode(const Kernel& kernel, std::size_t l) const
    {
        return kernel.groupsOver(std::uint32_t(level(l).cellsZ / 2 + 1), std::uint32_t(level(l).cellsX + 1), loads);
    }
    Groups inOrder(const Kernel& kernel, std::size_t l) const
    {
        return kernel.groupsOver(std::uint32_t(nodesOf(level(l))), 1, loads);
    }
    [[nodiscard]] double share(std::size_t l) const { return double(nodesOf(level(l))) / double(nodesOf(level(0))); }

    /// Sweeps from w[at], both colours, the one of `first` first; what is valid afterwards is returned.
    int sweep(Recorder& pass, std::size_t l, int at, std::uint32_t first, bool fromZero)
    {
        const LevelBuffers& b = levels[l];
        for (std::uint32_t n = 0; n < 2; ++n) {
            const shared::RelaxPush push{level(l), n == 0 ? first : 1 - first};
            const Buffer&           old = fromZero ? zeroes : b.w[at];
            if (fromZero && n == 0)
                pass(k.relaxFirst, {b.divisor, b.force, b.w[1 - at]}, push, everySecondNode(k.relaxFirst, l));
            else
                pass(k.relax, {b.rigidity, b.divisor, b.force, old, n == 0 ? old : b.w[1 - at], b.w[1 - at]}, push,
                     everySecondNode(k.relax, l));
            work += share(l) / 2;
        }
        return 1 - at;
    }

    /// Extra sweeps of w[at] in the tiles where the rigidity jumps. The residual's memory is free while they run.
    void sweepTiles(Recorder& pass, std::size_t l, int at, std::uint32_t first)
    {
        if (jumpTiles[l] == 0) return;
        const LevelBuffers& b = levels[l];
        const Groups        groups{jumpTiles[l], 1, loads};
        for (int n = 0; n < kTileSweeps; ++n)
            for (std::uint32_t colour : {first, 1 - first}) {
                const shared::RelaxPush push{level(l), colour};
                pass(k.relaxTile, {b.rigidity, b.divisor, b.force, b.w[at], b.tiles, b.residual}, push, groups);
                pass(k.copyTile, {b.tiles, b.residual, b.w[at]}, push, groups);
            }
        work += kTileSweeps * double(jumpTiles[l]) * shared::kTile * shared::kTile / double(nodesOf(level(0)));
    }

    /// One symmetric cycle for the forces of level l; returns which of its w holds the answer.
    int cycle(Recorder& pass, std::size_t l, int sweeps)
    {
        const LevelBuffers& b = levels[l];
        if (l + 1 == levels.size()) {
            pass(k.coarseSolve, {factor, b.force, b.w[0]}, shared::LevelPush{level(l)}, {1, 1, loads});
            return 0;
        }
        int at = 0;
        for (int n = 0; n < sweeps; ++n) at = sweep(pass, l, at, 0, n == 0);
        sweepTiles(pass, l, at, 0);
        const LevelBuffers&        below = levels[l + 1];
        const shared::TransferPush transfer{level(l), level(l + 1)};
        pass(k.residual, {b.rigidity, b.force, b.w[at], b.residual}, shared::LevelPush{level(l)},
             everyNode(k.residual, l));
        work += share(l);
        pass(k.restrict, {b.tableX, b.tableZ, b.residual, below.force}, transfer, everyNode(k.restrict, l + 1));
        const int from = cycle(pass, l + 1, sweeps);
        pass(k.correct, {b.tableX, b.tableZ, below.w[from], b.w[1 - at], b.w[at]}, transfer, everyNode(k.correct, l));
        at = 1 - at;
        sweepTiles(pass, l, at, 1);
        for (int n = 0; n < sweeps; ++n) at = sweep(pass, l, at, 1, false);
        return at;
    }

    /// The residual of the answer of level l.
    void start(Recorder& pass, std::size_t l)
    {
        const LevelBuffers& b = levels[l];
        pass(k.start, {b.rigidity, b.load, b.answer, b.left, b.force}, shared::LevelPush{level(l)},
             everyNode(k.start, l));
        work += share(l);
    }

    /// Conjugate gradients on level l. \param begins  as in shared::ScalarsPush
    void steps(Recorder& pass, std::size_t l, int count, int sweeps, std::uint32_t begins, double tolerance)
    {
        const LevelBuffers& b = levels[l];
        for (int n = 1; n <= count; ++n) {
            const auto                nodes = std::uint32_t(nodesOf(level(l)));
            const shared::VectorPush  vector{nodes, partials, std::uint32_t(n)};
            const shared::ScalarsPush scalars{loads, partials, n == 1 ? begins : 0, kArgumentBytes / 4,
                                              float(tolerance)};
            const Buffer&             z   = b.w[cycle(pass, l, sweeps)];
            const Buffer &            now = b.direction[n % 2], &last = b.direction[(n + 1) % 2];
            pass(k.dots, {b.left, z, b.answer, b.load, sums}, vector, k.dots.groupsOver(partials, 1, loads));
            pass(k.beta, {sums, state}, scalars, {1, 1, 1});
            pass(k.direction, {state, z, last, now}, vector, inOrder(k.direction, l));
            pass(k.apply, {b.rigidity, now, b.forces}, shared::LevelPush{level(l)}, everyNode(k.apply, l));
            work += share(l);
            pass(k.stepDots, {now, b.forces, sums}, vector, k.stepDots.groupsOver(partials, 1, loads));
            pass(k.step, {sums, state, arguments}, scalars, {1, 1, 1});
            // Not stoppable: the step that finds the estimate small enough must still be taken. It looks at the count.
            pass.list.dispatch(k.update, {state, now, b.forces, b.answer, b.left, b.force}, vector,
                               inOrder(k.update, l));
        }
    }

    void finestSteps(CommandList& list, std::uint32_t begins)
    {
        Recorder pass{*this, list, true};
        steps(pass, 0, kStepsPerList, kSweeps, begins, settings.tolerance);
        list.dispatch(k.result, {levels[0].answer, units, results[std::size_t(slot)]},
                      shared::VectorPush{std::uint32_t(nodesOf(level(0))), partials, 0}, inOrder(k.result, 0));
        list.copy(state, hostState);
        list.timestamp();
        list.end();
    }

    void beginSolve(CommandList& list)
    {
        list.timestamp();
        list.copy(hostLoads, levels[0].load);
        list.copy(hostUnits, units);
        list.copy(hostArguments, arguments);
    }

    // --- lists

    void recordPrepare()
    {
        CommandList list(context);
        Recorder    pass{*this, list};
        list.copy(hostRigidity, levels[0].rigidity);
        for (std::size_t l = 0; l + 1 < levels.size(); ++l)
            pass(k.coarsen, {levels[l].rigidity, levels[l + 1].rigidity}, shared::TransferPush{level(l), level(l + 1)},
                 k.coarsen.groupsOver(std::uint32_t(level(l + 1).cellsZ + 1), std::uint32_t(level(l + 1).cellsX + 1)));
        for (std::size_t l = 0; l + 1 < levels.size(); ++l)
            pass(k.divisor, {levels[l].rigidity, levels[l].divisor}, shared::LevelPush{level(l)},
                 k.divisor.groupsOver(std::uint32_t(level(l).cellsZ + 1), std::uint32_t(level(l).cellsX + 1)));
        for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
            const LevelBuffers&     b = levels[l];
            const shared::LevelPush push{level(l)};
            pass(k.jumpMark, {b.rigidity, b.marks}, push,
                 k.jumpMark.groupsOver(std::uint32_t(shared::tilesZ(level(l))),
                                       std::uint32_t(shared::tilesX(level(l)))));
            pass(k.jumpList, {b.marks, b.tiles}, push, {1, 1, 1});
            list.copy(b.tiles, 0, hostTiles, 4 * l, 4);
        }
        const shared::LevelPush coarsest{level(levels.size() - 1)};
        pass(k.assemble, {levels.back().rigidity, band}, coarsest,
             k.assemble.groupsOver(std::uint32_t(shared::halfBand(coarsest.level) + 1),
                                   std::uint32_t(nodesOf(coarsest.level))));
        pass(k.factor, {band, factor}, coarsest, {1, 1, 1});
        list.end();
        prepareList.push_back(std::move(list));
    }

    /// Nested iteration: an answer on the finest level from those on the coarser ones.
    void nest(Recorder& pass)
    {
        const std::size_t last = levels.size() - 1;
        for (std::size_t l = 0; l < last; ++l)
            pass(k.restrict, {levels[l].tableX, levels[l].tableZ, levels[l].load, levels[l + 1].load},
                 shared::TransferPush{level(l), level(l + 1)}, everyNode(k.restrict, l + 1));
        pass(k.coarseSolve, {factor, levels[last].load, levels[last].w[0]}, shared::LevelPush{level(last)},
             {1, 1, loads});
        for (std::size_t l = last; l-- > 0;) {
            const shared::TransferPush transfer{level(l), level(l + 1)};
            const LevelBuffers &       b = levels[l], &below = levels[l + 1];
            if (l + 1 == last)
                pass(k.interpolateFirst, {b.tableX, b.tableZ, below.w[0], b.answer}, transfer,
                     everyNode(k.interpolateFirst, l));
            else
                pass(k.interpolate, {b.tableX, b.tableZ, below.answer, b.answer}, transfer,
                     everyNode(k.interpolate, l));
            start(pass, l);
            if (l > 0) steps(pass, l, kNestedSteps, kNestedSweeps, 2, 0);
        }
    }

    CommandList recordCold()
    {
        CommandList list(context);
        Recorder    pass{*this, list};
        beginSolve(list);
        work = 0;
        if (levels.size() == 1) {
            list.fill(levels[0].answer, 0);
            start(pass, 0);
        } else {
            nest(pass);
        }
        coldWork = work;
        finestSteps(list, 2);
        stepWork = (work - coldWork) / kStepsPerList;
        return list;
    }

    CommandList recordWarm()
    {
        CommandList list(context);
        Recorder    pass{*this, list};
        beginSolve(list);
        work = 0;
        start(pass, 0);
        warmWork = work;
        finestSteps(list, 2);
        stepWork = (work - warmWork) / kStepsPerList;
        return list;
    }

    CommandList recordMore()
    {
        CommandList list(context);
        list.timestamp();
        finestSteps(list, 1);
        return list;
    }

    /// Runs the list of this slot, recording it if need be.
    CommandList& run(std::array<std::vector<CommandList>, kSlots>& lists, CommandList (Impl::*record)())
    {
        auto& mine = lists[std::size_t(slot)];
        if (mine.empty()) mine.push_back((this->*record)());
        context.run(mine.front());
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
            hostUnits.as<float>()[n] = float(most / grids.stiffness);
        }
    }

    void uploadRigidity(const NodeField& rigidity)
    {
        plate.rigidity = rigidity;
        if (const auto why = whyUnsolvable(plate)) throw Error("plate: " + *why);
        float* to = hostRigidity.as<float>().data();
        for (std::size_t n = 0; n < plate.grid.nodes(); ++n) to[n] = float(rigidity.values()[n] / unitRigidity);
        const auto [least, most] = std::minmax_element(to, to + plate.grid.nodes());
        constexpr float kLeast = 1e-15F, kMost = 1e15F; // products of three rigidities and more stay finite
        if (!(*least > kLeast && *most < kMost))
            throw Error("plate: the rigidity spans too many orders of magnitude for 32-bit arithmetic: " +
                        formatQuantity(double(*least) * unitRigidity, "N m") + " to " +
                        formatQuantity(double(*most) * unitRigidity, "N m"));
        if (prepareList.empty()) recordPrepare();
        context.run(prepareList.front());
        hostTiles.makeVisibleToHost();
        for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
            // A slope that is smooth on the finest grid may look like a jump on a coarse one: the cycle copes with
            // that.
            const std::uint32_t* found = hostTiles.as<std::uint32_t>().data();
            const std::uint32_t  now   = found[0] > 0 ? found[l] : 0;
            if (now == jumpTiles[l]) continue;
            jumpTiles[l] = now;
            argumentAt.clear(); // of the lists that go
            for (auto* lists : {&coldList, &warmList, &moreList})
                for (auto& recorded : *lists) recorded.clear();
        }
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
        report.device                      = context.device().name;
        report.iterations                  = done;
        report.errorEstimate               = worst(shared::kStateEstimate);
        report.workUnits                   = (warm ? warmWork : coldWork) + done * stepWork;
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
    // down and up on each level but the coarsest: two half sweeps per sweep, twice; residual, restriction, correction
    return int(impl_->levels.size() - 1) * (4 * kSweeps + 3) + 1;
}

int VulkanPlateSolver::levels() const noexcept
{
    return int(impl_->levels.size());
}

} // namespace palp
