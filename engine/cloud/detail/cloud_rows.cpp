#include "engine/cloud/detail/cloud_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/detail/places.h"
#include "engine/cloud/detail/room.h"
#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

/// Points are indexed by 32-bit numbers, of which the last means "none".
constexpr std::uint64_t kMostPoints = 0xFFFF'FFFEu;

/// Rows between two looks at the clock: about a millisecond.
constexpr std::uint64_t kRowsPerProgress = 1u << 14;

/// Number of names that a message lists before it states how many are left.
constexpr std::size_t kLongestList = 40;

constexpr std::array<const char*, 3> kCoordinateNames = {"x", "y", "z"};

/// The slots of which a number must be finite.
constexpr std::array kUsedSlots = {kSlotX, kSlotY, kSlotZ, kSlotStiffness, kSlotStiffening, kSlotFoundation, kSlotHeld};

/// The names of a normal's components: of PLY files, of PCD files, and of CloudCompare's text files.
constexpr std::array<std::array<std::string_view, 3>, 3> kNormalNames = {
    {{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}, {"Nx", "Ny", "Nz"}}};

std::string listed(const std::vector<std::string>& names)
{
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kLongestList); ++i)
        text += (i ? ", " : "") + shownText(names[i], kMostOfWord);
    if (names.size() > kLongestList) text += " and " + std::to_string(names.size() - kLongestList) + " more";
    return text.empty() ? "none" : text;
}

std::string allOf(std::size_t points, const char* ofOne, const char* ofMore)
{
    return points == 1 ? std::string("its only point ") + ofOne : "all " + std::to_string(points) + " points " + ofMore;
}

std::string lookUpList()
{
    std::string text;
    for (const std::string_view name : kStiffnessProperties) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}

std::optional<StiffnessKind> kindOfUnit(std::string_view unit)
{
    for (const StiffnessKind kind : kStiffnessKinds)
        if (unit == unitOf(kind)) return kind;
    return std::nullopt;
}

const char* nameOf(StiffnessKind kind)
{
    return kind == StiffnessKind::modulus    ? "modulus [Pa]"
           : kind == StiffnessKind::rigidity ? "flexural rigidity [N_m]"
                                             : "felt stiffness [N/m]";
}

/// Returns the index of the only property of that name.
std::optional<std::size_t> find(const ByteReader& reader, const std::vector<std::string>& properties,
                                std::string_view name)
{
    const auto first = std::find(properties.begin(), properties.end(), name);
    if (first == properties.end()) return std::nullopt;
    if (std::find(first + 1, properties.end(), name) != properties.end())
        reader.fail("expected one property " + inQuotes(name) + ", found several among: " + listed(properties));
    return std::size_t(first - properties.begin());
}

/// Returns the unit vector along a normal; zero for one that has no direction.
glm::vec3 directionOf(double x, double y, double z)
{
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return glm::vec3(0);
    const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (!(largest > 0)) return glm::vec3(0);
    const glm::dvec3 scaled = glm::dvec3(x, y, z) / largest; // whose square neither overflows nor vanishes
    return glm::vec3(scaled / glm::length(scaled));
}

void checkPositive(const ByteReader& reader, double value, const char* what)
{
    if (!(value > 0) || !std::isfinite(value))
        reader.fail(std::string("expected a finite ") + what + " above zero, found " + shown(value));
}

} // namespace

StiffnessKind kindByName(std::string_view property) noexcept
{
    if (property.ends_with("felt_stiffness")) return StiffnessKind::felt;
    return property == "D" || property.ends_with("flexural_rigidity") ? StiffnessKind::rigidity
                                                                      : StiffnessKind::modulus;
}

void CloudHeader::readComment(std::string_view comment, const ByteReader& reader)
{
    const std::string_view key  = nextWord(comment);
    const std::string_view unit = trimmed(comment);
    if (key != "length_unit" && key != "stiffness_unit") return;
    std::optional<std::string>& known = key == "length_unit" ? lengthUnit : stiffnessUnit;
    if (known && *known != unit)
        reader.failAtLine("a comment says " + std::string(key) + " " + inQuotes(unit) + ", an earlier one " +
                          inQuotes(*known));
    known = std::string(unit);
}

CloudRows::CloudRows(const ByteReader& reader, CloudHeader header, const CloudReadSettings& settings)
    : reader_(reader), header_(std::move(header)), settings_(settings), progress_("reading " + reader.name())
{
    for (const std::size_t slot : {kSlotX, kSlotY, kSlotZ}) {
        columns_[slot] = find(reader_, header_.properties, kCoordinateNames[slot]);
        if (!columns_[slot])
            reader_.fail(std::string("expected a number ") + kCoordinateNames[slot] +
                         " for each point, found only: " + listed(header_.properties) +
                         (header_.format == "text" ? "; name the columns, such as --columns x,y,z,-,stiffness" : ""));
    }
    chooseLengthUnit();
    chooseStiffness();
    chooseOthers();
    chooseNormals();
    // The first slot of a property that has several: the format delivers its number only there.
    for (std::size_t slot = 0; slot < kSlots; ++slot)
        if (columns_[slot]) source_[slot] = slotOf(*columns_[slot]);
}

void CloudRows::chooseOthers()
{
    for (const OtherProperty& other : kOtherProperties)
        for (const std::string_view name : other.names)
            if (!columns_[other.slot] && settings_.stiffnessProperty != name)
                columns_[other.slot] = find(reader_, header_.properties, name);
}

void CloudRows::chooseNormals()
{
    const auto& properties = header_.properties;
    for (const auto& names : kNormalNames) {
        std::array<std::optional<std::size_t>, 3> found;
        for (std::size_t k = 0; k < 3; ++k)
            if (const auto at = std::find(properties.begin(), properties.end(), names[k]); at != properties.end())
                found[k] = std::size_t(at - properties.begin());
        if (!found[0] || !found[1] || !found[2]) continue;
        std::copy(found.begin(), found.end(), columns_.begin() + kSlotNormalX);
        return;
    }
}

void CloudRows::chooseLengthUnit()
{
    const bool        chosen = !settings_.lengthUnit.empty();
    const std::string unit   = shownText(chosen ? settings_.lengthUnit : header_.lengthUnit.value_or("m"), kMostOfWord);
    const std::string source = chosen               ? "from the setting"
                               : header_.lengthUnit ? "from the file's comment"
                                                    : "because neither the file nor a setting names a unit";
    try {
        metresPerUnit_ = metresPer(unit);
    } catch (const Error& unknown) {
        reader_.fail("length unit " + source + ": " + unknown.what());
    }
    report_.lengthUnitSource  = unit + ", " + source;
    report_.lengthUnitAssumed = !chosen && !header_.lengthUnit;
}

void CloudRows::chooseKind(std::string_view property)
{
    std::string why;
    if (settings_.stiffnessKind) {
        kind_ = *settings_.stiffnessKind;
        why   = "by the setting";
    } else if (header_.stiffnessUnit) {
        const auto kind = kindOfUnit(*header_.stiffnessUnit);
        if (!kind)
            reader_.fail("expected a comment stiffness_unit Pa, N_m or N/m, found " + inQuotes(*header_.stiffnessUnit) +
                         "; name the kind of stiffness to overrule it");
        kind_ = *kind;
        why   = "by the file's comment";
    } else {
        kind_ = kindByName(property);
        why   = kind_ != StiffnessKind::modulus ? "by its name"
                                                : "because neither a setting, the file nor the name says otherwise";
    }
    if (header_.stiffnessUnit) report_.statedKind = kindOfUnit(*header_.stiffnessUnit);
    report_.stiffnessSource = "property " + inQuotes(property) + " as " + nameOf(kind_) + " " + why;
}

void CloudRows::chooseStiffness()
{
    const std::string&         wanted = settings_.stiffnessProperty;
    std::optional<std::size_t> column;
    if (!wanted.empty()) {
        column = find(reader_, header_.properties, wanted);
        if (!column)
            reader_.fail("expected a stiffness property " + inQuotes(wanted) +
                         ", found only these numbers for each point: " + listed(header_.properties));
    }
    for (std::size_t i = 0; wanted.empty() && !column && i < kStiffnessProperties.size(); ++i)
        column = find(reader_, header_.properties, kStiffnessProperties[i]);

    columns_[kSlotStiffness] = column;
    if (settings_.range) {
        checkPositive(reader_, settings_.range->from, "lower end of the stiffness range");
        checkPositive(reader_, settings_.range->to, "upper end of the stiffness range");
    }
    if (column) return chooseKind(header_.properties[*column]);

    const std::string none = "the file has no property " + lookUpList() + " but only: " + listed(header_.properties);
    if (settings_.range) reader_.fail("a stiffness range needs a property to map, but " + none + "; name one of these");
    kind_ = settings_.stiffnessKind.value_or(StiffnessKind::modulus);
    if (!settings_.uniformStiffness && kind_ != StiffnessKind::modulus)
        reader_.fail(none + "; name one of these, or a uniform " +
                     (kind_ == StiffnessKind::rigidity ? "flexural rigidity" : "felt stiffness"));
    uniform_ = settings_.uniformStiffness.value_or(kDefaultModulus);
    checkPositive(reader_, uniform_, "uniform stiffness");
    report_.stiffnessAssumed = !settings_.uniformStiffness;
    report_.stiffnessSource  = "uniform " + std::string(nameOf(kind_)) + " " + shown(uniform_) +
                              (settings_.uniformStiffness ? " by the setting" : " by default") + ", because " + none;
}

std::size_t CloudRows::slotOf(std::size_t property) const noexcept
{
    return std::size_t(std::find(columns_.begin(), columns_.end(), property) - columns_.begin());
}

void CloudRows::expect(std::uint64_t points, std::uint64_t leastBytes, Place place)
{
    if (points == 0) reader_.fail("the cloud is empty: expected at least one point, found a header that promises none");
    const std::uint64_t missingLineEnd = place == Place::line ? 1 : 0; // the last line may lack its end
    if (points > (reader_.remaining() + missingLineEnd) / leastBytes)
        reader_.failAtByte("the header promises " + std::to_string(points) + " points of at least " +
                           std::to_string(leastBytes) + " bytes each, but only " + std::to_string(reader_.remaining()) +
                           " bytes follow; the file may have been cut short while it was copied");
    makeRoom(points);
}

void CloudRows::makeRoom(std::uint64_t points)
{
    if (points > kMostPoints)
        reader_.fail("expected at most " + std::to_string(kMostPoints) + " points, found " + std::to_string(points));
    makeRoomFor(positions_, points);
    if (columns_[kSlotStiffness]) makeRoomFor(stiffness_, points);
    for (std::size_t k = 0; k < others_.size(); ++k)
        if (columns_[kOtherProperties[k].slot]) makeRoomFor(others_[k], points);
    if (columns_[kSlotNormalX]) makeRoomFor(normals_, points);
}

/// Returns true if a point has no such property, or a good one.
bool CloudRows::isWithin(const OtherProperty& other, const CloudRow& row) const noexcept
{
    return !columns_[other.slot] || (row[other.slot] >= other.least && row[other.slot] <= other.most);
}

bool CloudRows::usable(const CloudRow& row) const noexcept
{
    // NaN fails every comparison.
    const double limit = kLargestCoordinate / metresPerUnit_;
    return std::abs(row[kSlotX]) <= limit && std::abs(row[kSlotY]) <= limit && std::abs(row[kSlotZ]) <= limit &&
           std::isfinite(row[kSlotStiffness]) && (settings_.range || row[kSlotStiffness] > 0) &&
           std::ranges::all_of(kOtherProperties, [&](const OtherProperty& other) { return isWithin(other, row); });
}

void CloudRows::add(const CloudRow& row, Place place)
{
    if (rowsRead_ % kRowsPerProgress == 0) progress_.at(reader_.offset(), reader_.size());
    CloudRow used{};
    for (std::size_t slot = 0; slot < kSlots; ++slot)
        if (columns_[slot]) used[slot] = row[source_[slot]];
    const auto& stiffness = columns_[kSlotStiffness];
    if (!stiffness) used[kSlotStiffness] = uniform_;

    if (!usable(used)) {
        const bool finite = std::ranges::all_of(kUsedSlots, [&](RowSlot slot) { return std::isfinite(used[slot]); });
        const bool unseen =
            omitUnseen_ && std::ranges::any_of(kUsedSlots, [&](RowSlot slot) { return std::isnan(used[slot]); });
        if (!unseen && (finite || !settings_.dropInvalid)) refuseRow(used, place);
        ++report_.droppedPoints;
        droppedRows_.push_back(std::uint32_t(rowsRead_));
        ++rowsRead_;
        return;
    }
    if (positions_.size() == kMostPoints)
        failAtRow(place, "expected at most " + std::to_string(kMostPoints) + " points, found more");
    const glm::dvec3 position(used[kSlotX], used[kSlotY], used[kSlotZ]);
    rounding_.add(position);
    positions_.push_back(metresPerUnit_ * position);
    if (columns_[kSlotNormalX])
        normals_.push_back(directionOf(used[kSlotNormalX], used[kSlotNormalY], used[kSlotNormalZ]));
    if (stiffness) {
        const double value = used[kSlotStiffness];
        const bool   first = stiffness_.empty();
        found_ = {first ? value : std::min(found_.smallest, value), first ? value : std::max(found_.largest, value)};
        stiffness_.push_back(value);
    }
    for (std::size_t k = 0; k < others_.size(); ++k)
        if (columns_[kOtherProperties[k].slot]) others_[k].push_back(used[kOtherProperties[k].slot]);
    ++rowsRead_;
}

void CloudRows::refuseRow(const CloudRow& row, Place place) const
{
    for (const std::size_t slot : kUsedSlots) {
        const auto& column = columns_[slot];
        if (!column) continue;
        const std::string found = ", found " + inQuotes(header_.properties[*column]) + " " + shown(row[slot]);
        if (!std::isfinite(row[slot]))
            failAtRow(place, "expected a finite number" + found + "; such points can be dropped with --drop-invalid");
        for (const OtherProperty& other : kOtherProperties)
            if (slot == other.slot && !isWithin(other, row))
                failAtRow(place, std::string("expected ") + other.expected + found);
        if (slot <= kSlotZ && std::abs(row[slot]) > kLargestCoordinate / metresPerUnit_)
            failAtRow(place, "expected a coordinate below " + shown(kLargestCoordinate) + " m" + found +
                                 "; is the length unit right?");
        if (slot == kSlotStiffness && !settings_.range && !(row[slot] > 0))
            failAtRow(place,
                      "expected a stiffness above zero" + found + "; map the property with --stiffness-range FROM,TO");
    }
    PALP_EXPECT(false, "a usable row is refused");
}

void CloudRows::failAtRow(Place place, const std::string& message) const
{
    const std::string at = "point " + std::to_string(rowsRead_) + ": " + message;
    if (place == Place::line) reader_.failAtLine(at);
    if (place == Place::unpacked) reader_.fail(at);
    reader_.fail("before byte " + std::to_string(reader_.offset()) + ": " + at);
}

void CloudRows::warnOfTail()
{
    if (reader_.remaining() > 0) warnOfTail(reader_.offset(), reader_.remaining());
}

void CloudRows::warnOfTail(std::uint64_t from, std::uint64_t bytes)
{
    warn(counted(bytes, "byte") + " after the last row, from byte " + std::to_string(from) +
         " on, not read: padding, or a damaged file");
}

void CloudRows::mapRange()
{
    const auto [from, to, scale] = *settings_.range;
    report_.stiffnessSource += ", " + shown(found_.smallest) + " to " + shown(found_.largest) + " mapped " +
                               (scale == RangeScale::linear ? "linearly" : "logarithmically") + " onto " + shown(from) +
                               " to " + shown(to) + " " + unitOf(kind_);
    if (from == to) return void(std::fill(stiffness_.begin(), stiffness_.end(), from));
    if (found_.smallest == found_.largest)
        reader_.fail("property " + inQuotes(header_.properties[*columns_[kSlotStiffness]]) + " is " +
                     shown(found_.smallest) + " at every point, which a range from " + shown(from) + " to " +
                     shown(to) + " cannot spread; omit the range or make its ends equal");
    // Quarters, because the difference of two doubles can overflow; shifted up first if it could underflow.
    const double up    = std::max(std::abs(found_.smallest), std::abs(found_.largest)) < 1 ? 1e200 : 0.25;
    const double width = up * found_.largest - up * found_.smallest;
    for (double& value : stiffness_) {
        const double t = std::clamp((up * value - up * found_.smallest) / width, 0.0, 1.0);
        if (t == 0 || t == 1) // exactly the ends, whatever the logarithm rounds to
            value = t == 0 ? from : to;
        else
            value = std::clamp(scale == RangeScale::linear ? std::lerp(from, to, t)
                                                           : std::exp(std::lerp(std::log(from), std::log(to), t)),
                               std::min(from, to), std::max(from, to));
    }
}

void CloudRows::mergePlaces()
{
    std::vector<std::uint32_t> places = placesOf(positions_);
    if (places.empty()) return;
    const std::size_t          count = std::size_t(std::ranges::max(places)) + 1;
    std::vector<std::uint32_t> points(count); // at each place
    std::vector<double>        above(count);  // [1] sum of the logarithms of stiffnesses over the place's first
    std::size_t                known = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t place = places[i];
        ++points[place];
        if (place == known) { // the first point of a place; never behind i, so that nothing is overwritten
            ++known;
            positions_[place] = positions_[i];
            stiffness_[place] = stiffness_[i];
            for (std::vector<double>& other : others_)
                if (!other.empty()) other[place] = other[i];
            if (!normals_.empty()) normals_[place] = normals_[i];
            continue;
        }
        above[place] += std::log(stiffness_[i]) - std::log(stiffness_[place]);
        for (std::vector<double>& other : others_)
            if (!other.empty()) other[place] += other[i];
        if (!normals_.empty()) normals_[place] += normals_[i];
    }
    for (std::size_t place = 0; place < count; ++place) {
        if (points[place] == 1) continue;
        for (std::vector<double>& other : others_)
            if (!other.empty()) other[place] /= points[place];
        if (above[place] != 0) // the geometric mean
            stiffness_[place] = std::exp(std::log(stiffness_[place]) + above[place] / points[place]);
        if (!normals_.empty()) normals_[place] = directionOf(normals_[place].x, normals_[place].y, normals_[place].z);
    }
    positions_.resize(count);
    stiffness_.resize(count);
    for (std::vector<double>& other : others_)
        if (!other.empty()) other.resize(count);
    if (!normals_.empty()) normals_.resize(count);
    places_ = std::move(places);
    if (repeats_) return;
    report_.duplicatePositions = places_.size() - count;
    warn(counted(report_.duplicatePositions, "point", "lies", "lie") +
         " exactly where an earlier one lies; points at one place are merged");
}

std::vector<std::uint32_t> CloudRows::pointsOfRows() const
{
    if (droppedRows_.empty()) return places_;
    std::vector<std::uint32_t> points(rowsRead_);
    auto                       dropped = droppedRows_.begin();
    std::uint32_t              kept    = 0;
    for (std::size_t row = 0; row < rowsRead_; ++row) {
        const bool isDropped = dropped != droppedRows_.end() && *dropped == row;
        if (isDropped) ++dropped;
        points[row] = isDropped ? kNoPoint : places_.empty() ? kept : places_[kept];
        if (!isDropped) ++kept;
    }
    return points;
}

LoadedCloud CloudRows::finish()
{
    if (positions_.empty())
        reader_.fail(report_.droppedPoints ? "the cloud is empty: " + allOf(report_.droppedPoints, "has", "have") +
                                                 " NaN or infinity in a used property; such points are dropped"
                                           : "the cloud is empty: expected at least one point, found none");
    const glm::dvec3& first = positions_.front(); // distances whose squares vanish are none
    if (std::all_of(positions_.begin(), positions_.end(),
                    [&](const glm::dvec3& p) { return glm::length(p - first) == 0; }))
        reader_.fail(allOf(positions_.size(), "lies at", "coincide at") + " (" + shown(first.x) + ", " +
                     shown(first.y) + ", " + shown(first.z) + ") m: expected an object with an extent");
    if (columns_[kSlotStiffness]) {
        report_.stiffnessProperty = found_;
        if (settings_.range) mapRange();
    } else {
        stiffness_.assign(positions_.size(), uniform_);
    }
    if (report_.droppedPoints > 0 && !settings_.dropInvalid)
        warn("NaN, with which such files mark what the instrument did not see, stands in " +
             std::to_string(report_.droppedPoints) + " of " + counted(rowsRead_, "point") + "; nothing is there");
    mergePlaces();
    if (std::ranges::all_of(normals_, [](const glm::vec3& n) { return n == glm::vec3(0); })) normals_.clear();
    const auto rangeOf = [](const std::vector<double>& values) -> std::optional<PropertyRange> {
        if (values.empty()) return {};
        const auto [least, most] = std::ranges::minmax(values);
        return PropertyRange{least, most};
    };
    report_.stiffening         = rangeOf(others_[0]);
    report_.foundation         = rangeOf(others_[1]);
    report_.format             = header_.format;
    report_.points             = positions_.size();
    report_.coordinateRounding = metresPerUnit_ * rounding_.step();
    for (std::size_t n = 0; n < header_.properties.size(); ++n) {
        report_.properties.push_back(shownText(header_.properties[n], kMostOfWord));
        const bool used = std::ranges::any_of(columns_, [&](const auto& column) { return column == n; });
        if (!used) report_.unused.push_back(report_.properties.back());
    }
    LoadedCloud loaded{PointCloud(std::move(positions_), std::move(stiffness_), kind_), std::move(report_)};
    loaded.report.normals = !normals_.empty();
    loaded.normals        = std::move(normals_);
    loaded.stiffening     = std::move(others_[0]);
    loaded.foundation     = std::move(others_[1]);
    loaded.held           = std::move(others_[2]);
    loaded.pointOfRow     = pointsOfRows();
    return loaded;
}

} // namespace palp
