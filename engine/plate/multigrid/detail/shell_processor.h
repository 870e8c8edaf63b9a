#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compute_shaders/shared/shell_layout.h"
#include "engine/compute/buffer.h"
#include "engine/compute/command_list.h"
#include "engine/compute/kernel.h"
#include "engine/plate/multigrid/detail/shell_level.h"
#include "engine/plate/multigrid/multigrid_shell_solver.h"

namespace palp {

/// The kernels of compute_shaders/shared/shell_passes.def by name, for one processor of Vulkan.
struct ShellKernels::All {
    bool invertsCoarsest; ///< once per shell, where waiting for one unknown after the other costs more than a product
#define PALPATE_PASS(name, spirv, source, define, Push, buffers, shape) compute::Kernel name;
#include "compute_shaders/shared/shell_passes.def"
};

/// Vectors of conjugate gradients on a processor of Vulkan, and the cycle that preconditions them; of any number of
/// loads, each with the bits that HostShellFields<false> gives it, where the processor rounds as the host does and the
/// coarsest level is solved by factors; but finish() ends what several loads gain together, as that of the host's
/// eights does.
///
/// Levels and factors are the host's, made in doubles and copied once per shell. A step is two submissions, because the
/// host divides two numbers per load between them: the length of a step is known once its direction is, and whether
/// there is a next one once its work is.
class ProcessorShellFields {
public:
    using PerLoad = std::vector<double>;

    /// \throws compute::ProcessorOutOfMemory, compute::ProcessorLost
    ProcessorShellFields(compute::Context& context, const ShellKernels::All& kernels,
                         const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse, std::size_t loads);

    /// Copies the coefficients of the levels, which must be those that it was made with; of another shell if its grid
    /// and the unknowns of the coarsest level are the same.
    void setLevels(const ShellCoarseSolver& coarse);

    /// As those of HostShellFields.
    void                  setRight(std::span<const PlacedLoad> loads);
    [[nodiscard]] PerLoad none() const { return PerLoad(loads_, 0.0); }
    PerLoad               takeStart();
    PerLoad               precondition() { return sums(kRz); } // go() has made it
    void                  takeDirection() { turn(none()); }
    PerLoad               useDirection();
    void                  restart(const PerLoad& which);
    PerLoad               go(const PerLoad& lengths);
    void                  finish(const PerLoad& lengths);
    void                  turn(const PerLoad& betas);
    [[nodiscard]] double  answer(std::size_t load, std::ptrdiff_t place) const;

    /// Brings the answer to the host.
    void fetch();

    [[nodiscard]] std::size_t loads() const noexcept { return loads_; }

    /// Returns the memory of one load [byte], about.
    [[nodiscard]] static std::size_t bytesOf(const ShellLayout& finest) noexcept;

private:
    enum Sum : unsigned { kBx, kRx, kRz, kPq, kSums };

    /// Of one level: coefficients and tables, and the cycle's fields of all loads.
    struct Level {
        ShellLayout                    layout;
        compute::Buffer                entries;
        std::array<compute::Buffer, 4> tables;
        compute::Buffer                before, x; ///< half sweeps go from one to the other, and end in x
        compute::Buffer                b, r;
        compute::Buffer                right, guess; ///< of the start
    };

    [[nodiscard]] compute::Buffer memory(const char* name, std::size_t bytes,
                                         compute::Intent intent = compute::Intent::processor) const;
    [[nodiscard]] Level           makeLevel(const ShellLevel& level) const;
    [[nodiscard]] std::size_t     numbers() const noexcept { return numbersOf(levels_.front().layout); }

    template <class Visit>
    void eachUpload(const ShellCoarseSolver& coarse, const Visit& visit) const;
    void empty();
    void record();

    void nodes(compute::CommandList& list, const compute::Kernel& kernel, const compute::Bindings& bindings,
               std::size_t level, const shared::ShellPassPush& push) const;
    void vectors(compute::CommandList& list, const compute::Kernel& kernel, const compute::Bindings& bindings,
                 std::size_t level = 0) const;
    void dots(compute::CommandList& list, const compute::Kernel& kernel, const compute::Buffer& a,
              const compute::Buffer& b, Sum slot) const;
    void relax(compute::CommandList& list, std::size_t level, const compute::Buffer& b, int firstColour,
               bool fromZero) const;
    void cycle(compute::CommandList& list, std::size_t level, const compute::Buffer& b) const;
    void smallCycle(compute::CommandList& list, std::size_t level, const compute::Buffer& b) const;
    void restrictTo(compute::CommandList& list, std::size_t fine, const compute::Buffer& from,
                    const compute::Buffer& to) const;
    void prolongFrom(compute::CommandList& list, std::size_t fine, const compute::Buffer& from,
                     const compute::Buffer& to, bool fromZero) const;
    void solveCoarsest(compute::CommandList& list, const compute::Buffer& b, const compute::Buffer& x) const;
    void start(compute::CommandList& list) const;
    void turnAndApply(compute::CommandList& list, const compute::Buffer& z) const;
    void advance(compute::CommandList& list) const;
    void goAlong(compute::CommandList& list) const;

    [[nodiscard]] PerLoad sums(Sum which) const;
    [[nodiscard]] PerLoad works() const;

    compute::Context&              context_;
    const ShellKernels::All&       k;
    const std::vector<ShellLevel>& source_;
    std::size_t                    loads_;
    shared::ShellBandPush          band_;
    std::vector<Level>             levels_;
    compute::Buffer                exact_, factors_, places_; ///< coefficients in doubles; of the coarsest level
    std::optional<compute::Buffer> inverse_;                  ///< of the coarsest level's matrix, where it has unknowns
    compute::Buffer                right_, left_, direction_, product_, answer_; ///< of the finest level, in doubles
    compute::Buffer                rightInFloats_, leftInFloats_;
    compute::Buffer                staging_, givenRight_, givenFloats_, turns_, lengths_; ///< written by the host
    compute::Buffer                sums_, read_;                                          ///< read by it
    compute::CommandList           send_, begin_, aim_, again_, go_, finish_, fetch_;
};

} // namespace palp
