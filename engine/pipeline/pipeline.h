#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/chart/chart.h"
#include "engine/chart/resample.h"
#include "engine/chart/sphere_fit.h"
#include "engine/cloud/soft_object.h"
#include "engine/contact/contact.h"
#include "engine/core/enum_names.h"
#include "engine/force/force_law.h"
#include "engine/pipeline/table_solve.h"
#include "engine/plate/plate.h"
#include "engine/plate/plate_solver.h"

namespace palp {

/// Scene constants: everything that decides what a touch feels like, apart from the object itself.
///
/// PatchWindow, footprint and area of contact are lengths, never derived from the points at the contact: on a homogeneous
/// object compliance is then exactly constant, and whatever the hand feels is in the object.
struct PatchSettings {
    double     foundation      = 0;     ///< k [Pa/m] of what lies below; 0: nothing (the paper)
    double     window          = 40e-3; ///< edge of the square of chart that bends [m]
    int        cells           = 64;    ///< of the grid along that edge, even [1]
    double     footprintRadius = 4e-3;  ///< of the fingertip [m]
    Map        map             = Map::lambertAzimuthal;
    Resampling sampling        = Resampling::logMean;
    PlateEdges edges{}; ///< of the window
    ForceLaw   forceLaw  = ForceLaw::series;
    double     tolerance = 1e-4; ///< of the plate's solution, relative; see PlateSolver::solve [1]
};

/// The two ways to run the pipeline; engine/method.md says how they differ.
enum class Preset {
    palpate, ///< what we hold to be right
    paper    ///< as Kumari & Chaudhuri published it
};
constexpr auto namesOf(Preset)
{
    using enum Preset;
    return std::to_array<NamedValue<Preset>>({{palpate, "palpate"}, {paper, "paper"}});
}

/// These settings with the preset's map, sampling, edges, foundation and force law.
/// `palpate` leaves the foundation as it is, `paper` removes it.
[[nodiscard]] PatchSettings withPreset(PatchSettings settings, Preset preset);

/// One line per respect in which the settings differ from the paper's method; empty for the preset `paper`.
[[nodiscard]] std::vector<std::string> differencesFromPaper(const PatchSettings& settings);

/// Milliseconds that each stage of deform() took.
struct StageTimes {
    double gather = 0, fit = 0, project = 0, resample = 0, prepare = 0, solve = 0, lift = 0;

    [[nodiscard]] double total() const noexcept { return gather + fit + project + resample + prepare + solve + lift; }
};

/// What a unit force at the contact does to the neighbourhood.
struct Patch {
    Contact         contact;
    SphereFitResult sphere;
    Chart           chart;
    bool            sideUnsure = false; ///< the finger's side was guessed, and the cloud is open there
    PatchWindow     window;
    Plate           plate;                 ///< rigidity at the nodes, edges, foundation
    double          spacing           = 0; ///< typical distance of neighbouring points of the cloud [m]
    double          thickness         = 0; ///< of the object at the contact [m]
    std::size_t     nodesWithoutPoint = 0; ///< see Resampled [1]
    NodeField       response;              ///< deflection per force at the nodes [m/N]
    double          compliance       = 0;  ///< c: response averaged over the footprint, work-conjugate [m/N]
    double          contactStiffness = 0;  ///< k_c [N/m]
    double          feltStiffness    = 0;  ///< [N/m]

    std::vector<std::uint32_t> gathered;      ///< points of the cloud around the contact
    std::vector<std::uint32_t> points;        ///< those on the near side, in the same order as the next two
    std::vector<ChartPoint>    positions;     ///< of `points` in the chart [m]
    std::vector<double>        pointResponse; ///< deflection per force of `points` [m/N]; 0 outside the window

    SolveReport report;
    StageTimes  times; ///< [ms]

    /// False if the points do not determine a surface; then nothing below `sphere` is filled in.
    [[nodiscard]] bool deformed() const noexcept { return sphere.usable(); }

    /// Unit vector along which a force presses [1]: into the surface.
    [[nodiscard]] glm::dvec3 forceDirection() const noexcept { return -chart.frame.normal; }
};

/// Section 2 of the paper on one clock: contact, neighbourhood, sphere, chart, rigidity, plate, points.
///
/// Solves for a force of 1 N on a smooth footprint about the contact; the plate is linear, so any force follows.
/// \param carried  chart axes of a neighbouring contact; empty: the chart's own
/// \throws Error if the plate cannot be solved (for example free on all sides), if the window holds next to nothing of
///         the cloud, or if the hand's direction runs along the surface
/// \thread as the device; announces factorisations of many seconds on a terminal
/// \source Kumari & Chaudhuri 2016, sections 2.1 to 2.6
/// \differs as differencesFromPaper() says of the settings; engine/method.md has every difference and why
[[nodiscard]] Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                           PlateSolver& device, const std::optional<Frame>& carried = {});

/// As above, with the plate solved by the reference solver.
[[nodiscard]] Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings);

/// The footprints of a table in the settings' window, with what the window does to them on a homogeneous object whose
/// rigidity is the geometric mean of the cloud's: a constant of the scene, to be made once.
/// \param side  1, 3, 5 or 7, see tableSide()
/// \throws Error if the window is too small for the table
[[nodiscard]] FootprintLattice footprintLattice(const SoftObject& object, const PatchSettings& settings, int side,
                                                PlateSolver& device);

struct PatchWithTable {
    Patch                          patch;
    std::optional<ComplianceTable> table; ///< about the patch's chart; empty if it is not deformed()
};

/// deform() for a hand that moves: solves for a lattice of footprints in the same window, so that the servo can look
/// up the compliance of wherever the contact is until the next patch comes; see ComplianceTracker.
///
/// The table's sequence number and time are the caller's to set.
/// \param contact  where the hand will be, see aheadOf()
/// \param lattice  of these settings
/// \param carried  chart axes of the patch before: tables then turn only as the surface does
/// \throws as deform()
[[nodiscard]] PatchWithTable deformWithTable(const SoftObject& object, const Contact& contact,
                                             const PatchSettings& settings, const FootprintLattice& lattice,
                                             PlateSolver& device, const std::optional<Frame>& carried = {});

/// The whole cloud under `force` [N] at the patch's contact: p_i + force * response_i * forceDirection.
/// \source Kumari & Chaudhuri 2016, eq. 9
/// \differs that equation is empty in print: what moves, how far and along what is ours
[[nodiscard]] std::vector<glm::dvec3> displaced(const PointCloud& cloud, const Patch& patch, double force);

/// Deflection of every point of the cloud under `force` [N], positive into the surface [m].
[[nodiscard]] std::vector<double> deflections(const PointCloud& cloud, const Patch& patch, double force);

/// How far the compliance is from its limit of fine grids, relative [1]: the change of c from a grid twice as coarse,
/// divided by 3 (Richardson, second order). Empty if the cells are not a multiple of 4 or the footprint is too small.
[[nodiscard]] std::optional<double> discretisationError(const Patch& patch, const PatchSettings& settings,
                                                        PlateSolver& device);

/// What a user must know about a result, in sentences: where theory or data end. Empty is good.
[[nodiscard]] std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force);

} // namespace palp
