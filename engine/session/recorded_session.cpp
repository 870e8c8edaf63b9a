#include "engine/session/recorded_session.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <span>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"
#include "engine/force/governor.h"
#include "engine/session/scene_keys.h"

namespace palp {
namespace {

constexpr std::size_t kMostOfDescription = std::size_t(4) << 20; // [bytes] of session.json

/// The number of rows in the header of a column, and where its numbers begin.
struct Extent {
    std::uint64_t rows  = 0;
    std::uint64_t begin = 0; ///< [bytes]
};

/// Reads a header. It must be that of `column` as numpy writes it, but for the number of rows: (rows,) or (rows, 3).
Extent readHeader(std::istream& in, const SessionColumn& column, const std::string& name)
{
    constexpr std::size_t     kBefore = 10; // [bytes] magic, version 1, length of the header
    std::array<char, kBefore> start{};
    in.read(start.data(), start.size());
    if (!in || std::memcmp(start.data(), "\x93NUMPY\x01", 7) != 0)
        throw Error(name + ": expected a .npy file of version 1, found something else");
    std::string header(std::size_t(static_cast<unsigned char>(start[8])) + 256u * static_cast<unsigned char>(start[9]),
                       '\0');
    in.read(header.data(), std::streamsize(header.size()));
    if (!in) throw Error(name + ": the file ends within its header");

    const std::string before =
        "{'descr': '" + std::string(column.numpyType()) + "', 'fortran_order': False, 'shape': (";
    const std::string after = column.components > 1 ? ", " + std::to_string(column.components) + ")" : ",)";
    std::uint64_t     rows  = 0;
    const char*       rest  = header.data() + std::min(before.size(), header.size());
    const char*       end   = header.data() + header.size();
    const auto        read  = std::from_chars(rest, end, rows);
    if (!header.starts_with(before) || read.ec != std::errc() || !std::string_view(read.ptr, end).starts_with(after))
        throw Error(name + ": expected " + before + "N" + after + ", found " + header.substr(0, 100));
    return {rows, kBefore + header.size()};
}

struct OpenColumn {
    std::ifstream in;
    std::string   name;
    std::uint64_t rows;
};

OpenColumn openColumn(const std::filesystem::path& folder, const SessionColumn& column)
{
    const std::filesystem::path path   = folder / (std::string(column.name) + ".npy");
    std::ifstream               in     = openForReading(path);
    const Extent                extent = readHeader(in, column, path.string());
    std::error_code             failure;
    const std::uint64_t         bytes = std::filesystem::file_size(path, failure);
    if (failure) throw Error(path.string() + ": cannot be read: " + failure.message());
    if (extent.rows > (bytes - extent.begin) / column.bytes())
        throw Error(path.string() + ": the header counts " + std::to_string(extent.rows) + " ticks of " +
                    std::to_string(column.bytes()) + " bytes, found " + std::to_string(bytes - extent.begin) +
                    " bytes");
    return {std::move(in), path.string(), extent.rows};
}

/// Reads the columns of a folder.
/// \param expected  records of a session that was finished: all columns have as many
std::vector<TickRecord> readColumns(const std::filesystem::path& folder, std::optional<std::uint64_t> expected)
{
    std::vector<OpenColumn> open;
    std::uint64_t           rows = std::numeric_limits<std::uint64_t>::max();
    for (const SessionColumn& column : sessionColumns()) {
        open.push_back(openColumn(folder, column));
        rows = std::min(rows, open.back().rows);
        if (expected && open.back().rows != *expected)
            throw Error(open.back().name + ": expected the " + std::to_string(*expected) +
                        " ticks that session.json counts, found " + std::to_string(open.back().rows) +
                        "; the recording is damaged");
    }
    std::vector<TickRecord> records(rows);
    std::vector<char>       part;
    for (std::size_t k = 0; k < open.size(); ++k) {
        const SessionColumn&  column = sessionColumns()[k];
        constexpr std::size_t kPart  = 65536; // rows at a time
        for (std::size_t begin = 0; begin < rows; begin += kPart) {
            const std::size_t count = std::min<std::size_t>(kPart, rows - begin);
            part.resize(count * column.bytes());
            open[k].in.read(part.data(), std::streamsize(part.size()));
            if (!open[k].in) throw Error(open[k].name + ": the file ends within its numbers");
            for (std::size_t i = 0; i < count; ++i)
                std::memcpy(reinterpret_cast<char*>(&records[begin + i]) + column.offset,
                            part.data() + i * column.bytes(), column.bytes());
        }
    }
    return records;
}

/// Returns the scene of a recording of format 1, whose keys had other names, with the names of today.
std::string withNamesOfToday(const std::string& scene)
{
    using Json       = nlohmann::ordered_json;
    const Json then  = Json::parse(scene);
    Json       today = Json::object();
    for (const auto& [name, value] : then.items()) today[std::string(keyNamedOnce(name).value_or(name))] = value;
    return today.dump();
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
    const std::size_t each = column.bytes() / column.components;
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

RecordedSession readSession(const std::filesystem::path& folder)
{
    const std::filesystem::path path = folder / "session.json";
    std::error_code             none;
    const bool                  isFolder = std::filesystem::is_directory(folder, none);
    if (std::filesystem::exists(folder, none) && !std::filesystem::exists(path, none))
        throw Error(folder.string() + ": expected the folder of a recorded session, found " +
                    (isFolder ? "no session.json in it; " : "a file; ") +
                    "palpate run --record makes one, and so does F5 in the window");
    const JsonObject file =
        JsonObject::parse(readWhole(path, kMostOfDescription, "the description of a session"), path.string());
    const int format = file.has("format") ? file.wholeNumber("format", 1, std::numeric_limits<int>::max()) : 0;
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
    std::optional<std::uint64_t> expected;
    if (session.finished) expected = file.wholeNumber("samples", 0, std::numeric_limits<int>::max());
    session.cloud = file.has("cloud") ? file.text("cloud") : "";
    if (file.has("hand")) {
        const JsonObject hand         = file.object("hand");
        session.hand.model            = hand.text("model");
        session.hand.maximumForce     = hand.number("maximum_force_N");
        session.hand.maximumStiffness = hand.number("maximum_stiffness_N_per_m");
        const GovernorSettings arm; // older recordings credited every device with this arm
        session.hand.mass = hand.has("mass_kg") ? hand.number("mass_kg") : arm.mass;
        session.hand.ownDamping =
            hand.has("own_damping_N_s_per_m") ? hand.number("own_damping_N_s_per_m") : arm.ownDamping;
    }
    session.records = readColumns(folder, expected);
    return session;
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
        for (const SessionColumn& column : sessionColumns()) {
            if (column.measured) continue;
            if (auto difference = differenceIn(column, a.records[i], b.records[i])) {
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
    if (d.column.empty()) return first + " has " + d.first + " ticks and " + second + " has " + d.second;
    const auto column   = std::ranges::find(sessionColumns(), d.column, &SessionColumn::name);
    const bool isVector = column != sessionColumns().end() && column->components > 1;
    return "tick " + std::to_string(d.tick) + " (" + numberText<double>(reinterpret_cast<const char*>(&d.time)) +
           " s): " + d.column + (isVector ? std::string(" ") + "xyz"[d.component] : "") + " is " + d.first + " in " +
           first + " and " + d.second + " in " + second;
}

} // namespace palp
