#include "engine/pipeline/detail/grid_part.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

/// Returns the first cell and the number of cells of a part that holds some nodes.
std::pair<int, int> reach(int first, int last, int cells)
{
    constexpr int kMargin = 6, kTogether = 16; // cells: a border dies away within two; multigrid halves them four times
    const int     wanted = last - first + 2 * kMargin;
    const int     many   = (wanted + kTogether - 1) / kTogether * kTogether;
    if (many >= cells) return {0, cells};
    return {std::clamp((first + last - many) / 4 * 2, 0, cells - many), many}; // in the middle, at an even node
}

/// Returns the edges of Airy's function on a window whose sides lie in the void, or in the ground of what is held,
/// which has no bed. They are clamped, like any border: a free one stands for a frame that holds them in the plane, by
/// which what is curved resists (a gutter was felt 1.4 times too stiff), and the slopes that end there load it (laws of
/// large deflections fell by a tenth). But the ground goes on beyond a side that mostly lies in it, and where there are
/// thrusts it carries them beyond each side that it reaches: such a side is free.
PlateEdges edgesInVoid(const NodeField& bed, const PlateGrid& grid, bool thrusts)
{
    const auto along = [&](bool alongX, int at) {
        const int last   = alongX ? grid.cellsX : grid.cellsZ;
        int       ground = 0;
        for (int k = 0; k <= last; ++k) ground += !((alongX ? bed(k, at) : bed(at, k)) > 0);
        return (thrusts ? ground > 0 : 2 * ground > last) ? Edge::free : Edge::clamped;
    };
    return {along(false, 0), along(false, grid.cellsX), along(true, 0), along(true, grid.cellsZ)};
}

/// Makes the bed of Airy's function firm along the sides. Where such a side is free, the curvature that ends there
/// loads that function by the deflection itself, not by its second differences: a curved U that is held at both ends
/// was felt 30 % too stiff.
void makeSidesFirm(NodeField& bed, const PlateGrid& grid)
{
    constexpr int    kRows = 2;   // that the second differences at a side reach
    constexpr double kFirm = 100; // what is left is 1 % of that; solvers take more steps the firmer it is [1]
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j)
            if (std::min({i, j, grid.cellsX - i, grid.cellsZ - j}) < kRows) bed(i, j) *= kFirm;
}

} // namespace

GridPart::GridPart(const Patch& patch) : whole_(patch.plate.grid), part_(whole_)
{
    if (patch.covered.values().empty() || whole_.cellsX % 2 != 0 || whole_.cellsZ % 2 != 0) return;
    int lowX = whole_.cellsX, highX = 0, lowZ = whole_.cellsZ, highZ = 0;
    for (int i = 0; i <= whole_.cellsX; ++i)
        for (int j = 0; j <= whole_.cellsZ; ++j) {
            if (!(patch.covered(i, j) > 0)) continue;
            lowX = std::min(lowX, i), highX = std::max(highX, i);
            lowZ = std::min(lowZ, j), highZ = std::max(highZ, j);
        }
    if (lowX > highX) return;
    std::tie(firstX_, part_.cellsX) = reach(lowX, highX, whole_.cellsX);
    std::tie(firstZ_, part_.cellsZ) = reach(lowZ, highZ, whole_.cellsZ);
}

GridPart GridPart::everySecond() const
{
    GridPart coarse = *this;
    for (PlateGrid* grid : {&coarse.whole_, &coarse.part_})
        *grid = {grid->cellsX / 2, grid->cellsZ / 2, 2 * grid->spacingX, 2 * grid->spacingZ};
    coarse.firstX_ /= 2;
    coarse.firstZ_ /= 2;
    return coarse;
}

NodeField GridPart::of(const NodeField& field) const
{
    if (field.values().empty() || part_ == whole_) return field;
    NodeField part(part_);
    for (int i = 0; i <= part_.cellsX; ++i)
        for (int j = 0; j <= part_.cellsZ; ++j) part(i, j) = field(firstX_ + i, firstZ_ + j);
    return part;
}

Plate GridPart::of(const Plate& plate) const
{
    Plate part           = plate;
    part.grid            = part_;
    part.rigidity        = of(plate.rigidity);
    part.foundationShape = of(plate.foundationShape);
    return part;
}

Shell GridPart::of(const Shell& shell) const
{
    Shell part   = shell;
    part.bending = of(shell.bending);
    for (NodeField* field : {&part.membraneCompliance, &part.curvatureX, &part.curvatureZ, &part.curvatureXZ,
                             &part.stressBed, &part.sheared, &part.stretched})
        *field = of(*field);
    for (NodeField& thrust : part.thrusts) thrust = of(thrust);
    if (part.stressBed.values().empty()) return part;
    part.stressEdges = edgesInVoid(part.stressBed, part_, !part.thrusts.empty());
    makeSidesFirm(part.stressBed, part_);
    // The void of a round object that is held all around may reach the part in a corner alone. Such a bed leaves linear
    // stress functions free, and holds none of the rest.
    if (part.thrusts.empty() && whyUnsolvable(membraneOf(part))) part.stressBed = NodeField(part_);
    return part;
}

Footprint GridPart::of(const Footprint& load) const
{
    if (part_ == whole_) return load;
    Footprint part;
    for (Footprint::Part at : load.parts) {
        const int nodes = whole_.nodesZ(), i = int(at.node) / nodes - firstX_, j = int(at.node) % nodes - firstZ_;
        if (i < 0 || j < 0 || i > part_.cellsX || j > part_.cellsZ) continue;
        at.node = std::uint32_t(i * part_.nodesZ() + j);
        part.parts.push_back(at);
    }
    return part;
}

FootprintLattice GridPart::of(const FootprintLattice& lattice) const
{
    FootprintLattice part = lattice;
    for (Footprint& load : part.loads) load = of(load);
    return part;
}

NodeField GridPart::onWhole(const NodeField& field) const
{
    if (part_ == whole_) return field;
    NodeField all(whole_);
    for (int i = 0; i <= part_.cellsX; ++i)
        for (int j = 0; j <= part_.cellsZ; ++j) all(firstX_ + i, firstZ_ + j) = field(i, j);
    return all;
}

} // namespace palp
