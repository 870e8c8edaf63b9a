#pragma once
#include "engine/plate/reference/plate_energy.h"
#include "engine/plate/shell.h"

namespace palp {

// What couples the deflection of a shell with its membrane, as sums of small terms in undivided differences.
//
// Where the surface is curved: - int w (kx phi_zz + kz phi_xx - 2 kxz phi_xz) = sum of k w n(phi), see Shell; n is a
// second difference at the node of w, or the twist of a cell at each of whose corners w is a quarter.
//
// What a sheet stores beyond the linear theory when it turns out of its surface as it bends,
//
//     T(w, phi) = 1/2 int N : (grad w, grad w)        N from phi as for Shell, tension positive
//
// as a sum of small cubic terms 1/2 k n(phi) s(w) t(w) of undivided differences:
//
//   edge along x, each end's half:  n = phi_zz at that node,  s = t = w(i+1) - w(i),  the same along z with phi_xx
//   cell:                           n = phi_xz,  s = sum of both differences along x, t of those along z;  Nxz =
//   -phi_xz
//
// Where an edge of the membrane leaves no second difference, n is empty. Together with the quadratic energies this is
// the theory of Marguerre and von Karman, valid while slopes stay small, some two thicknesses deep.
//
// Beyond a border the terms count on: the load of all slopes around a node is the determinant of second differences of
// w, none of a sheet that bends without being stretched, and w goes on smoothly. Terms that ended at the border instead
// left loads along it by which such sheets hardened (a T by a third, two thicknesses deep). They end at the ground of
// what is held: it has no bed and hardly gives way, while w beside it may be anything; arches hardened fourfold by
// that.
// \source  von Karman 1910; Marguerre 1938

struct CouplingTerm {
    int        node = 0;      ///< of w
    Difference force;         ///< n
    double     stiffness = 0; ///< k [1/m] of w [m] and phi [N m]
};

/// Calls visit(term) for every term of the coupling by curvature, always in the same order.
/// \param membrane  of membraneOf(shell)
template <class Visit>
void visitCouplingTerms(const Shell& shell, const Plate& membrane, Visit&& visit)
{
    const PlateGrid& g  = membrane.grid;
    const double     hx = g.spacingX, hz = g.spacingZ;
    const NodeField& kxz = shell.curvatureXZ;
    for (int i = 0; i < g.nodesX(); ++i)
        for (int j = 0; j < g.nodesZ(); ++j) {
            const int        node = i * g.nodesZ() + j, beside = node + g.nodesZ();
            const EnergyTerm bending = bendingTerm(membrane, i, j); // p: undivided phi_xx, q: phi_zz
            visit(CouplingTerm{node, bending.p, -shell.curvatureZ(i, j) * nodeArea(g, i, j) / (hx * hx)});
            visit(CouplingTerm{node, bending.q, -shell.curvatureX(i, j) * nodeArea(g, i, j) / (hz * hz)});
            if (i == g.cellsX || j == g.cellsZ) continue;
            const double     mean  = 0.25 * (kxz(i, j) + kxz(i + 1, j) + kxz(i, j + 1) + kxz(i + 1, j + 1));
            const Difference twist = twistingTerm(membrane, i, j).p; // undivided phi_xz; the cell's area cancels
            for (const int corner : {node, beside, node + 1, beside + 1})
                visit(CouplingTerm{corner, twist, 2 * mean * 0.25});
        }
}

struct StretchTerm {
    Difference force;         ///< n
    Difference slope, across; ///< s, t
    double     stiffness = 0; ///< k [1/m^2] of phi [N m] and w [m]
};

/// Returns whether slopes stretch the sheet at a node.
[[nodiscard]] inline bool isStretched(const Shell& shell, int i, int j)
{
    return shell.stretched.values().empty() || shell.stretched(i, j) > 0;
}

/// Calls visit(term) for every term of T, always in the same order.
/// \param membrane  of membraneOf(shell)
template <class Visit>
void visitStretchTerms(const Shell& shell, const Plate& membrane, Visit&& visit)
{
    const PlateGrid& g  = membrane.grid;
    const double     hx = g.spacingX, hz = g.spacingZ;
    const auto       differenceOf = [](int from, int to) {
        Difference d;
        d.add(from, -1);
        d.add(to, 1);
        return d;
    };
    for (int i = 0; i < g.nodesX(); ++i)
        for (int j = 0; j < g.nodesZ(); ++j) {
            if (!isStretched(shell, i, j)) continue;
            const int        node = i * g.nodesZ() + j, ahead = node + g.nodesZ();
            const EnergyTerm bending = bendingTerm(membrane, i, j); // p: phi_xx, q: phi_zz, undivided
            const double     rimX    = i == 0 || i == g.cellsX ? 0.5 : 1;
            const double     rimZ    = j == 0 || j == g.cellsZ ? 0.5 : 1;
            const auto       edgeOf  = [&](const Difference& force, int from, int to, double stiffness) {
                const Difference d = differenceOf(from, to);
                if (force.count > 0) visit(StretchTerm{force, d, d, stiffness});
            };
            // half of area hx hz / (hz^2 hx^2), and of half that area along a rim
            const double each = 0.5 / (hx * hz);
            if (i < g.cellsX) edgeOf(bending.q, node, ahead, each * rimZ);
            if (i > 0) edgeOf(bending.q, node - g.nodesZ(), node, each * rimZ);
            if (j < g.cellsZ) edgeOf(bending.p, node, node + 1, each * rimX);
            if (j > 0) edgeOf(bending.p, node - 1, node, each * rimX);
            if (i == g.cellsX || j == g.cellsZ || !isStretched(shell, i + 1, j) || !isStretched(shell, i, j + 1) ||
                !isStretched(shell, i + 1, j + 1))
                continue;
            StretchTerm twist{twistingTerm(membrane, i, j).p, differenceOf(node, ahead), differenceOf(node, node + 1),
                              -2 * 0.25 / (hx * hz)}; // 2 Nxz w_x w_z, each slope the mean of two differences
            twist.slope.add(node + 1, -1);
            twist.slope.add(ahead + 1, 1);
            twist.across.add(ahead, -1);
            twist.across.add(ahead + 1, 1);
            visit(twist);
        }
}

/// Returns the forces B phi of membrane forces on a curved sheet [N]; the coupling is w . B phi.
[[nodiscard]] NodeField couplingForces(const Shell& shell, const NodeField& phi);

/// Returns the load B' w of a curved sheet's deflection on its membrane [1].
[[nodiscard]] NodeField couplingLoad(const Shell& shell, const NodeField& w);

/// Returns the forces S(phi) w by which membrane forces resist slopes [N]: T = w . S(phi) w / 2.
[[nodiscard]] NodeField stretchForces(const Shell& shell, const Plate& membrane, const NodeField& phi,
                                      const NodeField& w);

/// Returns the incompatibility s(v, w) by which slopes load the membrane [1]: s(v, w) . phi =
/// v . S(phi) w.
[[nodiscard]] NodeField stretchOf(const Shell& shell, const Plate& membrane, const NodeField& v, const NodeField& w);

} // namespace palp
