#pragma once
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"

namespace palp {

/// The way in which Vulkan in software solves a plate.
enum class SoftwareBits {
    itsOwn,   ///< the way that is fastest there
    ofTheHost ///< the host's way, with the same bits as the host: for replays
};

/// What footprints on one plate feel.
struct FootprintSolution {
    std::vector<FootprintResponse> responses; ///< in the order of the loads
    PlateSolution                  whole;     ///< under the load whose whole deflection was asked for
};

/// Solves plates: on a GPU or the host by multigrid, or by the reference solver.
///
/// It keeps the solver of the last plate. Another rigidity on the same grid, edges and foundation costs no new memory,
/// nor does the same number of loads.
/// \thread one at a time
class PlateSolver {
public:
    static constexpr std::string_view kReference = "reference";

    /// Opens the processor, in 40 ms where that loads drivers. A GPU compiles its kernels at their first use, once per
    /// machine.
    /// \param wanted    kReference, or a word of compute::chooseProcessor(): "auto", "host", "lavapipe", an INDEX or
    ///                  part of a NAME, in any case; "auto" is the best GPU that works, else the host
    /// \param patience  see compute::ContextSettings [s]
    /// \throws compute::UnknownProcessor if no processor has that name
    /// \throws compute::ProcessorError if the requested processor cannot be used
    explicit PlateSolver(std::string_view wanted = "auto", double patience = 0,
                         SoftwareBits bits = SoftwareBits::itsOwn);
    ~PlateSolver();
    PlateSolver(PlateSolver&&) noexcept;
    PlateSolver& operator=(PlateSolver&&) noexcept;

    [[nodiscard]] const std::string& name() const noexcept; ///< of the GPU, "host" or "reference"

    /// Returns what went wrong last: a GPU that "auto" skipped as broken, or why the reference solved a plate; empty if
    /// nothing went wrong.
    [[nodiscard]] const std::string& note() const noexcept;

    /// Solves for the deflection under forces at the nodes [N]; see MultigridPlateSolver and ReferencePlateSolver for
    /// the report.
    ///
    /// The reference solves this and all later plates if the processor is lost or runs out of memory, and this plate
    /// alone, up to 513 x 513 nodes, if multigrid does not reach the tolerance; note() reports it. See
    /// report.converged.
    /// \param tolerance  of the error estimate, relative [1]; the reference solver is as accurate as doubles allow, and
    ///                   reports whether that suffices
    /// \throws Error if the plate, the load or the tolerance is not acceptable
    [[nodiscard]] PlateSolution solve(const Plate& plate, const NodeField& nodalForce, double tolerance = 1e-4);

    /// Solves for several loads on one plate, in their order. They share what is prepared for the rigidity. On a GPU
    /// they also share every pass and the report, which is then that of the worst load.
    [[nodiscard]] std::vector<PlateSolution> solveAll(const Plate& plate, std::span<const NodeField> nodalForces,
                                                      double tolerance = 1e-4);

    /// Solves for loads on few nodes of one plate, with the whole deflection under one of them.
    ///
    /// That one is solved to the tolerance, in doubles. The works of the others are as accurate although they are solved
    /// less far: to the square root of the tolerance, at most 1e-2, see MultigridPlateSolver::solveFootprints(). On the
    /// host they are solved by eights, in floats; on a GPU all in one batch.
    /// \param whole  index of that load
    [[nodiscard]] FootprintSolution solveFootprints(const Plate& plate, std::span<const Footprint> loads,
                                                    std::size_t whole, double tolerance = 1e-4);

private:
    struct Multigrid;

    void lose(const std::exception& why); ///< the processor, for good
    [[nodiscard]] static std::vector<PlateSolution>
    byReference(const Plate& plate, std::span<const NodeField> nodalForces, double tolerance);

    std::unique_ptr<Multigrid> multigrid_; ///< null: the reference solver is used
    std::string                name_{kReference};
    std::string                note_;
};

} // namespace palp
