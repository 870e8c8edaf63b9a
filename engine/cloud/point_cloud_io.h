#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/cloud/cloud_format.h"
#include "engine/cloud/point_cloud.h"
#include "engine/cloud/triangle.h"
#include "engine/core/enum_names.h"

namespace palp {

/// The form of numbers in a written PLY or PCD file; text files are always text.
enum class CloudEncoding { binaryLittleEndian, binaryBigEndian, ascii };
constexpr auto namesOf(CloudEncoding)
{
    using enum CloudEncoding;
    return std::to_array<NamedValue<CloudEncoding>>(
        {{binaryLittleEndian, "binary"}, {binaryBigEndian, "binary-big-endian"}, {ascii, "ascii"}});
}

enum class RangeScale { linear, logarithmic };

/// Maps a property without a physical unit (a painted quality, say) onto stiffness: the smallest value in the file
/// becomes `from`, the largest `to`, and t = (value - smallest) / (largest - smallest) in between becomes
/// from + t (to - from), or from (to / from)^t on the logarithmic scale. `from` may exceed `to`.
struct StiffnessRange {
    double     from  = 0; ///< [Pa] or [N m], > 0
    double     to    = 0; ///< [Pa] or [N m], > 0
    RangeScale scale = RangeScale::linear;
};

/// Young's modulus where neither the file nor the user gives a stiffness [Pa]: a soft skin over a palm, 4 mm thick,
/// then dents by about 2 mm at 1 N.
inline constexpr double kDefaultModulus = 0.3e6;

/// The user's settings for reading a file; an empty one is taken from the file, and else as stated here.
struct CloudReadSettings {
    std::string lengthUnit;              ///< of the coordinates: m, mm, cm, ...; empty: the file's comment, else metres
    std::string stiffnessProperty;       ///< empty: the first of kStiffnessProperties that the file has
    std::optional<StiffnessRange> range; ///< empty: the property's values are already in Pa or N m
    std::optional<StiffnessKind>  stiffnessKind; ///< empty: the file's comment, else the property's name, else modulus
    std::optional<double>         uniformStiffness; ///< where the file has none [Pa] or [N m]; empty: kDefaultModulus
    std::string                   columns; ///< of a text file, such as "x,y,z,-,stiffness"; empty: its header line
    bool dropInvalid = false; ///< drops points with NaN or infinity in a used property, instead of refusing the file
};

/// The smallest and the largest value of a property as it stands in the file, in the file's unit.
struct PropertyRange {
    double smallest = 0;
    double largest  = 0;
};

/// The findings in a file and how it was understood, for the user to check.
struct CloudFileReport {
    std::string                  format;                     ///< such as "PLY, binary little-endian"
    std::size_t                  points             = 0;     ///< in the cloud
    std::size_t                  droppedPoints      = 0;     ///< omitted because of NaN or infinity
    std::size_t                  faces              = 0;     ///< in the file, of any number of corners
    std::size_t                  degenerateFaces    = 0;     ///< omitted: fewer than three corners, or one twice
    std::size_t                  droppedFaces       = 0;     ///< omitted because they lost a point
    std::size_t                  duplicatePositions = 0;     ///< merged with an earlier point at exactly the same place
    bool                         normals            = false; ///< there are some
    double                       coordinateRounding = 0;     ///< step between neighbouring numbers of the file [m]
    std::size_t                  scatteredPoints    = 0;     ///< over the faces, in place of the file's; 0: none were
    double                       scatterDistance    = 0;     ///< least between two of them [m]
    std::vector<std::string>     properties;                 ///< scalar properties of a point, in file order
    std::vector<std::string>     unused;                     ///< those of them that say nothing that is known
    std::string                  lengthUnitSource;           ///< such as "mm, from the file's comment"
    std::string                  stiffnessSource;            ///< which property, its unit, and why
    std::optional<PropertyRange> stiffnessProperty;          ///< of the values before a range; empty if uniform
    std::optional<PropertyRange> stiffening;                 ///< b of the points [1/m]; empty: the file has none
    std::optional<PropertyRange> foundation;                 ///< below the points [Pa/m]; empty: the file has none
    bool                         lengthUnitAssumed = false;  ///< neither the file nor a setting states one: metres
    bool                         stiffnessAssumed  = false;  ///< neither the file nor a setting: kDefaultModulus
    std::optional<StiffnessKind> statedKind;                 ///< of the property, by the file's comment
    std::vector<std::string>     warnings;                   ///< sentences on what is odd in the file
};

inline constexpr std::uint32_t kNoPoint = 0xFFFF'FFFFu; ///< see LoadedCloud::pointOfRow

struct LoadedCloud {
    PointCloud            cloud;
    CloudFileReport       report;
    std::vector<Triangle> faces{}; ///< of the cloud's points; empty unless the file has faces
    SurfaceMesh           mesh{};  ///< the file's, where the cloud's points were scattered over it; else empty

    /// For each point the outward normal that the file has for it, of unit length; zero where it has none. Empty if it
    /// has none at all.
    std::vector<glm::vec3> normals{};

    /// For each point its b [1/m], see DepthLaw; empty if the file has no property for it.
    std::vector<double> stiffening{};

    /// For each point the foundation below it [Pa/m]; empty if the file has no property for it.
    std::vector<double> foundation{};

    /// For each point whether something holds it, from 0 to 1; empty if the file has no property for it.
    std::vector<double> held{};

    /// For each row of the file its point, or kNoPoint if it was omitted. Empty if every row is a point of its own.
    std::vector<std::uint32_t> pointOfRow{};
};

/// Reads a cloud; the format is that of the file's extension.
///
/// PLY: ascii and both binary orders, every scalar type. Lists vertex_indices or vertex_index of an element face become
/// triangles; other elements and lists are checked and skipped.
/// PCD: ascii, binary and binary_compressed; fields with COUNT > 1 are skipped, and points with NaN, which is its sign
/// for "no return", are omitted and counted. Bytes after the last row of a binary PLY or PCD file are a warning. Text:
/// one point per line, `x y z [stiffness]` or named by a header line or by `columns`. Quality, confidence and intensity
/// never become stiffness unless the user names them. A property "stiffening" is b [1/m] of each point, from 0 to
/// kMostStiffening; "foundation" is that below it [Pa/m], and "held" is 1 where something holds it and 0 where it is
/// free. Points at exactly the same place become one, in the place of the first, with the mean of the logarithms of
/// their stiffness; faces then name that one. The place must not be the only one.
/// \throws Error naming the file, the line or byte, what was expected and what was found
[[nodiscard]] LoadedCloud readCloud(const std::filesystem::path& path, const CloudReadSettings& settings = {});

/// Does the same from a stream of `size` bytes whose first byte is the file's first; `name` stands in messages.
[[nodiscard]] LoadedCloud parseCloud(std::istream& stream, std::uint64_t size, const std::string& name,
                                     CloudFormat format, const CloudReadSettings& settings = {});

/// A value per point that is written beside the cloud.
struct NamedField {
    std::string             name;   ///< without white space, commas or semicolons, such as "deflection"
    std::string             unit;   ///< such as "m"; empty if dimensionless
    std::span<const double> values; ///< one per point, in `unit`
};

/// What a file says of a cloud's points beside their stiffness, to be written again: foundation, stiffening, held, and
/// their normals as nx, ny, nz.
class FieldsBeside {
public:
    /// \param loaded  outlives this
    explicit FieldsBeside(const LoadedCloud& loaded) : FieldsBeside(loaded, loaded.stiffening) {}

    /// \param stiffening  in place of the file's [1/m]; outlives this, too
    FieldsBeside(const LoadedCloud& loaded, std::span<const double> stiffening);
    FieldsBeside(const FieldsBeside&)            = delete;
    FieldsBeside& operator=(const FieldsBeside&) = delete;

    [[nodiscard]] std::span<const NamedField> all() const noexcept { return fields_; }

private:
    std::array<std::vector<double>, 3> normals_; ///< [1] by component
    std::vector<NamedField>            fields_;
};

struct CloudWriteSettings {
    CloudEncoding             encoding = CloudEncoding::binaryLittleEndian; ///< of PLY and PCD
    std::span<const Triangle> faces{};         ///< of the cloud's points; formats without a place for them omit them
    char                      separator = ' '; ///< between the numbers of a text file; writeCloud() puts ',' into .csv
};

/// Writes a cloud, whole or not at all; the format is that of the extension. Numbers are doubles (or as many digits as
/// bring the same double back), lengths metres, and comments state both units, so that reading gives the same cloud.
/// Stiffness is called "stiffness" if it is a modulus and "flexural_rigidity" if it is a rigidity, because other
/// programs drop comments.
/// \throws Error naming the path and the reason
void writeCloud(const std::filesystem::path& path, const PointCloud& cloud,
                std::span<const NamedField> extraFields = {}, const CloudWriteSettings& settings = {});

/// Does the same to a stream.
void formatCloud(std::ostream& stream, CloudFormat format, const PointCloud& cloud,
                 std::span<const NamedField> extraFields = {}, const CloudWriteSettings& settings = {});

} // namespace palp
