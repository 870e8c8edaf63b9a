#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/contract.h"
#include "engine/core/enum_names.h"
#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"

namespace palp {

namespace compute {
class Context;
}

/// Says that a solve gave something that is not a number: the rigidity or a load is beyond what its numbers can hold.
class SolverBrokeDown : public Error {
public:
    using Error::Error;
};

/// The division of a cycle into dispatches. The answers are the same.
enum class Schedule {
    automatic,  ///< fused on hardware, pass by pass in software
    passByPass, ///< 7 to 11 dispatches per level: nothing is computed twice
    fused       ///< 2 per level, and one for all levels of up to 32 cells together: few dispatches to wait for
};
constexpr auto namesOf(Schedule)
{
    using enum Schedule;
    return std::to_array<NamedValue<Schedule>>(
        {{automatic, "automatic"}, {passByPass, "pass-by-pass"}, {fused, "fused"}});
}

/// The precision of conjugate gradients and the coarsest level.
enum class Precision {
    best,           ///< doubles where the processor has them
    floatGradients, ///< the same on the coarsest level, and conjugate gradients in floats: for tolerances of 1e-3 and more
    floats          ///< as on a processor without doubles
};

/// The smoother of the errors that coarser grids cannot represent. Two steps of Chebyshev's iteration smooth better
/// than one sweep in red and black, and worse than two.
enum class Smoother {
    automatic, ///< Chebyshev's with exact rims on the host, else red and black
    redBlack,  ///< each colour from the newest values of the other: half the work for an invocation per node
    chebyshev, ///< all nodes from the values before: half the work for rows of nodes
    exactRims  ///< the same, and nodes around strong jumps of the rigidity are solved for exactly: on the host alone
};

/// The order of the fields of several loads in memory. The answers are the same.
enum class FieldLayout {
    apart,     ///< one after the other
    sideBySide ///< the numbers of eight loads at each node, then those at the next: on the host, for loads by eights
};

/// The plate's kernels, compiled for one processor; solvers of any size share them.
/// \thread as its context
class PlateKernels {
public:
    explicit PlateKernels(compute::Context& context, Schedule schedule = Schedule::automatic,
                          Precision precision = Precision::best, Smoother smoother = Smoother::automatic,
                          FieldLayout layout = FieldLayout::apart);
    ~PlateKernels();
    PlateKernels(PlateKernels&&) noexcept;
    PlateKernels& operator=(PlateKernels&&) noexcept;

    struct All;
    [[nodiscard]] const All& all() const noexcept { return *all_; } ///< for the files of engine/plate

private:
    std::unique_ptr<All> all_;
};

/// Solves plates by multigrid on a GPU, or on the host by the same kernels as native code: nested iteration, then
/// conjugate gradients preconditioned by one symmetric V cycle, matrix-free in moment form. The kernels themselves stop
/// the iteration.
///
/// The cycle is in 32-bit floats and the conjugate gradients are in doubles where the processor has them: a cycle only
/// needs to be roughly right, but rounding the residual to floats leaves an error that grows with the contrast of the
/// rigidity (1e-5 at 257 nodes and contrast 1000). Without doubles the tolerance must not ask for more than floats can
/// give.
/// \thread one at a time, together with its context
/// \source Brandt 1977 (multigrid, nested iteration); Hestenes & Stiefel 1952; README.md in engine/plate says what was
///         measured
/// \differs the paper uses undamped Jacobi, which grows 2.16 times per sweep on this stencil, until the change is
///          small; with damping that stops far too early (99 % off at 65 nodes and 1e-3). Here an error estimate stops
///          it
class MultigridPlateSolver {
public:
    struct Settings {
        double tolerance     = 1e-4; ///< relative error in the energy norm [1]; see SolveReport
        int    maxIterations = 200;  ///< checked every four steps
        int    loads         = 1;    ///< solved together, sharing every pass
    };

    /// Allocates, records and prepares everything for grids, edges, foundation and rigidity of this plate.
    /// \param context  must stay where it is
    /// \throws Error if whyUnsolvable(plate) says so, if the tolerance is below kLeastTolerance (or
    ///         kLeastFloatTolerance on a processor without doubles), or if the processor cannot hold the grid
    /// \throws compute::ProcessorLost if the processor fails
    MultigridPlateSolver(compute::Context& context, const PlateKernels& kernels, const Plate& plate,
                         const Settings& settings);
    ~MultigridPlateSolver();
    MultigridPlateSolver(MultigridPlateSolver&&) noexcept;
    MultigridPlateSolver& operator=(MultigridPlateSolver&&) noexcept;

    static constexpr double kLeastTolerance      = 1e-7; ///< rigidities and answers are rounded to floats [1]
    static constexpr double kRimContrast         = 600;  ///< from which Smoother::exactRims may pay [1]
    static constexpr double kLeastFloatTolerance = 1e-4; ///< what floats alone reach at contrast 1000 [1]

    /// Takes another rigidity [N m] on the same grid, and another shape of the foundation [1] if the plate has one.
    /// \throws Error if whyUnsolvable() refuses them
    void setRigidity(const NodeField& rigidity, const NodeField& foundationShape = {});

    /// Solves for the deflections under forces at the nodes [N], one field per load.
    ///
    /// report.errorEstimate estimates the error relative to the answer in the energy norm, from the gains of the last
    /// steps, and includes rounding; converged is false after maxIterations, if rounding() exceeds the tolerance, or if
    /// rounding hides how a part of the plate is held; iterations counts steps of conjugate gradients on the finest
    /// grid; workUnits include the nested iteration. Every solution has the same report, of the whole batch and its
    /// worst load.
    /// \throws Error if a load is not finite
    /// \throws SolverBrokeDown if an estimate or a deflection is not
    /// \throws compute::ProcessorLost if the processor fails
    [[nodiscard]] std::vector<PlateSolution> solve(std::span<const NodeField> nodalForces);
    [[nodiscard]] PlateSolution              solve(const NodeField& nodalForce);

    /// What footprints feel, and the report of the batch.
    struct Responses {
        std::vector<FootprintResponse> of;
        SolveReport                    report;
    };

    /// Solves for loads on few nodes and returns what each feels. No field of numbers comes back, except by
    /// deflectionOf().
    ///
    /// The work of a load is (f, x) + (r, x), with the residual r = f - A x that conjugate gradients have: its relative
    /// error is the square of that of the answer in the energy norm, so that a tolerance of 1e-2 gives a compliance to
    /// 1e-4. The works of the changes are as wrong as the answer.
    /// \throws Error, SolverBrokeDown and compute::ProcessorLost as solve()
    [[nodiscard]] Responses solveFootprints(std::span<const Footprint> loads);
    /// Returns the deflection [m] under a load of the last solveFootprints().
    [[nodiscard]] NodeField deflectionOf(std::size_t load) const;

    /// Returns the error that rounding leaves with the present rigidity, relative in the energy norm [1]. Where a
    /// rigidity jumps and conjugate gradients are in floats, it grows with the contrast.
    [[nodiscard]] double rounding() const noexcept;
    /// Returns what it would be if conjugate gradients were in floats [1].
    [[nodiscard]] double roundingInFloats() const noexcept;

    /// Returns what the kernels' rigidity is relative to, see rigidityUnit() [N m].
    [[nodiscard]] double unitRigidity() const noexcept;

    /// The commands of the lists; each waits for the one before it.
    struct CommandCounts {
        int prepare = 0, prepareCopies = 0; ///< dispatches and copies for a new rigidity
        int nested = 0;                     ///< dispatches before the steps on the finest level
        int step   = 0;                     ///< dispatches of a step of conjugate gradients there, its cycle included
        int cycle  = 0;
        int last   = 0; ///< dispatches after the steps of a list: where they are fused, what the last one leaves to do
    };
    /// Counts the commands for rigidities that jump as the present one does.
    [[nodiscard]] CommandCounts commands();

    [[nodiscard]] int dispatchesPerCycle() const noexcept; ///< of the finest level, in the last solve
    [[nodiscard]] int levels() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
