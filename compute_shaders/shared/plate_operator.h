// plate_operator.h - nodal forces A w of a plate of varying rigidity on a foundation, in moment form (GLSL and C++).
//
//   A w = dxx Mx + dzz Mz + dxz Mxz + k s w      gradient of the discrete energy, never assembled
//   Mx  = D (kxx p + kxz q)                      at nodes; p, q undivided second differences of w along x, z
//   Mz  = D (kzz q + kxz p)
//   Mxz = twist (D00 + D10 + D01 + D11) t        in cells; t = w00 - w10 - w01 + w11
//
// Sides: a clamped one mirrors w (zero slope), p = 2 w1 there. A hinged one carries no moment across it; on its nodes
// the curvature across is condensed out, which leaves (1 - nu^2)/2 D of the curvature along it, half because a side's
// node stands for half a cell. A guided one mirrors w and its nodes move: half the moment along it counts, and beyond
// it the moment across is that on it, which leaves half the force of a plate that goes on in its mirror image.
//
// A second difference is written as a change of changes: changes between neighbours of a smooth field are exact in
// floating point, so that the rounding of a curvature is relative to the slope and not to the deflection. Code that
// goes along rows can keep changes for the next row.
//
// All loads from memory come first, without branches around them: a compiler can then share them, and Vulkan in
// software, where each load costs time, loads 13 deflections and 9 rigidities.
//
// The includer provides, for nodes of the grid,  real rigidity(int i, int j),  real deflection(int i, int j)  for nodes
// of the same colour as the node of the call (i + j even apart) and  real otherColour(int i, int j)  for the others;
// they are the same field except within a half sweep.  real foundationShape(int i, int j)  is s, the foundation of a
// node over k; it is asked for only where the level has one.
// Include plate_grid.h first.
//
// Domain   any node that is not held; nodes outside the grid are never requested
// Source   energy as in engine/plate/reference/plate_energy.h; moment form after Kumari & Chaudhuri 2016, eqs 6 to 8

bool isHingedX(PlateLevel g, int i)
{
    return (i == 0 && (g.hinged & kSideX0) != 0u) || (i == g.cellsX && (g.hinged & kSideX1) != 0u);
}

bool isHingedZ(PlateLevel g, int j)
{
    return (j == 0 && (g.hinged & kSideZ0) != 0u) || (j == g.cellsZ && (g.hinged & kSideZ1) != 0u);
}

bool isGuidedX(PlateLevel g, int i)
{
    uint sides = g.free & ~g.hinged;
    return (i == 0 && (sides & kSideX0) != 0u) || (i == g.cellsX && (sides & kSideX1) != 0u);
}

bool isGuidedZ(PlateLevel g, int j)
{
    uint sides = g.free & ~g.hinged;
    return (j == 0 && (sides & kSideZ0) != 0u) || (j == g.cellsZ && (sides & kSideZ1) != 0u);
}

real change(real from, real to)
{
    return to - from;
}

real secondDifference(real before, real middle, real after)
{
    return change(change(before, middle), change(middle, after));
}

// Bending moments per rigidity; on a side along which the other one is condensed out, if `onHinge`.
real bendingX(PlateLevel g, bool onHinge, real p, real q)
{
    return onHinge ? real(g.exx) * p : real(g.kxx) * p + real(g.kxz) * q;
}

real bendingZ(PlateLevel g, bool onHinge, real p, real q)
{
    return onHinge ? real(g.ezz) * q : real(g.kzz) * q + real(g.kxz) * p;
}

// Bending moment along x of the node in column i, row j; zero where none acts, on hinged sides and outside.
real momentX(PlateLevel g, int i, int j, real nodeRigidity, real p, real q)
{
    real m = nodeRigidity * bendingX(g, isHingedZ(g, j), p, q);
    if (isGuidedZ(g, j)) m = real(0.5f) * m;
    return i < 0 || i > g.cellsX || isHingedX(g, i) ? real(0) : m;
}

real momentZ(PlateLevel g, int i, int j, real nodeRigidity, real p, real q)
{
    real m = nodeRigidity * bendingZ(g, isHingedX(g, i), p, q);
    if (isGuidedX(g, i)) m = real(0.5f) * m;
    return j < 0 || j > g.cellsZ || isHingedZ(g, j) ? real(0) : m;
}

// Twisting moment of the cell whose first corner is (i, j), from the changes of w along x on its two sides; zero
// outside.
real twistingMoment(PlateLevel g, int i, int j, real sumOfRigidities, real change0, real change1)
{
    real m = real(g.twist) * sumOfRigidities * change(change0, change1);
    return i < 0 || j < 0 || i >= g.cellsX || j >= g.cellsZ ? real(0) : m;
}

// Share of a cell's area that a node stands for.
real nodeShare(PlateLevel g, int i, int j)
{
    real x = i == 0 || i == g.cellsX ? real(0.5f) : real(1.0f);
    return j == 0 || j == g.cellsZ ? real(0.5f) * x : x;
}

// The foundation's force on a node per deflection.
real bedAt(PlateLevel g, int i, int j)
{
    real bed = real(g.bed) * nodeShare(g, i, j);
    return g.shapeAt == 0 ? bed : bed * foundationShape(i, j);
}

// The force of a node from second differences of the moments; `weight` is the foundation's, with the node's share.
real forceFrom(real bendingX2, real bendingZ2, real twisting2, real weight, real c)
{
    return ((bendingX2 + bendingZ2) + twisting2) + weight * c;
}

//                 i-2    i-1    i     i+1    i+2
//      j+2                      n2
//      j+1               nw     n1     ne                 values of w by compass: x runs east, z runs north
//      j           w2     w1     c     e1     e2
//      j-1               sw     s1     se
//      j-2                      s2
real operatorAt(PlateLevel g, int i, int j)
{
    int iw2 = mirrored(i - 2, g.cellsX), iw = mirrored(i - 1, g.cellsX);
    int ie2 = mirrored(i + 2, g.cellsX), ie = mirrored(i + 1, g.cellsX);
    int js2 = mirrored(j - 2, g.cellsZ), js = mirrored(j - 1, g.cellsZ);
    int jn2 = mirrored(j + 2, g.cellsZ), jn = mirrored(j + 1, g.cellsZ);

    real w2 = deflection(iw2, j), w1 = otherColour(iw, j), c = deflection(i, j);
    real e1 = otherColour(ie, j), e2 = deflection(ie2, j);
    real s2 = deflection(i, js2), s1 = otherColour(i, js), n1 = otherColour(i, jn), n2 = deflection(i, jn2);
    real sw = deflection(iw, js), nw = deflection(iw, jn), se = deflection(ie, js), ne = deflection(ie, jn);

    real Dc = rigidity(i, j), Dw = rigidity(iw, j), De = rigidity(ie, j), Ds = rigidity(i, js), Dn = rigidity(i, jn);
    real Dsw = rigidity(iw, js), Dnw = rigidity(iw, jn), Dse = rigidity(ie, js), Dne = rigidity(ie, jn);

    real p  = secondDifference(w1, c, e1);
    real q  = secondDifference(s1, c, n1);
    real mw = momentX(g, i - 1, j, Dw, secondDifference(w2, w1, c), secondDifference(sw, w1, nw));
    real mx = momentX(g, i, j, Dc, p, q);
    real me = momentX(g, i + 1, j, De, secondDifference(c, e1, e2), secondDifference(se, e1, ne));
    real ms = momentZ(g, i, j - 1, Ds, secondDifference(sw, s1, se), secondDifference(s2, s1, c));
    real mz = momentZ(g, i, j, Dc, p, q);
    real mn = momentZ(g, i, j + 1, Dn, secondDifference(nw, n1, ne), secondDifference(c, n1, n2));

    if (isGuidedX(g, i)) {
        mw = i == 0 ? mx : mw;
        me = i == g.cellsX ? mx : me;
    }
    if (isGuidedZ(g, j)) {
        ms = j == 0 ? mz : ms;
        mn = j == g.cellsZ ? mz : mn;
    }

    real tsw = twistingMoment(g, i - 1, j - 1, (Dsw + Ds) + (Dw + Dc), change(sw, s1), change(w1, c));
    real tse = twistingMoment(g, i, j - 1, (Ds + Dse) + (Dc + De), change(s1, se), change(c, e1));
    real tnw = twistingMoment(g, i - 1, j, (Dw + Dc) + (Dnw + Dn), change(w1, c), change(nw, n1));
    real tne = twistingMoment(g, i, j, (Dc + De) + (Dn + Dne), change(c, e1), change(n1, ne));

    real twisting = change(change(tsw, tse), change(tnw, tne));
    return forceFrom(secondDifference(mw, mx, me), secondDifference(ms, mz, mn), twisting,
                     bedAt(g, i, j), c);
}
