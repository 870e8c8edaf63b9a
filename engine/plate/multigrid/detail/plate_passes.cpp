#include "engine/plate/multigrid/detail/plate_passes.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/region_layout.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/compute/context.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

using compute::Binding;
using compute::Buffer;
using compute::CommandList;
using compute::Groups;
using compute::Intent;
using compute::Kernel;

/// Returns the steps on a coarser level of the nested iteration: two on more than the last one change the answer by
/// less than its error.
constexpr int stepsOf(std::size_t level)
{
    return level == 1 ? 2 : 1;
}

constexpr std::uint32_t kMostPartials = 16384; ///< sums that a dot product is split into
constexpr std::uint32_t kTermsPerSum  = 64;    ///< least terms of a sum, unless there are too few partials

/// Eigenvalues that Chebyshev's iteration damps, relative to the divisor. None is larger (see plate_relax.h), and on
/// equal spacings a coarser grid represents those below a sixteenth of the largest: (1 - cos(pi/2))^2 to (2 (1 -
/// cos(pi)))^2. On unequal spacings the range is up to 38 wide, which two steps cannot cover: a wider interval costs
/// one step more.
constexpr double kLargest = 2 / 0.51, kSmallest = kLargest / 16;

std::size_t tilesOf(const shared::PlateLevel& g)
{
    return std::size_t(shared::tilesX(g)) * std::size_t(shared::tilesZ(g));
}

/// A part of a buffer that the host sees.
template <class T>
std::span<T> viewOf(const Binding& part)
{
    return part.buffer->as<T>().subspan(part.offset / sizeof(T), part.bytes / sizeof(T));
}

/// Nodes along each side of the regions of plate_down.comp and plate_up.comp that others own.
int rimOfDown(int sweeps)
{
    return shared::kRimPerSweep * sweeps + shared::kGathered;
}

int rimOfUp(int sweeps)
{
    return shared::kRimPerSweep * sweeps;
}

/// \throws compute::ProcessorOutOfMemory if a dispatch over all rows would have more workgroups than every processor
///         takes: the host has none, and takes over
void checkLength(const compute::Context& context, const PlateKernels::All& k, const RigidityLayout& layout)
{
    constexpr std::uint32_t kMostGroups = 65535; // along y of a dispatch, on every processor
    if (context.processor().kind == compute::ProcessorKind::host) return;
    const auto          rows   = std::uint32_t(layout.levels.front().plate.cellsX + 1);
    const std::uint32_t groups = k.fused ? layout.rows + layout.tileRows : rows;
    if (groups > kMostGroups)
        throw compute::ProcessorOutOfMemory("a plate of " + std::to_string(rows) +
                                            " rows of nodes is longer than the GPU " + context.processor().name +
                                            " takes");
}

std::uint32_t partialsFor(std::size_t nodes)
{
    return std::uint32_t(std::clamp<std::size_t>(nodes / kTermsPerSum, kTermsPerSum, kMostPartials));
}

} // namespace

PlatePasses::PlatePasses(compute::Context& context, const PlateKernels::All& kernels, GridHierarchy grids,
                         std::uint32_t loads)
    : state(context, "state", kernels.realBytes() * shared::kStateWords * loads, Intent::processor), context_(context),
      k(kernels), grids_(std::move(grids)), layout_(rigidityLayout(grids_)), loads_(loads),
      partials_(partialsFor(nodesOf(level(0)))), rigidity_(floats("rigidity", layout_.numbers)),
      divisor_(floats("divisor", layout_.numbers)), marks_(floats("marks", layout_.words)),
      tiles_(floats("tiles", layout_.words)),
      band_(context, "band", kernels.coarseBytes() * bandSize(), Intent::processor),
      factor_(context, "factor", kernels.coarseBytes() * bandSize(), Intent::processor),
      lost_(floats("lost pivots", 1)), sums_(reals("partial sums", 2 * std::size_t(loads_) * partials_)),
      arguments_(context, "groups of dispatches", argumentBytes(), Intent::processor),
      hostArguments_(context, "groups from the host", argumentBytes(), Intent::upload),
      hostTiles_(context, "numbers of tiles for the host", 4 * grids_.levels.size(), Intent::readback)
{
    checkLength(context, k, layout_);
    gradients_ = makeGradients();
    levels     = makeLevels();
    if (k.smoothing.by == Smoother::redBlack) zeroes_.emplace(floats("zeroes", fieldSize(0)));
    std::memset(hostArguments_.mapped(), 0, argumentBytes());
    for (std::size_t l = 0; l < grids_.levels.size(); ++l)
        setGroups(tileArgument(l), {0, 1, loads_}); // enableSteps() copies the number of tiles here
    if (k.fused) {
        tail_.emplace(context, kernels, grids_, loads);
        const auto        count = [](const Groups& groups) { return std::size_t(groups.x) * groups.y; };
        const std::size_t most  = std::max(
             {2 * count(sharedByGroups(0)), 2 * count(regionsOf(0, rimOfUp(2))), count(everyNode(k.fused->probe, 0))});
        groupSums_.emplace(reals("sums of workgroups", most * loads_));
        tickets_.emplace(context, "tickets", 4 * (std::size_t(loads_) + 2), Intent::processor);
        layoutLevels_.emplace(context, "levels of rigidities", sizeof(shared::RigidityLevel) * levels.size(),
                              Intent::processor);
    }
    uploadTables();
}

std::size_t PlatePasses::nodes() const
{
    return nodesOf(level(0));
}

std::size_t PlatePasses::fieldSize(std::size_t l) const
{
    return nodesOf(level(l)) * loads_;
}

std::size_t PlatePasses::bandSize() const
{
    const auto& coarsest = grids_.levels.back().plate;
    return nodesOf(coarsest) * std::size_t(shared::halfBand(coarsest) + 1);
}

Buffer PlatePasses::floats(const std::string& name, std::size_t count) const
{
    return {context_, name, 4 * count, Intent::processor};
}

Buffer PlatePasses::reals(const std::string& name, std::size_t count) const
{
    return {context_, name, k.realBytes() * count, Intent::processor};
}

std::vector<Buffer> PlatePasses::makeGradients() const
{
    std::vector<Buffer> made;
    for (const char* name : {"answer", "left", "direction", "forces"}) made.push_back(reals(name, fieldSize(0)));
    if (k.fused)
        for (const char* name : {"other direction", "other left"}) made.push_back(reals(name, fieldSize(0)));
    return made;
}

std::vector<LevelBuffers> PlatePasses::makeLevels() const
{
    std::vector<LevelBuffers> made;
    for (std::size_t l = 0; l < grids_.levels.size(); ++l) {
        const std::string of    = " of level " + std::to_string(l);
        const std::size_t nodes = nodesOf(level(l)), field = fieldSize(l);
        const auto&       tables = grids_.levels[l];
        const auto&       at     = layout_.levels[l];
        const auto        part   = [](const Buffer& all, int first, std::size_t count) {
            return Binding(all, 4 * std::size_t(first), 4 * count);
        };
        made.push_back({part(rigidity_, at.field, level(l).shapeAt == 0 ? nodes : 2 * nodes),
                        part(divisor_, at.field, nodes),
                        floats("table x" + of, std::max<std::size_t>(1, tables.tableX.size())),
                        floats("table z" + of, std::max<std::size_t>(1, tables.tableZ.size())),
                        floats("force" + of, field),
                        {floats("w0" + of, field), floats("w1" + of, field)},
                        part(marks_, at.list, tilesOf(level(l))),
                        part(tiles_, at.list, 1 + tilesOf(level(l))),
                        floats("load" + of, field),
                        gradients_[l % 2],
                        gradients_[1 - l % 2],
                        gradients_[2],
                        gradients_[3],
                        gradients_[k.fused ? 4 : 2],
                        gradients_[k.fused ? 5 : 1]});
    }
    return made;
}

void PlatePasses::uploadTables()
{
    std::vector<Buffer> staging;
    CommandList         list(context_);
    const auto          upload = [&](const auto& from, const Buffer& to) {
        if (from.empty()) return;
        const std::size_t bytes = sizeof(from[0]) * from.size();
        staging.emplace_back(context_, "table from the host", bytes, Intent::upload);
        std::memcpy(staging.back().mapped(), from.data(), bytes);
        list.copy(staging.back(), to);
    };
    for (std::size_t l = 0; l < levels.size(); ++l) {
        upload(grids_.levels[l].tableX, levels[l].tableX);
        upload(grids_.levels[l].tableZ, levels[l].tableZ);
    }
    if (layoutLevels_) upload(layout_.levels, *layoutLevels_);
    if (zeroes_) list.fill(*zeroes_, 0);
    if (tickets_) list.fill(*tickets_, 0);
    for (const LevelBuffers& b : levels)
        for (const Buffer* w : {&b.w[0], &b.w[1]}) list.fill(*w, 0); // held nodes stay at 0
    list.end();
    context_.run(list);
}

std::size_t PlatePasses::argumentsFor(Groups groups)
{
    const auto [found, isNew] =
        argumentAt_.try_emplace({groups.x, groups.y, groups.z}, kSizeBytes * argumentAt_.size());
    PALP_EXPECT(found->second < kSizeBytes * kSizes, "more sizes of dispatches than were foreseen");
    if (isNew) setGroups(found->second, groups);
    return found->second;
}

void PlatePasses::setGroups(std::size_t offset, Groups groups)
{
    const std::array words{groups.x, groups.y, groups.z};
    std::memcpy(static_cast<char*>(hostArguments_.mapped()) + offset, words.data(), kSizeBytes);
}

Groups PlatePasses::everyNode(const Kernel& kernel, std::size_t l) const
{
    return kernel.groupsOver(std::uint32_t(level(l).cellsZ + 1), std::uint32_t(level(l).cellsX + 1), loads_);
}

// Returns the workgroups that share the nodes of a load for a sum, each invocation several of them.
Groups PlatePasses::sharedByGroups(std::size_t l) const
{
    constexpr std::uint32_t kTerms =
        8; // of an invocation: fewer leave more workgroups to wait for, more leave lanes idle
    return {k.fused->aim.groupsOver((std::uint32_t(nodesOf(level(l))) + kTerms - 1) / kTerms).x, 1, loads_};
}

Groups PlatePasses::everySecondNode(const Kernel& kernel, std::size_t l) const
{
    return kernel.groupsOver(std::uint32_t(level(l).cellsZ / 2 + 1), std::uint32_t(level(l).cellsX + 1), loads_);
}

Groups PlatePasses::inOrder(const Kernel& kernel, std::size_t l) const
{
    return kernel.groupsOver(std::uint32_t(nodesOf(level(l))), 1, loads_);
}

void PlatePasses::countWork(std::size_t l, double applications)
{
    work.nodes += applications * double(nodesOf(level(l)));
}

// Sweeps from w[at] in both colours, beginning with `first`; returns which w holds the result.
int PlatePasses::sweepBothColours(Recorder& pass, std::size_t l, int at, std::uint32_t first, bool fromZero)
{
    const LevelBuffers& b = levels[l];
    for (std::uint32_t n = 0; n < 2; ++n) {
        const shared::RelaxPush push{level(l), n == 0 ? first : 1 - first};
        const Buffer&           old = fromZero ? *zeroes_ : b.w[at];
        if (fromZero && n == 0)
            pass(k.relaxFirst, {b.divisor, b.force, b.w[1 - at]}, push, everySecondNode(k.relaxFirst, l));
        else
            pass(k.relax, {b.rigidity, b.divisor, b.force, old, n == 0 ? old : b.w[1 - at], b.w[1 - at]}, push,
                 everySecondNode(k.relax, l));
        if (!fromZero || n > 0) countWork(l, 0.5);
    }
    return 1 - at;
}

// Makes `sweeps` sweeps in red and black or steps of Chebyshev's iteration from zero; returns which w holds the result.
int PlatePasses::smoothFromZero(Recorder& pass, std::size_t l, int sweeps)
{
    const LevelBuffers& b  = levels[l];
    int                 at = 0;
    if (tail_) return sweepRegions(pass, l, at, sweeps, 0, Swept::allFromZero);
    if (k.smoothing.by == Smoother::redBlack) {
        for (int n = 0; n < sweeps; ++n) at = sweepBothColours(pass, l, at, 0, n == 0);
        return at;
    }
    const auto steps = chebyshevSteps(sweeps, kSmallest, kLargest);
    at               = 1;
    pass(k.smoothFirst, {b.divisor, b.force, b.w[0], b.w[1]}, shared::SmoothPush{level(l), 0, steps.front().step},
         everyNode(k.smoothFirst, l));
    for (std::size_t n = 1; n < steps.size(); ++n) at = takeChebyshevStep(pass, l, at, steps[n]);
    return at;
}

// Makes the same sweeps from w[at] in the reverse order.
int PlatePasses::smoothInReverse(Recorder& pass, std::size_t l, int at, int sweeps)
{
    if (tail_) return sweepRegions(pass, l, at, sweeps, 1, Swept::all);
    if (k.smoothing.by == Smoother::redBlack)
        for (int n = 0; n < sweeps; ++n) at = sweepBothColours(pass, l, at, 1, false);
    else
        for (const ChebyshevStep& one : chebyshevSteps(sweeps, kSmallest, kLargest))
            at = takeChebyshevStep(pass, l, at, one);
    return at;
}

// Takes a step of Chebyshev's iteration from w[at]; returns which w holds the result.
int PlatePasses::takeChebyshevStep(Recorder& pass, std::size_t l, int at, const ChebyshevStep& how)
{
    const LevelBuffers& b = levels[l];
    pass(k.smooth, {b.rigidity, b.divisor, b.force, b.w[at], b.w[1 - at]},
         shared::SmoothPush{level(l), how.ahead, how.step}, everyNode(k.smooth, l));
    countWork(l, 1);
    return 1 - at;
}

// Makes `sweeps` sweeps in one dispatch, from w[at] or from zero; returns which w holds the result.
int PlatePasses::sweepRegions(Recorder& pass, std::size_t l, int at, int sweeps, std::uint32_t first, Swept what)
{
    const LevelBuffers& b = levels[l];
    pass(k.fused->sweep[std::size_t(sweeps - 1)],
         {b.rigidity, b.divisor, b.force, b.marks, what == Swept::allFromZero ? *zeroes_ : b.w[at], b.w[1 - at]},
         shared::SweepPush{level(l), first, what == Swept::tiles ? 1U : 0U}, regionsOf(l, rimOfUp(sweeps)));
    if (what != Swept::tiles) countWork(l, sweeps);
    return 1 - at;
}

// Makes extra sweeps of w[at] in the tiles where the rigidity jumps; returns which w holds the result. The residual's
// memory is free while they run.
int PlatePasses::sweepTiles(Recorder& pass, std::size_t l, int at, std::uint32_t first)
{
    constexpr int kTogether = 2; // of a dispatch where passes are fused
    const int     sweeps    = jumps_ == Jumps::some     ? k.smoothing.tiles
                              : jumps_ == Jumps::strong ? k.smoothing.strongTiles
                                                        : 0;
    if (sweeps == 0) return at;
    work.tileSweeps.resize(levels.size());
    work.tileSweeps[l] += sweeps;
    if (tail_) {
        for (int n = 0; n < sweeps; n += kTogether) at = sweepRegions(pass, l, at, kTogether, first, Swept::tiles);
        return at;
    }
    const LevelBuffers& b = levels[l];
    for (int n = 0; n < sweeps; ++n)
        for (std::uint32_t colour : {first, 1 - first}) {
            const shared::RelaxPush push{level(l), colour};
            pass.list.dispatchIndirect(k.relaxTile, {b.rigidity, b.divisor, b.force, b.w[at], b.tiles, b.residual()},
                                       push, arguments_, tileArgument(l));
            pass.list.dispatchIndirect(k.copyTile, {b.tiles, b.residual(), b.w[at]}, push, arguments_, tileArgument(l));
        }
    return at;
}

// Sets w[at] to the exact answer on the rim, with all other nodes at 0.
void PlatePasses::solveFirstRim(Recorder& pass, std::size_t l, int at)
{
    const LevelBuffers& b = levels[l];
    pass(k.rims->first, {rimViews_[l], b.force, b.w[at]}, shared::LevelPush{level(l)}, {1, 1, loads_});
}

// Corrects w[at] on the rim so that no residual is left there.
void PlatePasses::solveLastRim(Recorder& pass, std::size_t l, int at)
{
    const LevelBuffers& b = levels[l];
    pass(k.rims->last, {rimViews_[l], b.rigidity, b.force, b.w[at], b.residual()}, shared::LevelPush{level(l)},
         {1, 1, loads_});
    work.tileSweeps.resize(levels.size());
    work.tileSweeps[l] += 1;
}

// Makes the first half of a level's smoothing, from zero; returns which w holds the result.
int PlatePasses::smoothFirst(Recorder& pass, std::size_t l, int sweeps, bool rimIsSolved)
{
    if (jumps_ == Jumps::rims && !rimIsSolved) {
        solveFirstRim(pass, l, 0);
        return smoothInReverse(pass, l, 0, sweeps);
    }
    return sweepTiles(pass, l, smoothFromZero(pass, l, sweeps), 0);
}

// Runs one symmetric cycle for the forces of level l; returns which of its w holds the answer.
//
// Rims are solved for at the very beginning and end of a level, outside of the other smoothing. The first of these
// leaves everything at 0 if there are no forces on the rim of the finest level. So it is with conjugate gradients on
// that level once an answer has been corrected there: every direction comes from a cycle whose end left no residual on
// the rim.
int PlatePasses::runCycle(Recorder& pass, std::size_t l, int sweeps, bool rimIsSolved)
{
    if (isFused()) return runFusedCycle(pass, l, sweeps);
    const LevelBuffers& b = levels[l];
    if (l + 1 == levels.size()) {
        pass(k.coarseSolve, {factor_, b.force, b.w[0]}, shared::LevelPush{level(l)}, {1, 1, loads_});
        return 0;
    }
    int                        at    = smoothFirst(pass, l, sweeps, rimIsSolved);
    const LevelBuffers&        below = levels[l + 1];
    const shared::TransferPush transfer{level(l), level(l + 1)};
    pass(k.residual, {b.rigidity, b.force, b.w[at], b.residual()}, shared::LevelPush{level(l)},
         everyNode(k.residual, l));
    countWork(l, 1);
    pass(k.restrict, {b.tableX, b.tableZ, b.residual(), below.force}, transfer, everyNode(k.restrict, l + 1));
    const int from = runCycle(pass, l + 1, sweeps);
    pass(k.correct, {b.tableX, b.tableZ, below.w[from], b.w[1 - at], b.w[at]}, transfer, everyNode(k.correct, l));
    at = sweepTiles(pass, l, 1 - at, 1);
    at = smoothInReverse(pass, l, at, sweeps);
    if (jumps_ == Jumps::rims) solveLastRim(pass, l, at);
    return at;
}

// Returns a workgroup for each region of level l, see plate_region.glsl.
Groups PlatePasses::regionsOf(std::size_t l, int rim) const
{
    const auto owned = std::uint32_t(shared::kRegion - 2 * rim);
    return {std::uint32_t(level(l).cellsZ) / owned + 1, std::uint32_t(level(l).cellsX) / owned + 1, loads_};
}

// Goes down from level l. From the second step of conjugate gradients on it takes the last step on its way.
void PlatePasses::goDown(Recorder& pass, std::size_t l, int sweeps, int step)
{
    const LevelBuffers&        b      = levels[l];
    const Buffer&              below  = levels[l + 1].force;
    const auto                 kernel = std::size_t(sweeps - 1);
    const shared::TransferPush transfer{level(l), level(l + 1)};
    const Groups               groups = regionsOf(l, rimOfDown(sweeps));
    countWork(l, sweeps);
    if (step == 1)
        return pass(k.fused->down[kernel], {b.rigidity, b.divisor, b.tableX, b.tableZ, b.w[0], below, b.force},
                    transfer, groups);
    const bool odd = step % 2 == 1;
    pass(k.fused->downUpdating[kernel],
         {b.rigidity, b.divisor, b.tableX, b.tableZ, b.w[0], below, b.force, state, directionOf(l, step - 1), b.forces,
          odd ? b.otherLeft : b.left, odd ? b.left : b.otherLeft, b.answer},
         transfer, groups);
}

// Runs the same cycle in fewer dispatches.
int PlatePasses::runFusedCycle(Recorder& pass, std::size_t l, int sweeps)
{
    const LevelBuffers& b = levels[l];
    if (tail_->holds(l)) {
        solveTail(pass, l, sweeps, b.force);
        return 0;
    }
    goDown(pass, l, sweeps);
    const int from = runFusedCycle(pass, l + 1, sweeps);
    pass(k.fused->up[std::size_t(sweeps - 1)],
         {b.rigidity, b.divisor, b.tableX, b.tableZ, b.force, levels[l + 1].w[from], b.w[0], b.w[1]},
         shared::TransferPush{level(l), level(l + 1)}, regionsOf(l, rimOfUp(sweeps)));
    countWork(l, sweeps + 1);
    return 1;
}

// Runs a cycle from level l down in one workgroup, the answer to w[0].
void PlatePasses::solveTail(Recorder& pass, std::size_t l, int sweeps, const Buffer& force)
{
    pass(k.fused->tail[std::size_t(sweeps - 1)],
         tail_->bindings({rigidity_, levels[tail_->first()].rigidity.offset},
                         {divisor_, levels[tail_->first()].divisor.offset}, force, levels[l].w[0]),
         tail_->pushFrom(l), tail_->groups());
    for (std::size_t n = l; n + 1 < levels.size(); ++n) countWork(n, 2 * sweeps + 1);
}

void PlatePasses::computeResidual(Recorder& pass, std::size_t l)
{
    const LevelBuffers& b = levels[l];
    pass(k.start, {b.rigidity, b.load, b.answer, b.left, b.force}, shared::LevelPush{level(l)}, everyNode(k.start, l));
    countWork(l, 1);
}

void PlatePasses::takeGradientSteps(Recorder& pass, std::size_t l, int count, int sweeps, std::uint32_t begins,
                                    double tolerance)
{
    if (isFused()) return takeFusedSteps(pass, l, count, sweeps, begins, tolerance);
    const LevelBuffers& b = levels[l];
    for (int n = 1; n <= count; ++n) {
        const auto               nodes = std::uint32_t(nodesOf(level(l)));
        const shared::VectorPush vector{nodes, partials_, std::uint32_t(n)};
        // A first step has no step before it to be judged by, which is not enough where the rigidity jumps.
        const bool                judged = n > 1 || begins != 2 || jumps_ == Jumps::none;
        const shared::ScalarsPush scalars{loads_, partials_, n == 1 ? begins : 0, std::uint32_t(argumentBytes() / 4),
                                          judged ? float(tolerance) : 0.0F};
        const int                 before = pass.list.dispatches();
        const Buffer&             z      = b.w[runCycle(pass, l, sweeps, l == 0)];
        if (l == 0) dispatchesPerCycle_ = pass.list.dispatches() - before;
        pass(k.dots, {b.left, z, b.answer, b.load, sums_}, vector, k.dots.groupsOver(partials_, 1, loads_));
        pass(k.beta, {sums_, state}, scalars, {1, 1, 1});
        pass(k.direction, {state, z, b.direction}, vector, inOrder(k.direction, l));
        pass(k.apply, {b.rigidity, b.direction, b.forces}, shared::LevelPush{level(l)}, everyNode(k.apply, l));
        countWork(l, 1);
        pass(k.stepDots, {b.direction, b.forces, sums_}, vector, k.stepDots.groupsOver(partials_, 1, loads_));
        pass(k.step, {sums_, state, arguments_}, scalars, {1, 1, 1});
        // Not stoppable: the step that finds the estimate small enough must still be taken. The kernel reads the count.
        pass.list.dispatch(k.update, {state, b.direction, b.forces, b.answer, b.left, b.force}, vector,
                           inOrder(k.update, l));
    }
}

// Takes the same steps in fewer dispatches. Every second direction, and where regions take steps every second residual,
// lies in a memory of its own; a list ends with those that the next one begins with in the first memory. Of the tail's
// steps that is so if their number is even, or one.
void PlatePasses::takeFusedSteps(Recorder& pass, std::size_t l, int count, int sweeps, std::uint32_t begins,
                                 double tolerance)
{
    const LevelBuffers& b         = levels[l];
    const bool          byRegions = !tail_->holds(l);
    const auto          nodes     = std::uint32_t(nodesOf(level(l)));
    for (int n = 1; n <= count; ++n) {
        const std::uint32_t anew   = n == 1 ? begins : 0;
        const int           before = pass.list.dispatches();
        if (byRegions)
            takeRegionStep(pass, l, sweeps, n, anew, float(tolerance));
        else
            takeTailStep(pass, l, sweeps, n, anew, float(tolerance));
        constexpr int kBeside[] = {2, 1}; // dispatches that are not of the cycle
        if (l == 0) dispatchesPerCycle_ = pass.list.dispatches() - before - kBeside[byRegions];
        // Not stoppable, as in takeGradientSteps().
        if (!byRegions && count > 1)
            pass.list.dispatch(k.update, {state, directionOf(l, n), b.forces, b.answer, b.left, b.force},
                               shared::VectorPush{nodes, partials_, std::uint32_t(n)}, inOrder(k.update, l));
    }
    if (byRegions || count == 1) // the last step was not taken by the next one's way down
        pass.list.dispatch(k.fused->finish,
                           {state, b.direction, b.otherDirection, b.forces, b.answer, b.left,
                            byRegions ? b.otherLeft : b.left, b.force},
                           shared::VectorPush{nodes, partials_, 0}, inOrder(k.fused->finish, l));
}

// Takes a step, but for its update, on a level whose cycle is one workgroup's.
void PlatePasses::takeTailStep(Recorder& pass, std::size_t l, int sweeps, int step, std::uint32_t begins,
                               float tolerance)
{
    const LevelBuffers& b = levels[l];
    solveTail(pass, l, sweeps, b.force);
    pass(k.fused->aim, {b.left, b.w[0], b.answer, b.load, *groupSums_, *tickets_, state},
         shared::AimPush{std::uint32_t(nodesOf(level(l))), begins}, sharedByGroups(l));
    probe(pass, l, b.w[0], step, tolerance);
}

// Takes a step on a larger level: its update on the way down, its dot products on the way up.
void PlatePasses::takeRegionStep(Recorder& pass, std::size_t l, int sweeps, int step, std::uint32_t begins,
                                 float tolerance)
{
    const LevelBuffers& b = levels[l];
    goDown(pass, l, sweeps, step);
    const int from = runFusedCycle(pass, l + 1, sweeps);
    pass(k.fused->upAiming[std::size_t(sweeps - 1)],
         {b.rigidity, b.divisor, b.tableX, b.tableZ, b.force, levels[l + 1].w[from], b.w[0], b.w[1],
          step % 2 == 1 ? b.left : b.otherLeft, b.answer, b.load, *groupSums_, *tickets_, state},
         shared::UpPush{level(l), level(l + 1), begins}, regionsOf(l, rimOfUp(sweeps)));
    countWork(l, sweeps + 1);
    probe(pass, l, b.w[1], step, tolerance);
}

// Returns the memory of the direction that a step of a list takes.
const Buffer& PlatePasses::directionOf(std::size_t l, int step) const
{
    return step % 2 == 1 ? levels[l].otherDirection : levels[l].direction;
}

// Finds a step's direction, its forces, and how far to go along it.
void PlatePasses::probe(Recorder& pass, std::size_t l, const Buffer& z, int step, float tolerance)
{
    const LevelBuffers& b = levels[l];
    pass(k.fused->probe,
         {b.rigidity, z, directionOf(l, step - 1), directionOf(l, step), b.forces, *groupSums_, *tickets_, state,
          arguments_},
         shared::ProbePush{level(l), loads_, std::uint32_t(argumentBytes() / 4), tolerance},
         everyNode(k.fused->probe, l));
    countWork(l, 1);
}

void PlatePasses::prepareRigidity(Recorder& pass)
{
    if (tail_) {
        prepareFused(pass);
        return;
    }
    for (std::size_t l = 0; l + 1 < levels.size(); ++l)
        pass(k.coarsen, {levels[l].rigidity, levels[l + 1].rigidity}, shared::TransferPush{level(l), level(l + 1)},
             k.coarsen.groupsOver(std::uint32_t(level(l + 1).cellsZ + 1), std::uint32_t(level(l + 1).cellsX + 1)));
    for (std::size_t l = 0; l + 1 < levels.size(); ++l)
        pass(k.divisor, {levels[l].rigidity, levels[l].divisor}, shared::LevelPush{level(l)},
             k.divisor.groupsOver(std::uint32_t(level(l).cellsZ + 1), std::uint32_t(level(l).cellsX + 1),
                                  std::uint32_t(shared::kEntries)));
    for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
        const LevelBuffers&     b = levels[l];
        const shared::LevelPush push{level(l)};
        pass(k.jumpMark, {b.rigidity, b.marks}, push,
             k.jumpMark.groupsOver(std::uint32_t(shared::tilesZ(level(l))), std::uint32_t(shared::tilesX(level(l)))));
        pass(k.jumpList, {b.marks, b.tiles}, push, {1, 1, 1});
        pass.list.copy(tiles_, b.tiles.offset, hostTiles_, 4 * l, 4);
    }
    const shared::LevelPush coarsest{level(levels.size() - 1)};
    pass(k.assemble, {levels.back().rigidity, band_}, coarsest,
         k.assemble.groupsOver(std::uint32_t(shared::halfBand(coarsest.level) + 1),
                               std::uint32_t(nodesOf(coarsest.level))));
    pass(k.factor, {band_, factor_, lost_}, coarsest, {1, 1, 1});
    pass.list.copy(lost_, 0, hostTiles_, 4 * (levels.size() - 1), 4); // the coarsest level has no tiles
}

// Prepares the same in at most four dispatches. What the host reads is written where it reads it.
void PlatePasses::prepareFused(Recorder& pass)
{
    const std::size_t          last = levels.size() - 1;
    const shared::RigidityPush push{std::uint32_t(levels.size()), layout_.rows};
    if (last > 0) {
        const shared::PlateLevel& made   = level(std::min(last, std::size_t(shared::kDeep)));
        const auto                groups = [](int cells) { return std::uint32_t(cells / shared::kOwnNodes + 1); };
        pass(k.fused->coarsenLevels, {*layoutLevels_, levels[0].rigidity, rigidity_, *tickets_}, push,
             {groups(made.cellsZ), groups(made.cellsX), 1});
        const std::uint32_t across =
            k.fused->divisorLevels.groupsOver(std::uint32_t(level(0).cellsZ + 1), 1, std::uint32_t(shared::kEntries)).x;
        pass(k.fused->divisorLevels, {*layoutLevels_, rigidity_, divisor_, marks_}, push,
             {across, layout_.rows + layout_.tileRows, 1});
    }
    pass(k.fused->prepareEnd, {*layoutLevels_, rigidity_, marks_, tiles_, band_, factor_, hostTiles_}, push,
         {std::uint32_t(levels.size()), 1, 1});
    tail_->invertFactor(pass.list, factor_);
}

void PlatePasses::enableSteps(CommandList& list) const
{
    list.copy(hostArguments_, arguments_);
    if (jumps_ == Jumps::none) return;
    for (std::size_t l = 0; l + 1 < levels.size(); ++l)
        list.copy(tiles_, levels[l].tiles.offset, arguments_, tileArgument(l), 4);
}

// Computes an answer on a coarse level for its load; returns that level.
std::size_t PlatePasses::beginNested(Recorder& pass)
{
    const std::size_t last = levels.size() - 1;
    const std::size_t top  = isFused() ? std::max<std::size_t>(tail_->first(), 1) : last;
    for (std::size_t l = 0; l < top; ++l)
        pass(k.restrict, {levels[l].tableX, levels[l].tableZ, levels[l].load, levels[l + 1].load},
             shared::TransferPush{level(l), level(l + 1)}, everyNode(k.restrict, l + 1));
    if (!isFused()) {
        pass(k.coarseSolve, {factor_, levels[last].load, levels[last].w[0]}, shared::LevelPush{level(last)},
             {1, 1, loads_});
        return last;
    }
    pass(k.fused->nested,
         tail_->nestedBindings({rigidity_, levels[tail_->first()].rigidity.offset},
                               {divisor_, levels[tail_->first()].divisor.offset}, levels[top].load, levels[top].w[0]),
         tail_->nestedPush(top, stepsOf(top)), tail_->groups());
    for (std::size_t l = top; l < last; ++l) countWork(l, 1 + stepsOf(l) * (2 + 2 * k.smoothing.nested));
    return top;
}

void PlatePasses::iterateNested(Recorder& pass)
{
    const std::size_t top = beginNested(pass);
    for (std::size_t l = top; l-- > 0;) {
        const shared::TransferPush transfer{level(l), level(l + 1)};
        const LevelBuffers &       b = levels[l], &below = levels[l + 1];
        if (l + 1 == top)
            pass(k.interpolateFirst, {b.tableX, b.tableZ, below.w[0], b.answer}, transfer,
                 everyNode(k.interpolateFirst, l));
        else
            pass(k.interpolate, {b.tableX, b.tableZ, below.answer, b.answer}, transfer, everyNode(k.interpolate, l));
        computeResidual(pass, l);
        if (l == 0 && jumps_ == Jumps::rims) {
            pass(k.rims->start, {rimViews_[0], b.left, b.answer}, shared::LevelPush{level(0)}, {1, 1, loads_});
            computeResidual(pass, 0);
        }
        if (l > 0) takeGradientSteps(pass, l, stepsOf(l), k.smoothing.nested, 2, 0);
    }
}

void PlatePasses::Recorder::operator()(const Kernel& kernel, const compute::Bindings& bindings,
                                       const compute::Push& push, Groups groups)
{
    if (stoppable)
        list.dispatchIndirect(kernel, bindings, push, passes.arguments_, passes.argumentsFor(groups));
    else
        list.dispatch(kernel, bindings, push, groups);
}

bool PlatePasses::factorRims(bool inDoubles, double workPerNode)
{
    const std::size_t last = levels.size() - 1;
    for (std::size_t l = rims_.size(); l < last; ++l) {
        rims_.emplace_back();
        rimViews_.emplace_back(context_, "rim of level " + std::to_string(l), sizeof(RimView), Intent::processor);
    }
    double left = workPerNode * double(nodes());
    for (std::size_t l = 0; l < last; ++l) {
        if (!rims_[l].divide(level(l), viewOf<float>(levels[l].rigidity), viewOf<std::uint32_t>(levels[l].tiles).data(),
                             left))
            return false;
        left -= rims_[l].work();
    }
    for (std::size_t l = 0; l < last; ++l) {
        const shared::LevelPush push{level(l)};
        std::uint32_t           lost = 1;
        for (const bool doubles : {inDoubles, true}) {
            RimView              view = rims_[l].prepare(doubles);
            std::array<void*, 3> buffers{&view, viewOf<float>(levels[l].rigidity).data(), &lost};
            k.rims->factor({buffers.data(), &push, nullptr, {}, {}});
            std::memcpy(rimViews_[l].mapped(), &view, sizeof view);
            if (lost == 0) break;
        }
        if (lost > 0) return false;
    }
    return true;
}

bool PlatePasses::foundJumps() const
{
    hostTiles_.makeVisibleToHost();
    return levels.size() > 1 && hostTiles_.as<std::uint32_t>()[0] > 0;
}

bool PlatePasses::isTooSoft() const
{
    hostTiles_.makeVisibleToHost();
    return hostTiles_.as<std::uint32_t>()[levels.size() - 1] > 0;
}

double PlatePasses::workUnits(const PlateWork& of) const
{
    double nodes = of.nodes;
    hostTiles_.makeVisibleToHost();
    for (std::size_t l = 0; l + 1 < of.tileSweeps.size(); ++l)
        nodes += double(of.tileSweeps[l]) * hostTiles_.as<std::uint32_t>()[l] * shared::kTile * shared::kTile;
    return nodes / double(nodesOf(level(0)));
}

} // namespace palp
