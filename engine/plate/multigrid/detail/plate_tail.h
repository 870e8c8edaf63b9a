#pragma once
#include <cstdint>
#include <vector>

#include "compute_shaders/shared/tail_level.h"
#include "engine/compute/buffer.h"
#include "engine/compute/command_list.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/multigrid/detail/plate_kernels.h"

namespace palp {

/// The coarse levels as plate_tail.comp reads them: next to each other, for one workgroup that runs a cycle alone.
struct TailLayout {
    std::size_t                    first = 0; ///< level of the hierarchy that the tail begins with
    std::vector<shared::TailLevel> levels;    ///< from there to the coarsest
    std::uint32_t                  nodes = 0; ///< from the first one's first number to the end, see RigidityLayout
    std::vector<float>             tablesX, tablesZ; ///< transfer tables, level after level
};

/// Takes as many of the coarsest levels as the kernel's shared memory and loops can hold, at least the coarsest.
[[nodiscard]] TailLayout tailLayout(const GridHierarchy& grids);

/// The memory of the tail.
/// \thread as its context
class PlateTail {
public:
    PlateTail(compute::Context& context, const PlateKernels::All& kernels, const GridHierarchy& grids,
              std::uint32_t loads);

    [[nodiscard]] std::size_t first() const noexcept { return layout_.first; } ///< level of the hierarchy
    [[nodiscard]] bool        holds(std::size_t level) const noexcept { return level >= layout_.first; }

    /// Inverts the coarsest level's matrix, of which `factor` holds the Cholesky factor.
    void invertFactor(compute::CommandList& list, const compute::Buffer& factor) const;

    [[nodiscard]] shared::TailPush pushFrom(std::size_t level) const;
    /// \param steps  of conjugate gradients on that level
    [[nodiscard]] shared::NestedPush nestedPush(std::size_t level, int steps) const;
    [[nodiscard]] compute::Groups    groups() const noexcept { return {1, 1, loads_}; }

    /// Bindings of plate_tail.comp.
    /// \param rigidity, divisor  of all levels from the tail's first on, see RigidityLayout
    [[nodiscard]] std::vector<compute::Binding> bindings(const compute::Binding& rigidity,
                                                         const compute::Binding& divisor, const compute::Buffer& force,
                                                         const compute::Buffer& deflection) const;

    /// Bindings of plate_nested.comp, from loads of a level to its deflection.
    [[nodiscard]] std::vector<compute::Binding> nestedBindings(const compute::Binding& rigidity,
                                                               const compute::Binding& divisor,
                                                               const compute::Buffer&  load,
                                                               const compute::Buffer&  deflection) const;

private:
    [[nodiscard]] compute::Buffer field(compute::Context& context, const char* name) const;

    const PlateKernels::All& k;
    TailLayout               layout_;
    std::uint32_t            loads_, coarsestNodes_;
    compute::Buffer          levels_, tableX_, tableZ_, inverse_, aside_;
    compute::Buffer          loadOf_, answer_, left_, direction_; ///< of all levels in nested iteration
};

} // namespace palp
