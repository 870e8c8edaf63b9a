#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "engine/force/compliance_table.h"
#include "engine/pipeline/patch.h"
#include "engine/plate/footprint.h"
#include "engine/plate/plate_solver.h"

namespace palp {

struct ShellWindows;

/// Size and number of a table's footprints: a constant of the scene.
struct FootprintTable {
    double radius             = 4e-3; ///< of a footprint, and their spacing [m]
    int    side               = 3;    ///< footprints along each axis: 1, 3, 5 or 7, see tableSide()
    double contactPerRigidity = 0;    ///< k_c over D: 12 (1 - nu^2) pi R^2 / h^4 [1/m^2]
};

/// The footprints of a table in one patch window: a constant of the scene, made once.
///
/// A footprint off the middle feels the window's edge (2 % at a twentieth of the width without foundation), and the
/// phase of the grid under it. The effect of a plate of constant rigidity on each is kept here and taken out of every
/// table: on a homogeneous object tables are then flat to the last bit. On a foundation it depends on the rigidity (the
/// corner of 7 x 7 footprints reads 3 % less where D is three times as large, and the window 9 l instead of 12), so it
/// is kept for a ladder of rigidities, and a plate takes that of its geometric mean.
struct FootprintLattice {
    FootprintTable         shape{};
    std::vector<Footprint> loads{};        ///< 1 N each, in the order of ComplianceTable's entries
    double                 rigidity   = 1; ///< D of the middle rung [N m]
    double                 foundation = 0; ///< k of the homogeneous windows [Pa/m]
    /// ln c(e)/c(0) of homogeneous windows, with its slopes, by rigidity; one rung without a foundation.
    std::vector<ComplianceTable::Entries> rungs{};
    std::vector<double>                   middles{}; ///< ln c in their middle, of a shell about as curved as the object
    bool   wholeObject = false; ///< the window spans the object: what its borders do to a footprint stays in
    double feltRadius  = 0;     ///< root mean square radius of the bending energy, in the middle rung [m]
    std::shared_ptr<ShellWindows> shells{}; ///< of homogeneous ones in this window, as they are met

    /// Returns the entries for a plate whose rigidity has this geometric mean [N m]: linear between rungs, the last one
    /// beyond them.
    [[nodiscard]] ComplianceTable::Entries homogeneous(double meanRigidity) const;

    /// Returns ln c in the middle of a homogeneous window of this rigidity [N m]: linear between rungs and beyond them;
    /// without a foundation c is 1/D exactly.
    [[nodiscard]] double lnCompliance(double ofRigidity) const;
    [[nodiscard]] bool   onFoundation() const noexcept { return middles.size() > 1; }
};

/// Returns the place on a plate, from its middle [m], of a place in a table.
using PlaceOnPlate = std::function<ChartPoint(const ChartPoint&)>;

/// Makes the footprints of a table whose places lie elsewhere on a plate, with their changes along the table's axes.
/// \throws Error if a footprint does not lie wholly on the plate
[[nodiscard]] std::vector<Footprint> footprintsAt(const PlateGrid& grid, const FootprintTable& shape,
                                                  const PlaceOnPlate& placeOf);

/// Solves the lattice of the settings' window on a homogeneous object of the geometric mean of this one's rigidity.
/// \param side  1, 3, 5 or 7, see tableSide()
/// \throws Error if the patch window is too small for the table
[[nodiscard]] FootprintLattice footprintLattice(const SoftObject& object, const PatchSettings& settings, int side,
                                                PlateSolver& solver);

/// Solves the lattice of one patch window.
/// \param homogeneous  the window: grid, edges, foundation, and one rigidity throughout, in the middle of what is to
///                     come
/// \param tolerance    as for the tables themselves: the error that iteration leaves is then taken out too
/// \param wholeObject  the window spans the object: nothing of a homogeneous window is to be taken out of its tables
/// \param curved       l^-4 of a shell [1/m^4]: under the ladder's middles it stands for the membrane, because a dome
///                     gives way as a plate on a foundation of D/l^4 does (Reissner 1946)
/// \throws Error if a footprint does not lie wholly on the plate
[[nodiscard]] FootprintLattice solveLattice(const Plate& homogeneous, const FootprintTable& shape, PlateSolver& solver,
                                            double tolerance, bool wholeObject = false, double curved = 0);

/// Returns k of a plate's foundation, its geometric mean over the nodes [Pa/m].
[[nodiscard]] double meanFoundation(const Plate& plate);

struct TableSolution {
    ComplianceTable table;      ///< without sequence number, time and chart
    PlateSolution   middle;     ///< under 1 N in the middle
    double          compliance; ///< c there [m/N]
};

/// Solves the self-compliances of all footprints on one plate: the middle to the tolerance, and the others so far that
/// their c is right to it, see PlateSolver::solveFootprints().
///
/// c(q) = p_q . w_q with A w_q = p_q. A is symmetric, so that dc/dq = 2 (dp_q/dq) . w_q: slopes need no further solve.
/// k_c(q) is that of the rigidity's geometric mean over the footprint, see rigidityUnder(): at a step of the object it
/// then changes over the width of a footprint, as c does.
/// \throws Error as PlateSolver::solveFootprints()
[[nodiscard]] TableSolution solveTable(const Plate& plate, const FootprintLattice& lattice, PlateSolver& solver,
                                       double tolerance);

/// The solution in the middle of a table.
struct MiddleSolution {
    PlateSolution solution;   ///< under 1 N
    double        compliance; ///< c there, of the shallow theory [m/N]
    double        curved = 1; ///< what c is of that, see givesWay() [1]
    NodeField     stress{};   ///< Airy's function of a shell, where it was asked for [N m]
};

/// Does the same into a table that is there, so that who reads it needs no copy. Its sequence number, time and chart
/// stay as they are.
/// \param below  k of what lies below, its mean over the window without what is held [Pa/m], as meanFoundation() has it
[[nodiscard]] MiddleSolution solveTable(const Plate& plate, double below, const FootprintLattice& lattice,
                                        PlateSolver& solver, double tolerance, ComplianceTable& table);

/// Does the same on a shell. What the window does to footprints off its middle, and the phase of the grid, are those of
/// a shell of the mean rigidity and curvature, to a step of 2 %, which is solved as well and kept with the lattice.
[[nodiscard]] MiddleSolution solveTable(const Shell& shell, double below, const FootprintLattice& lattice,
                                        PlateSolver& solver, double tolerance, ComplianceTable& table,
                                        Stresses stresses = Stresses::none);

/// Returns the geometric mean of a rigidity under a footprint, weighted as the load is [N m]: that from which the
/// stiffness of the contact follows, and exactly the rigidity where all nodes are alike.
/// \pre the footprint presses somewhere
[[nodiscard]] double rigidityUnder(const Footprint& footprint, const NodeField& rigidity);

/// Fills in the stiffness of the contact under each footprint: of the geometric mean of the rigidity, weighted as the
/// load is.
/// \param rigidity  of the sheet at the nodes [N m]
void fillContact(const NodeField& rigidity, const FootprintLattice& lattice, ComplianceTable& table);

/// Fills in how the force stiffens under each footprint: the mean of b, weighted as the load is.
/// \param stiffening  b at the nodes [1/m]; empty: the table does not say it
void fillStiffening(const NodeField& stiffening, const FootprintLattice& lattice, ComplianceTable& table);

} // namespace palp
