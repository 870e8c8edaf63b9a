#include "engine/session/hand_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "engine/chart/chart.h"
#include "engine/cloud/surface_flood.h"
#include "engine/cloud/tokens.h"
#include "engine/contact/contact.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/fingerprint.h"
#include "engine/core/npy.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/session/scene_place.h"

namespace palp {
namespace {

constexpr double      kTick          = 1e-3;       // [s] of generated hands: the servo's period
constexpr std::size_t kMostWaypoints = 10'000'000; // 2.8 hours at 1 kHz; a larger file is no hand
constexpr double      kWhole         = 60;         // [s] of generated hands that are stored whole
constexpr double      kLongest       = 86400;      // [s] of a hand: what is longer is no hand, or in another unit

std::string text(double value)
{
    return shortNumber(value, 9);
}

/// Takes waypoints one by one and refuses the first that no hand can make.
class Checked {
public:
    /// Adds a waypoint.
    /// \param where  "line 4", "row 3", for complaints
    void add(const HandPose& waypoint, const std::string& where)
    {
        const std::array<double, 4> numbers = {waypoint.time, waypoint.position.x, waypoint.position.y,
                                               waypoint.position.z};
        for (const double number : numbers)
            if (!std::isfinite(number))
                throw Error(where + ": expected finite numbers, time [s] and x, y, z [m], found " +
                            (std::isnan(number) ? "NaN" : "infinity"));
        if (waypoints.size() >= kMostWaypoints)
            throw Error(where + ": expected at most " + std::to_string(kMostWaypoints) + " waypoints; cut the file");
        if (!waypoints.empty()) step(waypoints.back(), waypoint, where);
        waypoints.push_back(waypoint);
    }

    void finish(const std::string& name) const
    {
        if (waypoints.size() < 2)
            throw Error(name + ": expected at least two waypoints time, x, y, z, found " +
                        std::to_string(waypoints.size()));
        if (const double lasts = waypoints.back().time - waypoints.front().time; !(lasts <= kLongest))
            throw Error(name + ": expected a hand of at most " + text(kLongest) + " s, found one of " + text(lasts) +
                        " s; are the times seconds?");
    }

    std::vector<HandPose> waypoints;
    double                fastest = 0; ///< [m/s]

private:
    void step(const HandPose& from, const HandPose& to, const std::string& where)
    {
        if (!(to.time > from.time))
            throw Error(where + ": expected a time after " + text(from.time) + " s, found " + text(to.time) +
                        " s: time must rise from waypoint to waypoint");
        const double speed = glm::length(to.position - from.position) / (to.time - from.time);
        if (!(speed <= HandPath::kFastest))
            throw Error(where + ": expected a hand slower than " + text(HandPath::kFastest) + " m/s, found " +
                        text(speed) + " m/s; are the times seconds and the positions metres?");
        fastest = std::max(fastest, speed);
    }
};

constexpr std::string_view kBetween = ",; \t\r"; // separators of numbers

/// Takes the next word of a line; empty behind the last.
std::string_view takeWord(std::string_view& line)
{
    line.remove_prefix(std::min(line.find_first_not_of(kBetween), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBetween));
    line.remove_prefix(word.size());
    return word;
}

/// The first four words of a line, empty where there are fewer, and their number.
struct Words {
    std::array<std::string_view, 4> first{};
    std::size_t                     count = 0;
};

Words wordsOf(std::string_view line)
{
    Words words;
    for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
        if (words.count < words.first.size()) words.first[words.count] = word;
        ++words.count;
    }
    return words;
}

/// Demands as many columns as the header has, four without one: a comma too many may be a decimal one.
void demandColumns(const Words& words, std::size_t columns, const std::string& where)
{
    if (words.count == columns || words.count < 4) return; // too few are reported number by number
    throw Error(where + ": expected " + std::to_string(columns) + " columns, found " + std::to_string(words.count) +
                "; decimals have a point, and further columns need a header line");
}

/// Returns the word of a line in a column that is counted from 0; empty if there are fewer.
std::string_view wordAt(std::string_view line, std::size_t column)
{
    std::string_view word = takeWord(line);
    for (; column > 0 && !word.empty(); --column) word = takeWord(line);
    return word;
}

/// Returns the column in which a header has a name; 0 (where time is) if it has none.
std::size_t columnIn(std::string_view header, std::string_view name)
{
    std::size_t k = 0;
    for (std::string_view word = takeWord(header); !word.empty(); word = takeWord(header), ++k)
        if (k >= 4 && columnHead(word).name == name) return k;
    return 0;
}

/// Where a header has what a file may add to time and place; 0 where it has it not.
struct FurtherColumns {
    std::size_t                buttons = 0;
    std::size_t                device  = 0; ///< of an exported recording, whose upper half is the buttons
    std::array<std::size_t, 4> turn{};      ///< x, y, z, w

    [[nodiscard]] bool turns() const { return turn[0] > 0; }
};

FurtherColumns furtherIn(std::string_view header, const std::string& where)
{
    FurtherColumns found;
    found.buttons = columnIn(header, "buttons");
    // A column "device" is that of a session beside its others only.
    if (found.buttons == 0 && columnIn(header, "missed") > 0) found.device = columnIn(header, "device");
    for (std::size_t k = 0; k < 4; ++k) found.turn[k] = columnIn(header, std::string("orientation_") + "xyzw"[k]);
    const auto there = 4 - std::ranges::count(found.turn, 0U);
    if (there != 0 && there != 4)
        throw Error(where + ": expected orientation_x, _y, _z and _w or none of them, found " + std::to_string(there));
    return found;
}

std::uint32_t buttonsOf(std::string_view line, const FurtherColumns& columns, const std::string& where)
{
    constexpr std::uint64_t kMost = 0xFFFF; // as many as a session records
    const bool              own   = columns.buttons > 0;
    const auto              word  = wordAt(line, own ? columns.buttons : columns.device);
    const auto              bits  = parseCount(word);
    if (!bits || *bits > (own ? kMost : kMost << 16U | kMost))
        throw Error(where +
                    (own ? ": expected buttons as a whole number from 0 to 65535, one bit each, found "
                         : ": expected the bits of an exported column device, a whole number below 2^32, found ") +
                    inQuotes(word));
    return std::uint32_t(own ? *bits : *bits >> 16U);
}

glm::dquat turnOf(std::string_view line, const std::array<std::size_t, 4>& columns, const std::string& where)
{
    glm::dquat turn{};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string_view word   = wordAt(line, columns[k]);
        const auto             number = parseNumber(word);
        if (!number)
            throw Error(where + ": expected a number in column " + std::to_string(columns[k] + 1) + ", found " +
                        inQuotes(word));
        (k == 0 ? turn.x : k == 1 ? turn.y : k == 2 ? turn.z : turn.w) = *number;
    }
    constexpr double kRounded = 0.05; // [1] a quaternion in two decimal places is off by less
    const double     size     = glm::length(turn);
    if (!(std::abs(size - 1) < kRounded))
        throw Error(where + ": expected an orientation of length 1, found one of length " + text(size));
    return turn / size;
}

HandPose waypointOf(const std::array<std::string_view, 4>& words, const std::array<double, 4>& inSi,
                    const std::string& where)
{
    std::array<double, 4> numbers{};
    for (std::size_t k = 0; k < 4; ++k) {
        if (words[k].empty())
            throw Error(where + ": expected four columns, time [s], x, y, z [m], found " + std::to_string(k));
        const auto number = parseNumber(words[k]);
        if (!number)
            throw Error(where + ": expected a number in column " + std::to_string(k + 1) + ", found " +
                        inQuotes(words[k]));
        numbers[k] = *number * inSi[k];
    }
    return {numbers[0], {numbers[1], numbers[2], numbers[3]}};
}

/// Returns a header whose units in brackets stand directly behind their names, so that "time [ms]" is one word.
std::string withUnitsAtNames(std::string_view header)
{
    std::string text;
    bool        within = false; // brackets
    for (const char c : header) {
        const bool opens = c == '[' || c == '(';
        while (opens && !text.empty() && (text.back() == ' ' || text.back() == '\t')) text.pop_back();
        within = opens || (within && c != ']' && c != ')' && c != ',' && c != ';');
        if (!within || kBetween.find(c) == std::string_view::npos) text += c;
    }
    return text;
}

/// Returns the SI units in one of time, x, y and z, as a header states them.
std::array<double, 4> unitsIn(const std::array<std::string_view, 4>& names, const std::string& where)
{
    std::array<double, 4> inSi{};
    for (std::size_t k = 0; k < names.size(); ++k)
        inSi[k] = siPerUnitOf(columnHead(names[k]), k == 0 ? Dimension::time : Dimension::length, where);
    return inSi;
}

/// Returns true if a comment is a header after all, as numpy.savetxt writes it: "time [s], x [m], y [m], z [m]".
bool namesColumns(const std::array<std::string_view, 4>& words)
{
    const auto ends = [&](std::size_t k, char c) { return columnHead(words[k]).name.ends_with(c); };
    const auto time = columnHead(words[0]).name;
    return (time == "t" || time == "time") && ends(1, 'x') && ends(2, 'y') && ends(3, 'z');
}

bool isHeader(const std::array<std::string_view, 4>& words, const std::string& where)
{
    if (parseNumber(words[0])) return false;
    if (words[0].starts_with('t') || words[0].starts_with('T')) return true;
    throw Error(where + ": expected the columns time, x, y, z in this order, found a first column " +
                inQuotes(words[0]));
}

/// \throws Error if a header's names say another order of x, y and z; names of any other kind are the file's own
void demandOrder(const std::array<std::string_view, 4>& words, const std::string& where)
{
    constexpr std::string_view kAxes = "xyz";
    for (std::size_t k = 1; k < words.size(); ++k) {
        const std::string_view name = columnHead(words[k]).name;
        if (!name.empty() && kAxes.find(name.back()) != std::string_view::npos && name.back() != kAxes[k - 1])
            throw Error(where + ": expected the columns time, x, y, z in this order, found " + inQuotes(words[k]) +
                        " in the place of " + kAxes[k - 1] + "; reorder the columns");
    }
}

HandPath handOf(const NodeField& rows, const std::string& name)
{
    if (rows.nodesZ() < 4)
        throw Error(name + ": expected an array of four columns, time [s], x, y, z [m], found " +
                    std::to_string(rows.nodesZ()));
    std::vector<HandPose> waypoints;
    for (int i = 0; i < rows.nodesX(); ++i) waypoints.push_back({rows(i, 0), {rows(i, 1), rows(i, 2), rows(i, 3)}});
    return HandPath(std::move(waypoints), name);
}

/// Returns the integral of the smooth step u^2 (3 - 2u) from 0 to u, for u clamped to [0, 1]; beyond 1 it rises by 1
/// per u.
double rampedTime(double u)
{
    const double v = std::clamp(u, 0.0, 1.0);
    return v * v * v - v * v * v * v / 2 + std::max(u - 1, 0.0);
}

void expectPositive(std::initializer_list<std::pair<const char*, double>> values)
{
    for (const auto& [what, value] : values)
        if (!(value > 0 && std::isfinite(value)))
            throw Error(std::string("hand: ") + what + ": expected a positive number, found " + text(value));
}

/// The generated hands in the coordinates east, north, up of the place.
class Script {
public:
    explicit Script(const HandScript& script)
        : s_(script), fall_(script.height + script.depth), descent_(std::numbers::pi * fall_ / (2 * script.speed))
    {
    }

    [[nodiscard]] glm::dvec3 at(double t) const
    {
        switch (s_.motion) {
        case HandMotion::press:
            return {0, 0, up(t)};
        case HandMotion::circle: {
            const double angle = kRamp * rampedTime((t - descent_) / kRamp) * s_.speed / s_.radius;
            return {s_.radius * std::cos(angle), s_.radius * std::sin(angle), up(std::min(t, descent_))};
        }
        case HandMotion::scan:
            break;
        }
        const double phase = std::max(t - descent_, 0.0) * s_.speed / s_.radius;
        return {-s_.radius * std::cos(phase), 0, up(std::min(t, descent_))};
    }

    /// Returns when all is repetition [s].
    [[nodiscard]] double settled() const { return s_.motion == HandMotion::press ? 0 : descent_ + kRamp; }

    /// Returns how long whole repetitions take, a second and more [s].
    [[nodiscard]] double repetition() const
    {
        const double one = s_.motion == HandMotion::press ? 2 * descent_ : 2 * std::numbers::pi * s_.radius / s_.speed;
        return one * std::ceil(1 / one);
    }

private:
    static constexpr double kRamp = 0.2; // [s] from rest to full speed: a person takes about as long

    [[nodiscard]] double up(double t) const
    {
        return s_.height - fall_ * (1 - std::cos(std::numbers::pi * t / descent_)) / 2;
    }

    HandScript s_;
    double     fall_;    ///< [m]
    double     descent_; ///< [s]
};

} // namespace

HandPath::HandPath(std::vector<HandPose> waypoints, const std::string& name, std::optional<double> repeatsFrom)
    : repeatsFrom_(repeatsFrom)
{
    Checked checked;
    checked.waypoints.reserve(waypoints.size());
    for (const HandPose& waypoint : waypoints)
        checked.add(waypoint, name + ": row " + std::to_string(checked.waypoints.size()));
    checked.finish(name);
    waypoints_ = std::move(checked.waypoints);
    fastest_   = checked.fastest;
    turns_     = std::ranges::any_of(
            waypoints_, [](const HandPose& waypoint) { return waypoint.orientation != glm::dquat(1, 0, 0, 0); });
}

double HandPath::inPath(double time) const noexcept
{
    const double end = waypoints_.back().time;
    if (!repeatsFrom_ || !(time > end)) return time;
    return *repeatsFrom_ + std::fmod(time - *repeatsFrom_, end - *repeatsFrom_);
}

glm::dvec3 HandPath::position(double time) const noexcept
{
    time = inPath(time);
    if (!(time > waypoints_.front().time)) return waypoints_.front().position; // NaN too
    if (time >= waypoints_.back().time) return waypoints_.back().position;
    const auto      next = std::ranges::upper_bound(waypoints_, time, {}, &HandPose::time);
    const HandPose &b = *next, &a = *(next - 1);
    if (time == a.time) return a.position; // bit for bit: -0 + 0 would be 0
    return a.position + (time - a.time) / (b.time - a.time) * (b.position - a.position);
}

std::uint32_t HandPath::buttons(double time) const noexcept
{
    time = inPath(time);
    if (!(time >= waypoints_.front().time)) return 0; // NaN too
    return (std::ranges::upper_bound(waypoints_, time, {}, &HandPose::time) - 1)->buttons;
}

glm::dquat HandPath::orientation(double time) const noexcept
{
    if (!turns_) return {1, 0, 0, 0};
    time = inPath(time);
    if (!(time > waypoints_.front().time)) return waypoints_.front().orientation; // NaN too
    if (time >= waypoints_.back().time) return waypoints_.back().orientation;
    const auto      next = std::ranges::upper_bound(waypoints_, time, {}, &HandPose::time);
    const HandPose &b = *next, &a = *(next - 1);
    if (time == a.time) return a.orientation;
    return glm::normalize(glm::slerp(a.orientation, b.orientation, (time - a.time) / (b.time - a.time)));
}

HandPath parseHand(std::istream& in, const std::string& name)
{
    constexpr std::size_t kLongestLine = 1 << 16; // [bytes] a file without line ends is no text, and may be endless
    Checked               checked;
    std::size_t           columns = 4;
    FurtherColumns        further;
    std::array<double, 4> inSi{1, 1, 1, 1};      // SI units in one of a column's
    std::string           comment, commentWhere; // that names columns
    std::vector<char>     line(kLongestLine);
    const auto            take = [&](const std::string& header, const std::string& where) {
        const Words names = wordsOf(header);
        columns           = std::max(names.count, columns);
        further           = furtherIn(header, where);
        inSi              = unitsIn(names.first, where);
        comment.clear();
    };
    for (std::size_t number = 1; in.getline(line.data(), std::streamsize(line.size())); ++number) {
        const std::string where = name + ": line " + std::to_string(number);
        std::string_view  rest(line.data());
        if (number == 1 && rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
        const Words words = wordsOf(rest);
        if (words.count == 0) continue;
        if (words.first[0].starts_with('#')) {
            const std::string header =
                withUnitsAtNames(rest.substr(std::min(rest.find_first_not_of("# \t"), rest.size())));
            if (checked.waypoints.empty() && namesColumns(wordsOf(header).first))
                comment = header, commentWhere = where;
            continue;
        }
        if (checked.waypoints.empty() && isHeader(words.first, where)) {
            const std::string header = withUnitsAtNames(rest);
            demandOrder(wordsOf(header).first, where);
            take(header, where);
            continue;
        }
        if (checked.waypoints.empty() && !comment.empty() && wordsOf(comment).count == words.count)
            take(comment, commentWhere);
        demandColumns(words, columns, where);
        HandPose waypoint = waypointOf(words.first, inSi, where);
        if (further.buttons > 0 || further.device > 0) waypoint.buttons = buttonsOf(rest, further, where);
        if (further.turns()) waypoint.orientation = turnOf(rest, further.turn, where);
        checked.add(waypoint, where);
    }
    if (!in.eof())
        throw Error(name + ": expected lines of numbers, found one longer than " + std::to_string(kLongestLine) +
                    " bytes; is it a text file?");
    checked.finish(name);
    return HandPath(std::move(checked.waypoints), name);
}

HandPath readHand(const std::filesystem::path& path)
{
    if (path.extension() == ".npy") return handOf(readNpy(path), path.string());
    InputFile in = openForReading(path);
    return parseHand(in, path.string());
}

std::string fingerprint(const HandPath& hand)
{
    Fingerprint print;
    for (const HandPose& w : hand.waypoints()) {
        for (const double value : {w.time, w.position.x, w.position.y, w.position.z}) print.add(value);
        print.add(std::uint64_t(w.buttons));
        for (int k = 0; k < 4; ++k) print.add(w.orientation[k]);
    }
    return print.text();
}

Contact contactOf(const Scene& scene, const SoftObject& object)
{
    std::optional<glm::dvec3> from = scene.from;
    if (!scene.place && !from) from = glm::dvec3(0, 0, 1);
    return touchAt(object, placeOf(scene, object.cloud()), from, scene.patch.window / 4);
}

HandPlace handPlace(const Scene& scene, const SoftObject& object)
{
    const Contact contact = contactOf(scene, object);
    return {contact.point, contact.outward};
}

HandPath makeHand(const HandScript& script, const HandPlace& place)
{
    expectPositive({{"speed", script.speed},
                    {"radius", script.radius},
                    {"height + depth", script.height + script.depth},
                    {"duration", script.duration}});
    const Frame  frame = Frame::about(place.outward);
    const Script motion(script);
    const double once    = motion.settled() + motion.repetition(); // [s]
    const bool   repeats = script.duration > std::max(kWhole, once);
    const double end     = repeats ? once : kTick * std::ceil(script.duration / kTick); // [s]
    if (!(end < kTick * double(kMostWaypoints)))
        throw Error("hand: expected a motion of less than " + text(kTick * double(kMostWaypoints)) + " s, found " +
                    text(end) + " s; take a greater speed");
    std::vector<HandPose> waypoints;
    waypoints.reserve(std::size_t(end / kTick) + 2);
    const auto add = [&](double t) {
        const glm::dvec3 p = motion.at(t);
        waypoints.push_back({t, place.point + p.x * frame.east + p.y * frame.north + p.z * frame.normal});
    };
    for (std::size_t i = 0; double(i) * kTick < end - kTick / 2; ++i) add(double(i) * kTick);
    add(end);
    return HandPath(std::move(waypoints), std::string("hand ") + name(script.motion),
                    repeats ? std::optional(motion.settled()) : std::nullopt);
}

HandPath draped(const HandPath& hand, const HandPlace& place, const SoftObject& object)
{
    constexpr double kReach   = 3;   // [1] spacings: some 28 points, so that the height is smooth
    constexpr double kFlooded = 2;   // [radii]: in a wider ball the points inside hang together wherever it lies
    constexpr double kStays   = 0.5; // [radii] that the hand goes before the surface is looked for anew

    const double               spacing   = object.spacing();
    const double               radius    = kReach * spacing;
    std::vector<HandPose>      waypoints = hand.waypoints();
    SurfaceFlood               flood(object); // a thin body has another face within the radius
    std::vector<std::uint32_t> own;           // points of the surface around `flooded`
    std::optional<glm::dvec3>  flooded;       // [m]
    // Heights are looked for around the last one: where the hand has come from, the surface is known. The search starts
    // at the place and walks to the first waypoint in steps of a spacing.
    double     height = 0; // [m] above the plane through the place
    const auto follow = [&](const glm::dvec3& inPlane) {
        const glm::dvec3 last = place.point + inPlane + height * place.outward;
        if (!flooded || glm::distance(last, *flooded) > kStays * radius) {
            const auto found = flood.reach(last, (kFlooded + kStays) * radius, place.outward);
            own.assign(found.begin(), found.end());
            std::ranges::sort(own); // the flood's order depends on where it starts
            flooded = last;
        }
        double sum = 0, weights = 0;
        for (const std::uint32_t n : own) {
            const glm::dvec3 point = object.positions()[n], away = point - last;
            if (glm::dot(away, away) > radius * radius) continue;
            const glm::dvec3 d      = point - place.point;
            const double     h      = glm::dot(d, place.outward);
            const glm::dvec3 beside = d - h * place.outward - inPlane;
            const double     share  = 1 - glm::dot(beside, beside) / (radius * radius);
            if (share <= 0) continue;
            weights += share * share;
            sum += share * share * h;
        }
        if (weights > 0) height = sum / weights;
    };
    const auto inPlaneOf = [&](const glm::dvec3& p) {
        const glm::dvec3 d = p - place.point;
        return d - glm::dot(d, place.outward) * place.outward;
    };
    const glm::dvec3 first = inPlaneOf(waypoints.front().position);
    const double     steps = radius > 0 ? std::ceil(glm::length(first) / spacing) : 0;
    for (int i = 0; i < int(steps); ++i) follow(double(i) / steps * first);
    std::vector<double> heights; // [m]
    heights.reserve(waypoints.size());
    for (const HandPose& waypoint : waypoints) {
        if (radius > 0) follow(inPlaneOf(waypoint.position));
        heights.push_back(height);
    }
    if (const auto from = hand.repeatsFrom()) { // a height hangs on the way there; what is open closes evenly
        const auto   after = std::ranges::upper_bound(waypoints, *from, {}, &HandPose::time);
        const auto   k     = std::size_t(after - waypoints.begin());
        const double share = (*from - waypoints[k - 1].time) / (after->time - waypoints[k - 1].time);
        const double open  = std::lerp(heights[k - 1], heights[k], share) - heights.back();
        const double lasts = waypoints.back().time - *from; // [s]
        for (std::size_t n = k; n < waypoints.size(); ++n) heights[n] += (waypoints[n].time - *from) / lasts * open;
    }
    for (std::size_t k = 0; k < waypoints.size(); ++k) waypoints[k].position += heights[k] * place.outward;
    return HandPath(std::move(waypoints), "hand", hand.repeatsFrom());
}

} // namespace palp
