#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/cloud/detail/numbers.h"
#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// An array of numbers, unpacked only when it is used.
struct VtkArray {
    std::string              name;
    std::uint64_t            components = 1;
    std::function<Numbers()> open;
    bool                     isNormals = false; ///< declared as such, or so called
};

/// Cells: lists of points. Two forms are in use: each list after its length, in one array; or all lists in one array,
/// and where each begins or ends in another.
struct VtkCells {
    enum class Kind { polygons, strips, mixed };

    Kind                    kind  = Kind::polygons;
    std::uint64_t           count = 0;
    VtkArray                lists;                ///< lengths and points, or points alone
    std::optional<VtkArray> offsets;              ///< where lists end; empty: their lengths stand before them
    bool                    beginsAtZero = false; ///< the offsets have a zero before the first
    std::optional<VtkArray> types;                ///< of mixed cells
};

/// A part of a VTK file with points of its own.
struct VtkPiece {
    std::uint64_t              points = 0;
    VtkArray                   coordinates;
    std::vector<VtkArray>      pointData;
    std::vector<VtkCells>      cells;
    std::vector<std::uint64_t> dimensions; ///< of a grid, three numbers whose product is `points`; else empty
};

/// Makes one cloud of the pieces of a file, by `format`. Arrays of one component are properties, normals are nx, ny and
/// nz, arrays of several others are skipped. Of cells the two-dimensional become faces; of cells with a volume only the
/// points are taken, which is a warning.
[[nodiscard]] LoadedCloud cloudOf(const WholeFile& file, std::span<const VtkPiece> pieces, const std::string& format,
                                  const CloudReadSettings& settings);

} // namespace palp
