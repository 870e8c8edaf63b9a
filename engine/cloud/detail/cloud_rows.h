#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cloud/detail/byte_reader.h"
#include "engine/cloud/detail/coordinate_rounding.h"
#include "engine/cloud/point_cloud_io.h"
#include "engine/core/progress.h"

namespace palp {

/// The contents of a file's header, in the words common to all formats.
struct CloudHeader {
    std::string                format;        ///< such as "PLY, ascii"
    std::vector<std::string>   properties;    ///< single numbers of a point, in file order
    std::optional<std::string> lengthUnit;    ///< of a comment "length_unit m"
    std::optional<std::string> stiffnessUnit; ///< of a comment "stiffness_unit Pa"

    /// Notes a comment that states a unit; all others are ignored.
    /// \throws Error if an earlier comment states another
    void readComment(std::string_view comment, const ByteReader& reader);
};

/// The meaning of a number of a row.
enum RowSlot : std::size_t {
    kSlotX,
    kSlotY,
    kSlotZ,
    kSlotStiffness,
    kSlotStiffening, ///< b [1/m], see DepthLaw
    kSlotFoundation, ///< of the tissue below [Pa/m]
    kSlotHeld,       ///< whether something holds the point: 0 to 1
    kSlotNormalX,    ///< of a normal of any length; zero or NaN: the point has none
    kSlotNormalY,
    kSlotNormalZ,
    kSlots
};

/// The numbers of one point that matter, in the file's units, indexed by RowSlot.
using CloudRow = std::array<double, kSlots>;

/// The names under which stiffness is looked for; the first that is there wins. Programs for point clouds put
/// "scalar_" before the names of their own properties. Quality, confidence and intensity mean too many things.
inline constexpr std::array<std::string_view, 8> kStiffnessProperties = {
    "stiffness", "scalar_stiffness", "flexural_rigidity",    "scalar_flexural_rigidity", "D",
    "E",         "felt_stiffness",   "scalar_felt_stiffness"};

/// A property beside the stiffness that a file may have for its points, in SI units.
struct OtherProperty {
    RowSlot                         slot = kSlots;
    std::array<std::string_view, 2> names{}; ///< the first that is there wins
    double                          least = 0, most = 0;
    const char*                     expected = ""; ///< in words
};
inline constexpr std::array<OtherProperty, 3> kOtherProperties = {
    {{kSlotStiffening, {"stiffening", "scalar_stiffening"}, 0, kMostStiffening, "a stiffening from 0 to 1e5 1/m"},
     {kSlotFoundation,
      {"foundation", "scalar_foundation"},
      kLeastFoundation,
      kMostFoundation,
      "a foundation from 1 to 1e15 Pa/m"},
     {kSlotHeld, {"held", "scalar_held"}, 0, 1, "a share from 0, free, to 1, held"}}};

/// Returns the kind of a stiffness of which only the property's name is known.
[[nodiscard]] StiffnessKind kindByName(std::string_view property) noexcept;

/// Interprets the numbers of a file: the one place that knows units, ranges and which property is stiffness.
/// Use: ask `slotOf` which properties to deliver, `add` each row, `finish`.
/// \thread one
class CloudRows {
public:
    /// \throws Error if x, y, z or the wanted stiffness are missing or ambiguous, or a unit is unknown
    CloudRows(const ByteReader& reader, CloudHeader header, const CloudReadSettings& settings);

    /// Returns the slot that a property (an index in CloudHeader::properties) fills; kSlots: none.
    [[nodiscard]] std::size_t slotOf(std::size_t property) const noexcept;

    /// The place of a row: on a line of its own, at a byte, or none because it comes of unpacked data.
    enum class Place { line, byte, unpacked };

    /// Checks a promised number of points against the bytes that are left, and only then makes room for them.
    /// \param leastBytes  that one point takes in the file, > 0
    void expect(std::uint64_t points, std::uint64_t leastBytes, Place place);

    /// Makes room for points that other checks have bounded.
    void makeRoom(std::uint64_t points);

    /// From now on a point with NaN is one that the instrument did not see, and is omitted; its number is a warning.
    void omitUnseen() noexcept { omitUnseen_ = true; }

    /// From now on points at one place are one that the file repeats, of which nothing is said.
    void expectRepeats() noexcept { repeats_ = true; }

    /// Adds a sentence to the warnings of the report.
    void warn(std::string sentence) { report_.warnings.push_back(std::move(sentence)); }

    /// Adds a warning if bytes are left at the end of a binary file.
    void warnOfTail();

    /// Adds a warning of so many bytes that were not read.
    void warnOfTail(std::uint64_t from, std::uint64_t bytes);

    /// Takes the next row of the file, which is the reader's last line or ends at the reader's offset.
    /// \throws Error naming the row if a number is not finite or the stiffness not above zero
    void add(const CloudRow& row, Place place);

    /// Maps ranges, makes one point of those at the same place, and builds the cloud.
    [[nodiscard]] LoadedCloud finish();

private:
    void               chooseStiffness();
    void               chooseKind(std::string_view property);
    void               chooseLengthUnit();
    void               refuseRow(const CloudRow& row, Place place) const;
    [[noreturn]] void  failAtRow(Place place, const std::string& message) const;
    [[nodiscard]] bool usable(const CloudRow& row) const noexcept;
    [[nodiscard]] bool isWithin(const OtherProperty& other, const CloudRow& row) const noexcept;
    void               mapRange();
    void               chooseNormals();
    void               chooseOthers();
    void               mergePlaces();

    [[nodiscard]] std::vector<std::uint32_t> pointsOfRows() const; ///< see LoadedCloud::pointOfRow

    const ByteReader&        reader_;
    CloudHeader              header_;
    const CloudReadSettings& settings_;
    CloudFileReport          report_;
    Progress                 progress_;

    std::array<std::optional<std::size_t>, kSlots> columns_;  ///< index in CloudHeader::properties; empty: none
    std::array<std::size_t, kSlots>                source_{}; ///< slot that has the number of the same property

    std::vector<std::uint32_t> droppedRows_; ///< rising
    std::vector<std::uint32_t> places_;      ///< point of each row that was not dropped; empty: all differ

    std::vector<glm::dvec3> positions_; ///< [m]
    std::vector<double>     stiffness_; ///< [Pa] or [N m], or in the property's unit until mapRange
    std::array<std::vector<double>, kOtherProperties.size()> others_;  ///< empty: the file has none
    std::vector<glm::vec3>                                   normals_; ///< of unit length, or zero
    CoordinateRounding                                       rounding_;
    StiffnessKind                                            kind_          = StiffnessKind::modulus;
    double                                                   metresPerUnit_ = 1; ///< [m]
    double                                                   uniform_       = 0; ///< [Pa] or [N m]
    PropertyRange                                            found_;             ///< of the property, in its unit
    std::uint64_t                                            rowsRead_   = 0;
    bool                                                     omitUnseen_ = false;
    bool                                                     repeats_    = false;
};

} // namespace palp
