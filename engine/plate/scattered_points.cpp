#include "engine/plate/scattered_points.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

#include "engine/compute/context.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

using compute::Buffer;
using compute::CommandList;
using compute::Intent;

constexpr std::size_t kFirstCapacity = 4096;  ///< [1] contacts have some thousands of points: few grow it
constexpr std::size_t kMostGroups    = 65535; ///< [1] of a dispatch, on every device

/// Points for which no buffer is too large and no dispatch too long.
std::size_t mostPoints(const compute::Context& context, const compute::Kernel& lift, std::uint32_t loads)
{
    const std::size_t bytes = context.limits().buffer;
    return std::min(
        {bytes / sizeof(shared::ScatteredPoint), bytes / (sizeof(float) * loads), kMostGroups * lift.workgroup().x});
}

} // namespace

ScatteredPoints::Memory::Memory(compute::Context& context, std::size_t room, std::uint32_t loads)
    : capacity(room), starts(context, "starts of buckets", 4 * (room + 1), Intent::device),
      points(context, "points", sizeof(shared::ScatteredPoint) * room, Intent::device),
      hostStarts(context, "starts of buckets from the host", starts.bytes(), Intent::upload),
      hostPoints(context, "points from the host", points.bytes(), Intent::upload),
      deflection(context, "deflection of points", 4 * room * loads, Intent::readback)
{
}

ScatteredPoints::ScatteredPoints(compute::Context& context, const PlateKernels::All& kernels, const PlateGrid& grid,
                                 std::uint32_t loads)
    : context_(context), k(kernels), grid_(grid), loads_(loads), most_(mostPoints(context, kernels.lift, loads)),
      layout_(context, "layout of points", sizeof(shared::PointLayout), Intent::device),
      hostLayout_(context, "layout of points from the host", sizeof(shared::PointLayout), Intent::upload),
      without_(context, "nodes without a point", 4 * grid.nodes(), Intent::readback),
      memory_(context, std::min(kFirstCapacity, most_), loads)
{
}

bool ScatteredPoints::set(const PlatePoints& points)
{
    const std::size_t wanted = points.positions.size();
    if (wanted > most_)
        throw Error("plate: " + std::to_string(wanted) + " points are more than the " + std::to_string(most_) +
                    " that the GPU " + context_.device().name + " can hold; try a smaller window");
    const PointBuckets sorted = bucketPoints(grid_, points);
    const bool         grows  = wanted > memory_.capacity;
    if (grows) memory_ = Memory(context_, std::min(std::max(wanted, 2 * memory_.capacity), most_), loads_);
    count_ = wanted;
    std::memcpy(hostLayout_.mapped(), &sorted.layout, sizeof sorted.layout);
    std::memcpy(memory_.hostStarts.mapped(), sorted.starts.data(), 4 * sorted.starts.size());
    std::memcpy(memory_.hostPoints.mapped(), sorted.points.data(), sizeof(shared::ScatteredPoint) * wanted);
    return grows;
}

void ScatteredPoints::recordSampling(CommandList& list, const compute::Kernel& kernel, const Buffer& rigidity) const
{
    PALP_EXPECT(rigidity.bytes() >= 4 * grid_.nodes(),
                "the buffer '" + rigidity.name() + "' is too small for the grid");
    list.copy(hostLayout_, layout_);
    list.copy(memory_.hostStarts, memory_.starts);
    list.copy(memory_.hostPoints, memory_.points);
    list.dispatch(kernel, {layout_, memory_.starts, memory_.points, rigidity, without_}, {},
                  kernel.groupsOver(std::uint32_t(grid_.nodesZ()), std::uint32_t(grid_.nodesX())));
}

void ScatteredPoints::recordNearest(CommandList& list, const Buffer& rigidity) const
{
    recordSampling(list, k.rigidityNearest, rigidity);
}

void ScatteredPoints::recordLogMean(CommandList& list, const Buffer& rigidity) const
{
    recordSampling(list, k.rigidityLogMean, rigidity);
}

void ScatteredPoints::recordLift(CommandList& list, const Buffer& answer, const Buffer& metres) const
{
    PALP_EXPECT(answer.bytes() >= k.realBytes() * grid_.nodes() * loads_ && metres.bytes() >= 4 * std::size_t(loads_),
                "the buffers '" + answer.name() + "' and '" + metres.name() + "' are too small for " +
                    std::to_string(loads_) + " loads");
    list.dispatch(k.lift, {layout_, memory_.points, answer, metres, memory_.deflection}, {},
                  k.lift.groupsOver(std::uint32_t(memory_.capacity), 1, loads_));
}

std::size_t ScatteredPoints::nodesWithoutPoint() const
{
    without_.makeVisibleToHost();
    const auto flags = without_.as<const std::uint32_t>();
    return std::accumulate(flags.begin(), flags.end(), std::size_t(0));
}

std::span<const float> ScatteredPoints::deflection(std::uint32_t load) const
{
    PALP_EXPECT(load < loads_, "load " + std::to_string(load) + " of " + std::to_string(loads_));
    memory_.deflection.makeVisibleToHost();
    return memory_.deflection.as<const float>().subspan(load * count_, count_);
}

} // namespace palp
