#pragma once
#include <memory>

#include "engine/core/grid.h"
#include "engine/plate/footprint.h"
#include "engine/plate/shell.h"

namespace palp {

/// What bends a curved object besides w'': its points also move along the surface, by u, and where that is curved by k
/// their normals turn by k u. The shallow theory leaves this out; it bends the sheet by (k u)'.
///
/// u is what leaves the sheet as long as it was, u' = k w, and 0 where the object is held: on few nodes, in the sense
/// of least squares weighed by the rigidity. Of an arch u' k = k^2 w counts, of what is curved in part or to and fro
/// k' u as well. A lump that goes up and down with a panel is not bent by it, since the work of even moments along
/// (k u)' is that of its ends.
///
/// Where a sheet is curved both ways, terms of the Gaussian curvature are missing in what its stretching must be
/// compatible with as well, and these of bending alone make caps softer and cups stiffer than they are, by 2 to 4 %: so
/// they count by 1 - (k1 k2)^2 / (mean of k1 and k2)^4 over some cells around, and on spheres and saddles not at
/// all.
/// \source  Sanders 1959, an improved first-approximation theory for thin shells; Koiter 1960
/// \differs the energy's change at the shallow theory's w, not an operator: see givesWay(). The rotation about the
///          normal is left out (it changed arches, gutters and caps by 0.7 % at most), and what the sheet stretches by
class CurvedBending {
public:
    /// \param shell  which outlives this. Without a border, Shell::stretched, nothing counts, since dents die away
    ///          within; nor where nothing is held
    explicit CurvedBending(const Shell& shell);
    ~CurvedBending();
    CurvedBending(const CurvedBending&)            = delete;
    CurvedBending& operator=(const CurvedBending&) = delete;

    /// Returns the work of the moments of w along (k u)' [N m].
    /// \param w  of the load [m]
    [[nodiscard]] double workOf(const NodeField& w) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_; ///< none where nothing counts
};

/// Returns how far a footprint gives way over what the shallow theory says [1]: exp(-q), where q is the change of
/// energy over the energy, from -1/2 to 3/2 at most. Bent bars, which give way as far as levers say, are up to 3 %
/// stiffer than this where q is up to 0.6, 8 % at 0.8 and 20 % at 1.3; by Rayleigh's quotient, 1 / (1 + q), three to
/// five times as much.
[[nodiscard]] double givesWay(const FootprintResponse& response) noexcept;

} // namespace palp
