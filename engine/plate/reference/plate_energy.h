#pragma once
#include <array>
#include <cstddef>

#include "engine/plate/load.h"
#include "engine/plate/plate.h"

namespace palp {

// The energy of a plate as a sum of small quadratic terms, each
//
//     1/2 (kpp p^2 + 2 kpq p q + kqq q^2)        p, q undivided differences of w [m], k.. stiffnesses [N/m]
//
// The terms are listed once, by visitTerms; matrix and residual are two uses of that list. There is no stencil.
//
//   node (i, j), area A:   p = w(i-1) - 2 w(i) + w(i+1) along x,  q the same along z,
//                          kpp = D A / hx^4,  kqq = D A / hz^4,  kpq = nu D A / (hx^2 hz^2)
//   cell, mean rigidity Dc: p = w00 - w10 - w01 + w11,  kpp = 2 (1 - nu) Dc hx hz / (hx hz)^2
//   foundation:            p = w(i, j),  kpp = k A
//
// On a node of an edge the difference across that edge reaches outside the plate:
//
//   clamped            zero slope: the ghost mirrors the first inner node, p = 2 w(1) - 2 w(0)
//   supported or free  no bending moment, p + nu q hx^2/hz^2 = 0: p is condensed out, which leaves
//                      (1 - nu^2) kqq q^2 / 2. Along a supported edge w is zero, so that term is zero.
//
// A corner takes the rule of either side for its own direction, and is held if either side holds it:
//
//   free/free and free/supported    both differences condensed out: no bending energy
//   clamped/free                    (1 - nu^2) kpp p^2 / 2 with the mirrored p; w is zero at the corner
//   all others                      differences along held sides: zero

/// A sum of a few nodal values times small whole numbers.
struct Difference {
    int                   count = 0;
    std::array<int, 4>    node{};   ///< index into a NodeField's values
    std::array<double, 4> factor{}; ///< [1]

    void add(int atNode, double withFactor)
    {
        node[std::size_t(count)]     = atNode;
        factor[std::size_t(count++)] = withFactor;
    }
};

struct EnergyTerm {
    Difference p, q;
    double     kpp = 0, kpq = 0, kqq = 0; ///< [N/m]
};

/// Returns the sum of the products of a difference with a field.
[[nodiscard]] double valueOf(const Difference& d, const NodeField& field);

[[nodiscard]] EnergyTerm bendingTerm(const Plate& plate, int i, int j);  ///< of a node
[[nodiscard]] EnergyTerm twistingTerm(const Plate& plate, int i, int j); ///< of the cell whose first corner is (i, j)
[[nodiscard]] EnergyTerm foundationTerm(const Plate& plate, int i, int j);

/// Calls visit(term) for every term of the energy, always in the same order.
template <class Visit>
void visitTerms(const Plate& plate, Visit&& visit)
{
    for (int i = 0; i < plate.grid.nodesX(); ++i)
        for (int j = 0; j < plate.grid.nodesZ(); ++j) {
            visit(bendingTerm(plate, i, j));
            if (i < plate.grid.cellsX && j < plate.grid.cellsZ) visit(twistingTerm(plate, i, j));
            if (plate.foundation > 0) visit(foundationTerm(plate, i, j));
        }
}

/// Returns forces [N] minus the energy's gradient at w [m], in moment form: differences first, products with the
/// rigidity second. The matrix would lose the small differences of w to the rounding of its own entries. On held nodes
/// the result is the reaction of the edge.
[[nodiscard]] NodeField energyResidual(const Plate& plate, const NodeField& forces, const NodeField& w);

} // namespace palp
