#pragma once
#include <cstddef>
#include <cstdint>

namespace palp {

/// Fronts that wait for a later one at any time; halves of halves are far fewer.
inline constexpr int kMostOpenFronts = 60;

inline constexpr int kWholeRows = 8; ///< of a front come in vectors

/// A dense part of a rim's factor: it eliminates its own unknowns, which are coupled to its border, unknowns of later
/// fronts. With the matrix [P B'; B C] that it meets, of both, it keeps B P^-1 and P^-1.
struct RimFront {
    int            first, own;          ///< its own unknowns, by number
    int            border;              ///< length of the border
    int            borderRows, ownRows; ///< rounded up to whole vectors
    std::ptrdiff_t borderAt;            ///< in RimView::borders
    std::ptrdiff_t columnsAt;           ///< in RimView::columns
    bool           isLeaf;              ///< the others take what the last two fronts before them left, not yet taken

    [[nodiscard]] int rows() const noexcept { return borderRows + ownRows; }
    [[nodiscard]] int rowsTogether() const noexcept
    {
        return (own + border + kWholeRows - 1) / kWholeRows * kWholeRows;
    }
};

/// The rim of a level as the host's kernels see it: plain memory, which a Rim owns. Unknowns are numbered in the order
/// of elimination.
struct RimView {
    const int*           nodes;   ///< of the level, by unknown
    const int*           numbers; ///< unknown by node, or -1
    const RimFront*      fronts;
    const int*           borders; ///< unknowns, in order
    const std::uint32_t* tiles;   ///< number of tiles with a node of the rim, then their indices
    void*                columns; ///< a front's: B P^-1, then P^-1, both followed by zeros [float or double]
    int                  unknowns, frontCount;
    int                  mostRows; ///< of a front
    bool                 doubles;
};

} // namespace palp
