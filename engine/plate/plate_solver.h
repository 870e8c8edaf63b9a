#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/plate/plate.h"

namespace palp {

/// What Vulkan in software makes of a plate.
enum class SoftwareBits {
    itsOwn,   ///< the way that is fastest there
    ofTheHost ///< the host's way, and then to the bit what the host makes of it: for replays
};

/// Where plates are solved: on a GPU or the host by multigrid, or by the reference solver.
///
/// Keeps the solver of the last plate: another rigidity on the same grid, edges and foundation costs no new memory, nor
/// do as many loads.
/// \thread one at a time
class PlateSolver {
public:
    static constexpr std::string_view kReference = "reference";

    /// Opens the device: 40 ms where that loads drivers; a GPU compiles its kernels at their first use, once per
    /// machine. \param wanted  kReference, or as compute::chooseProcessor() has it: "auto", "host", "lavapipe", an INDEX or
    /// part of a
    ///                NAME; words in any case. "auto" is the best GPU that works, else the host
    /// \throws compute::UnknownProcessor or compute::ProcessorError if a device that is asked for is not there or cannot be used
    /// \param patience  see compute::ContextSettings [s]
    explicit PlateSolver(std::string_view wanted = "auto", double patience = 0,
                         SoftwareBits bits = SoftwareBits::itsOwn);
    ~PlateSolver();
    PlateSolver(PlateSolver&&) noexcept;
    PlateSolver& operator=(PlateSolver&&) noexcept;

    [[nodiscard]] const std::string& name() const noexcept; ///< of the Vulkan device, "host" or "reference"

    /// What went wrong last: a GPU that "auto" passed over as broken, or why the reference solved a plate. Or empty.
    [[nodiscard]] const std::string& note() const noexcept;

    /// Deflection under forces at the nodes [N]; see MultigridPlateSolver and ReferencePlateSolver for the report.
    ///
    /// If the device is lost or runs out of memory, this and all later plates are solved by the reference; if it does
    /// not reach the tolerance, this one is, up to 513 x 513 nodes. note() says so. See report.converged.
    /// \param tolerance  of the error estimate, relative [1]; the reference solver is as accurate as doubles allow, and
    /// says
    ///                   whether that is enough
    /// \throws Error if the plate, the load or the tolerance are not acceptable
    [[nodiscard]] PlateSolution solve(const Plate& plate, const NodeField& nodalForce, double tolerance = 1e-4);

    /// The same of several loads on one plate, in their order. They share what is prepared for the rigidity; on a
    /// device that is not the host also every pass, and the report, which then is of the worst of them.
    [[nodiscard]] std::vector<PlateSolution> solveAll(const Plate& plate, std::span<const NodeField> nodalForces,
                                                      double tolerance = 1e-4);

private:
    struct Multigrid;
    std::unique_ptr<Multigrid> multigrid_; ///< empty: the reference
    std::string                name_{kReference};
    std::string                note_;
};

} // namespace palp
