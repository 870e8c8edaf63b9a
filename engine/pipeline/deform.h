#pragma once
#include <optional>

#include "engine/pipeline/compliance_table_solve.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Does beforehand what the first touch of a very dense object would wait for, up to a second.
void prepareTouch(const SoftObject& object, const PatchSettings& settings);

/// Runs section 2 of the paper on one clock: contact, neighbourhood, sphere, chart, rigidity, plate, points.
///
/// The plate is solved for a force of 1 N on a smooth footprint about the contact; it is linear, so any force follows.
/// \param carried  chart axes of a neighbouring contact; empty: the chart's own
/// \throws Error if the plate cannot be solved (for example free on all sides), if the patch window holds next to
///         nothing of the cloud, or if the hand's direction runs along the surface
/// \thread that of the solver; announces factorisations of many seconds on a terminal
/// \source Kumari & Chaudhuri 2016, sections 2.1 to 2.6
/// \differs as differencesFromPaper() lists for the settings; engine/method.md has every difference and its reason
[[nodiscard]] Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                           PlateSolver& solver, const std::optional<Frame>& carried = {});

/// Does the same, with the plate solved by the reference solver.
[[nodiscard]] Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings);

/// Does what deform() does up to the plate, with nothing solved: a window in which movePatch() presses.
[[nodiscard]] Patch windowAbout(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                                const std::optional<Frame>& carried = {});

struct PatchWithTable {
    Patch                          patch;
    std::optional<ComplianceTable> table; ///< about the patch's chart; empty if it is not deformed()
};

/// Does what deform() does, for a hand that moves: it solves for a lattice of footprints in the same window, so that
/// the servo can look up the compliance wherever the contact is until the next patch comes; see ComplianceTracker.
///
/// The caller sets the table's sequence number and time.
/// \param contact  where the hand will be, see aheadOf()
/// \param lattice  of these settings
/// \param carried  chart axes of the patch before: tables then turn only as the surface does
/// \throws Error as deform()
[[nodiscard]] PatchWithTable deformWithTable(const SoftObject& object, const Contact& contact,
                                             const PatchSettings& settings, const FootprintLattice& lattice,
                                             PlateSolver& solver, const std::optional<Frame>& carried = {});

/// Does the same into a table that is there: the one that the servo will read. It is written if the patch is
/// deformed().
[[nodiscard]] Patch deformWithTable(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                                    const FootprintLattice& lattice, PlateSolver& solver,
                                    const std::optional<Frame>& carried, ComplianceTable& table);

/// Estimates how far the compliance is from its limit of fine grids, relative [1]: the change of c from a grid twice as
/// coarse, divided by 3 (Richardson, second order). Empty if the cells are not a multiple of 4 or the footprint is too
/// small.
[[nodiscard]] std::optional<double> discretisationError(const Patch& patch, const PatchSettings& settings,
                                                        PlateSolver& solver);

/// Felt stiffness of a shell [N/m] by how the surface beyond its window holds it.
struct SupportRange {
    double supported = 0; ///< cut from a larger body: no deflection, and no strain along the edge
    double clamped   = 0; ///< held as firmly as can be
    double least     = 0; ///< supported at the edge of a wider window, where that is softer: as far as the object goes
    double width     = 0; ///< of that window [m]
};

/// Touches the same place with supported and with clamped edges on all sides, and with supported ones of wider windows;
/// each window turns as it does for its edges. Where a surface is curved one way, or both ways against each other, a
/// dent reaches as far as the object does, and its support decides between `least` and `clamped`; where it bulges both
/// ways and the window is some eight lengths wide, all are nearly alike.
/// \return empty if the settings ask for no shell, or the window spans an object, which has supports of its own
/// \param object, settings  that the patch was made with
[[nodiscard]] std::optional<SupportRange> supportRange(const SoftObject& object, const Patch& patch,
                                                       const PatchSettings& settings, PlateSolver& solver);

} // namespace palp
