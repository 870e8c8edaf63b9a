#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/resampling.h"
#include "engine/plate/plate.h"
#include "engine/plate/point_buckets.h"

namespace palp {

namespace compute {
class Context;
}

/// How a cycle is cut into dispatches; the answers are the same.
enum class Schedule {
    automatic,  ///< fused on hardware, pass by pass in software
    passByPass, ///< 7 to 11 dispatches per level: nothing is computed twice
    fused       ///< 3 per level, and one for all levels of up to 64 cells together: few dispatches to wait for
};

/// What conjugate gradients and the coarsest level compute in.
enum class Precision {
    best,  ///< doubles where the device has them
    floats ///< as on a device without doubles
};

/// What evens out the errors that coarser grids cannot see. Two steps of Chebyshev's iteration do that better than one
/// sweep in red and black, and not as well as two.
enum class Smoother {
    automatic, ///< Chebyshev's on the host, else red and black
    redBlack,  ///< each colour from the newest values of the other: half the work for an invocation per node
    chebyshev  ///< all nodes from the values before: half the work for rows of nodes
};

/// The plate's shaders, compiled for one device; solvers of any size share them. \thread as its context
class PlateKernels {
public:
    explicit PlateKernels(compute::Context& context, Schedule schedule = Schedule::automatic,
                          Precision precision = Precision::best, Smoother smoother = Smoother::automatic);
    ~PlateKernels();
    PlateKernels(PlateKernels&&) noexcept;
    PlateKernels& operator=(PlateKernels&&) noexcept;

    struct All;
    [[nodiscard]] const All& all() const noexcept { return *all_; } ///< for the files of engine/plate

private:
    std::unique_ptr<All> all_;
};

/// Multigrid on a Vulkan device, or on the host by the same kernels as native code: nested iteration, then conjugate
/// gradients preconditioned by one symmetric V cycle, smoothed as PlateKernels say, matrix-free in moment form, stopped
/// by the device itself.
///
/// The cycle is in 32-bit floats and the conjugate gradients are in doubles where the device has them: a cycle only
/// needs to be roughly right, but rounding the residual to floats leaves an error that grows with the contrast of the
/// rigidity (1e-5 at 257 nodes and contrast 1000). Without doubles the tolerance must not ask for more than floats can
/// give. \thread one at a time, together with its context \source Brandt 1977 (multigrid, nested iteration); Hestenes &
/// Stiefel 1952; README.md here says what was measured
/// \differs the paper iterates by undamped Jacobi, which grows 2.16 times a sweep on this stencil, until the change is
///          small, which damped is far too early (99 % off at 65 nodes and 1e-3); here an error estimate stops it
class MultigridPlateSolver {
public:
    struct Settings {
        double tolerance     = 1e-4; ///< of the error, relative in the energy norm [1]; see SolveReport
        int    maxIterations = 200;  ///< [1] looked at every four steps
        int    loads         = 1;    ///< solved together, sharing every pass [1]
    };

    /// Allocates, records and prepares everything for grids, edges, foundation and rigidity of this plate.
    /// \throws Error if whyUnsolvable(plate), if the tolerance is below kLeastTolerance (or kLeastFloatTolerance on a
    ///         device without doubles), or if the device cannot hold the grid; compute::ProcessorLost
    /// \param context  must stay where it is
    MultigridPlateSolver(compute::Context& context, const PlateKernels& kernels, const Plate& plate,
                         const Settings& settings);
    ~MultigridPlateSolver();
    MultigridPlateSolver(MultigridPlateSolver&&) noexcept;
    MultigridPlateSolver& operator=(MultigridPlateSolver&&) noexcept;

    static constexpr double kLeastTolerance      = 1e-7; ///< rigidities and answers are rounded to floats [1]
    static constexpr double kLeastFloatTolerance = 1e-4; ///< what floats alone reach at contrast 1000 [1]

    /// Another rigidity [N m] on the same grid.
    /// \throws Error if whyUnsolvable() with it
    void setRigidity(const NodeField& rigidity);

    /// Another rigidity, from scattered points: the device brings it to the nodes when the next solve runs, and then
    /// lifts every answer to the points, in one submission with the solve.
    ///
    /// Same results as resampleRigidity() but for float arithmetic (1e-4). Extra sweeps where the rigidity jumps go by
    /// what the points before had: after a change the first solve may take more steps.
    /// \param points  their `unit` is not looked at
    /// \throws Error if there are no points or more than the device can hold, if a position is not finite, or if a
    ///         rigidity is not positive and finite
    void setRigidity(const PlatePoints& points, Resampling sampling);

    enum class Start {
        cold, ///< by nested iteration
        warm  ///< from the last answer (of each load), unless a load is 1000 times as large or small as the last
    };

    /// Deflections under forces at the nodes [N], one field per load.
    ///
    /// report.errorEstimate: of the error relative to the answer in the energy norm, from the gains of the last steps,
    /// and of rounding; converged is false after maxIterations, or if rounding hides how a part of the plate is held;
    /// iterations: steps of conjugate gradients on the finest grid; workUnits include the nested iteration. The same
    /// report, of the whole batch and the worst load, is in every solution.
    /// \throws Error if a load is not finite or the deflection is not; compute::ProcessorLost
    [[nodiscard]] std::vector<PlateSolution> solve(std::span<const NodeField> nodalForces, Start start = Start::cold);
    [[nodiscard]] PlateSolution              solve(const NodeField& nodalForce, Start start = Start::cold);

    /// The last solve's deflections [m] where the device wrote them: mapped memory, one load after the other. They stay
    /// as they are while two further solves run.
    [[nodiscard]] std::span<const float> mappedDeflections() const;

    /// What the last solve found at the points of setRigidity(): deflection [m] in their order, mapped as well, until
    /// the next solve; nodes without a point nearby, see Resampled [1]; the rigidity at the nodes [N m].
    [[nodiscard]] std::span<const float> pointDeflections(int load = 0) const;
    [[nodiscard]] std::size_t            nodesWithoutPoint() const;
    [[nodiscard]] NodeField              sampledRigidity() const;

    [[nodiscard]] int dispatchesPerCycle() const noexcept; ///< of the finest level, in the last solve [1]
    [[nodiscard]] int levels() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
