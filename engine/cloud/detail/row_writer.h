#pragma once
#include <bit>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Writes the parts of a cloud that all formats share: names, units and rows of doubles.
/// The cloud and the fields must outlive it.
class RowWriter {
public:
    RowWriter(const PointCloud& cloud, std::span<const NamedField> extraFields);

    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; } ///< x y z stiffness ...
    [[nodiscard]] const std::vector<std::string>& comments() const noexcept { return comments_; } ///< the units

    /// Writes one line per point, with as many digits as bring the same double back.
    void writeText(std::ostream& stream, char separator) const;
    /// Writes every point's doubles in the given byte order.
    void writeBinary(std::ostream& stream, std::endian order) const;

private:
    template <class Append>
    void writeRows(std::ostream& stream, std::size_t mostBytesPerNumber, const Append& append) const;

    const PointCloud&           cloud_;
    std::span<const NamedField> extraFields_;
    std::vector<std::string>    columns_;
    std::vector<std::string>    comments_;
};

} // namespace palp
