#include "engine/pipeline/detail/whole_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/chart/coverage.h"
#include "engine/core/extremes.h"
#include "engine/pipeline/detail/node_pieces.h"
#include "engine/pipeline/detail/thrust_fields.h"

namespace palp {
namespace {

/// Rigidity beyond the border over that of the sheet [1]. More of it bridges gaps: two arms of a hairpin 8 mm apart, of
/// which one was held and the other touched, were felt 17 times too stiff with 3e-3, 3.6 times with 1e-4, and 12 % with
/// this. Shells of which that makes too much for multigrid are solved by the reference, in a second at 256 cells.
constexpr double kVoid = 1e-6;

/// A bed of a fourth-order operator of stiffness D that clamps a field on a border: 30 D / cell^4 ((2.7 - depth) / 3)^6
/// at a depth of that many cells, so that it begins within the border. Clamped is a beam there to a hundredth of a
/// cell, wherever the border lies between the nodes, and whether the bed grows on beyond it or not. A bed that begins
/// on the border clamps it 0.3 to 1 cells further out, the more a node is by itself there, however firm it is.
constexpr double kBed = 30, kBedWithin = 2.7, kBedWide = 3; // D / cell^4 [1]; [cells]

/// Returns that bed.
/// \param depth  within the border [cells]
/// \param most   of the bed, 30 or more [D / cell^4]
double bedAt(double depth, double most)
{
    return std::min(kBed * std::pow(std::max((kBedWithin - depth) / kBedWide, 0.0), 6), most);
}

double cellOf(const PlateGrid& grid)
{
    return std::max(grid.spacingX, grid.spacingZ);
}

double shareOf(double covered, double beyond)
{
    return beyond + (1 - beyond) * covered;
}

/// Returns the pieces of the sheet: separate ones hang together only by what is next to nothing.
std::vector<Nodes> piecesOf(const PlateGrid& grid, const NodeField& covered)
{
    return connected(grid, [&](std::size_t n) { return isOnSheet(covered, n); });
}

/// Returns for each node whether it lies on a piece of the sheet that is touched.
std::vector<bool> touchedPiece(const Patch& patch, const NodeField& load)
{
    std::vector<bool> is(patch.plate.grid.nodes());
    for (const Nodes& piece : piecesOf(patch.plate.grid, patch.covered))
        if (std::ranges::any_of(piece, [&](std::size_t n) { return load.values()[n] > 0; }))
            for (const std::size_t n : piece) is[n] = true;
    return is;
}

/// Returns the share of the sheet without its other pieces, and without what of these ends between two nodes.
NodeField onlyPiece(const PlateGrid& grid, const NodeField& covered, const std::vector<bool>& piece)
{
    NodeField own(grid);
    for (std::size_t n = 0; n < piece.size(); ++n) {
        bool isOwn = piece[n];
        if (!isOnSheet(covered, n)) eachAround(grid, n, [&](std::size_t other) { isOwn = isOwn || piece[other]; });
        if (isOwn) own.values()[n] = covered.values()[n];
    }
    return own;
}

/// Returns how deep a node lies in what is not held, in the widths of the Gaussian that made its share of what is: the
/// inverse of that Gaussian's integral, to 5e-4. Beyond 3.7 widths it is infinite.
/// \source Abramowitz and Stegun 1964, 26.2.23
double widthsFromHeld(double share)
{
    constexpr double kRest = 1e-4; // a share next to nothing [1]
    const double     least = std::min(share, 1 - share), side = share < 0.5 ? 1 : -1;
    if (!(least > kRest)) return side * std::numeric_limits<double>::infinity();
    const double t = std::sqrt(-2 * std::log(least));
    return side *
           (t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))));
}

/// Returns whether what is held surrounds a quarter and more of what is not, as far as sixteen directions tell: no
/// finger and no part of an object that is held at one end lies between held nodes.
bool isSurrounded(const Patch& patch)
{
    constexpr int    kDirections = 16;
    constexpr double kShare      = 0.25; // [1]
    const PlateGrid& grid        = patch.plate.grid;
    const auto       along       = [&](std::size_t n, int direction) {
        const double angle = 2 * std::numbers::pi * direction / kDirections;
        return double(int(n) / grid.nodesZ()) * std::cos(angle) + double(int(n) % grid.nodesZ()) * std::sin(angle);
    };
    if (patch.held.values().empty()) return false;
    std::array<double, kDirections> farthest{};
    farthest.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t n = 0; n < grid.nodes(); ++n)
        for (int d = 0; d < kDirections && isOnSheet(patch, n) && isHeld(patch, n); ++d)
            farthest[std::size_t(d)] = std::max(farthest[std::size_t(d)], along(n, d));
    double inside = 0, all = 0;
    for (std::size_t n = 0; n < grid.nodes(); ++n) {
        if (!isOnSheet(patch, n) || isHeld(patch, n)) continue;
        bool within = true;
        for (int d = 0; d < kDirections && within; ++d) within = along(n, d) <= farthest[std::size_t(d)];
        inside += within;
        ++all;
    }
    return inside >= kShare * all;
}

} // namespace

bool isHeld(const Patch& patch, std::size_t node)
{
    return !patch.held.values().empty() && patch.held.values()[node] >= 0.5;
}

void cutOut(Patch& patch, double spacing)
{
    const auto       touched = std::span(patch.positions).first(patch.touched);
    const PlateGrid& grid    = patch.window.grid;
    patch.inside             = depthWithin(patch.window, touched, spacing, (kBedWithin + 1) * cellOf(grid));
    patch.covered            = coveredShare(grid, patch.inside);
    patch.beyond             = kVoid;
    for (std::size_t n = 0; n < patch.covered.values().size(); ++n)
        patch.plate.rigidity.values()[n] *= shareOf(patch.covered.values()[n], patch.beyond);
}

namespace {

/// Holds the void on the ways of ties: it goes on curving, and gave way to the forces that the tie should carry.
void groundTies(Patch& patch)
{
    if (patch.heldInPlane.values().empty()) return;
    const double most = extremesOf(sheetRigidity(patch).values()).most; // [N m], as for holdNodes()
    for (std::size_t n = 0; n < patch.held.values().size(); ++n)
        if (patch.heldInPlane.values()[n] > patch.held.values()[n] && !(patch.covered.values()[n] > 0))
            patch.plate.foundationShape.values()[n] = patch.plate.rigidity.values()[n] / most;
}

} // namespace

/// Beyond a free border no sheet carries a force: Airy's function is clamped to 0 there. By a bed that begins on the
/// border, narrow curved bands were felt 5 to 19 % too stiff; with a membrane that merely gives way a thousand times as
/// much, gutters 24 to 53 %, because the void went on curving and resisted at a long lever. The curvature is not cut
/// out: one that ends at a border along which it changes belongs to no surface, and such a sheet carries loads by
/// stresses of its own (a gutter of 100 mm was felt five times too stiff).
void cutOutMembrane(Patch& patch)
{
    constexpr double kFirm = 1e4; // over the sheet's stiffness: what a ring of held nodes gives way is below 0.1 % [1]
    const PlateGrid& grid  = patch.plate.grid;
    const double     area  = grid.spacingX * grid.spacingZ;
    HeldInPlane      inPlane = heldInPlane(patch);
    const FreePieces pieces  = freePieces(patch, inPlane);
    patch.thrustsLeftOut     = pieces.leftOut;
    patch.tied               = inPlane.tied;
    if (!patch.covered.values().empty()) patch.stressBed = NodeField(grid);
    patch.spans = isSurrounded(patch) || pieces.count > 1;
    // What is held keeps its shape, like the ground behind it, which carries no bed therefore. Of a cap that is held on
    // a narrow segment the sheet alone did not: its corners lay on the bed of the free border, and it was felt 8 %
    // softer.
    for (std::size_t n = 0; n < patch.covered.values().size(); ++n) {
        double&      compliance = patch.membraneCompliance.values()[n];
        const double held       = inPlane.share.values().empty() ? 0 : inPlane.share.values()[n];
        patch.stressBed.values()[n] =
            (1 - held) * bedAt(patch.inside.values()[n] / cellOf(grid), kBed) * compliance / (area * area);
        compliance *= 1 - held + held / kFirm;
    }
    patch.heldInPlane = std::move(inPlane.share);
    groundTies(patch);
    patch.thrusts = thrustFields(patch, pieces);
}

void holdNodes(Patch& patch, const NodeField& shares, double width, double foundation, const NodeField& load)
{
    constexpr double kFirm  = 1000; // D / cell^4: a curved sheet is stiffer than its D [1]
    Plate&           plate  = patch.plate;
    const NodeField  sheet  = sheetRigidity(patch);
    const double     cell   = cellOf(plate.grid);
    const double     most   = extremesOf(sheet.values()).most;  // [N m]
    const double     firm   = kFirm * most / std::pow(cell, 4); // [Pa/m]
    const bool       varies = !plate.foundationShape.values().empty();
    const auto       piece  = touchedPiece(patch, load);
    NodeField        shape(plate.grid);
    patch.held = NodeField(plate.grid);
    for (std::size_t n = 0; n < shape.values().size(); ++n) {
        const double below     = foundation * (varies ? plate.foundationShape.values()[n] : 1);
        const double depth     = widthsFromHeld(shares.values()[n]) * width / cell; // [cells]
        shape.values()[n]      = below / firm + bedAt(depth, kFirm) / kFirm * plate.rigidity.values()[n] / most;
        patch.held.values()[n] = std::clamp(0.5 - depth, 0.0, 1.0);
        patch.heldNodes += depth < 0 && piece[n];
    }
    plate.foundation      = firm;
    plate.foundationShape = std::move(shape);
}

bool areOnOnePiece(const Patch& patch, const NodeField& a, const NodeField& b)
{
    const auto piece = touchedPiece(patch, a);
    bool       some  = false;
    for (std::size_t n = 0; n < piece.size(); ++n) {
        if (!(b.values()[n] > 0) || !isOnSheet(patch, n)) continue;
        if (!piece[n]) return false;
        some = true;
    }
    return some;
}

std::size_t heldNodesUnder(const Patch& patch, const NodeField& load)
{
    const auto  piece = touchedPiece(patch, load);
    std::size_t count = 0;
    for (std::size_t n = 0; n < piece.size(); ++n) count += piece[n] && isHeld(patch, n);
    return count;
}

bool isLoose(const Patch& patch, const PatchSettings& settings)
{
    return settings.windowOf != WindowOf::contact && !(settings.foundation > 0) && patch.heldNodes < kFewestHeld;
}

void findApart(Patch& patch, const NodeField& load)
{
    const auto piece = touchedPiece(patch, load);
    double     all = 0, apart = 0; // nodes of the sheet
    for (std::size_t n = 0; n < piece.size(); ++n) {
        all += isOnSheet(patch, n);
        apart += isOnSheet(patch, n) && !piece[n];
    }
    patch.apart = all > 0 ? apart / all : 0;
}

void findSheared(Patch& patch)
{
    constexpr int kAway  = 2; // cells
    const auto    isFree = [&](int i, int j) {
        return patch.covered(i, j) > 0.999 && (patch.held.values().empty() || patch.held(i, j) < 1e-3);
    };
    const PlateGrid& grid = patch.plate.grid;
    patch.sheared         = NodeField(grid);
    for (int i = kAway; i + kAway <= grid.cellsX; ++i)
        for (int j = kAway; j + kAway <= grid.cellsZ; ++j) {
            bool free = true;
            for (int a = i - kAway; a <= i + kAway; ++a)
                for (int b = j - kAway; b <= j + kAway; ++b) free = free && isFree(a, b);
            patch.sheared(i, j) = free;
        }
}

double sheetRigidity(const Patch& patch, std::size_t node)
{
    const double own = patch.plate.rigidity.values()[node];
    return patch.covered.values().empty() ? own : own / shareOf(patch.covered.values()[node], patch.beyond);
}

namespace {

constexpr double kHardly = 0.05; ///< share of a footprint's force that is hardly any of it [1]

/// Returns the share of a footprint's force that lies on the sheet [1].
double shareOnSheet(const Footprint& footprint, const NodeField& covered)
{
    double whole = 0, sum = 0;
    for (const Footprint::Part& part : footprint.parts) {
        whole += part.force;
        sum += covered.values()[part.node] * part.force;
    }
    return sum / whole;
}

/// Returns a footprint moved by whole cells, without what lies beyond the grid then.
Footprint movedBy(const Footprint& footprint, int alongX, int alongZ, const NodeField& grid)
{
    Footprint moved;
    for (Footprint::Part part : footprint.parts) {
        const int i = int(part.node) / grid.nodesZ() + alongX, j = int(part.node) % grid.nodesZ() + alongZ;
        if (i < 0 || j < 0 || i >= grid.nodesX() || j >= grid.nodesZ()) continue;
        part.node = std::uint32_t(i * grid.nodesZ() + j);
        moved.parts.push_back(part);
    }
    return moved;
}

/// Returns a footprint whose middle lies on the node of the sheet that is nearest to it; itself, if there is none.
Footprint movedOntoSheet(const Footprint& footprint, const NodeField& covered)
{
    double force = 0, x = 0, z = 0; // [N], [N] times nodes
    for (const Footprint::Part& part : footprint.parts) {
        force += part.force;
        x += part.force * (int(part.node) / covered.nodesZ());
        z += part.force * (int(part.node) % covered.nodesZ());
    }
    const int middleI = int(std::lround(x / force)), middleJ = int(std::lround(z / force));
    int       alongX = 0, alongZ = 0;
    double    least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < covered.nodesX(); ++i)
        for (int j = 0; j < covered.nodesZ(); ++j) {
            const double away = std::hypot(i - middleI, j - middleJ);
            if (!(covered(i, j) > 0.5) || !(away < least)) continue;
            least  = away;
            alongX = i - middleI;
            alongZ = j - middleJ;
        }
    return movedBy(footprint, alongX, alongZ, covered);
}

/// Returns a footprint's load on the sheet alone, of the same force.
/// \pre some of it lies there
Footprint cutToSheet(const Footprint& footprint, const NodeField& covered)
{
    double whole = 0, sum = 0, changeX = 0, changeZ = 0;
    for (const Footprint::Part& part : footprint.parts) {
        const double share = covered.values()[part.node];
        whole += part.force;
        sum += share * part.force;
        changeX += share * part.changeX;
        changeZ += share * part.changeZ;
    }
    Footprint    own  = footprint;
    const double more = whole / sum;
    for (Footprint::Part& part : own.parts) { // what moves beyond the border presses more on the rest
        const double share = covered.values()[part.node], force = more * share * part.force;
        part = {part.node, force, more * share * part.changeX - force * changeX / sum,
                more * share * part.changeZ - force * changeZ / sum};
    }
    return own;
}

/// Returns a footprint that does not move.
Footprint still(Footprint footprint)
{
    for (Footprint::Part& part : footprint.parts) part.changeX = part.changeZ = 0;
    return footprint;
}

} // namespace

Footprint onSheet(const Footprint& footprint, const NodeField& covered)
{
    if (shareOnSheet(footprint, covered) > kHardly) return cutToSheet(footprint, covered);
    const Footprint beside = movedOntoSheet(footprint, covered);
    return shareOnSheet(beside, covered) > kHardly ? still(cutToSheet(beside, covered)) : footprint;
}

Footprint onPiece(const Footprint& footprint, const PlateGrid& grid, const NodeField& covered)
{
    const Footprint whole = onSheet(footprint, covered);
    const NodeField load  = whole.load(grid);
    const auto parts = connected(grid, [&](std::size_t n) { return load.values()[n] > 0 && isOnSheet(covered, n); });
    if (parts.size() < 2) return whole;
    double            most = 0;
    std::vector<bool> best(grid.nodes());
    for (const Nodes& piece : piecesOf(grid, covered)) { // two parts hang together around a slit that ends
        double sum = 0;                                  // [N]
        for (const std::size_t n : piece) sum += load.values()[n];
        if (!(sum > most)) continue;
        most = sum;
        best.assign(best.size(), false);
        for (const std::size_t n : piece) best[n] = true;
    }
    return onSheet(footprint, onlyPiece(grid, covered, best));
}

FootprintLattice onSheet(const FootprintLattice& lattice, const Patch& patch)
{
    FootprintLattice own = lattice;
    own.wholeObject      = true; // nothing of a homogeneous window is to be taken out where a sheet ends in it
    if (patch.isCut) own.rungs.clear();
    const PlateGrid& grid    = patch.plate.grid;
    const Footprint  touch   = onPiece(lattice.loads[lattice.loads.size() / 2], grid, patch.covered);
    const NodeField  covered = onlyPiece(grid, patch.covered, touchedPiece(patch, touch.load(grid)));
    for (Footprint& load : own.loads)
        load = shareOnSheet(load, covered) > kHardly ? cutToSheet(load, covered) : still(touch);
    return own;
}

} // namespace palp
