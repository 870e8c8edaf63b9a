#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/chart/chart.h"
#include "engine/chart/curvature_field.h"
#include "engine/chart/resample.h"
#include "engine/chart/sphere_fit.h"
#include "engine/cloud/coarse_object.h"
#include "engine/cloud/soft_object.h"
#include "engine/contact/contact.h"
#include "engine/core/enum_names.h"
#include "engine/force/force_law.h"
#include "engine/plate/large_law.h"
#include "engine/plate/plate.h"
#include "engine/plate/plate_solver.h"

namespace palp {

struct BodyOnWindow;

/// The points near the contact that make the chart and give the plate its rigidity.
enum class Neighbourhood {
    surface, ///< the piece of surface that hangs together with the contact, nearer points counting more
    ball     ///< all points in a ball, alike: the paper's. A thin body's other side takes part
};
constexpr auto namesOf(Neighbourhood)
{
    using enum Neighbourhood;
    return std::to_array<NamedValue<Neighbourhood>>({{surface, "surface"}, {ball, "ball"}});
}

/// The ways in which a thin sheet resists.
enum class Theory {
    plate, ///< it bends as if it were flat: the paper's
    shell  ///< where it is curved its membrane resists too; see Shell
};
constexpr auto namesOf(Theory)
{
    using enum Theory;
    return std::to_array<NamedValue<Theory>>({{plate, "plate"}, {shell, "shell"}});
}

/// What a patch window spans.
enum class WindowOf {
    contact, ///< a square of fixed size about the contact, whose sides hold it: the paper's
    object, ///< the whole object, as far as the chart can carry it: its own borders are free, and what is held holds it
    dent    ///< a square of 8 or more lengths over which a dent of this object dies away, see dentWindow()
};
constexpr auto namesOf(WindowOf)
{
    using enum WindowOf;
    return std::to_array<NamedValue<WindowOf>>({{contact, "contact"}, {object, "object"}, {dent, "auto"}});
}

/// Whether a sheet that is pressed further than some half of its thickness resists in another way.
enum class Large {
    off, ///< the linear theory, however far: the paper's
    on   ///< flat sheets harden and domes give way, see LargeLaw
};
constexpr auto namesOf(Large)
{
    using enum Large;
    return std::to_array<NamedValue<Large>>({{off, "off"}, {on, "on"}});
}

/// What is known of the object outside of a patch window.
enum class Outside {
    unknown, ///< the window's edges stand for it: the paper's
    body     ///< the window is clamped and cut from the object as a whole, see BodyShell: its edges move as that does
};

/// The constants of a scene that decide what a touch feels like, apart from the object itself.
///
/// Patch window, footprint and area of contact are lengths that are never derived from the points at the contact. So
/// the compliance of a homogeneous object is exactly constant, and everything that the hand feels is in the object.
struct PatchSettings {
    double        foundation = 0;     ///< k [Pa/m] of what lies below; 0: nothing (the paper)
    double        window     = 40e-3; ///< edge of the square of chart that bends [m]; of an object see settledFor()
    WindowOf      windowOf   = WindowOf::contact;
    int           cells      = 64;        ///< of the grid along that edge, an even number
    double        footprintRadius = 4e-3; ///< of the fingertip [m]
    Map           map             = Map::lambertAzimuthal;
    Neighbourhood neighbourhood   = Neighbourhood::surface;
    Resampling    resampling      = Resampling::logMean;
    Theory        theory          = Theory::plate;
    Large         large           = Large::off;
    PlateEdges    edges{}; ///< of the window; of a shell that is cut from a larger body best all supported
    ForceLaw      forceLaw  = ForceLaw::series;
    double        tolerance = 1e-4;             ///< of the plate's solution, relative; see PlateSolver::solve [1]
    Outside       outside   = Outside::unknown; ///< see settledFor()
    bool          isSettled = false;            ///< window and cells are those of settledFor()
};

/// Returns the settings with the window and the cells of this object: as they are, unless the window is chosen by what
/// it spans. One of a dent is as dentWindow() says; that takes milliseconds, so settle once before many touches. One
/// of the object is twice as wide as the object is across, as far as extentOf() finds that, so that it holds all of it
/// about any contact, however it is turned. Its cells are as wide as `window` and `cells` say, but no finer than a
/// fourth of the fingertip, and 128 of them or more, half of `cells`, go into the length of a strip that spreads as far
/// as the object; there are 512 at most. Its sides, in the void, are free. A second time changes nothing.
///
/// Whether it is cut from a body says isCutFromBody().
[[nodiscard]] PatchSettings settledFor(const SoftObject& object, const PatchSettings& settings);

/// Returns whether patch windows are to be cut from the object as a whole where something holds it: the theory is a
/// shell's, the window is one of the contact or of a dent with its edges supported, as they are by default, and nothing
/// lies below.
[[nodiscard]] bool asksForBody(const PatchSettings& settings) noexcept;

/// Returns whether they are, see Outside::body: the object has a coarse shell as well, see bodyShellOf().
/// \note takes some tenths of a second the first time
[[nodiscard]] bool isCutFromBody(const SoftObject& object, const PatchSettings& settings);

/// Returns the edges of a window's plate: those that the settings say, or clamped ones of a window that is cut from a
/// body.
[[nodiscard]] PlateEdges edgesOfWindow(const PatchSettings& settings) noexcept;

/// Returns how wide that is which bends [m]: the window, or an object that it spans, which takes up half of it.
[[nodiscard]] double bentSize(const SoftObject& object, const PatchSettings& settings);

/// The milliseconds that each stage of deform() took.
struct StageTimes {
    double gather = 0, fit = 0, project = 0, resample = 0, prepare = 0, solve = 0, lift = 0;

    [[nodiscard]] double total() const noexcept { return gather + fit + project + resample + prepare + solve + lift; }
};

/// Where a patch is pressed that movePatch() has moved on.
struct PressedElsewhere {
    ChartPoint place{}; ///< in the patch's chart [m]
    Chart      chart;   ///< about the contact
};

/// The response of the neighbourhood to a unit force at the contact.
struct Patch {
    Contact         contact;
    SphereFitResult sphere;
    Chart           chart;
    bool            sideUnsure = false; ///< the finger's side was guessed, and the cloud is open there
    bool            normalFelt =
        false;           ///< the points around determine no surface that agrees with the hand's: the proxy's is taken
    double unrolled = 0; ///< share of the exponential map in the positions [1]; 0: the sphere follows the surface
    std::optional<PressedElsewhere> moved{}; ///< empty: it is pressed in the middle of its window
    PatchWindow                     window;
    Plate                           plate; ///< rigidity at the nodes, edges, foundation
    NodeField
        membraneCompliance{}, ///< 1/(E h) at the nodes [m/N], where the settings ask for a shell or large deflections
        stressBed{};          ///< see Shell::stressBed; empty: the object does not end in the window
    std::vector<NodeField> thrusts{};              ///< see Shell::thrusts
    int                    thrustsLeftOut = 0;     ///< see FreePieces::leftOut
    int                    tied           = 0;     ///< see HeldInPlane
    bool                   spans          = false; ///< it is held in several places, or by what surrounds it
    bool                   isCut          = false; ///< from a body whose movement is known, see Outside::body
    /// Of the surface at the nodes, if it bent as a shell; empty: as a plate.
    std::optional<CurvatureField> curvature;
    std::string flatBecause; ///< why it bent as a plate although a shell was asked for; empty: it need not
    std::pair<double, double> principal{}; ///< curvatures at the contact, the larger by size first; 0 without a shell
                                           ///< [1/m] > 0: bulges to the finger
    double      shellLength = 0; ///< l over which a dent dies away, a foundation included [m]; 0 without a shell
    double      below       = 0; ///< k of what lies below, its mean over the window without what is held [Pa/m]
    double      sag         = 0; ///< of the touched surface across the patch window, over its width [1]; of a shell
    double      spacing     = 0; ///< typical distance of neighbouring points at the contact [m]
    double      noise       = 0; ///< standard deviation of the points there about the surface [m]
    double      thickness   = 0; ///< of the object at the contact [m]
    std::size_t nodesWithoutPoint = 0;                                       ///< see Resampled
    double      bareFrom          = std::numeric_limits<double>::infinity(); ///< [m] likewise
    NodeField   inside{}; ///< how deep the nodes lie within the object's border where the window spans it [m], see
                          ///< depthWithin(); empty: there is no border
    NodeField covered{};  ///< share of the sheet at the nodes, where the window spans the object [1]; empty: all
    double    beyond = 1; ///< rigidity beyond the sheet's border over the sheet's [1]; 1: there is no border
    NodeField
        held{}; ///< share of each node that the scene holds, by a foundation and in the sheet's plane: from 0 to 1 over
                ///< a cell [1]; empty: none
    NodeField   heldInPlane{}; ///< the same in the sheet's plane, where its membrane counts, see heldInPlane()
    std::size_t heldNodes = 0; ///< nodes that the scene holds, of the piece that is touched
    double      apart     = 0; ///< share of the sheet in pieces that are not touched [1]
    NodeField   sheared{};     ///< see Shell, where the window spans the object
    /// The force of the plate alone over the depth of the dent, if the settings ask for it; empty: it is linear.
    std::optional<LargeLaw>             large;
    std::string                         linearBecause; ///< why it is not there although it was asked for
    NodeField                           response;      ///< deflection per force at the nodes [m/N]
    std::shared_ptr<const BodyOnWindow> body{}; ///< that the window is cut from, where the settings know it; else null
    double                              bodyCompliance = 0; ///< of a body that the window is cut from, in series [m/N]
    double                              twist          = 0; ///< by which free borders resist less, part of c [m/N]
    double    curvedBending    = 1; ///< what the response is of the shallow theory's, see givesWay()
    double    compliance       = 0; ///< c: response averaged over the footprint, and the body's [m/N]
    double    contactStiffness = 0; ///< k_c [N/m]
    double    feltStiffness    = 0; ///< [N/m]
    double    stiffening       = 0; ///< b under the footprint [1/m], see DepthLaw
    NodeField stiffeningAtNodes;    ///< [1/m]; empty: b is the same everywhere

    /// The object that was touched in place of one far denser than the grid; empty: the object itself. The points below
    /// are its.
    std::shared_ptr<const CoarseObject> coarse;

    std::vector<std::uint32_t> gathered;  ///< points around the contact
    std::vector<std::uint32_t> points;    ///< those that may move, in the same order as the next three; first `touched`
    std::vector<ChartPoint>    positions; ///< of `points` in the chart [m]
    std::vector<ChartPoint> followed; ///< places in the chart whose deflections `points` have, see placesFollowed() [m]
    std::size_t touched = 0; ///< number of `points` on the touched surface, which alone give the plate its rigidity
    std::vector<double>
        pointResponse; ///< deflection per force of `points` [m/N]; 0 where they follow no place in the window

    SolveReport report;
    StageTimes  times; ///< [ms]

    /// Returns false if the points do not determine a surface; then nothing below `sphere` is filled in.
    [[nodiscard]] bool deformed() const noexcept { return sphere.usable(); }

    /// Returns the unit vector along which a force presses: into the surface.
    [[nodiscard]] glm::dvec3 forceDirection() const noexcept { return -(moved ? moved->chart : chart).frame.normal; }
};

/// Returns the object that the patch's points are of.
[[nodiscard]] const SoftObject& usedOf(const Patch& patch, const SoftObject& object) noexcept;

/// Returns the place in the patch's chart that is pressed [m]: its origin, unless the patch was moved.
[[nodiscard]] ChartPoint pressedPlace(const Patch& patch) noexcept;

/// Returns the chart about the contact: the patch's, unless it was moved.
[[nodiscard]] const Chart& chartAtContact(const Patch& patch) noexcept;

/// A node of a patch's grid, by its number along each axis.
struct GridNode {
    int i = 0, j = 0;
};

/// Returns the node nearest to what is pressed.
[[nodiscard]] GridNode nodeAtContact(const Patch& patch) noexcept;

/// Returns whether a node lies on the sheet, not beyond a border of an object that the window spans.
/// \param covered  share of the sheet at the nodes [1]; empty: it is everywhere
[[nodiscard]] bool isOnSheet(const NodeField& covered, std::size_t node);
[[nodiscard]] bool isOnSheet(const Patch& patch, std::size_t node);

/// Returns the rigidity of the sheet at the nodes [N m], also beyond a border, where the plate has next to none.
[[nodiscard]] NodeField sheetRigidity(const Patch& patch);

/// Returns the sheet's flexural rigidity at the contact [N m].
[[nodiscard]] double rigidityAtContact(const Patch& patch);

/// Returns the least and the largest rigidity of the sheet at the nodes that the object covers [N m], and how many they
/// are.
[[nodiscard]] std::pair<double, double> rigiditiesOfSheet(const Patch& patch);
[[nodiscard]] std::size_t               nodesOfSheet(const Patch& patch);

/// Returns what is felt of the body's compliance [m/N]: all where the window is cut from it, nothing where a scene
/// holds an edge, or it is free.
[[nodiscard]] double bodyFelt(const Patch& patch) noexcept;

/// Returns the largest deflection per force of the object [m/N]; nodes beyond its border do not count.
[[nodiscard]] double mostResponse(const Patch& patch);

/// Returns how wide that is which bends [m], see bentSize() above.
[[nodiscard]] double bentSize(const Patch& patch);

/// Returns "at (0.012, 0, 0.03) m", which opens complaints about a touch there.
[[nodiscard]] std::string placeText(const Contact& contact);

/// Refuses a patch whose points determine no surface.
/// \throws Error naming the place, unless patch.deformed()
void demandDeformed(const Patch& patch, const char* hint = "try a larger --window, or check --length-unit");

/// Refuses an answer that is not as good as asked for.
/// \throws Error naming the place, unless patch.report.converged
void demandConverged(const Patch& patch);

/// Refuses an answer that is no answer: its error is a tenth of it or more, or nobody knows it. One that merely misses
/// the tolerance has a warning.
/// \throws Error naming the place
void demandUsable(const Patch& patch);

/// Returns a unit vector as complaints and warnings show it: "0.00,0.60,0.80".
[[nodiscard]] std::string directionText(const glm::dvec3& direction);

/// Returns the deflection per force at a place in the chart [m/N]; 0 outside the window.
[[nodiscard]] double responseAt(const Patch& patch, const ChartPoint& place);
/// Returns the same for many places, in a fraction of the time.
[[nodiscard]] std::vector<double> responsesAt(const Patch& patch, std::span<const ChartPoint> places);

/// Calls visit(point of the cloud, the place in the chart that it follows [m], its deflection per force [m/N]) for
/// every point that may move.
/// \param positions  [m] of the cloud at rest
void eachMoving(const Patch& patch, std::span<const glm::dvec3> positions,
                const std::function<void(std::uint32_t, const ChartPoint&, double)>& visit);

/// Returns the whole cloud under `force` [N] at the patch's contact: p_i + force * response_i * forceDirection.
/// \source Kumari & Chaudhuri 2016, eq. 9
/// \differs that equation is empty in print: what moves, how far and in which direction is ours
[[nodiscard]] std::vector<glm::dvec3> displaced(const PointCloud& cloud, const Patch& patch, double force);

/// Returns the deflection of every point of the cloud under `force` [N], positive into the surface [m].
[[nodiscard]] std::vector<double> deflections(const PointCloud& cloud, const Patch& patch, double force);

} // namespace palp
