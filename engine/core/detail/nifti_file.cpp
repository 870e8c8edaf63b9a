#include "engine/core/detail/nifti_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <istream>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <zlib.h>

#include "engine/core/contract.h"
#include "engine/core/detail/volume_values.h"
#include "engine/core/quantity.h"

// Source: NIfTI-1 data format, nifti1.h of the Data Format Working Group; byte numbers below are from there.

namespace palp {
namespace {

constexpr std::size_t kHeader = 348; ///< bytes

/// The bytes of a file from its begin to its end, unpacked if gzip has packed them.
class Unpacked {
public:
    Unpacked(std::istream& in, std::uint64_t size, const std::string& name) : in_(in), size_(size), name_(name)
    {
        packed_ = in_.peek() == 0x1f;
        if (packed_ && inflateInit2(&zlib_, kGzip) != Z_OK) throw Error(name_ + ": there is no memory to unpack it");
    }
    ~Unpacked()
    {
        if (packed_) inflateEnd(&zlib_);
    }
    Unpacked(const Unpacked&)            = delete;
    Unpacked& operator=(const Unpacked&) = delete;

    void take(char* to, std::size_t count, const char* what)
    {
        const std::size_t found = packed_ ? inflated(to, count) : plain(to, count);
        if (found != count)
            throw Error(name_ + ": byte " + std::to_string(taken_ + found) + (packed_ ? " when unpacked" : "") +
                        ": the file ends within " + what + ": expected " + std::to_string(count - found) +
                        " more bytes; it may have been cut short while it was copied");
        taken_ += count;
    }

    /// Returns the most bytes that can follow: deflate packs 1032 into one at best.
    [[nodiscard]] std::uint64_t mostLeft() const noexcept
    {
        constexpr std::uint64_t kMostRatio = 1032;
        return packed_ ? size_ * kMostRatio : size_ - std::min(size_, taken_);
    }

    [[nodiscard]] std::uint64_t taken() const noexcept { return taken_; }

private:
    static constexpr int kGzip = 15 + 16; // the largest window, and gzip's header

    std::size_t plain(char* to, std::size_t count)
    {
        in_.read(to, std::streamsize(std::min<std::uint64_t>(count, size_ - std::min(size_, taken_))));
        return std::size_t(in_.gcount());
    }

    /// Reads on where all that was read is unpacked.
    void refill()
    {
        if (zlib_.avail_in > 0) return;
        in_.read(block_.data(), std::streamsize(block_.size()));
        zlib_.next_in  = reinterpret_cast<Bytef*>(block_.data());
        zlib_.avail_in = uInt(in_.gcount());
    }

    std::size_t inflated(char* to, std::size_t count)
    {
        zlib_.next_out  = reinterpret_cast<Bytef*>(to);
        zlib_.avail_out = uInt(count); // blocks of a megabyte at most
        while (zlib_.avail_out > 0) {
            refill();
            const int status = inflate(&zlib_, Z_NO_FLUSH);
            if (status == Z_STREAM_END) { // of a member; a file may have several, and zeros after the last
                refill();
                constexpr Bytef kFirst = 0x1f; // of gzip's header
                if (zlib_.avail_in == 0 || *zlib_.next_in != kFirst || inflateReset(&zlib_) != Z_OK) break;
                continue;
            }
            if (status == Z_BUF_ERROR) break;
            if (status != Z_OK)
                throw Error(name_ + ": byte " + std::to_string(taken_) +
                            " when unpacked: the compressed data is damaged; is it a whole file of gzip?");
        }
        return count - zlib_.avail_out;
    }

    std::istream&      in_;
    std::uint64_t      size_;
    const std::string& name_;
    z_stream           zlib_{};
    bool               packed_ = false;
    std::uint64_t      taken_  = 0;
    std::vector<char>  block_  = std::vector<char>(1u << 16);
};

template <class Number>
Number load(const char* bytes, bool swapped)
{
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), bytes, raw.size());
    if (swapped) std::ranges::reverse(raw);
    return std::bit_cast<Number>(raw);
}

template <class Number>
double loadNumber(const char* bytes, bool swapped)
{
    return double(load<Number>(bytes, swapped));
}

/// One type of numbers in a file.
struct DataType {
    int         code                  = 0;
    std::size_t bytes                 = 0;
    double (*load)(const char*, bool) = nullptr;
};
constexpr std::array kTypes = {
    DataType{2, 1, loadNumber<std::uint8_t>},    DataType{4, 2, loadNumber<std::int16_t>},
    DataType{8, 4, loadNumber<std::int32_t>},    DataType{16, 4, loadNumber<float>},
    DataType{64, 8, loadNumber<double>},         DataType{256, 1, loadNumber<std::int8_t>},
    DataType{512, 2, loadNumber<std::uint16_t>}, DataType{768, 4, loadNumber<std::uint32_t>},
};

/// The header: 348 bytes, of which only those are read that place and scale the values.
class Header {
public:
    Header(Unpacked& bytes, const std::string& name) : name_(name)
    {
        bytes.take(raw_.data(), raw_.size(), "its header of 348 bytes");
        constexpr std::int32_t kSize = 348, kSecond = 540;
        swapped_ = load<std::int32_t>(raw_.data(), true) == kSize;
        if (const auto size = at<std::int32_t>(0); size != kSize)
            fail(0, "expected 348, the size of a NIfTI-1 header, found " + std::to_string(size) +
                        (size == kSecond || load<std::int32_t>(raw_.data(), true) == kSecond
                             ? ", which is NIfTI-2; save it as NIfTI-1"
                             : "; is it a .nii file?"));
        const std::string_view magic(raw_.data() + 344, 4);
        if (magic == std::string_view("ni1\0", 4))
            fail(344, "expected a header and its values in one file, found a header of two files; save it as one .nii");
        if (magic != std::string_view("n+1\0", 4)) fail(344, "expected the word n+1 of NIfTI-1, found another");
    }

    [[nodiscard]] std::array<int, 3> size() const
    {
        const int dimensions = at<std::int16_t>(40);
        if (dimensions < 3 || dimensions > 7) fail(40, "expected 3 dimensions, found " + std::to_string(dimensions));
        for (int k = 4; k <= dimensions; ++k)
            if (const int more = dim(k); more != 1)
                fail(40 + 2 * k, "expected one volume of values, found " + std::to_string(more) + " along axis " +
                                     std::to_string(k) + "; save one of them");
        for (int k = 1; k <= 3; ++k)
            if (dim(k) < 2)
                fail(40 + 2 * k, "expected two voxels or more along axis " + std::to_string(k) + ", found " +
                                     std::to_string(dim(k)));
        return {dim(1), dim(2), dim(3)};
    }

    [[nodiscard]] const DataType& type() const
    {
        const int  code  = at<std::int16_t>(70);
        const auto found = std::ranges::find(kTypes, code, &DataType::code);
        if (found == kTypes.end())
            fail(70, "expected real numbers of 8 to 64 bits (types 2, 4, 8, 16, 64, 256, 512, 768), found type " +
                         std::to_string(code) + "; save it as float32");
        return *found;
    }

    /// Returns the byte at which the values begin.
    [[nodiscard]] std::uint64_t begin() const
    {
        const float offset = at<float>(108);
        if (!(offset >= 348 && offset <= 1e9F) || offset != std::floor(offset))
            fail(108, "expected the byte at which the values begin, 352 or more, found " + std::to_string(offset));
        return std::uint64_t(offset);
    }

    struct Scale {
        double slope = 1, inter = 0;
    };
    /// Returns how values are scaled; a slope of zero or NaN means that they are not.
    [[nodiscard]] Scale scale() const
    {
        const double slope = at<float>(112), inter = at<float>(116);
        if (std::isnan(slope) || slope == 0) return {};
        if (!std::isfinite(slope) || std::isinf(inter))
            fail(112, "expected a finite slope and intercept of the values");
        return {slope, std::isnan(inter) ? 0 : inter};
    }

    /// Returns the metres in one unit of length.
    [[nodiscard]] double metres(const std::string& stated) const
    {
        if (!stated.empty()) return metresPer(stated);
        switch (raw_[123] & 7) {
        case 1:
            return 1;
        case 2:
            return 1e-3;
        case 3:
            return 1e-6;
        default:
            fail(123, "expected a unit of length, found none; state it beside the file: \"length_unit\": \"mm\", "
                      "which nearly all programs mean");
        }
    }

    struct Placement {
        glm::dmat3 axes{};   ///< per voxel, in the file's unit
        glm::dvec3 origin{}; ///< in the file's unit
    };
    [[nodiscard]] Placement placement() const
    {
        const Placement place   = at<std::int16_t>(254) > 0   ? byRows()
                                  : at<std::int16_t>(252) > 0 ? byQuaternion()
                                                              : bySizes();
        const auto&     a       = place.axes;
        const auto      lengths = glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]);
        const auto      volume  = std::abs(glm::determinant(a));
        const auto      finite  = std::isfinite(glm::dot(place.origin, glm::dvec3(1)) + lengths + volume);
        if (!finite || !(volume > 1e-6 * lengths))
            fail(280, "expected three axes of voxels that are finite and not in a plane, found others");
        return place;
    }

private:
    [[nodiscard]] int dim(int k) const { return at<std::int16_t>(std::size_t(40 + 2 * k)); }

    [[nodiscard]] Placement byRows() const
    {
        Placement place;
        for (int row = 0; row < 3; ++row) {
            const auto begin = std::size_t(280 + 16 * row);
            for (int k = 0; k < 3; ++k) place.axes[k][row] = at<float>(begin + 4 * std::size_t(k));
            place.origin[row] = at<float>(begin + 12);
        }
        return place;
    }

    [[nodiscard]] Placement byQuaternion() const
    {
        const double b = at<float>(256), c = at<float>(260), d = at<float>(264);
        const double rest = 1 - b * b - c * c - d * d;
        if (!(rest > -1e-5)) fail(256, "expected a quaternion of length 1, found b, c, d that are longer");
        const double     a     = std::sqrt(std::max(rest, 0.0));
        const double     flip  = at<float>(76) < 0 ? -1 : 1;
        const glm::dvec3 sizes = voxelSizes();
        Placement        place;
        place.axes[0] = sizes.x * glm::dvec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
        place.axes[1] = sizes.y * glm::dvec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b));
        place.axes[2] =
            flip * sizes.z * glm::dvec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c);
        place.origin = {at<float>(268), at<float>(272), at<float>(276)};
        return place;
    }

    [[nodiscard]] Placement bySizes() const
    {
        const glm::dvec3 sizes = voxelSizes();
        Placement        place;
        place.axes = glm::dmat3(sizes.x, 0, 0, 0, sizes.y, 0, 0, 0, sizes.z);
        return place;
    }

    [[nodiscard]] glm::dvec3 voxelSizes() const
    {
        const glm::dvec3 sizes(at<float>(80), at<float>(84), at<float>(88));
        if (!(std::min({sizes.x, sizes.y, sizes.z}) > 0)) fail(80, "expected sizes of voxels above zero");
        return sizes;
    }

    template <class Number>
    [[nodiscard]] Number at(std::size_t byte) const
    {
        return load<Number>(raw_.data() + byte, swapped_);
    }

    [[noreturn]] void fail(int byte, const std::string& message) const
    {
        throw Error(name_ + ": byte " + std::to_string(byte) + ": " + message);
    }

    const std::string&        name_;
    std::array<char, kHeader> raw_{};
    bool                      swapped_ = false;

public:
    [[nodiscard]] bool swapped() const noexcept { return swapped_; }
};

/// Reads the values in blocks.
void readValues(Unpacked& bytes, const Header& header, std::uint64_t count, VolumeValues& to)
{
    constexpr std::uint64_t kBlock = 1u << 16; // numbers
    const DataType&         type   = header.type();
    const auto              scale  = header.scale();
    std::vector<char>       block(std::size_t(kBlock * type.bytes));
    for (std::uint64_t left = count; left > 0;) {
        const std::uint64_t now = std::min(left, kBlock);
        bytes.take(block.data(), std::size_t(now * type.bytes), "its values");
        for (std::uint64_t n = 0; n < now; ++n)
            to.add(scale.slope * type.load(block.data() + n * type.bytes, header.swapped()) + scale.inter);
        left -= now;
    }
}

} // namespace

VolumeGrid parseNifti(std::istream& in, std::uint64_t size, const std::string& name, const VolumeSettings& settings)
{
    Unpacked            bytes(in, size, name);
    const Header        header(bytes, name);
    const auto          nodes     = header.size();
    const DataType&     type      = header.type();
    const std::uint64_t begin     = header.begin();
    const double        metres    = header.metres(settings.lengthUnit);
    const auto          placement = header.placement();
    std::uint64_t       count     = 1;
    for (const int each : nodes) count *= std::uint64_t(each); // below 2^45
    if (const std::uint64_t needed = begin - bytes.taken() + count * type.bytes; needed > bytes.mostLeft())
        throw Error(name + ": byte 40: the header promises " + std::to_string(count) + " values of " +
                    std::to_string(type.bytes) + " bytes, but at most " + std::to_string(bytes.mostLeft()) +
                    " bytes follow; it may have been cut short while it was copied");
    std::vector<char> between(std::size_t(std::min<std::uint64_t>(begin - bytes.taken(), 1u << 16)));
    while (bytes.taken() < begin)
        bytes.take(between.data(), std::size_t(std::min<std::uint64_t>(begin - bytes.taken(), between.size())),
                   "what stands before its values");
    VolumeValues values(name, nodes, true, settings.factor);
    readValues(bytes, header, count, values);
    return {nodes, values.take(), metres * placement.axes, metres * placement.origin};
}

} // namespace palp
