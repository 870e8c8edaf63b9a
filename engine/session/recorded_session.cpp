#include "engine/session/recorded_session.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <span>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"
#include "engine/core/shown_text.h"
#include "engine/force/governor.h"
#include "engine/session/scene_keys.h"
#include "engine/session/tick_source.h"

namespace palp {
namespace {

constexpr std::size_t kMostOfDescription = std::size_t(4) << 20; // [bytes] of session.json
constexpr std::size_t kMostOfReason      = 300;                  // [bytes] of a sentence in it

/// Reads markers.jsonl, one object a line. What follows the last line's end was cut by a kill.
std::vector<Marker> readMarkers(const std::filesystem::path& path)
{
    constexpr std::size_t kMost = std::size_t(64) << 20, kLongest = std::size_t(16) << 10; // [bytes] of all, of a line
    std::error_code       none;
    if (!std::filesystem::exists(path, none)) return {}; // format 1 had none
    const std::string   whole = readWhole(path, kMost, "the markers of a session", Pipes::refused);
    std::vector<Marker> markers;
    std::string_view    rest = whole;
    for (std::size_t end; (end = rest.find('\n')) != std::string_view::npos; rest.remove_prefix(end + 1)) {
        const std::string where = path.string() + ": line " + std::to_string(markers.size() + 1);
        if (end > kLongest)
            throw Error(where + ": expected a marker of at most " + std::to_string(kLongest) + " bytes, found " +
                        std::to_string(end));
        const JsonObject line = JsonObject::parse(rest.substr(0, end), where);
        if (markers.size() == Recording::kMostMarkers)
            throw Error(path.string() + ": expected at most " + std::to_string(Recording::kMostMarkers) + " markers");
        markers.push_back({line.number("time"), markerText(line.text("text"))});
    }
    return markers;
}

/// Returns the clocks of time 0, which may be null or, in an older file, absent.
std::optional<SessionClocks> clocksOf(const JsonObject& file)
{
    const auto nanoseconds = [&](std::string_view key) -> std::optional<std::int64_t> {
        std::int64_t value = 0;
        if (!file.has(key)) return {};
        const std::string text    = file.json(key);
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure == std::errc() && end == text.data() + text.size()) return value;
        if (text != "null") file.refuse(key, "a whole number of nanoseconds, or null");
        return {};
    };
    const auto realtime = nanoseconds("realtime_ns"), monotonic = nanoseconds("monotonic_ns");
    if (!realtime || !monotonic) return {};
    return SessionClocks{*realtime, *monotonic};
}

/// Returns what a recording lacks, as the end of a sentence; empty if it is whole.
/// \param file  session.json
std::string whyIncomplete(const JsonObject& file, bool finished)
{
    if (!finished) return "it has no end: its program was killed, or still records";
    const auto count = [&](std::string_view key) {
        return std::size_t(file.has(key) ? std::clamp(file.number(key), 0.0, 1e15) : 0);
    };
    if (file.has("stopped") && file.json("stopped") != "null") return shownText(file.text("stopped"), kMostOfReason);
    if (count("lost") > 0) return "it lacks " + counted(count("lost"), "tick");
    if (count("markers_lost") > 0) return "it lacks " + counted(count("markers_lost"), "marker");
    return {};
}

/// Returns which markers are missing in the file, as whyIncomplete() does.
/// \param file  session.json
/// \param path  of the markers, of which `found` have been read
std::string whyFewerMarkers(const JsonObject& file, const std::filesystem::path& path, std::size_t found)
{
    const double counts = file.has("markers") ? file.number("markers") : 0; // only a finished recording has it
    if (!(counts > double(found))) return {};
    std::error_code none;
    return path.string() + ": expected the " + counted(std::size_t(std::min(counts, 1e15)), "marker") +
           " that session.json counts, found " +
           (std::filesystem::exists(path, none) ? std::to_string(found) : std::string("no such file"));
}

/// Returns the scene of a recording of format 1, whose keys had other names, with the names of today.
std::string withNamesOfToday(const std::string& scene)
{
    using Json       = nlohmann::json; // one that keeps the order looks through all keys for each
    const Json then  = Json::parse(scene);
    Json       today = Json::object();
    for (const auto& [name, value] : then.items()) today[std::string(keyNamedOnce(name).value_or(name))] = value;
    return today.dump();
}

/// Returns true if a column is among those of RecordedSession::columns.
bool holds(std::uint64_t columns, std::string_view name)
{
    const auto place = std::ranges::find(sessionColumns(), name, &SessionColumn::name) - sessionColumns().begin();
    return (columns & std::uint64_t(1) << place) != 0;
}

const char* bytesOf(const TickRecord& record, const SessionColumn& column)
{
    return reinterpret_cast<const char*>(&record) + column.offset;
}

template <class Number>
std::string numberText(const char* bytes)
{
    Number number{};
    std::memcpy(&number, bytes, sizeof number);
    std::array<char, 32> digits;
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

std::string valueText(const SessionColumn& column, const char* bytes)
{
    switch (column.type) {
    case SessionColumn::Type::float64:
        return numberText<double>(bytes);
    case SessionColumn::Type::float32: {
        double wide = 0;
        std::memcpy(&wide, bytes, sizeof wide);
        const auto value = static_cast<float>(wide);
        return numberText<float>(reinterpret_cast<const char*>(&value));
    }
    case SessionColumn::Type::int32:
        return numberText<std::int32_t>(bytes);
    case SessionColumn::Type::uint32:
        return numberText<std::uint32_t>(bytes);
    }
    return {};
}

/// Returns the bits of an eight-byte number as text, for NaNs whose payloads differ.
std::string bitsText(const char* bytes)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    std::array<char, 20> digits;
    return " (bits 0x" +
           std::string(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), bits, 16).ptr) + ")";
}

/// Finds the first component in which one column of two records differs.
std::optional<SessionDifference> differenceIn(const SessionColumn& column, const TickRecord& a, const TickRecord& b)
{
    const std::size_t each = column.recordBytes();
    for (std::size_t k = 0; k < column.components; ++k) {
        const char *x = bytesOf(a, column) + k * each, *y = bytesOf(b, column) + k * each;
        if (std::memcmp(x, y, each) == 0) continue;
        SessionDifference difference{
            0, a.time, std::string(column.name), k, valueText(column, x), valueText(column, y)};
        if (difference.first == difference.second) {
            difference.first += bitsText(x);
            difference.second += bitsText(y);
        }
        return difference;
    }
    return {};
}

} // namespace

SessionClock clockOf(const JsonObject& file, const std::filesystem::path& path)
{
    const std::string word = file.text("clock");
    if (const auto clock = valueNamed<SessionClock>(word)) return *clock;
    throw Error(path.string() + ": key \"clock\": expected " + wordsOf<SessionClock>() + ", found \"" + word + "\"");
}

RecordedSession readDescription(const std::filesystem::path& folder)
{
    const std::filesystem::path path = folder / "session.json";
    std::error_code             none;
    const bool                  isFolder = std::filesystem::is_directory(folder, none);
    if (std::filesystem::exists(folder, none) && !std::filesystem::exists(path, none))
        throw Error(folder.string() + ": expected the folder of a recorded session, found " +
                    (isFolder ? "no session.json in it; " : "a file; ") +
                    "palpate run --record makes one, and so does F5 in the window");
    const std::string text   = readWhole(path, kMostOfDescription, "the description of a session", Pipes::refused);
    const JsonObject  file   = JsonObject::parse(text, path.string());
    const int         format = file.has("format") ? file.wholeNumber("format", 1, std::numeric_limits<int>::max()) : 0;
    if (format < 1 || format > kSessionFormat)
        throw Error(path.string() + ": expected \"format\": 1 or " + std::to_string(kSessionFormat) + ", found " +
                    (format > 0 ? std::to_string(format) + "; a later palpate wrote it" : "none"));
    RecordedSession session;
    session.folder  = folder;
    session.clock   = clockOf(file, path);
    session.solver  = file.text(format == 1 ? "device" : "solver");
    session.command = file.text("command");
    session.scene   = format == 1 ? withNamesOfToday(file.json("scene")) : file.json("scene");
    if (file.has("finished")) session.finished = file.json("finished") == "true";
    if (session.finished) session.counted = file.wholeNumber("samples", 0, std::numeric_limits<int>::max());
    session.whyIncomplete = whyIncomplete(file, session.finished);
    session.clocks        = clocksOf(file);
    session.cloud         = file.has("cloud") ? file.text("cloud") : "";
    if (file.has("hand")) {
        const JsonObject hand         = file.object("hand");
        session.hand.model            = hand.text("model");
        session.hand.maximumForce     = hand.number("maximum_force_N");
        session.hand.maximumStiffness = hand.number("maximum_stiffness_N_per_m");
        const GovernorSettings arm; // older recordings credited every device with this arm
        session.hand.mass = hand.has("mass_kg") ? hand.number("mass_kg") : arm.mass;
        session.hand.ownDamping =
            hand.has("own_damping_N_s_per_m") ? hand.number("own_damping_N_s_per_m") : arm.ownDamping;
        if (hand.has("weight_N")) {
            const std::vector<double> weight = hand.numbers("weight_N", 3);
            session.hand.weight              = {weight[0], weight[1], weight[2]};
        }
        if (hand.has("came_from_m")) {
            const std::vector<double> from = hand.numbers("came_from_m", 3);
            session.from                   = glm::dvec3(from[0], from[1], from[2]);
        }
        const auto senses       = [&](const char* what) { return hand.has(what) && hand.json(what) == "true"; };
        session.hand.rotates    = senses("senses_orientation"); // older recordings do not say it
        session.hand.hasGripper = senses("senses_grip");
    }
    session.markers = readMarkers(folder / "markers.jsonl");
    if (const std::string fewer = whyFewerMarkers(file, folder / "markers.jsonl", session.markers.size());
        !fewer.empty())
        session.whyIncomplete += (session.whyIncomplete.empty() ? "" : "; ") + fewer;
    return session;
}

RecordedSession readSession(const std::filesystem::path& folder)
{
    RecordedSession session = readDescription(folder);
    const auto      ticks   = openTicks(session);
    session.columns         = ticks->columns();
    session.records.resize(ticks->rows());
    ticks->read(session.records);
    session.doubts = ticks->doubts();
    if (!holds(session.columns, "answers")) // as format 1: one at each tick, which is what simulated devices answer
        for (std::size_t i = 0; i < session.records.size(); ++i) {
            session.records[i].answers    = std::uint32_t(i + 1);
            session.records[i].answerTime = session.records[i].time;
        }
    return session;
}

std::unique_ptr<TickSource> openTicks(const RecordedSession& session)
{
    auto ticks = openTicks(session.folder, session.finished);
    if (session.counted && ticks->rows() != *session.counted)
        throw Error(session.folder.string() + ": expected the " + counted(*session.counted, "tick") +
                    " that session.json counts, found " + std::to_string(ticks->rows()) + "; the recording is damaged");
    return ticks;
}

Scene sceneOf(const RecordedSession& session, const std::vector<SceneKey>* toolKeys)
{
    SceneOverrides overrides;
    overrides.toolKeys = toolKeys;
    return parseScene(session.scene, (session.folder / "session.json").string() + ": scene", session.folder, overrides);
}

std::optional<SessionDifference> compareSessions(const RecordedSession& a, const RecordedSession& b)
{
    const std::size_t both = std::min(a.records.size(), b.records.size());
    for (std::size_t i = 0; i < both; ++i) {
        if (std::memcmp(&a.records[i], &b.records[i], sizeof(TickRecord)) == 0) continue;
        const TickRecord x = asStored(a.records[i]), y = asStored(b.records[i]);
        for (std::size_t k = 0; k < sessionColumns().size(); ++k) {
            const SessionColumn& column = sessionColumns()[k];
            if (column.measured || (a.columns & b.columns & std::uint64_t(1) << k) == 0) continue;
            if (auto difference = differenceIn(column, x, y)) {
                difference->tick = i;
                return difference;
            }
        }
    }
    if (a.records.size() == b.records.size()) return {};
    const auto& longer = (a.records.size() > both ? a : b).records;
    return SessionDifference{
        both, longer[both].time, "", 0, std::to_string(a.records.size()), std::to_string(b.records.size())};
}

std::string describe(const SessionDifference& d, const RecordedSession& a, const RecordedSession& b)
{
    const std::string first = a.folder.string(), second = b.folder.string();
    if (d.column.empty())
        return first + " has " + counted(a.records.size(), "tick") + " and " + second + " has " + d.second;
    const auto column   = std::ranges::find(sessionColumns(), d.column, &SessionColumn::name);
    const bool isVector = column != sessionColumns().end() && column->components > 1;
    return "tick " + std::to_string(d.tick) + " (" + numberText<double>(reinterpret_cast<const char*>(&d.time)) +
           " s): " + d.column + (isVector ? std::string(" ") + "xyzw"[d.component] : "") + " is " + d.first + " in " +
           first + " and " + d.second + " in " + second;
}

} // namespace palp
