#include "engine/pipeline/patch_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/extremes.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/detail/body_on_window.h"
#include "engine/plate/report_text.h"

namespace palp {
namespace {

/// Returns the width beyond which the edges of a patch window on a foundation are not felt [m]; empty without one. D is
/// the geometric mean over the window.
/// \param foundation  of the scene: that of the plate also holds what is held [Pa/m]
std::optional<double> windowWanted(const Plate& plate, double foundation)
{
    if (foundation <= 0) return {};
    const Extremes found = extremesOf(plate.rigidity.values());
    return foundationWindow(found.least, found.most) *
           std::pow(geometricMean(plate.rigidity.values()) / foundation, 0.25);
}

double largest(const NodeField& field)
{
    return *std::max_element(field.values().begin(), field.values().end());
}

/// Returns the largest deflection per force at an edge of the window beyond which points of the touched surface stay
/// [m/N]: within two spacings, or past those that follow a free edge.
double torn(const Patch& patch)
{
    const double beside = patch.thickness + 2 * patch.spacing + patch.plate.grid.spacingX;
    double       most   = 0;
    for (const ChartPoint& p : std::span(patch.followed).first(patch.touched)) {
        if (patch.window.holds(p)) continue;
        const ChartPoint edge = patch.window.nearest(p);
        if (std::hypot(p.x - edge.x, p.z - edge.z) <= beside) most = std::max(most, responseAt(patch, edge));
    }
    return most;
}

std::string withOneDecimal(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

/// Says what a window that is too deep may do to the answer.
///
/// A dent of what bulges both ways dies away before it comes where the surface is steep. Whole ellipsoids by CalculiX,
/// touched in the middle of a side with half axes of 60, 45 and 35 mm, 80 and 30, 60 and 20 mm and 1 and 2 mm thick,
/// are felt 2 to 8 % too stiff in windows as wide as their dents ask for, which sag up to all of their width, and one
/// of h/R 0.1 10 % too soft; in windows of a sag of 25 % by up to 37 %. Spheres and tips are felt within 3 % of what
/// narrower windows give. What is curved one way lets a dent run on: a tube is felt softer by 14 and 56 % in a window
/// that sags 30 and 50 %.
/// \param sag     over the width of the window [1]
/// \param limit   that it may have [1]
std::string tooDeep(double sag, double limit)
{
    return "the surface is too deep for the theory of shallow shells: it sags " + withOneDecimal(100 * sag) +
           " % of the patch window's width, expected at most " + std::to_string(std::lround(100 * limit)) + "; " +
           (limit > kMostSag
                ? "where it bulges both ways a dent hardly feels that: whole bodies that another program computed were "
                  "felt within some 10 %"
                : "a wider window is felt softer, a narrower one stiffer, and the object's supports decide: see the "
                  "support range");
}

/// Says the same of a window that is cut from a body, whose sides move as that does.
std::string tooDeepCut(double sag, double limit)
{
    return "the surface is too deep for the theory of shallow shells: it sags " + withOneDecimal(100 * sag) +
           " % of the patch window's width, expected at most " + std::to_string(std::lround(100 * limit)) +
           "; try a narrower --window";
}

constexpr double kMostSagOfWhole = 0.1, kMostSagOfBowl = 0.2; // of what is held at one place [1]

/// Says that an object that bends as a whole is deep. By CalculiX: cups of 100 x 40 mm that are held at one end and sag
/// 15 and 7 % of their length are felt 10 and 2 % too stiff at their tips, caps that are held on a segment and sag 11
/// and 19 % 5 and 11 % too soft, as is a trough at a far corner that sags 45 % and is held along one side, by 13 %.
/// Strips that curve away from where they are held, in part or to and fro, gutters, dishes, and domes that are held all
/// round are within 5 %, and within 12 where curvature changes within the radius of its fits.
///
/// Bowls that are held at a stem alone, by a shell theory of revolution, h 1 mm, 40 mm along the surface from bottom to
/// rim (angles of 20, 35, 50, 70 and 90 degrees there): 2, 8, 16, 39 and 63 % too soft 5 mm from the rim, and 1, 6, 12,
/// 26 and 47 at 20 mm.
/// \param oneHold  what holds it is in one place
/// \param bowl     it bulges both ways
std::string tooDeepAsAWhole(double sag, bool oneHold, bool bowl)
{
    return "the object sags " + withOneDecimal(100 * sag) +
           " % of its width, and the theory of shallow shells takes it for nearly level: " +
           (!oneHold ? "it may be felt up to a sixth too soft"
            : bowl && sag > kMostSagOfBowl
                ? "a bowl that is held at one place alone may be felt several times too soft far from it, which is no "
                  "answer"
                : "what is held at one end alone may be felt a tenth too stiff, or up to a sixth too soft");
}

/// Says which forces in the sheet are left out. Domes on a rim and a post, or on bolts around holes, were felt 2 to 25
/// % softer than by CalculiX, domes with twenty holes by 33 and 45 %.
std::string withoutThrust(int leftOut)
{
    return "the forces in the sheet towards " + std::to_string(leftOut) +
           " of its supports and holes are left out, those of supports far within it and of free "
           "borders beyond sixteen: it may be felt a quarter to a half too soft";
}

/// Says how supports hold that do not reach the border. An arch of R 40 mm whose second support is a pin of 2.5 mm,
/// 2.5 mm behind a border, is felt 9 % softer in its middle than by CalculiX, and 74 and 79 beside its borders.
std::string tiedPins(int tied)
{
    return "the sheet is held at " + std::to_string(tied) + (tied == 1 ? " place that does" : " places that do") +
           " not reach its border, and in its plane as if it were up to there: beside a small one it may be "
           "felt "
           "half as stiff as it is";
}

/// Says which window a dent asks for, and how many cells carry the fingertip in it.
/// \param width  [m]
std::string widerWindow(double width, const PatchSettings& settings)
{
    constexpr int kTogether = 16, kMostCells = 1024; // a multiple that a multigrid can coarsen; that a scene may have
    const int     cells =
        int(std::ceil(std::min(kFewestCells * width / settings.footprintRadius, 2.0 * kMostCells) / kTogether)) *
        kTogether;
    return "try a --window of " + formatQuantity(width, "m") +
           (cells > kMostCells       ? " with a wider fingertip"
            : cells > settings.cells ? " with --cells " + std::to_string(cells)
                                     : "");
}

/// Returns how far the dent of a shell reaches about the contact.
DentReach reachAt(const Patch& patch, const PatchSettings& settings, const Material& material)
{
    const auto [most, least] = patch.principal;
    return dentReach(most, least, material, settings.foundation / rigidityAtContact(patch));
}

/// Returns whether nodes without a point may be felt: not those in the corners of a window that reaches round a body
/// that bulges both ways, where the dent has died away before.
bool mayBeFelt(const Patch& patch, const PatchSettings& settings, const Material& material)
{
    const auto [most, least] = patch.principal;
    if (!patch.curvature || !(least / most > kBothWays)) return true;
    const DentReach reach = reachAt(patch, settings, material);
    return patch.bareFrom < reach.window * reach.length / 2;
}

/// Returns whether a surface is curved otherwise from place to place: where it is not, as on a tube or a saddle, it
/// lies off a sphere and has no folds.
bool varies(const CurvatureField& field)
{
    constexpr double kHalf = 0.5; // of the mean curvature's size, in the root of the mean square [1]
    double           mean = 0, square = 0;
    for (const auto& [which, counts] : {std::pair{&CurvatureField::x, 1.0}, std::pair{&CurvatureField::z, 1.0},
                                        std::pair{&CurvatureField::xz, 2.0}}) {
        const std::vector<double>& values = (field.*which).values();
        double                     sum    = 0;
        for (const double value : values) {
            sum += value;
            square += counts * value * value / double(values.size());
        }
        mean += counts * std::pow(sum / double(values.size()), 2);
    }
    return square - mean > kHalf * kHalf * mean;
}

/// Adds what limits a shell, or what a plate that is no shell leaves out.
void addCurvature(std::vector<std::string>& result, const Patch& patch, const PatchSettings& settings,
                  const Material& material)
{
    constexpr double kFolded = 0.5, kNearly = 0.95, kHardly = 0.02; // [1]
    constexpr double kShown = 0.005;                                // half of what is printed of a sag is no excess [1]
    if (settings.theory == Theory::plate && settings.neighbourhood == Neighbourhood::surface &&
        membraneLeftOut(patch, settings, material, patch.sphere.fit.curvature) > kMembraneFelt)
        result.push_back(bentFlat(patch.sphere.fit.curvature));
    if (!patch.flatBecause.empty())
        result.push_back("it bent as a flat plate, not as the shell that was asked for: " + patch.flatBecause);
    if (patch.thrustsLeftOut > 0 && (patch.curvature || settings.large == Large::on))
        result.push_back(withoutThrust(patch.thrustsLeftOut));
    if (patch.tied > 0 && patch.curvature) result.push_back(tiedPins(patch.tied));
    if (!patch.curvature) return;
    const auto [most, least] = patch.principal;
    const bool   whole       = settings.windowOf == WindowOf::object;
    const double window = bentSize(patch), lengths = window / patch.shellLength;
    const bool   bent  = std::abs(most) * window >= kHardly;
    const bool   ends  = (bent && least / most > kOneWay) || settings.foundation > 0; // dents, somewhere
    const double asked = reachAt(patch, settings, material).window;                   // [lengths]
    if (patch.isCut) {
        if (patch.sag > mostSag(most, least) + kShown) result.push_back(tooDeepCut(patch.sag, mostSag(most, least)));
    } else if (!whole && lengths < kNearly * asked && ends)
        result.push_back("the patch window is " + withOneDecimal(lengths) + " lengths of the shell wide (" +
                         formatQuantity(patch.shellLength, "m") + " each), so that its edges are felt; " +
                         widerWindow(asked * patch.shellLength, settings) +
                         ", or object, with what holds it, where the object is smaller than that");
    else if (!whole && !ends)
        result.push_back(
            "the surface is " +
            std::string(!bent                     ? "hardly curved"
                        : least / most < -kOneWay ? "curved both ways against each other"
                                                  : "curved one way") +
            " here, so that a dent reaches as far as the object: how it is held decides, see the support range, "
            "and --edges");
    const double     limit  = whole ? (patch.spans ? kMostSag : kMostSagOfWhole) : mostSag(most, least);
    constexpr double kKnown = 0.8; // q, see givesWay() [1]
    if (!patch.isCut && patch.sag > limit + kShown)
        result.push_back(whole ? tooDeepAsAWhole(patch.sag, !patch.spans, least / most > kOneWay)
                               : tooDeep(patch.sag, limit));
    if (std::abs(std::log(patch.curvedBending)) > kKnown)
        result.push_back("its points move far along its curved surface, which makes it " +
                         std::string(patch.curvedBending < 1 ? "stiffer" : "softer") +
                         " by more than a first order can say: it may be felt a fifth too soft");
    if (patch.unrolled > kFolded && varies(*patch.curvature))
        result.push_back("the surface lies far off a sphere, and a shell's forces do not follow its folds well");
}

/// Says where a sheet is not thin, as all of these theories take it to be.
void addThick(std::vector<std::string>& result, const Patch& patch)
{
    constexpr double kOfWindow = 0.25; // thickness over what bends [1]
    const double     h = patch.thickness, bent = bentSize(patch), curved = h * std::abs(patch.principal.first);
    if (h > kOfWindow * bent)
        result.push_back("the sheet is " + formatQuantity(h, "m") + " thick and only " + formatQuantity(bent, "m") +
                         " of it bends: that is no thin sheet, and its answer is no more than a guess");
    else if (curved > kMostThick)
        result.push_back("the sheet is " + withOneDecimal(100 * curved) +
                         " % as thick as its radius of curvature is long, expected at most 10: the theory is that of "
                         "thin shells");
}

/// Says where the deflection is beyond the theory: half the thickness, or twice it if large deflections are on.
void addTooDeep(std::vector<std::string>& result, const Patch& patch, bool mayBeLarge, double deepest, double load)
{
    const double most = patch.large ? patch.large->reach() : patch.thickness / 2;
    if (!(deepest > most)) return;
    const DepthLaw law  = depthLawOf(patch);
    const double   less = load * most / deepest;
    // The middle of the dent is deeper than its mean, of which the law is.
    if (patch.large)
        return result.push_back(
            "the deflection of " + formatQuantity(deepest, "m") + " exceeds twice the thickness (" +
            formatQuantity(most, "m") + "), to which the law of large deflections is trusted; press with less than " +
            formatQuantity(forceToDent(patch, most / (patch.large->tangent.front() * mostResponse(patch))), "N"));
    result.push_back("the deflection of " + formatQuantity(deepest, "m") + " exceeds half the thickness (" +
                     formatQuantity(most, "m") + "): Kirchhoff plate theory does not hold here; press with less than " +
                     formatQuantity(patch.stiffening > 0 ? law.force(less / patch.feltStiffness) : less, "N") +
                     (mayBeLarge && deepest <= 2 * patch.thickness
                          ? ", or set --large on, which holds to twice the thickness"
                          : ""));
}

/// Says where the body that a window is cut from leaves its theory: the coarse shell is linear, and knows no large
/// deflections.
/// \param load  of the window's sheet [N]
void addBody(std::vector<std::string>& result, const Patch& patch, double load)
{
    constexpr double kFar = 0.1, kMost = 0.5; // of the radius of curvature, or the window; of the compliance [1]
    if (patch.isCut && !patch.body)
        result.push_back(
            "no part of the object that is held hangs together with this place, as far as its points tell: "
            "the edges of the patch window hold it, and it is felt too stiff");
    if (!patch.body) return;
    constexpr double kFine = 8; // spacings of nodes to the window's width at least: the load and the fits reach two [1]
    if (kFine * patch.body->spacing > bentSize(patch))
        result.push_back("the nodes of the object's coarse shell are " + formatQuantity(patch.body->spacing, "m") +
                         " apart, too far to say how the sides of so narrow a patch window move; try a --window of " +
                         formatQuantity(kFine * patch.body->spacing, "m") +
                         " or more, or an object cut to what matters");
    const double bent  = std::max(std::abs(patch.principal.first), 1 / bentSize(patch)); // [1/m]
    const double moved = load * std::abs(patch.bodyCompliance), far = kFar / bent;       // [m]
    if (moved > far)
        result.push_back("the object gives way by " + formatQuantity(moved, "m") +
                         " as a whole, more than a tenth of its radius of curvature there or of the patch window: its "
                         "coarse shell is linear; press with less than " +
                         formatQuantity(load * far / moved, "N"));
    if (patch.large && patch.bodyCompliance > kMost * patch.compliance)
        result.push_back(
            "most of what gives way is the object as a whole, which is linear: large deflections are those "
            "of the patch window alone");
}

} // namespace

double membraneLeftOut(const Patch& patch, const PatchSettings& settings, const Material& material, double curvature)
{
    const double h = patch.thickness, nu = material.poissonRatio;
    const double D    = geometricMean(sheetRigidity(patch).values());
    const double wave = 4 * std::pow(std::numbers::pi / bentSize(patch), 4);
    return 12 * (1 - nu * nu) * D * curvature * curvature / (h * h) / (wave * D + settings.foundation);
}

std::string bentFlat(double curvature)
{
    return "the surface is curved, with a radius of " + formatQuantity(1 / std::abs(curvature), "m") +
           ", and bent as if it were flat: the forces within it are left out, and may be felt; set theory "
           "shell, unless it is a thin sheet between two faces that bulge apart";
}

std::string unconvergedText(const Patch& patch)
{
    return "the plate's solution is not as good as asked for: " + errorText(patch.report) +
           "; try fewer cells or less contrast";
}

std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force,
                                  const Material& material)
{
    std::vector<std::string> result;
    if (!patch.deformed()) return result;
    if (!patch.report.converged) result.push_back(unconvergedText(patch));
    const double load    = pressOf(patch, material, std::abs(force)).load;
    const double deepest = load * mostResponse(patch);
    addTooDeep(result, patch, settings.large == Large::off && settings.forceLaw == ForceLaw::series, deepest, load);
    addThick(result, patch);
    const bool   whole  = settings.windowOf == WindowOf::object;
    const double window = patch.window.grid.sizeX(); // [m]
    if (patch.nodesWithoutPoint > 0 && !whole && !patch.isCut && mayBeFelt(patch, settings, material))
        result.push_back(
            std::to_string(patch.nodesWithoutPoint) + " of " + std::to_string(patch.plate.grid.nodes()) +
            " grid nodes have no point nearby (a hole, a border or the far side): they carry the rigidity of "
            "the nearest point");
    if (patch.coarse && settings.footprintRadius < 2 * patch.plate.grid.spacingX)
        result.push_back("the cells are " + formatQuantity(patch.plate.grid.spacingX, "m") +
                         " wide and the footprint's radius is " + formatQuantity(settings.footprintRadius, "m") +
                         ": finer detail of the rigidity is averaged out; take more cells");
    else if (!patch.coarse && settings.footprintRadius < 2 * patch.spacing)
        result.push_back("the points are " + formatQuantity(patch.spacing, "m") +
                         " apart and the footprint's radius is " + formatQuantity(settings.footprintRadius, "m") +
                         ": rigidity between the points is interpolated, finer detail is not in the data");
    if (patch.sideUnsure)
        result.push_back("the cloud has no other side behind this place, so the finger's side is a guess (" +
                         directionText(patch.chart.frame.normal) + "); set --from");
    if (const NodeField& held = patch.held; !held.values().empty() && held.values()[held.values().size() / 2] > 0.5)
        result.push_back("the object is held at this place, so that only the fingertip's contact gives way");
    constexpr double kFewApart = 0.02; // of the sheet: strays and frayed borders [1]
    if (patch.apart > kFewApart)
        result.push_back(std::to_string(std::lround(100 * patch.apart)) +
                         " % of the object are other pieces than the touched one, and are not felt: no points lie "
                         "between them");
    addBody(result, patch, load);
    addCurvature(result, patch, settings, material);
    constexpr double kElsewhere = 0.5,
                     kFarOut    = 8; // [spacings]; [standard deviations of noise], of which few are beyond 5
    const double away           = glm::length(patch.chart.origin - patch.contact.point);
    if (settings.neighbourhood == Neighbourhood::surface &&
        away > std::max(kElsewhere * patch.spacing, kFarOut * patch.noise))
        result.push_back("the surface that faces the finger lies " + formatQuantity(away, "m") +
                         " from that place: it is another layer, and it is what was touched");
    constexpr double kFarOffSphere =
        0.05; // of the window: surfaces then slope by a tenth and more against the sphere [1]
    if (settings.neighbourhood == Neighbourhood::ball && patch.sphere.fit.misfit > kFarOffSphere * window)
        result.push_back("the points lie " + formatQuantity(patch.sphere.fit.misfit, "m") +
                         " (rms) off the fitted sphere, more than 5 % of the patch window: a smaller one follows the "
                         "surface better");
    if (const double moving = torn(patch) / largest(patch.response); moving > 0.02 && !whole)
        result.push_back("the patch window's edge moves by " + std::to_string(std::lround(100 * moving)) +
                         " % of the largest deflection and nothing moves beyond it: the deformed cloud is torn there");
    if (settings.foundation == 0 && !patch.curvature && !whole &&
        !patch.isCut) // a shell's own stiffness ends its dents; see addCurvature()
        result.push_back(
            "there is no foundation, so the size of the patch window decides: compliance grows with its area" +
            std::string(settings.theory == Theory::shell ? ", and with how its edges are held, see the support range"
                                                         : ""));
    if (const auto width = windowWanted(patch.plate, settings.foundation);
        !whole && !patch.curvature && width && window < *width)
        result.push_back("the patch window of " + formatQuantity(window, "m") + " is narrower than the " +
                         formatQuantity(*width, "m") +
                         " that this rigidity and foundation ask for: its edges are felt");
    return result;
}

} // namespace palp
