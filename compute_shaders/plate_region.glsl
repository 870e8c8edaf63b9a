// plate_region.glsl - red-black sweeps of a part of a level in shared memory, for plate_down.comp and plate_up.comp.
//
// A workgroup owns the nodes in the middle of a square region and also computes the rim, which others own: each half
// sweep is right two nodes less far out than the one before. So several sweeps take one pass over memory, and one
// dispatch, at the price of computing the rim twice or more often. The result equals that of sweep after sweep of
// plate_relax.comp, to the bit.
//
// The includer declares D and inverseDivisor, kBeyond, the nodes beyond its own ones on which it needs the result too,
// and  PlateLevel region(), float forceAt(int i, int j), bool isSwept(int i, int j),  which return the level, its
// forces, and whether a node takes part.

layout(constant_id = 3) const int kSweeps = 2; // before, or after, the correction
const int kRim = kRimPerSweep * kSweeps + kBeyond; // [nodes]
const int kOwned = kRegion - 2 * kRim; // nodes along either side of the part that a workgroup owns

shared float tile[kRegion * kRegion];

int base;    // of the load's fields
int cornerI; // corner of the region, may lie outside the grid
int cornerJ;

int   placeOf(int i, int j) { return (i - cornerI) * kRegion + (j - cornerJ); }
bool  isNode(int i, int j) { return i >= 0 && j >= 0 && i <= region().cellsX && j <= region().cellsZ; }
int   nodeAt(int i, int j) { return i * nodesZ(region()) + j; }
float rigidity(int i, int j) { return D[nodeAt(i, j)]; }
float foundationShape(int i, int j) { return D[region().shapeAt + nodeAt(i, j)]; }
float deflection(int i, int j) { return tile[placeOf(i, j)]; }
float otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"

void startRegion()
{
    base    = firstOfLoad(region());
    cornerI = int(gl_WorkGroupID.y) * kOwned - kRim;
    cornerJ = int(gl_WorkGroupID.x) * kOwned - kRim;
}

// Node of this colour, the nth in the region without `margin` nodes along its sides.
ivec2 nthOfColour(int n, int margin, uint colour)
{
    int side = kRegion - 2 * margin, i = cornerI + margin + n / (side / 2), j = cornerJ + margin + 2 * (n % (side / 2));
    return ivec2(i, j + int((uint(i + j) + colour) & 1u));
}

const int kLanes = int(gl_WorkGroupSize.x);
const int kMostPerLane = (kRegion * kRegion / 2 + kLanes - 1) / kLanes;

// All new values are computed before any is written: a node's neighbours of its own colour are those from before.
void relaxRegion(uint colour, int margin)
{
    PlateLevel g = region();
    int side = kRegion - 2 * margin, count = side * side / 2, lane = int(gl_LocalInvocationID.x);
    float fresh[kMostPerLane];
    for (int k = 0; k < kMostPerLane; ++k) {
        int   n = lane + k * kLanes;
        ivec2 at = nthOfColour(n, margin, colour);
        if (n < count && isNode(at.x, at.y) && isSwept(at.x, at.y))
            fresh[k] = relaxed(deflection(at.x, at.y), forceAt(at.x, at.y), operatorAt(g, at.x, at.y),
                               inverseDivisor[nodeAt(at.x, at.y)]);
    }
    barrier();
    for (int k = 0; k < kMostPerLane; ++k) {
        int   n = lane + k * kLanes;
        ivec2 at = nthOfColour(n, margin, colour);
        if (n < count && isNode(at.x, at.y) && isSwept(at.x, at.y)) tile[placeOf(at.x, at.y)] = fresh[k];
    }
    barrier();
}
