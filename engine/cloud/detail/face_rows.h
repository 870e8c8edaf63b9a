#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/cloud/detail/byte_reader.h"
#include "engine/cloud/detail/cloud_rows.h"

namespace palp {

/// Makes triangles of the faces of a file: a polygon becomes a fan about its first corner, or, where that would leave a
/// concave polygon, triangles that lie within it. A face with fewer than three corners, or with a corner twice, is
/// omitted and counted; so are triangles of points that were merged. Faces may come before the points they are made of.
/// Use: for each face `addCorner` and then `endFace`; `finish` once all points are read.
/// \thread one
class FaceRows {
public:
    /// \param points  rows of points in the file
    FaceRows(const ByteReader& reader, std::uint64_t points);

    /// Makes room for the triangles of a file; only the bytes that are left bound their number.
    /// \param faces       rows of the element
    /// \param leastBytes  that a triangle takes in the file, > 0
    void expect(std::uint64_t faces, std::uint64_t leastBytes);

    /// Takes the next corner of the face that is being read.
    /// \param corner  index of a point as it stands in the file
    /// \throws Error naming the face if it is no whole number below the number of points
    void addCorner(double corner, CloudRows::Place place);
    void endFace();

    /// Gives the faces to the cloud of their points, and counts them in its report. A face that lost a point is
    /// omitted.
    void finish(LoadedCloud& loaded);

private:
    void                                makeRoom(std::size_t count);
    [[nodiscard]] bool                  cornersDiffer();
    void                                keepWithinPolygons(const LoadedCloud& loaded);
    [[nodiscard]] std::vector<Triangle> byPoints(std::span<const std::uint32_t> pointOfRow, CloudFileReport& report);

    const ByteReader&          reader_;
    std::uint64_t              points_;
    std::uint64_t              promised_ = 0; ///< faces by the file's header; 0: it does not tell
    std::uint64_t              began_    = 0; ///< offset behind the first corner [bytes]
    std::vector<std::uint32_t> corners_; ///< of the face that is being read, one more than there are points at most
    std::vector<std::uint32_t> sorted_;  ///< scratch
    std::vector<Triangle>      triangles_;
    std::vector<std::uint32_t> fans_; ///< triangles of each face that is in triangles_
    std::size_t                faces_ = 0, degenerate_ = 0;
};

} // namespace palp
