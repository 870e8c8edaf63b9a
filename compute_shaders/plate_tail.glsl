// plate_tail.glsl - cycles on the coarse levels by one workgroup per load, for plate_tail.comp and plate_nested.comp.
//
// A dispatch on a small level costs mainly the wait for it, so all small levels together are one dispatch. Invocations
// exchange numbers of a cycle through shared memory only; deflections put aside on the way down are each invocation's
// own nodes'. Sweeps, residual and transfers equal those of single dispatches, to the bit; the coarsest level is solved
// by its inverse, which invocations share better than substitution. Its sums are in doubles where the processor has
// them: a plate that is softly held sinks by a thousand times more than it bends, and floats would round the bending
// away. Pairs of floats would take longer, also where a double takes 64 times as long as a float.
//
// The includer declares push, with the numbers of levels and of nodes of all of them, kSweeps before and after each
// correction, and  float givenForce(int node),  the force of a node of the level that a cycle begins with.

#ifdef PALPATE_DOUBLE
#define wide double
#else
#define wide float
#endif
#undef real
#define real float // in the cycle

const int kLanes = int(gl_WorkGroupSize.x);

layout(std430, binding = 0) readonly buffer Levels { TailLevel levels[]; };
layout(std430, binding = 1) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 2) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 3) readonly buffer TableX { float tablesX[]; };
layout(std430, binding = 4) readonly buffer TableZ { float tablesZ[]; };
layout(std430, binding = 5) readonly buffer Inverse { wide inverse[]; };
layout(std430, binding = 7) coherent buffer Aside { float aside[]; };

shared float pool[kTailPool];

int       load, level, first;  // the level that a cycle begins with
TailLevel here;  // the level that is worked on
TailLevel below; // the next coarser one, if there is one

int   nodesOf(PlateLevel g) { return nodesX(g) * nodesZ(g); }
int   nodeAt(int i, int j) { return i * nodesZ(here.plate) + j; }
float rigidity(int i, int j) { return D[here.field + nodeAt(i, j)]; }
float foundationShape(int i, int j) { return D[here.plate.shapeAt + here.field + nodeAt(i, j)]; }
float deflection(int i, int j) { return pool[here.w + nodeAt(i, j)]; }
float otherColour(int i, int j) { return deflection(i, j); }
float tableX(int n) { return tablesX[here.tableX + n]; }
float tableZ(int n) { return tablesZ[here.tableZ + n]; }
float fineValue(int i, int j) { return deflection(i, j); }
float coarseValue(int i, int j) { return pool[below.w + i * nodesZ(below.plate) + j]; }

#define PALPATE_PROLONGS
#define PALPATE_RESTRICTS
#include "compute_shaders/shared/transfer_layout.h"
#include "compute_shaders/shared/plate_transfer.h"
#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"

// A node of one colour, by its column and its half row. An invocation's own are so many columns and half rows apart.
ivec2 ownFirst, ownStep;

void enter(int l)
{
    level = l;
    here = levels[l];
    if (l + 1 < int(push.levels)) below = levels[l + 1];
    int rowHalf = here.plate.cellsZ / 2 + 1, lane = int(gl_LocalInvocationID.x);
    ownFirst = ivec2(lane / rowHalf, lane % rowHalf);
    ownStep = ivec2(kLanes / rowHalf, kLanes % rowHalf);
}

// The invocation's next node of a colour.
ivec2 nextOwn(ivec2 own)
{
    own += ownStep;
    int rowHalf = here.plate.cellsZ / 2 + 1;
    return own.y < rowHalf ? own : ivec2(own.x + 1, own.y - rowHalf);
}

float forceAt(int node) { return level == first ? givenForce(node) : pool[here.force + node]; }

int asideAt(int node) { return load * int(push.nodes) + here.field + node; }

ivec2 ofColour(ivec2 own, uint colour) { return ivec2(own.x, 2 * own.y + int((uint(own.x) + colour) & 1u)); }

bool isNode(ivec2 at) { return at.x <= here.plate.cellsX && at.y <= here.plate.cellsZ; }

// Relaxes the nodes of a colour, or puts what is left of their forces aside. All new values are computed before any is
// written: a node's neighbours of its own colour are those from before. The only call of the operator: a driver takes
// seconds to compile each one that stands within loops.
void treatColour(uint colour, bool relaxes)
{
    const int kMost = (kTailHalf + kLanes - 1) / kLanes;
    float fresh[kMost];
    ivec2 own = ownFirst;
    for (int k = 0; k < kMost; ++k, own = nextOwn(own)) {
        ivec2 at = ofColour(own, colour);
        if (isNode(at)) {
            int node = nodeAt(at.x, at.y);
            float load = forceAt(node), w = operatorAt(here.plate, at.x, at.y);
            if (relaxes)
                fresh[k] = relaxed(deflection(at.x, at.y), load, w, inverseDivisor[here.field + node]);
            else
                aside[asideAt(node)] = isHeld(here.plate, at.x, at.y) ? 0.0f : load - w;
        }
    }
    barrier();
    own = ownFirst;
    for (int k = 0; k < kMost; ++k, own = nextOwn(own)) {
        ivec2 at = ofColour(own, colour);
        if (relaxes && isNode(at)) pool[here.w + nodeAt(at.x, at.y)] = fresh[k];
    }
    barrier();
}

void swapWithAside(uint colour)
{
    for (ivec2 own = ownFirst; own.x <= here.plate.cellsX; own = nextOwn(own)) {
        ivec2 at = ofColour(own, colour);
        if (isNode(at)) {
            int node = nodeAt(at.x, at.y);
            float left = aside[asideAt(node)];
            aside[asideAt(node)] = pool[here.w + node];
            pool[here.w + node] = left;
        }
    }
}

// On the way down a level begins with the half sweep from zero deflection that needs no operator, on the way up with
// the correction.
void begin(uint colour, bool down)
{
    for (ivec2 own = ownFirst; own.x <= here.plate.cellsX; own = nextOwn(own)) {
        ivec2 at = ofColour(own, colour);
        if (isNode(at)) {
            int node = nodeAt(at.x, at.y);
            if (down)
                pool[here.w + node] = colour == 0u ? forceAt(node) * inverseDivisor[here.field + node] : 0.0f;
            else
                pool[here.w + node] = aside[asideAt(node)] + prolongedAt(at.x, at.y);
        }
    }
}

// The residual takes the deflection's place, and goes on to the level below as force.
void passOn()
{
    [[dont_unroll]] for (uint colour = 0u; colour < 2u; ++colour) swapWithAside(colour);
    barrier();
    for (int n = int(gl_LocalInvocationID.x); n < nodesOf(below.plate); n += kLanes)
        pool[below.force + n] = restrictedAt(n / nodesZ(below.plate), n % nodesZ(below.plate), nodesX(here.plate),
                                             nodesZ(here.plate));
    barrier();
}

// A part of the sum of products with a row of the inverse, four sums side by side: one would wait for each product.
wide partOfProduct(int nodes, int row, int begin, int end)
{
    wide a = wide(0.0f), b = a, c = a, d = a;
    int  m = begin;
    for (; m + 4 <= end; m += 4) {
        a += inverse[m * nodes + row] * wide(forceAt(m));
        b += inverse[(m + 1) * nodes + row] * wide(forceAt(m + 1));
        c += inverse[(m + 2) * nodes + row] * wide(forceAt(m + 2));
        d += inverse[(m + 3) * nodes + row] * wide(forceAt(m + 3));
    }
    for (; m < end; ++m) a += inverse[m * nodes + row] * wide(forceAt(m));
    return (a + b) + (c + d);
}

// Where there are more invocations than nodes several share a row. Their sums meet in the pool of the tail's largest
// level, which holds nothing while the coarsest one is solved; a double there is two floats.
void solveCoarsest()
{
    int nodes = nodesOf(here.plate), lane = int(gl_LocalInvocationID.x);
    int room = push.levels > 1u ? nodesOf(levels[0].plate) / (2 * nodes) : 0;
    int parts = max(1, min(kLanes / nodes, 1 + room)), share = (nodes + parts - 1) / parts;
    wide sum = wide(0.0f);
    for (int n = lane; n < parts * nodes; n += kLanes) {
        int part = n / nodes, row = n % nodes;
        sum = partOfProduct(nodes, row, part * share, min(nodes, (part + 1) * share));
        if (part == 0) {
            pool[here.w + row] = float(sum);
        } else {
            int at = levels[0].w + 2 * (n - nodes);
            pool[at] = float(sum);
            pool[at + 1] = float(sum - wide(pool[at]));
        }
    }
    barrier();
    if (parts == 1) return;
    if (lane < nodes) {
        for (int part = 1; part < parts; ++part) {
            int at = levels[0].w + 2 * ((part - 1) * nodes + lane);
            sum += wide(pool[at]) + wide(pool[at + 1]);
        }
        pool[here.w + lane] = float(sum);
    }
    barrier();
}

// Runs a cycle from the first level down; its deflection is then that level's in the pool.
void runCycle()
{
    int last = int(push.levels) - 1;
    [[dont_unroll]] for (int visit = first; visit <= 2 * last - first; ++visit) {
        bool down = visit < last;
        enter(down ? visit : 2 * last - visit);
        if (visit == last) {
            solveCoarsest();
            continue;
        }
        [[dont_unroll]] for (uint colour = 0u; colour < 2u; ++colour) begin(colour, down);
        barrier();
        // Half sweeps of colours 1, 0, 1 ...; down, two more of both colours for the residual.
        int sweeps = down ? 2 * kSweeps - 1 : 2 * kSweeps;
        [[dont_unroll]] for (int turn = 1; turn <= sweeps + (down ? 2 : 0); ++turn)
            treatColour(uint(turn & 1), turn <= sweeps);
        if (down) passOn();
    }
}
