#pragma once
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"
#include "engine/plate/plate_trial.h"
#include "engine/plate/shell.h"

namespace palp {

class DirectShell;

namespace compute {
struct ContextSettings;
}

/// The way in which Vulkan in software solves a plate.
enum class SoftwareBits {
    itsOwn,   ///< the way that is fastest there
    ofTheHost ///< the host's way, with the same bits as the host: for replays. Where the host may solve for rims, or
              ///< for many footprints, by a factor, which has no shader, it takes over itself
};

/// Whether Airy's function of a shell is wanted with the deflection of its whole load.
enum class Stresses { none, ofWhole };

/// What footprints on one plate feel.
struct FootprintSolution {
    std::vector<FootprintResponse> responses; ///< in the order of the loads
    PlateSolution                  whole;     ///< under the load whose whole deflection was asked for
    NodeField stress{}; ///< phi of a shell under that load [N m], where Stresses::ofWhole was asked for; else empty
};

/// Solves plates: on a GPU or the host by multigrid, or by the reference solver.
///
/// The host's multigrid takes over from another processor
///  - for good, if that one is lost or hangs;
///  - for plates of as many nodes or more, if one does not fit its memory, until a later one does: now and then one is
///    tried; loads that do not fit it together are split into batches before;
///  - for one plate, if the processor has no doubles and the tolerance needs them, if it stops short of the tolerance
///    for want of them, or if something is no longer a number; and if Vulkan in software has to give the host's bits,
///    which depend on exact rims there.
/// The reference takes over for a plate that multigrid in doubles does not solve within its 200 steps, up to 513 x 513
/// nodes: beyond, factorising takes minutes and gigabytes, and an answer that is reported as not converged is better.
/// Such a plate is remembered, and the reference solves those like it at once: of as many cells and the same edges,
/// about the same spacing and foundation, at least half the contrast, and as sharp. Each time note() says why.
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
    /// Opens the processor that settings.processor names, with other settings than the usual ones.
    explicit PlateSolver(compute::ContextSettings settings, SoftwareBits bits = SoftwareBits::itsOwn);
    ~PlateSolver();
    PlateSolver(PlateSolver&&) noexcept;
    PlateSolver& operator=(PlateSolver&&) noexcept;

    [[nodiscard]] const std::string& name() const noexcept; ///< of the GPU, "host" or "reference"

    /// Returns what went wrong last: a GPU that "auto" skipped as broken, or why the host or the reference took over;
    /// empty if nothing went wrong.
    [[nodiscard]] const std::string& note() const noexcept;

    /// Solves for the deflection under forces at the nodes [N]; see MultigridPlateSolver and ReferencePlateSolver for
    /// the report.
    ///
    /// report.solver is the name of what solved it, see above; report.converged whether the tolerance was reached.
    /// \param tolerance  of the error estimate, relative [1]; the reference solver is as accurate as doubles allow, and
    ///                   reports whether that suffices
    /// \throws Error if the plate, the load or the tolerance is not acceptable
    [[nodiscard]] PlateSolution solve(const Plate& plate, const NodeField& nodalForce, double tolerance = 1e-4);

    /// Solves for several loads on one plate, in their order. They share what is prepared for the rigidity. On a GPU
    /// they also share every pass and the report, which is then that of the worst load.
    [[nodiscard]] std::vector<PlateSolution> solveAll(const Plate& plate, std::span<const NodeField> nodalForces,
                                                      double tolerance = 1e-4);

    /// For solveFootprints(): no deflection is wanted more exactly than works ask for.
    static constexpr double kAsWorks = 1;

    /// Solves for loads on few nodes of one plate, with the whole deflection under one of them.
    ///
    /// A work is of the second order in the error of its answer: loads are solved to the square root of the tolerance,
    /// at most 1e-2, see MultigridPlateSolver::solveFootprints(). On the host they are solved by eights, in floats, and
    /// the one whose deflection is wanted in doubles; on a GPU all in one batch. Many of them on a small plate whose
    /// rigidity jumps are solved by a factor of its matrix on the host, to what doubles and a rounded rigidity give,
    /// with 0 iterations.
    /// \param whole      index of that load
    /// \param tolerance  of works, relative [1]
    /// \param drawn      of the deflection, relative in the energy norm [1]: less than works ask for takes more steps
    [[nodiscard]] FootprintSolution solveFootprints(const Plate& plate, std::span<const Footprint> loads,
                                                    std::size_t whole, double tolerance, double drawn);

    /// Does the same for a shell; works hold its shear across the thickness too, see shearWork(). An object that ends
    /// in its window is solved by a factor on the host, whatever the processor, see DirectShell. A processor without
    /// doubles, or whose memory does not fit one, lets the host solve it, and note() says so. On the reference solver
    /// every load is solved by the reference solver of shells.
    [[nodiscard]] FootprintSolution solveFootprints(const Shell& shell, std::span<const Footprint> loads,
                                                    std::size_t whole, double tolerance, double drawn,
                                                    Stresses stresses = Stresses::none);

    /// Returns the time that it is [ms]; only differences count.
    using Clock = std::function<double()>;

    /// Measures the median time of five solves of a trial, each with a new rigidity, after one that compiles kernels
    /// and makes memory [ms].
    /// \param clock  empty: the wall clock
    /// \throws Error if the processor cannot solve it
    [[nodiscard]] double timeOf(const PlateTrial& trial, const Clock& clock = {});

    /// What the processors took that were compared.
    struct ProcessorTime {
        std::string name;
        double      milliseconds; ///< infinite: it could not solve the trial, see note()
    };

    /// Compares the processor with the host by timeOf(), and goes on with the faster one: a GPU waits 3 to 5 us for
    /// each of its dispatches, so that the host may win on small plates. It takes some ten solves.
    /// \return the processor's time, then the host's; nothing where there is no choice, on the host and the reference
    std::vector<ProcessorTime> keepFaster(const PlateTrial& trial, const Clock& clock = {});

    /// Counts what was done so far.
    struct Counts {
        int takeovers = 0; ///< changes from the processor to another solver, or from one reason for that to another
        int memories  = 0; ///< allocations of a solver's memory: for another grid, number of loads or tolerance
        int attempts  = 0; ///< solves by multigrid, those that failed included
    };
    [[nodiscard]] Counts counts() const noexcept;

    /// Returns in a sentence without a full stop who took over last, and why, if there were more takeovers than
    /// `before`; else empty.
    [[nodiscard]] std::string takeoverSince(int before) const;

private:
    struct Multigrid;
    struct Learned;

    [[nodiscard]] std::unique_ptr<Multigrid> makeHost() const;
    [[nodiscard]] Multigrid&                 host(); ///< the host's multigrid, which takes over; made when first needed
    [[nodiscard]] Multigrid&                 bestFor(const Plate& plate, double tolerance, std::size_t footprints);

    /// Calls solve(multigrid) on the processor and, where that fails, on the host; and refer(), the reference, where
    /// that fails too or is known to. Of two answers that are not good enough it returns the better one.
    /// \param footprints  that are solved for together
    template <class Answer, class Solve, class Refer>
    [[nodiscard]] Answer byMultigrid(const Plate& plate, double tolerance, const Solve& solve, const Refer& refer,
                                     std::size_t footprints = 0);

    void takeHost();                               ///< for good
    void loseProcessor(const std::exception& why); ///< for good: the host is the processor then
    void noteTakeover(const std::string& by);      ///< for the reason in note_
    void noteSolvedBy(const std::string& solver);  ///< another one than before is a takeover
    [[nodiscard]] static std::vector<PlateSolution>
    byReference(const Plate& plate, std::span<const NodeField> nodalForces, double tolerance);
    [[nodiscard]] static FootprintSolution byReference(const Plate& plate, std::span<const Footprint> loads,
                                                       std::size_t whole, double tolerance);
    /// \return nothing if a factor does not pay, or is not exact enough
    [[nodiscard]] std::optional<FootprintSolution> byFactor(const Shell& shell, std::span<const Footprint> loads,
                                                            std::size_t whole, double tolerance);
    [[nodiscard]] FootprintSolution byProcessor(const Shell& shell, std::span<const Footprint> loads, std::size_t whole,
                                                double tolerance, double drawn, Stresses stresses);
    [[nodiscard]] static FootprintSolution byReference(const Shell& shell, std::span<const Footprint> loads,
                                                       std::size_t whole, double tolerance);

    SoftwareBits               bits_;
    std::unique_ptr<Multigrid> processor_; ///< null: the reference solver is used
    std::unique_ptr<Multigrid> host_;      ///< what takes over where the processor cannot; null: not needed yet
    std::unique_ptr<Learned>   learned_;   ///< from plates that could not be solved, or not where they should be
    std::list<DirectShell>     factors_;   ///< the newest first
    std::string                name_{kReference};
    std::string                note_;
    std::string                takeover_; ///< the last one, in a sentence
    int                        takeovers_ = 0, attempts_ = 0, memoriesOfLost_ = 0;
    std::string                counted_;             ///< reason of the takeover that was counted last
    bool                       othersSolve_ = false; ///< the last plate was solved by another than the processor
};

} // namespace palp
