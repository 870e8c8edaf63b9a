#include "engine/cloud/detail/row_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <ostream>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Number of bytes that are collected before the stream is called.
constexpr std::size_t kBlock = std::size_t(1) << 18;

/// Most characters of a number: the longest shortest text of a double is "-2.2250738585072014e-308", then a separator.
constexpr std::size_t kLongestNumber = 25;

bool isPlainName(const std::string& name)
{
    return !name.empty() && std::all_of(name.begin(), name.end(),
                                        [](char c) { return c > ' ' && c <= '~' && c != ',' && c != ';' && c != '#'; });
}

} // namespace

RowWriter::RowWriter(const PointCloud& cloud, std::span<const NamedField> extraFields)
    : cloud_(cloud), extraFields_(extraFields), columns_{"x", "y", "z", propertyOf(cloud.kind())},
      comments_{"length_unit m", std::string("stiffness_unit ") + unitOf(cloud.kind())}
{
    for (const NamedField& field : extraFields) {
        const auto taken = [&](const auto& names) {
            return std::find(names.begin(), names.end(), field.name) != names.end();
        };
        PALP_EXPECT(isPlainName(field.name), "the field is called " + inQuotes(field.name));
        PALP_EXPECT(!taken(columns_) && !taken(kStiffnessProperties),
                    "the name " + inQuotes(field.name) + " of a field has another meaning");
        PALP_EXPECT(field.values.size() == cloud.size(), "field " + inQuotes(field.name) + " has " +
                                                             std::to_string(field.values.size()) + " values for " +
                                                             std::to_string(cloud.size()) + " points");
        columns_.push_back(field.name);
        if (!field.unit.empty()) comments_.push_back("unit " + field.name + " " + field.unit);
    }
}

template <class Append>
void RowWriter::writeRows(std::ostream& stream, std::size_t mostBytesPerNumber, const Append& append) const
{
    const std::size_t mostBytesPerRow = columns_.size() * mostBytesPerNumber;
    std::vector<char> block(std::max(kBlock, mostBytesPerRow));
    char*             end = block.data();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
        if (std::size_t(block.data() + block.size() - end) < mostBytesPerRow) {
            stream.write(block.data(), end - block.data());
            end = block.data();
        }
        const glm::dvec3& p = cloud_.positions()[i];
        for (const double value : {p.x, p.y, p.z, cloud_.stiffness()[i]}) end = append(end, value, false);
        for (const NamedField& field : extraFields_) end = append(end, field.values[i], false);
        end = append(end, 0, true);
    }
    stream.write(block.data(), end - block.data());
}

void RowWriter::writeText(std::ostream& stream, char separator) const
{
    writeRows(stream, kLongestNumber, [separator](char* at, double value, bool rowEnds) {
        if (rowEnds) {
            *(at - 1) = '\n'; // in place of the last separator
            return at;
        }
        at  = std::to_chars(at, at + kLongestNumber, value).ptr;
        *at = separator;
        return at + 1;
    });
}

void RowWriter::writeBinary(std::ostream& stream, std::endian order) const
{
    writeRows(stream, sizeof(double), [order](char* at, double value, bool rowEnds) {
        if (rowEnds) return at;
        std::memcpy(at, &value, sizeof value);
        if (order != std::endian::native) std::reverse(at, at + sizeof value);
        return at + sizeof value;
    });
}

} // namespace palp
