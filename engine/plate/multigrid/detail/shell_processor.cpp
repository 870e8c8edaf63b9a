#include "engine/plate/multigrid/detail/shell_processor.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "compute_shaders/plate_kernels.spv.h"
#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/plate/multigrid/detail/shell_host.h"

namespace palp {

using compute::Buffer;
using compute::CommandList;
using compute::Intent;
using compute::Kernel;
using shared::ShellPassPush;
using shared::ShellVectorPush;

namespace {

/// Shapes of workgroups by their names in shell_passes.def, as those of plates are.
struct Shapes {
    compute::Workgroup tile, line, alone, reduce, row, level;
};

constexpr std::uint32_t kMostOfLevel = 512; // invocations over a small level: up to three nodes each
/// Nodes of a level that one workgroup takes for each load, with less waiting than a dispatch for each pass has.
constexpr std::size_t kFewNodes = 33 * 33;

Shapes shapesFor(const compute::Context& context)
{
    if (context.processor().kind == compute::ProcessorKind::software)
        return {{8, 8, 1}, {128, 1, 1}, {8, 1, 1}, {64, 1, 1}, {8, 1, 1}, {8, 1, 1}};
    const std::uint32_t most = std::min(std::uint32_t(context.limits().invocations), kMostOfLevel);
    return {{32, 4, 1}, {128, 1, 1}, {64, 1, 1}, {256, 1, 1}, {64, 1, 1}, {most, 1, 1}};
}

ShellPassPush passOf(const ShellLayout& layout)
{
    return {layout, {}, 0, 0};
}

bool isSmall(const ShellLayout& layout)
{
    return std::size_t(layout.cellsX + 1) * std::size_t(layout.cellsZ + 1) <= kFewNodes;
}

ShellPassPush transferBetween(const ShellLayout& fine, const ShellLayout& coarse, bool fromZero)
{
    return {fine, coarse, 0, fromZero ? 1U : 0U};
}

} // namespace

bool ShellKernels::suit(const compute::Context& context) noexcept
{
    const bool isVulkan = context.processor().kind != compute::ProcessorKind::host;
    return isVulkan && context.processor().float64 && context.limits().invocations >= shapesFor(context).reduce.x &&
           context.limits().sharedMemory >=
               sizeof(double) * (shared::kMostShellUnknowns + shared::kShellTogether + shared::kShellLanes);
}

ShellKernels::ShellKernels(compute::Context& context, CoarsestShell coarsest)
{
    PALP_EXPECT(suit(context), "kernels of shells need Vulkan and doubles");
    const Shapes shapes = shapesFor(context);
    using enum CoarsestShell;
    const bool isHardware = context.processor().kind != compute::ProcessorKind::software;
    all_.reset(new All{
        .invertsCoarsest = coarsest == byInverse || (coarsest == automatic && isHardware),
#define PALPATE_PASS(name, spirv, source, define, Push, buffers, shape)                                                \
    .name = Kernel(context, {#spirv, spirv##_spv, buffers, int(sizeof(shared::Push)), nullptr}, shapes.shape),
#include "compute_shaders/shared/shell_passes.def"
    });
}

ShellKernels::~ShellKernels()                                  = default;
ShellKernels::ShellKernels(ShellKernels&&) noexcept            = default;
ShellKernels& ShellKernels::operator=(ShellKernels&&) noexcept = default;

ProcessorShellFields::ProcessorShellFields(compute::Context& context, const ShellKernels::All& kernels,
                                           const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse,
                                           std::size_t loads)
    : context_(context), k(kernels), source_(levels),
      loads_(loads), band_{std::uint32_t(coarse.places().size()), std::uint32_t(coarse.halfBand()),
                           std::uint32_t(numbersOf(levels.back().layout))},
      levels_([&] {
          std::vector<Level> made;
          for (const ShellLevel& level : levels) made.push_back(makeLevel(level));
          return made;
      }()),
      exact_(memory("exact coefficients", sizeof(double) * levels.front().exact.size())),
      factors_(memory("factors", sizeof(double) * coarse.factors().size())),
      places_(memory("places", sizeof(std::int32_t) * std::max<std::size_t>(1, coarse.places().size()))),
      inverse_(k.invertsCoarsest && band_.unknowns > 0
                   ? std::optional(memory("inverse of the coarsest level",
                                          sizeof(double) * std::size_t(band_.unknowns) * band_.unknowns))
                   : std::nullopt),
      right_(memory("right side", sizeof(double) * loads * numbers())),
      left_(memory("left", sizeof(double) * loads * numbers())),
      direction_(memory("direction", sizeof(double) * loads * numbers())),
      product_(memory("product", sizeof(double) * loads * numbers())),
      answer_(memory("answer", sizeof(double) * loads * numbers())),
      rightInFloats_(memory("right side in floats", sizeof(float) * loads * numbers())),
      leftInFloats_(memory("left in floats", sizeof(float) * loads * numbers())), staging_([&] {
          std::size_t bytes = 0;
          eachUpload(coarse, [&](const Buffer&, const void*, std::size_t count) { bytes += count; });
          return memory("coefficients from the host", bytes, Intent::upload);
      }()),
      givenRight_(memory("right side from the host", sizeof(double) * loads * numbers(), Intent::upload)),
      givenFloats_(memory("the same in floats", sizeof(float) * loads * numbers(), Intent::upload)),
      turns_(memory("turns", 2 * sizeof(double) * loads, Intent::upload)),
      lengths_(memory("lengths", sizeof(double) * loads, Intent::upload)),
      sums_(memory("sums", sizeof(double) * kSums * loads, Intent::readback)),
      read_(memory("answer for the host", sizeof(double) * loads * numbers(), Intent::readback)), send_(context),
      begin_(context), aim_(context), again_(context), go_(context), finish_(context), fetch_(context)
{
    PALP_EXPECT(band_.unknowns + band_.halfBand < shared::kMostShellUnknowns, "the coarsest level is too large");
    std::size_t offset = 0;
    eachUpload(coarse, [&](const Buffer& to, const void*, std::size_t count) {
        send_.copy(staging_, offset, to, 0, count);
        offset += count;
    });
    if (inverse_) send_.dispatch(k.invert, {factors_, *inverse_}, band_, {1, 1, band_.unknowns});
    send_.end();
    empty();
    record();
}

Buffer ProcessorShellFields::memory(const char* name, std::size_t bytes, Intent intent) const
{
    return {context_, std::string(name) + " of a shell", bytes, intent};
}

ProcessorShellFields::Level ProcessorShellFields::makeLevel(const ShellLevel& level) const
{
    const std::size_t field = sizeof(float) * loads_ * numbersOf(level.layout);
    const auto        table = [&](std::size_t n) {
        return memory("table", sizeof(float) * std::max<std::size_t>(1, level.tables[n].size()));
    };
    return {level.layout,
            memory("entries", sizeof(float) * level.entries.size()),
            {table(0), table(1), table(2), table(3)},
            memory("before", field),
            memory("x", field),
            memory("b", field),
            memory("r", field),
            memory("right", field),
            memory("guess", field)};
}

/// Calls visit(buffer, memory, bytes) for all that belongs to a shell.
template <class Visit>
void ProcessorShellFields::eachUpload(const ShellCoarseSolver& coarse, const Visit& visit) const
{
    for (std::size_t n = 0; n < levels_.size(); ++n) {
        visit(levels_[n].entries, source_[n].entries.data(), sizeof(float) * source_[n].entries.size());
        for (std::size_t m = 0; m < levels_[n].tables.size(); ++m)
            if (const auto& table = source_[n].tables[m]; !table.empty())
                visit(levels_[n].tables[m], table.data(), sizeof(float) * table.size());
    }
    visit(exact_, source_.front().exact.data(), sizeof(double) * source_.front().exact.size());
    visit(factors_, coarse.factors().data(), sizeof(double) * coarse.factors().size());
    const std::vector<std::int32_t> places(coarse.places().begin(), coarse.places().end());
    if (!places.empty()) visit(places_, places.data(), sizeof(std::int32_t) * places.size());
}

void ProcessorShellFields::setLevels(const ShellCoarseSolver& coarse)
{
    PALP_EXPECT(band_.unknowns == coarse.places().size() && band_.halfBand == unsigned(coarse.halfBand()),
                "another coarsest level than the memory is for");
    auto* to = static_cast<std::byte*>(staging_.mapped());
    eachUpload(coarse, [&](const Buffer&, const void* from, std::size_t bytes) {
        std::memcpy(to, from, bytes);
        to += bytes;
    });
    context_.run(send_);
}

/// Empty places of fields are 0, and no kernel writes there.
void ProcessorShellFields::empty()
{
    CommandList list(context_);
    for (const Level& level : levels_)
        for (const Buffer* field : {&level.before, &level.x, &level.b, &level.r, &level.right, &level.guess})
            list.fill(*field, 0);
    for (const Buffer* field : {&left_, &direction_, &product_, &answer_}) list.fill(*field, 0);
    list.end();
    context_.run(list);
}

void ProcessorShellFields::record()
{
    begin_.copy(givenRight_, right_);
    begin_.copy(givenFloats_, rightInFloats_);
    start(begin_);
    turnAndApply(begin_, levels_.front().guess);
    begin_.fill(answer_, 0);
    begin_.copy(right_, left_);
    goAlong(begin_);
    begin_.end();

    turnAndApply(aim_, levels_.front().x);
    dots(aim_, k.dots, direction_, product_, kPq);
    aim_.end();

    turnAndApply(again_, levels_.front().x);
    again_.end();

    goAlong(go_);
    go_.end();

    advance(finish_);
    finish_.end();

    fetch_.copy(answer_, read_);
    fetch_.end();
}

void ProcessorShellFields::nodes(CommandList& list, const Kernel& kernel, const compute::Bindings& bindings,
                                 std::size_t level, const ShellPassPush& push) const
{
    const ShellLayout& l = levels_[level].layout;
    list.dispatch(kernel, bindings, push,
                  kernel.groupsOver(std::uint32_t(2 * l.span), std::uint32_t(l.cellsX + 1), std::uint32_t(loads_)));
}

void ProcessorShellFields::vectors(CommandList& list, const Kernel& kernel, const compute::Bindings& bindings,
                                   std::size_t level) const
{
    const auto count = std::uint32_t(numbersOf(levels_[level].layout));
    list.dispatch(kernel, bindings, ShellVectorPush{count, std::uint32_t(loads_), 0},
                  kernel.groupsOver(count, 1, std::uint32_t(loads_)));
}

void ProcessorShellFields::dots(CommandList& list, const Kernel& kernel, const Buffer& a, const Buffer& b,
                                Sum slot) const
{
    list.dispatch(kernel, {a, b, sums_},
                  ShellVectorPush{std::uint32_t(numbers()), std::uint32_t(loads_), std::uint32_t(slot)},
                  {1, 1, std::uint32_t(loads_)});
}

/// Two sweeps in both colours, from x, or from nothing, to x.
void ProcessorShellFields::relax(CommandList& list, std::size_t level, const Buffer& b, int firstColour,
                                 bool fromZero) const
{
    const Level&  at   = levels_[level];
    const Buffer *from = &at.x, *to = &at.before;
    for (int n = 0; n < 2 * kShellSweeps; ++n) {
        ShellPassPush push = passOf(at.layout);
        push.colour        = (firstColour + n) % 2;
        if (n == 0 && fromZero)
            nodes(list, k.relaxFirst, {at.entries, b, *to}, level, push);
        else
            nodes(list, k.relax, {at.entries, b, *from, *to}, level, push);
        std::swap(from, to);
    }
}

void ProcessorShellFields::cycle(CommandList& list, std::size_t level, const Buffer& b) const
{
    const Level& at = levels_[level];
    if (level + 1 == levels_.size()) return solveCoarsest(list, b, at.x);
    if (isSmall(at.layout)) return smallCycle(list, level, b);
    relax(list, level, b, 0, true);
    nodes(list, k.residual, {at.entries, at.x, at.r, b}, level, passOf(at.layout));
    restrictTo(list, level, at.r, levels_[level + 1].b);
    cycle(list, level + 1, levels_[level + 1].b);
    prolongFrom(list, level, levels_[level + 1].x, at.x, false);
    relax(list, level, b, 1, false);
}

/// The same where one workgroup takes all of a level.
void ProcessorShellFields::smallCycle(CommandList& list, std::size_t level, const Buffer& b) const
{
    const Level &       at = levels_[level], &below = levels_[level + 1];
    const auto&         t    = at.tables;
    const ShellPassPush push = transferBetween(at.layout, below.layout, false);
    const auto          each = std::uint32_t(loads_);
    list.dispatch(k.down, {at.entries, b, t[0], t[1], t[2], t[3], at.x, at.r, below.b}, push, {1, 1, each});
    cycle(list, level + 1, below.b);
    list.dispatch(k.up, {at.entries, b, t[0], t[1], t[2], t[3], at.x, at.before, below.x}, push, {1, 1, each});
}

void ProcessorShellFields::restrictTo(CommandList& list, std::size_t fine, const Buffer& from, const Buffer& to) const
{
    const auto& t = levels_[fine].tables;
    nodes(list, k.restrict, {t[0], t[1], t[2], t[3], from, to}, fine + 1,
          transferBetween(levels_[fine].layout, levels_[fine + 1].layout, false));
}

void ProcessorShellFields::prolongFrom(CommandList& list, std::size_t fine, const Buffer& from, const Buffer& to,
                                       bool fromZero) const
{
    const auto& t = levels_[fine].tables;
    nodes(list, k.prolong, {t[0], t[1], t[2], t[3], from, to}, fine,
          transferBetween(levels_[fine].layout, levels_[fine + 1].layout, fromZero));
}

void ProcessorShellFields::solveCoarsest(CommandList& list, const Buffer& b, const Buffer& x) const
{
    const auto loads = std::uint32_t(loads_);
    if (inverse_)
        list.dispatch(k.byInverse, {*inverse_, places_, b, x}, band_, {band_.unknowns, 1, loads});
    else
        list.dispatch(k.coarse, {factors_, places_, b, x}, band_, {1, 1, loads});
}

/// Nested iteration, as ShellCycle::start() does it.
void ProcessorShellFields::start(CommandList& list) const
{
    const std::size_t last = levels_.size() - 1;
    const auto right       = [&](std::size_t n) -> const Buffer& { return n == 0 ? rightInFloats_ : levels_[n].right; };
    for (std::size_t n = 0; n < last; ++n) restrictTo(list, n, right(n), levels_[n + 1].right);
    solveCoarsest(list, right(last), levels_[last].guess);
    for (std::size_t n = last; n-- > 0;) {
        const Level& at = levels_[n];
        prolongFrom(list, n, levels_[n + 1].guess, at.guess, true);
        if (n == 0) continue;
        nodes(list, k.residual, {at.entries, at.guess, at.b, at.right}, n, passOf(at.layout));
        cycle(list, n, at.b);
        vectors(list, k.add, {at.x, at.guess}, n);
    }
}

void ProcessorShellFields::turnAndApply(CommandList& list, const Buffer& z) const
{
    vectors(list, k.turn, {z, direction_, turns_});
    nodes(list, k.apply, {exact_, direction_, product_}, 0, passOf(levels_.front().layout));
}

void ProcessorShellFields::advance(CommandList& list) const
{
    vectors(list, k.advance, {answer_, left_, direction_, product_, leftInFloats_, lengths_});
}

/// A step along the direction, its work, and what the cycle makes of what is left.
void ProcessorShellFields::goAlong(CommandList& list) const
{
    advance(list);
    dots(list, k.dots, right_, answer_, kBx);
    dots(list, k.dots, left_, answer_, kRx);
    cycle(list, 0, leftInFloats_);
    dots(list, k.dotsOfCycle, left_, levels_.front().x, kRz);
}

void ProcessorShellFields::setRight(std::span<const PlacedLoad> loads)
{
    PALP_EXPECT(loads.size() <= loads_, "more loads than the memory is for");
    std::memset(givenRight_.mapped(), 0, givenRight_.bytes());
    std::memset(givenFloats_.mapped(), 0, givenFloats_.bytes());
    const auto doubles = givenRight_.as<double>();
    const auto floats  = givenFloats_.as<float>();
    for (std::size_t n = 0; n < loads.size(); ++n)
        for (const auto& [place, force] : loads[n]) {
            const std::size_t at = n * numbers() + std::size_t(place);
            doubles[at]          = force;
            floats[at]           = float(force);
        }
}

ProcessorShellFields::PerLoad ProcessorShellFields::takeStart()
{
    turn(none());
    std::ranges::fill(lengths_.as<double>(), 1.0);
    context_.run(begin_);
    return works();
}

ProcessorShellFields::PerLoad ProcessorShellFields::useDirection()
{
    context_.run(aim_);
    return sums(kPq);
}

void ProcessorShellFields::restart(const PerLoad& which)
{
    const auto turns = turns_.as<double>();
    for (std::size_t n = 0; n < loads_; ++n) {
        turns[2 * n]     = 0;
        turns[2 * n + 1] = which[n];
    }
    context_.run(again_);
}

ProcessorShellFields::PerLoad ProcessorShellFields::go(const PerLoad& lengths)
{
    std::ranges::copy(lengths, lengths_.as<double>().begin());
    context_.run(go_);
    return works();
}

void ProcessorShellFields::finish(const PerLoad& lengths)
{
    std::ranges::copy(lengths, lengths_.as<double>().begin());
    context_.run(finish_);
}

void ProcessorShellFields::turn(const PerLoad& betas)
{
    const auto turns = turns_.as<double>();
    for (std::size_t n = 0; n < loads_; ++n) {
        turns[2 * n]     = betas[n];
        turns[2 * n + 1] = 1;
    }
}

void ProcessorShellFields::fetch()
{
    context_.run(fetch_);
    read_.makeVisibleToHost();
}

double ProcessorShellFields::answer(std::size_t load, std::ptrdiff_t place) const
{
    return read_.as<double>()[load * numbers() + std::size_t(place)];
}

ProcessorShellFields::PerLoad ProcessorShellFields::sums(Sum which) const
{
    sums_.makeVisibleToHost();
    const auto all = sums_.as<double>().subspan(which * loads_, loads_);
    return {all.begin(), all.end()};
}

ProcessorShellFields::PerLoad ProcessorShellFields::works() const
{
    PerLoad       works = sums(kBx);
    const PerLoad rx    = sums(kRx);
    for (std::size_t n = 0; n < loads_; ++n) works[n] += rx[n];
    return works;
}

std::size_t ProcessorShellFields::bytesOf(const ShellLayout& finest) noexcept
{
    // Seven vectors of doubles and three of floats with what is staged; six fields of the cycle on all levels.
    return numbersOf(finest) * (7 * sizeof(double) + 3 * sizeof(float) + 8 * sizeof(float));
}

} // namespace palp
