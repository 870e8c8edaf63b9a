#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/cloud/detail/byte_reader.h"
#include "engine/cloud/detail/cloud_rows.h"

namespace palp {

/// Makes triangles of the faces of a file: a polygon becomes a fan about its first corner. A face with fewer than three
/// corners, or with a corner twice, is omitted and counted. Faces may come before the points they are made of.
/// Use: for each face `addCorner` and then `endFace`; `finish` once all points are read.
/// \thread one
class FaceRows {
public:
    /// Tells if points may be dropped later, so that faces must be remembered as wholes.
    enum class Points { allKept, someDropped };

    /// \param points  rows of points in the file
    FaceRows(const ByteReader& reader, std::uint64_t points, Points kept);

    /// Makes room for the triangles of a file; only the bytes that are left bound their number.
    /// \param faces       rows of the element
    /// \param leastBytes  that a triangle takes in the file, > 0
    void expect(std::uint64_t faces, std::uint64_t leastBytes);

    /// Takes the next corner of the face that is being read.
    /// \param corner  index of a point as it stands in the file
    /// \throws Error naming the face if it is no whole number below the number of points
    void addCorner(double corner, CloudRows::Place place);
    void endFace();

    /// Returns the triangles by the numbers of the points that are left; a face that lost a point is omitted.
    /// \param dropped  rows of points, rising
    [[nodiscard]] std::vector<Triangle> finish(std::span<const std::uint32_t> dropped);

    [[nodiscard]] std::size_t faces() const noexcept { return faces_; }           ///< rows read
    [[nodiscard]] std::size_t degenerate() const noexcept { return degenerate_; } ///< too few corners, or one twice
    [[nodiscard]] std::size_t dropped() const noexcept { return dropped_; }       ///< lost a point, after finish()

private:
    [[nodiscard]] bool cornersDiffer();

    const ByteReader&          reader_;
    std::uint64_t              points_;
    Points                     kept_;
    std::vector<std::uint32_t> corners_; ///< of the face that is being read, one more than there are points at most
    std::vector<std::uint32_t> sorted_;  ///< scratch
    std::vector<Triangle>      triangles_;
    std::vector<std::uint32_t> fans_; ///< triangles of each face that is in triangles_; unused with allKept
    std::size_t                faces_ = 0, degenerate_ = 0, dropped_ = 0;
};

} // namespace palp
