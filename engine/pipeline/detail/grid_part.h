#pragma once
#include "engine/core/grid.h"
#include "engine/pipeline/compliance_table_solve.h"
#include "engine/pipeline/patch.h"
#include "engine/plate/footprint.h"
#include "engine/plate/shell.h"

namespace palp {

/// A rectangle of a grid's nodes: of a window that spans an object, what the object covers, which is less than a
/// quarter of it. Only that is solved for; what is cut off is the void beyond free borders, and what lies behind held
/// ones.
class GridPart {
public:
    /// Takes the sheet with a margin; all of the grid where the window spans no object.
    explicit GridPart(const Patch& patch);

    /// Returns the same part of a grid of twice the spacing.
    [[nodiscard]] GridPart everySecond() const;

    [[nodiscard]] NodeField        of(const NodeField& field) const; ///< of an empty field: empty
    [[nodiscard]] Plate            of(const Plate& plate) const;
    [[nodiscard]] Shell            of(const Shell& shell) const;
    [[nodiscard]] Footprint        of(const Footprint& load) const; ///< without what does not press
    [[nodiscard]] FootprintLattice of(const FootprintLattice& lattice) const;

    /// Returns the field on all of the grid, with 0 beyond the part.
    [[nodiscard]] NodeField onWhole(const NodeField& field) const;

private:
    PlateGrid whole_, part_;
    int       firstX_ = 0, firstZ_ = 0; ///< its first node's index in the whole, an even number
};

} // namespace palp
