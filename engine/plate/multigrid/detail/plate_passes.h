#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/compute/buffer.h"
#include "engine/compute/command_list.h"
#include "engine/plate/multigrid/detail/chebyshev.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/multigrid/detail/plate_kernels.h"
#include "engine/plate/multigrid/detail/plate_tail.h"
#include "engine/plate/multigrid/detail/rigidity_layout.h"
#include "engine/plate/multigrid/detail/rim.h"

namespace palp {

/// The memory of a level on the processor. `real` arrays are doubles where the processor has them.
struct LevelBuffers {
    compute::Binding rigidity; ///< and behind it, if the plate has one, the shape of the foundation
    compute::Binding divisor;
    compute::Buffer  tableX, tableZ;
    compute::Buffer  force, w[2];  ///< of the cycle, floats
    compute::Binding marks, tiles; ///< where the rigidity jumps: a flag per tile; number of tiles, then their indices
    compute::Buffer  load;         ///< force of the nested iteration, floats

    // Conjugate gradients run on one level after another, and all levels share the memory of the finest one's. An
    // answer and its residual change places from level to level: a level interpolates the answer of the next coarser
    // one, and needs its residual's memory only when that answer has been used.
    const compute::Buffer &answer, &left, &direction, &forces; ///< x, r, p, A p, real
    const compute::Buffer &otherDirection, &otherLeft; ///< real: where the schedule is fused, every second p and r

    /// In a cycle A p is not computed yet: its memory holds the residual, in floats, or deflections that are set aside.
    [[nodiscard]] const compute::Buffer& residual() const noexcept { return forces; }
};

/// The cost of recorded passes.
struct PlateWork {
    double           nodes = 0;  ///< number of nodes to which the operator was applied
    std::vector<int> tileSweeps; ///< per level, sweeps of the tiles where the rigidity jumps
};

/// The sharpness of the rigidity's variation from node to node.
enum class Jumps {
    none,
    some,
    strong, ///< more extra sweeps
    rims    ///< no extra sweeps: the nodes around jumps are solved for exactly
};

/// Records the multigrid method as passes over the levels' memory, which the solver joins to command lists.
///
/// Recording changes only `work` and the table of sizes; the memory changes when a list runs. Recording decides whether
/// there are extra sweeps where the rigidity jumps; the run decides in which tiles.
/// \thread as its context
class PlatePasses {
public:
    PlatePasses(compute::Context& context, const PlateKernels::All& kernels, GridHierarchy grids, std::uint32_t loads);

    /// Adds passes to a list. `stoppable` ones become empty once the solve is finished.
    struct Recorder {
        PlatePasses&          passes;
        compute::CommandList& list;
        bool                  stoppable = false;

        void operator()(const compute::Kernel& kernel, const compute::Bindings& bindings, const compute::Push& push,
                        compute::Groups groups);
    };

    /// Computes coarser rigidities, divisors, the tiles with a jump and the factor of the coarsest level.
    void prepareRigidity(Recorder& pass);
    /// Computes an answer on the finest level from those on the coarser ones, and its residual: nested iteration.
    void iterateNested(Recorder& pass);
    /// Computes the residual of the answer of level l.
    void computeResidual(Recorder& pass, std::size_t l);
    /// Takes steps of conjugate gradients on level l.
    /// \param begins  as in shared::ScalarsPush
    void takeGradientSteps(Recorder& pass, std::size_t l, int count, int sweeps, std::uint32_t begins,
                           double tolerance);
    /// Enables the steps of a list, and must come before them: none is stopped yet, and they sweep the tiles that
    /// prepareRigidity() found.
    void enableSteps(compute::CommandList& list) const;

    /// Sets how many extra sweeps the lists recorded from now on have where the rigidity jumps; with fewer, jumps take
    /// more steps.
    void expectJumps(Jumps expected) noexcept { jumps_ = expected; }
    /// Factors the rims of the last rigidity for Jumps::rims.
    /// \param inDoubles    at once: else floats are tried first
    /// \param workPerNode  that may be spent, of the finest level [multiplications]
    /// \return whether that is enough, and rounding spares the factors
    [[nodiscard]] bool factorRims(bool inDoubles, double workPerNode);
    /// Returns whether the last prepareRigidity() that ran found jumps on the finest level.
    [[nodiscard]] bool foundJumps() const;
    /// Returns whether the last prepareRigidity() that ran found a part of the plate that is so loosely held that
    /// rounding hides it.
    [[nodiscard]] bool isTooSoft() const;
    /// Counts the work in applications of the operator on the finest grid, with the tiles of the last
    /// prepareRigidity().
    [[nodiscard]] double workUnits(const PlateWork& of) const;
    [[nodiscard]] int    dispatchesPerCycle() const noexcept { return dispatchesPerCycle_; } ///< as last recorded

    [[nodiscard]] const shared::PlateLevel& level(std::size_t l) const { return grids_.levels[l].plate; }
    [[nodiscard]] std::size_t               nodes() const; ///< of the finest level, of one load
    [[nodiscard]] std::uint32_t             partials() const noexcept { return partials_; } ///< per dot product
    [[nodiscard]] compute::Groups           inOrder(const compute::Kernel& kernel, std::size_t l) const;

    std::vector<LevelBuffers> levels; ///< finest first
    compute::Buffer           state;  ///< real, see compute_shaders/shared/cg_state.h
    PlateWork                 work;   ///< of what was recorded since it was last set to {}

private:
    static constexpr std::size_t kSizes     = 256; ///< of dispatches, in the table; a list has about 60
    static constexpr std::size_t kSizeBytes = 12;  ///< three words

    [[nodiscard]] std::size_t                  fieldSize(std::size_t l) const;
    [[nodiscard]] std::size_t                  bandSize() const;
    [[nodiscard]] compute::Buffer              floats(const std::string& name, std::size_t count) const;
    [[nodiscard]] compute::Buffer              reals(const std::string& name, std::size_t count) const;
    [[nodiscard]] std::vector<compute::Buffer> makeGradients() const;
    [[nodiscard]] std::vector<LevelBuffers>    makeLevels() const;
    void                                       uploadTables();

    [[nodiscard]] std::size_t     argumentsFor(compute::Groups groups);
    void                          setGroups(std::size_t offset, compute::Groups groups);
    [[nodiscard]] compute::Groups everyNode(const compute::Kernel& kernel, std::size_t l) const;
    [[nodiscard]] compute::Groups sharedByGroups(std::size_t l) const;
    [[nodiscard]] compute::Groups everySecondNode(const compute::Kernel& kernel, std::size_t l) const;
    void                          countWork(std::size_t l, double applications);
    [[nodiscard]] std::size_t     argumentBytes() const { return kSizeBytes * (kSizes + grids_.levels.size()); }
    [[nodiscard]] std::size_t     tileArgument(std::size_t l) const { return kSizeBytes * (kSizes + l); }
    /// Returns whether levels are smoothed in plate_down.comp, plate_up.comp and the tail, which have no extra sweeps.
    [[nodiscard]] bool isFused() const noexcept { return tail_ && jumps_ == Jumps::none; }

    [[nodiscard]] int smoothFromZero(Recorder& pass, std::size_t l, int sweeps);
    [[nodiscard]] int smoothInReverse(Recorder& pass, std::size_t l, int at, int sweeps);
    [[nodiscard]] int sweepBothColours(Recorder& pass, std::size_t l, int at, std::uint32_t first, bool fromZero);
    [[nodiscard]] int takeChebyshevStep(Recorder& pass, std::size_t l, int at, const ChebyshevStep& how);
    enum class Swept { all, allFromZero, tiles };
    [[nodiscard]] int sweepRegions(Recorder& pass, std::size_t l, int at, int sweeps, std::uint32_t first, Swept what);
    [[nodiscard]] int sweepTiles(Recorder& pass, std::size_t l, int at, std::uint32_t first);
    void              solveFirstRim(Recorder& pass, std::size_t l, int at);
    void              solveLastRim(Recorder& pass, std::size_t l, int at);
    [[nodiscard]] int smoothFirst(Recorder& pass, std::size_t l, int sweeps, bool rimIsSolved);
    [[nodiscard]] int runCycle(Recorder& pass, std::size_t l, int sweeps, bool rimIsSolved = false);
    [[nodiscard]] compute::Groups regionsOf(std::size_t l, int rim) const;
    void                          goDown(Recorder& pass, std::size_t l, int sweeps, int step = 1);
    [[nodiscard]] int             runFusedCycle(Recorder& pass, std::size_t l, int sweeps);
    void takeFusedSteps(Recorder& pass, std::size_t l, int count, int sweeps, std::uint32_t begins, double tolerance);
    void takeTailStep(Recorder& pass, std::size_t l, int sweeps, int step, std::uint32_t begins, float tolerance);
    void takeRegionStep(Recorder& pass, std::size_t l, int sweeps, int step, std::uint32_t begins, float tolerance);
    [[nodiscard]] const compute::Buffer& directionOf(std::size_t l, int step) const;
    void                      probe(Recorder& pass, std::size_t l, const compute::Buffer& z, int step, float tolerance);
    void                      prepareFused(Recorder& pass);
    void                      solveTail(Recorder& pass, std::size_t l, int sweeps, const compute::Buffer& force);
    [[nodiscard]] std::size_t beginNested(Recorder& pass);

    compute::Context&        context_;
    const PlateKernels::All& k;
    GridHierarchy            grids_;
    RigidityLayout           layout_;
    std::uint32_t            loads_, partials_;

    compute::Buffer                rigidity_, divisor_, marks_, tiles_; ///< of all levels, see RigidityLayout
    std::vector<compute::Buffer>   gradients_;                          ///< the memory of conjugate gradients
    std::optional<compute::Buffer> zeroes_; ///< a deflection of zero, for the first sweep in red and black
    compute::Buffer                band_, factor_, lost_, sums_, arguments_, hostArguments_, hostTiles_;
    std::vector<Rim>               rims_;                ///< by level, where the kernels solve them
    std::vector<compute::Buffer>   rimViews_;            ///< a RimView each
    std::optional<PlateTail>       tail_;                ///< if the schedule is fused
    std::optional<compute::Buffer> groupSums_, tickets_; ///< likewise: see cg_last_group.glsl
    std::optional<compute::Buffer> layoutLevels_;        ///< likewise
    Jumps                          jumps_              = Jumps::none;
    int                            dispatchesPerCycle_ = 0;
    std::map<std::array<std::uint32_t, 3>, std::size_t> argumentAt_; ///< groups -> byte offset in `arguments_`
};

} // namespace palp
