#include "engine/plate/multigrid/detail/plate_tail.h"

#include <algorithm>
#include <cstring>

#include "compute_shaders/shared/plate_push.h"
#include "engine/compute/context.h"
#include "engine/plate/multigrid/detail/rigidity_layout.h"

namespace palp {
namespace {

using compute::Buffer;
using compute::CommandList;
using compute::Intent;

bool fitsLoops(const shared::PlateLevel& g)
{
    return nodesOf(g) <= std::size_t(shared::kTailNodes) && (g.cellsX + 1) * (g.cellsZ / 2 + 1) <= shared::kTailHalf;
}

/// Counts the numbers of the levels from `first` on: deflections of all, forces of all but the first.
std::size_t poolOf(const GridHierarchy& grids, std::size_t first)
{
    std::size_t numbers = nodesOf(grids.levels[first].plate);
    for (std::size_t l = first + 1; l < grids.levels.size(); ++l) numbers += 2 * nodesOf(grids.levels[l].plate);
    return numbers;
}

template <class T>
std::size_t bytesOf(const std::vector<T>& values)
{
    return sizeof(T) * values.size();
}

} // namespace

TailLayout tailLayout(const GridHierarchy& grids)
{
    TailLayout layout;
    layout.first = grids.levels.size() - 1;
    while (layout.first > 0 && grids.levels.size() - layout.first < std::size_t(shared::kTailLevels) &&
           fitsLoops(grids.levels[layout.first - 1].plate) &&
           poolOf(grids, layout.first - 1) <= std::size_t(shared::kTailPool))
        --layout.first;
    const RigidityLayout all  = rigidityLayout(grids);
    int                  pool = 0;
    for (std::size_t l = layout.first; l < grids.levels.size(); ++l) {
        const auto& level = grids.levels[l];
        const int   nodes = int(nodesOf(level.plate));
        const int   force = l == layout.first ? 0 : pool + nodes;
        layout.levels.push_back({level.plate, all.levels[l].field - all.levels[layout.first].field,
                                 int(layout.tablesX.size()), int(layout.tablesZ.size()), pool, force});
        layout.tablesX.insert(layout.tablesX.end(), level.tableX.begin(), level.tableX.end());
        layout.tablesZ.insert(layout.tablesZ.end(), level.tableZ.begin(), level.tableZ.end());
        pool += l == layout.first ? nodes : 2 * nodes;
    }
    layout.nodes = std::uint32_t(all.numbers) - std::uint32_t(all.levels[layout.first].field);
    for (auto* tables : {&layout.tablesX, &layout.tablesZ})
        if (tables->empty()) tables->push_back(0); // a buffer holds something
    return layout;
}

PlateTail::PlateTail(compute::Context& context, const PlateKernels::All& kernels, const GridHierarchy& grids,
                     std::uint32_t loads)
    : k(kernels), layout_(tailLayout(grids)), loads_(loads),
      coarsestNodes_(std::uint32_t(nodesOf(grids.levels.back().plate))),
      levels_(context, "levels of the tail", sizeof(shared::TailLevel) * layout_.levels.size(), Intent::processor),
      tableX_(context, "tables x of the tail", bytesOf(layout_.tablesX), Intent::processor),
      tableZ_(context, "tables z of the tail", bytesOf(layout_.tablesZ), Intent::processor),
      inverse_(context, "inverse of the coarsest level",
               kernels.coarseBytes() * std::size_t(coarsestNodes_) * coarsestNodes_, Intent::processor),
      aside_(field(context, "deflections put aside")), loadOf_(field(context, "loads of the tail")),
      answer_(field(context, "answers of the tail")), left_(field(context, "residuals of the tail")),
      direction_(field(context, "directions of the tail"))
{
    std::vector<Buffer> staging;
    CommandList         list(context);
    const auto          upload = [&](const auto& from, const Buffer& to) {
        staging.emplace_back(context, "tail from the host", bytesOf(from), Intent::upload);
        std::memcpy(staging.back().mapped(), from.data(), bytesOf(from));
        list.copy(staging.back(), to);
    };
    upload(layout_.levels, levels_);
    upload(layout_.tablesX, tableX_);
    upload(layout_.tablesZ, tableZ_);
    list.end();
    context.run(list);
}

/// A number for every node of every level and load.
Buffer PlateTail::field(compute::Context& context, const char* name) const
{
    return {context, name, 4 * std::size_t(layout_.nodes) * loads_, Intent::processor};
}

void PlateTail::invertFactor(CommandList& list, const Buffer& factor) const
{
    list.dispatch(k.fused->coarseInvert, {factor, inverse_}, shared::LevelPush{layout_.levels.back().plate},
                  {1, 1, coarsestNodes_});
}

shared::TailPush PlateTail::pushFrom(std::size_t level) const
{
    return {std::uint32_t(level - layout_.first), std::uint32_t(layout_.levels.size()), layout_.nodes};
}

shared::NestedPush PlateTail::nestedPush(std::size_t level, int steps) const
{
    return {std::uint32_t(level - layout_.first), std::uint32_t(layout_.levels.size()), layout_.nodes,
            std::uint32_t(steps)};
}

std::vector<compute::Binding> PlateTail::nestedBindings(const compute::Binding& rigidity,
                                                        const compute::Binding& divisor, const Buffer& load,
                                                        const Buffer& deflection) const
{
    std::vector<compute::Binding> all = bindings(rigidity, divisor, load, deflection);
    for (const Buffer* each : {&loadOf_, &answer_, &left_, &direction_}) all.emplace_back(*each);
    return all;
}

std::vector<compute::Binding> PlateTail::bindings(const compute::Binding& rigidity, const compute::Binding& divisor,
                                                  const Buffer& force, const Buffer& deflection) const
{
    return {levels_, rigidity, divisor, tableX_, tableZ_, inverse_, force, aside_, deflection};
}

} // namespace palp
