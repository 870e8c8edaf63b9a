#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/compute/buffer.h"
#include "engine/compute/command_list.h"
#include "engine/plate/multigrid/plate_kernels.h"
#include "engine/plate/point_buckets.h"

namespace palp {

/// The points around a contact on the device: their rigidity goes to the nodes of a plate, and its deflection back.
///
/// Lists stay valid when other points are set, whatever their number, as long as there is room for them.
/// \thread as its context
class ScatteredPoints {
public:
    /// \param grid   of the plate
    /// \param loads  of the answers to come [1]
    ScatteredPoints(compute::Context& context, const PlateKernels::All& kernels, const PlateGrid& grid,
                    std::uint32_t loads);

    /// Takes other points; the next run of a list with a sampling sees them.
    /// \return whether memory had to grow: then every list that this recorded into names memory that is gone, and must
    ///         be recorded anew before anything runs
    /// \throws Error as bucketPoints(), or if there are more points than the device can hold; the old ones stay then
    [[nodiscard]] bool set(const PlatePoints& points);

    /// Adds what writes the rigidity at the nodes [unit], in floats, from the points that are set when the list runs.
    void recordNearest(compute::CommandList& list, const compute::Buffer& rigidity) const;
    void recordLogMean(compute::CommandList& list, const compute::Buffer& rigidity) const;

    /// Adds what brings the deflection at the points of the last sampling to the host, in order after it.
    /// \param answer  at the nodes, one load after the other, real
    /// \param metres  per unit of the answer, a float per load
    void recordLift(compute::CommandList& list, const compute::Buffer& answer, const compute::Buffer& metres) const;

    // After a list has run that sampled the points that are set:

    /// Nodes without a point within 2.5 s, see engine/chart/resample.h [1]
    [[nodiscard]] std::size_t nodesWithoutPoint() const;
    /// Deflection of the points in their order, where the device wrote it, until the next lift or set() [m].
    [[nodiscard]] std::span<const float> deflection(std::uint32_t load) const;

    [[nodiscard]] std::size_t count() const noexcept { return count_; }              ///< of the points [1]
    [[nodiscard]] std::size_t capacity() const noexcept { return memory_.capacity; } ///< [1]
    [[nodiscard]] std::size_t most() const noexcept { return most_; }                ///< that the device can hold [1]

private:
    /// What grows with the points. "host" buffers are mapped and copied when a list runs.
    struct Memory {
        std::size_t     capacity; ///< [1]
        compute::Buffer starts, points, hostStarts, hostPoints, deflection;

        Memory(compute::Context& context, std::size_t capacity, std::uint32_t loads);
    };

    void recordSampling(compute::CommandList& list, const compute::Kernel& kernel,
                        const compute::Buffer& rigidity) const;

    compute::Context&        context_;
    const PlateKernels::All& k;
    PlateGrid                grid_;
    std::uint32_t            loads_;
    std::size_t              most_;
    std::size_t              count_ = 0;
    compute::Buffer          layout_, hostLayout_;
    compute::Buffer          without_; ///< per node 1 if no point is nearby, else 0
    Memory                   memory_;
};

} // namespace palp
