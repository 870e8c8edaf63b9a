#include "engine/core/spatial_law.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_limits.h"
#include "engine/core/json_object.h"
#include "engine/core/volume_grid.h"

namespace palp {
namespace {

/// Share of a shape's size within which a point counts as on its rim [1]; it exceeds the rounding of i * spacing.
constexpr double kRim = 1e-9;

/// Most centres of a law, each of which is asked for at each point; more would be a grid.
constexpr std::size_t kMostCentres = 1000;

/// Returns the position along the line from `start` to `end`, within [0, 1].
double shareAlong(const SpatialLaw& law, const glm::dvec3& p)
{
    const glm::dvec3 line = law.end - law.start;
    return std::clamp(glm::dot(p - law.start, line) / glm::dot(line, line), 0.0, 1.0);
}

double squaredDistanceToNearest(const std::vector<glm::dvec3>& centres, const glm::dvec3& p)
{
    double least = HUGE_VAL;
    for (const glm::dvec3& centre : centres) least = std::min(least, glm::dot(p - centre, p - centre));
    return least;
}

bool isInBox(const SpatialLaw& law, const glm::dvec3& p)
{
    const glm::dvec3 slack = kRim * (law.high - law.low);
    return glm::all(glm::greaterThanEqual(p, law.low - slack)) && glm::all(glm::lessThanEqual(p, law.high + slack));
}

bool isInEvenCube(const SpatialLaw& law, const glm::dvec3& p)
{
    const glm::dvec3 cube = glm::floor((p - law.start) / law.width + kRim);
    return std::fmod(cube.x + cube.y + cube.z, 2.0) == 0;
}

using Kind = SpatialLaw::Kind;

struct NamedKind {
    std::string_view name;
    Kind             kind;
};
constexpr std::array kKinds = {NamedKind{"constant", Kind::constant},
                               NamedKind{"linear", Kind::linear},
                               NamedKind{"hyperbolic", Kind::hyperbolic},
                               NamedKind{"exponential", Kind::exponential},
                               NamedKind{"gaussian", Kind::gaussian},
                               NamedKind{"disc", Kind::disc},
                               NamedKind{"box", Kind::box},
                               NamedKind{"checker", Kind::checker},
                               NamedKind{"grid", Kind::grid}};

Kind kindOf(const JsonObject& object, SpatialLaw::Space space)
{
    const std::string name = object.text("law");
    std::string       known;
    for (const NamedKind& entry : kKinds) {
        // The grid of a problem file is another one, and its reader knows it.
        if (entry.name == name && (space == SpatialLaw::Space::volume || entry.kind != Kind::grid)) return entry.kind;
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw Error(object.where() + ": unknown law \"" + name + "\"; known laws: " + known);
}

/// The region that a law covers, and the form in which its points are written.
struct Region {
    glm::dvec3        low, high; ///< [m]
    SpatialLaw::Space space;

    [[nodiscard]] std::size_t coordinates() const { return space == SpatialLaw::Space::plane ? 2 : 3; }

    [[nodiscard]] glm::dvec3 point(const std::vector<double>& given) const
    {
        return space == SpatialLaw::Space::plane ? glm::dvec3(given[0], 0, given[1])
                                                 : glm::dvec3(given[0], given[1], given[2]);
    }

    [[nodiscard]] glm::dvec3 point(const JsonObject& object, std::string_view key) const
    {
        return point(object.numbers(key, coordinates()));
    }
};

void readLine(SpatialLaw& law, const JsonObject& object, const Region& region)
{
    object.allowOnly({"law", "from", "to", "axis", "start", "end"});
    if (object.has("start") != object.has("end"))
        throw Error(object.where() + ": give \"start\" and \"end\" or neither, found one of them");
    if (object.has("axis") && object.has("start"))
        throw Error(object.where() + ": give \"axis\", or \"start\" and \"end\", not both");
    const bool        plane = region.space == SpatialLaw::Space::plane;
    const std::string axis  = object.has("axis") ? object.text("axis") : "x";
    if (axis != "x" && axis != "z" && (axis != "y" || plane))
        object.refuse("axis", plane ? "\"x\" or \"z\"" : "\"x\", \"y\" or \"z\"");
    const int k = axis[0] - 'x';
    law.start   = region.low;
    law.end     = region.low;
    law.end[k]  = region.high[k];
    if (object.has("start")) law.start = region.point(object, "start");
    if (object.has("end")) law.end = region.point(object, "end");
    if (!(glm::dot(law.end - law.start, law.end - law.start) > 0))
        throw Error(object.where() + ": start and end of the law \"" + object.text("law") +
                    "\" must differ; give \"start\" and \"end\", or an \"axis\" along which the region has a length");
}

void readCentres(SpatialLaw& law, const JsonObject& object, const Region& region)
{
    const std::string_view width = law.kind == Kind::gaussian ? "sigma" : "radius";
    object.allowOnly({"law", "from", "to", "centre", "centres", width});
    if (object.has("centres")) {
        if (object.has("centre")) throw Error(object.where() + ": give \"centre\" or \"centres\", not both");
        for (const auto& row : object.rows("centres", region.coordinates())) law.centres.push_back(region.point(row));
        if (law.centres.empty() || law.centres.size() > kMostCentres)
            object.refuse("centres", "a list of 1 to " + std::to_string(kMostCentres) + " points");
    } else {
        law.centres = {region.point(object, "centre")};
    }
    law.width = object.positiveNumber(width);
}

void readBox(SpatialLaw& law, const JsonObject& object, const Region& region)
{
    object.allowOnly({"law", "from", "to", "low", "high"});
    law.low  = region.point(object, "low");
    law.high = region.point(object, "high");
    if (!glm::all(glm::lessThanEqual(law.low, law.high))) object.refuse("high", "no coordinate below that of \"low\"");
}

/// Returns a number for all three axes or one for each, above zero.
glm::dvec3 spacingOf(const JsonObject& object)
{
    constexpr std::string_view kKey = "spacing";
    if (object.kind(kKey) == JsonObject::Kind::number) return glm::dvec3(object.positiveNumber(kKey));
    const std::vector<double> given = object.numbers(kKey, 3);
    if (!(std::ranges::min(given) > 0)) object.refuse(kKey, "metres above zero");
    return {given[0], given[1], given[2]};
}

void readGrid(SpatialLaw& law, const JsonObject& object, const Region& region, LawFiles files)
{
    object.allowOnly({"law", "file", "factor", "outside", "along", "length_unit", "origin", "spacing"});
    law.file = object.text("file");
    if (object.has("outside")) law.outside = object.positiveNumber("outside");
    if (object.has("along")) {
        const auto along = valueNamed<SpatialLaw::Along>(object.text("along"));
        if (!along) object.refuse("along", "\"points\" or \"thickness\"");
        law.along = *along;
    }
    VolumeSettings settings;
    if (object.has("factor")) settings.factor = object.positiveNumber("factor");
    if (object.has("length_unit")) settings.lengthUnit = object.text("length_unit");
    if (object.has("origin")) settings.origin = region.point(object, "origin");
    if (object.has("spacing")) settings.spacing = spacingOf(object);
    if (files == LawFiles::left) return static_cast<void>(openRegularFile(law.file));
    law.volume = std::make_shared<const VolumeGrid>(readVolume(law.file, settings));
}

/// A translator of the short form into JSON text: NAME:key=value,... with numbers, vectors a;b;c, lists of vectors
/// a;b;c/d;e;f, or words.
class ShortForm {
public:
    static std::string asJson(std::string_view text)
    {
        const std::size_t colon = text.find(':');
        std::string       json  = "{\"law\":" + word(text.substr(0, colon), text);
        std::string_view  rest  = colon == std::string_view::npos ? "" : text.substr(colon + 1);
        while (!rest.empty()) {
            const std::string_view pair  = rest.substr(0, rest.find(','));
            const std::size_t      equal = pair.find('=');
            if (equal == std::string_view::npos) throw Error(complaint(text) + "found \"" + std::string(pair) + "\"");
            const std::string_view key = pair.substr(0, equal);
            json += ',';
            json += word(key, text);
            json += ':';
            json += value(key, pair.substr(equal + 1), text);
            rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
        }
        return json + "}";
    }

private:
    static std::string complaint(std::string_view text)
    {
        return "law \"" + std::string(text) +
               "\": expected NAME:key=value,key=value such as linear:from=1,to=10,axis=x, ";
    }

    static std::string word(std::string_view word, std::string_view text)
    {
        if (word.empty() ||
            !std::ranges::all_of(word, [](unsigned char c) { return c > ' ' && c < 0x7f && c != '"' && c != '\\'; }))
            throw Error(complaint(text) + "found \"" + std::string(word) + "\"");
        return std::string(1, '"').append(word).append(1, '"');
    }

    static std::optional<std::string> number(std::string_view token)
    {
        double parsed{};
        const auto [end, failure] = std::from_chars(token.data(), token.data() + token.size(), parsed);
        if (failure != std::errc() || end != token.data() + token.size() || !std::isfinite(parsed)) return std::nullopt;
        std::array<char, 32> digits; // the longest shortest form of a double has 24 characters
        return std::string(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), parsed).ptr);
    }

    /// Returns the parts between separators as a JSON list.
    template <class Convert>
    static std::string list(std::string_view token, char separator, Convert&& convert)
    {
        std::string json = "[";
        for (std::size_t at = 0; at <= token.size();) {
            const std::size_t end = std::min(token.find(separator, at), token.size());
            if (at) json += ',';
            json += convert(token.substr(at, end - at));
            at = end + 1;
        }
        return json + "]";
    }

    static std::string value(std::string_view key, std::string_view token, std::string_view text)
    {
        const auto component = [&](std::string_view part) { return number(part).value_or(word(part, text)); };
        const auto vector    = [&](std::string_view part) { return list(part, ';', component); };
        if (token.empty()) throw Error(complaint(text) + "found no value for \"" + std::string(key) + "\"");
        if (key == "centres") return list(token, '/', vector);
        return token.find(';') != std::string_view::npos ? vector(token) : component(token);
    }
};

/// Returns a law as JSON, whichever form it has.
std::string asJson(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && text[first] == '{' ? std::string(text) : ShortForm::asJson(text);
}

} // namespace

double SpatialLaw::operator()(const glm::dvec3& p) const noexcept
{
    switch (kind) {
    case Kind::constant:
        return from;
    case Kind::linear:
        return std::lerp(from, to, shareAlong(*this, p));
    case Kind::hyperbolic:
        return 1 / std::lerp(1 / from, 1 / to, shareAlong(*this, p));
    case Kind::exponential:
        return from * std::pow(to / from, shareAlong(*this, p));
    case Kind::gaussian:
        return from + (to - from) * std::exp(-squaredDistanceToNearest(centres, p) / (2 * width * width));
    case Kind::disc:
        return squaredDistanceToNearest(centres, p) <= width * width * (1 + kRim) * (1 + kRim) ? to : from;
    case Kind::box:
        return isInBox(*this, p) ? to : from;
    case Kind::checker:
        return isInEvenCube(*this, p) ? to : from;
    case Kind::grid: {
        const auto found = volume ? volume->at(p) : VolumeGrid::Value{};
        return found.at == VolumeGrid::At::inside ? found.value : outside.value_or(std::nan(""));
    }
    }
    return from;
}

namespace {

std::string placeOf(const glm::dvec3& p, const std::string& what)
{
    return what + " at " + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + " m";
}

} // namespace

double SpatialLaw::valueAt(const glm::dvec3& p, const std::string& what) const
{
    const double value = (*this)(p);
    if (kind != Kind::grid || !std::isnan(value) || !volume) return value;
    const auto        found  = volume->at(p);
    const std::string place  = placeOf(p, what);
    const std::string advice = "; give the law \"outside\": PASCAL for such places";
    if (found.at == VolumeGrid::At::unknown)
        throw Error(file + ": expected a stiffness above zero for " + place + ", found zero at [" +
                    std::to_string(found.node[0]) + ", " + std::to_string(found.node[1]) + ", " +
                    std::to_string(found.node[2]) + "], where nothing was measured" + advice);
    throw Error(file + ": expected a volume that holds " + place + ", found one over " + volume->extent() + advice +
                ", or check unit and axes: some programs count x and y the other way");
}

Error SpatialLaw::sideUnknown(const glm::dvec3& p, const std::string& what, const std::string& orElse) const
{
    return Error(file + ": expected to know on which side of " + placeOf(p, what) +
                 " the object lies, found values on both; give the cloud normals or faces" + orElse);
}

double SpatialLaw::valueBelow(const glm::dvec3& p, const Below& below, const std::string& what) const
{
    VolumeGrid::Sheet sheet = volume->sheetAlong(p, -below.normal, below.thickness);
    if (!below.outward) {
        const VolumeGrid::Sheet other = volume->sheetAlong(p, below.normal, below.thickness);
        if (sheet.share > 0 && sheet.share == other.share && sheet.value.value != other.value.value)
            throw sideUnknown(p, what, ", or the law \"along\": \"points\"");
        if (other.share > sheet.share) sheet = other;
    }
    return sheet.share > 0 ? sheet.value.value : valueAt(p, what);
}

SpatialLaw parseSpatialLaw(const JsonObject& object, const glm::dvec3& low, const glm::dvec3& high,
                           SpatialLaw::Space space, LawFiles files)
{
    const Region region{low, high, space};
    SpatialLaw   law;
    law.kind = kindOf(object, space);
    if (law.kind == Kind::constant) {
        object.allowOnly({"law", "value"});
        law.from = law.to = object.positiveNumber("value");
        return law;
    }
    if (law.kind == Kind::grid) {
        readGrid(law, object, region, files);
        return law;
    }
    switch (law.kind) {
    case Kind::gaussian:
    case Kind::disc:
        readCentres(law, object, region);
        break;
    case Kind::box:
        readBox(law, object, region);
        break;
    case Kind::checker:
        object.allowOnly({"law", "from", "to", "edge"});
        law.start = low;
        law.width = object.positiveNumber("edge");
        break;
    default:
        readLine(law, object, region);
    }
    law.from = object.positiveNumber("from");
    law.to   = object.positiveNumber("to");
    return law;
}

SpatialLaw parseSpatialLaw(std::string_view text, const glm::dvec3& low, const glm::dvec3& high,
                           SpatialLaw::Space space, LawFiles files)
{
    return parseSpatialLaw(JsonObject::parse(asJson(text), "law"), low, high, space, files);
}

std::string lawWithFileIn(const std::string& text, const std::filesystem::path& folder)
{
    try {
        const std::string json = asJson(text);
        if (excessOf(json)) return text; // as below
        nlohmann::json law = nlohmann::json::parse(json, nullptr, true, true);
        if (law.value("law", "") != "grid" || !law.contains("file") || !law["file"].is_string()) return text;
        law["file"] = (folder / law["file"].get<std::string>()).lexically_normal().string();
        return law.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    } catch (const nlohmann::json::exception&) { // whoever reads the law says what is wrong
        return text;
    } catch (const Error&) {
        return text;
    }
}

} // namespace palp
