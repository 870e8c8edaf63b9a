#include "engine/session/recording.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <iostream>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/session/detail/growing_file.h"
#include "engine/session/detail/quiet_thread.h"
#include "engine/session/recorded_session.h"
#include "engine/session/tick_ring.h"

namespace palp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kRing   = 4096; // records: 4 s at 1 kHz, longer than a disk should ever make us wait
constexpr auto        kVisits = std::chrono::milliseconds(2); // of the writer; a kill may cost 10 ms
constexpr std::size_t kBatch  = 256; // records written at once, all or none: what the end of a disk may cost

/// The header of ticks.npy, as numpy spells it. The count of rows is its last word, and has room for every count below
/// 2^64.
class RowsHeader {
public:
    RowsHeader()
    {
        text_ = "{'descr': [";
        for (const SessionColumn& column : sessionColumns()) {
            text_ += "('" + std::string(column.name) + "', '" + std::string(column.numpyType()) + "'";
            if (column.components > 1) text_ += ", (" + std::to_string(column.components) + ",)";
            text_ += column.name == sessionColumns().back().name ? ")" : "), ";
        }
        text_ += "], 'fortran_order': False, 'shape': (";
        constexpr std::size_t kBefore = 10, kMultiple = 64; // [bytes] magic, version, length; numpy's alignment
        countAt_                 = kBefore + text_.size();
        const std::size_t whole  = (countAt_ + kRoom + 1 + kMultiple - 1) / kMultiple * kMultiple;
        const std::size_t length = whole - kBefore;
        text_ = std::string("\x93NUMPY\x01\x00", 8) + char(length & 0xff) + char(length >> 8) + text_ + counting(0);
        text_.resize(whole - 1, ' ');
        text_ += '\n';
    }

    [[nodiscard]] const std::string& text() const noexcept { return text_; } ///< of no rows
    [[nodiscard]] std::size_t        countAt() const noexcept { return countAt_; }
    /// Returns what stands at countAt() for a number of rows, always of the same length.
    [[nodiscard]] static std::string counting(std::uint64_t rows)
    {
        std::string end = std::to_string(rows) + ",), }";
        end.resize(kRoom, ' ');
        return end;
    }

private:
    static constexpr std::size_t kRoom = 26; // [bytes] 20 digits and the brackets

    std::string text_;
    std::size_t countAt_ = 0; ///< [bytes]
};

/// The files of a folder that grow.
class TickFiles {
public:
    explicit TickFiles(const std::filesystem::path& folder)
        : ticks_(folder / "ticks.npy"), markers_(folder / "markers.jsonl")
    {
        rowsOf_.reserve(kBatch * tickRowBytes());
        ticks_.append(header_.text());
        ticks_.accept();
    }

    /// Appends all of the records, at most kBatch, or none.
    /// \throws Error naming the file and the reason
    void append(std::span<const TickRecord> records)
    {
        rowsOf_.resize(records.size() * tickRowBytes());
        for (std::size_t i = 0; i < records.size(); ++i) packTick(records[i], &rowsOf_[i * tickRowBytes()]);
        try {
            ticks_.append(rowsOf_);
            ticks_.write(RowsHeader::counting(rows_ + records.size()), header_.countAt());
        } catch (const Error&) {
            ticks_.undo();
            if (ticks_.isCut()) throw;
            try { // the header lies within blocks that the file has, so the rows found no room; but if not:
                ticks_.write(RowsHeader::counting(rows_), header_.countAt());
            } catch (const Error&) { // the first complaint is the one to report
            }
            throw;
        }
        rows_ += records.size();
        ticks_.accept();
    }

    /// Appends a line for each marker, all or none.
    /// \throws Error as append()
    void append(const std::vector<Marker>& markers)
    {
        std::string lines;
        for (const Marker& marker : markers)
            lines += nlohmann::ordered_json{{"time", marker.time}, {"text", marker.text}}.dump() + "\n";
        try {
            markers_.append(lines);
        } catch (const Error&) {
            markers_.undo();
            throw;
        }
        markers_.accept();
        marked_ += markers.size();
    }

    /// \throws Error naming the file and the reason
    void close()
    {
        ticks_.close();
        markers_.close();
    }

    [[nodiscard]] bool          areThere() const noexcept { return ticks_.isThere() && markers_.isThere(); }
    [[nodiscard]] bool          areCut() const noexcept { return ticks_.isCut() || markers_.isCut(); }
    [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
    [[nodiscard]] std::uint64_t marked() const noexcept { return marked_; }

private:
    RowsHeader    header_;
    GrowingFile   ticks_, markers_;
    std::string   rowsOf_; ///< the batch that is being written
    std::uint64_t rows_   = 0;
    std::uint64_t marked_ = 0;
};

std::string now()
{
    const std::time_t seconds = std::time(nullptr);
    std::tm           utc{};
    ::gmtime_r(&seconds, &utc);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

nlohmann::ordered_json describe(const SessionInfo& info, const std::filesystem::path& folder)
{
    nlohmann::ordered_json columns = nlohmann::ordered_json::object();
    for (const SessionColumn& column : sessionColumns())
        columns[std::string(column.name)] = {{"unit", column.unit},
                                             {"type", column.numpyType()},
                                             {"components", column.components},
                                             {"means", column.means}};
    nlohmann::ordered_json origins = nlohmann::ordered_json::object();
    for (const auto& [key, origin] : info.scene.origins)
        origins[key] = name(origin.origin) + (origin.where.empty() ? "" : " " + origin.where);
    nlohmann::ordered_json hand{{"model", info.hand.model},
                                {"maximum_force_N", info.hand.maximumForce},
                                {"maximum_stiffness_N_per_m", info.hand.maximumStiffness},
                                {"mass_kg", info.hand.mass},
                                {"own_damping_N_s_per_m", info.hand.ownDamping},
                                {"weight_N", {info.hand.weight.x, info.hand.weight.y, info.hand.weight.z}},
                                {"senses_orientation", info.hand.rotates},
                                {"senses_grip", info.hand.hasGripper}};
    if (info.from) hand["came_from_m"] = {info.from->x, info.from->y, info.from->z};
    return {{"format", kSessionFormat},
            {"versions", info.versions},
            {"started", now()},
            {"realtime_ns", nullptr}, // of time 0, which has not come yet
            {"monotonic_ns", nullptr},
            {"command", info.command},
            {"clock", name(info.clock)},
            {"solver", info.solver},
            {"cloud", info.cloud},
            {"hand", std::move(hand)},
            {"scene", nlohmann::ordered_json::parse(sceneJson(info.scene, folder))},
            {"origins", std::move(origins)},
            {"columns", std::move(columns)},
            {"finished", false}};
}

void writeDescription(const std::filesystem::path& folder, const nlohmann::ordered_json& description)
{
    writeFileWhole(folder / "session.json", [&](std::ostream& out) {
        out << description.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
    });
}

/// \throws Error if a folder is not empty
void expectEmpty(const std::filesystem::path& folder)
{
    std::error_code failure;
    if (!std::filesystem::is_empty(folder, failure) && !failure)
        throw Error(folder.string() + ": expected a new or empty folder for a session, found one with files, which " +
                    "would be overwritten; name another");
    if (failure) throw Error(folder.string() + ": cannot be read: " + failure.message());
}

} // namespace

struct Recording::Impl {
    Impl(const std::filesystem::path& place, const SessionInfo& info, Complain hear)
        : folder(place), description(describe(info, place)), complain(std::move(hear)), ring(kRing), files(place)
    {
        writeDescription(folder, description);
        writer = quietThread([this] { work(); });
    }

    /// Takes the clocks of time 0 from the first record, unless begin() did.
    /// \param time  of the record, which is of this moment; a caller's may begin anywhere [s]
    void beginNow(double time) noexcept
    {
        constexpr double kMost = 4e9; // [s] 127 years: more nanoseconds would not fit
        if (begun.load(std::memory_order_relaxed)) return;
        const std::chrono::duration<double> ago(std::clamp(time, -kMost, kMost));
        clocks = SessionClocks::at(Clock::now() - std::chrono::duration_cast<Clock::duration>(ago));
        begun.store(true, std::memory_order_release);
    }

    void work()
    {
        Clock::time_point last = Clock::now();
        for (bool more = true; more;) {
            more = !finishing.load(std::memory_order_acquire); // before the last look: earlier records are seen
            noteClocks();
            drain();
            writeMarkers();
            const Clock::time_point time = Clock::now();
            longestGap                   = std::max(longestGap, std::chrono::duration<double>(time - last).count());
            last                         = time;
            if (more) std::this_thread::sleep_for(kVisits);
        }
    }

    void drain()
    {
        for (std::span<const TickRecord> batch = ring.front(); !batch.empty(); batch = ring.front()) {
            batch = batch.first(std::min(batch.size(), kBatch));
            if (!stopped.load(std::memory_order_relaxed)) write(batch);
            ring.pop(batch.size());
        }
    }

    /// Completes session.json once time 0 has come. If that fails, describeEnd() tries again.
    void noteClocks()
    {
        if (noted || !begun.load(std::memory_order_acquire)) return;
        noted                       = true;
        description["realtime_ns"]  = clocks.realtime;
        description["monotonic_ns"] = clocks.monotonic;
        if (!files.areThere()) return; // finish() says so
        try {
            writeDescription(folder, description);
        } catch (const Error&) { // the one from the start is still there
        }
    }

    void writeMarkers()
    {
        std::vector<Marker> batch;
        {
            const std::lock_guard lock(mutex);
            batch.swap(markers);
        }
        if (!batch.empty() && !stopped.load(std::memory_order_relaxed)) write(batch);
    }

    template <class Batch>
    void write(const Batch& batch)
    {
        try {
            files.append(batch);
        } catch (const std::exception& error) {
            stop("recording stopped after " + counted(files.rows(), "tick") + ": " + error.what());
        }
    }

    void stop(const std::string& sentence)
    {
        why = sentence;
        stopped.store(true, std::memory_order_release);
        say(sentence);
    }

    void say(const std::string& sentence) const
    {
        if (complain)
            complain(sentence);
        else
            std::cerr << "palpate: " << sentence << "\n";
    }

    RecordingReport finish()
    {
        if (writer.joinable()) {
            finishing.store(true, std::memory_order_release);
            writer.join();
            const bool there = files.areThere(), whole = there && !files.areCut();
            if (!whole && !why)
                stop(folder.string() + ": another program has removed, moved or cut the files of the recording");
            close();
            const std::uint64_t rows = whole ? files.rows() : 0, marked = whole ? files.marked() : 0;
            report = {rows, pushed - rows, longestGap, why, marked, marksHeard - marked + marksMissed};
            if (there) describeEnd(); // else another recording may have the folder's name
            if (!report.stopped && report.lost > 0)
                say(folder.string() + ": " + counted(report.lost, "tick") +
                    " lost: its disk was slower than the servo");
        }
        return report;
    }

    void close()
    {
        try {
            files.close();
        } catch (const Error& error) {
            if (!why) stop(std::string("the end of the recording may be lost: ") + error.what());
        }
    }

    void describeEnd()
    {
        description["finished"]      = true;
        description["samples"]       = report.ticks; // the format's word, for a tick
        description["lost"]          = report.lost;
        description["markers"]       = report.markers;
        description["markers_lost"]  = report.markersLost;
        description["longest_gap_s"] = report.longestGap;
        description["stopped"]       = report.stopped ? nlohmann::ordered_json(*report.stopped) : nullptr;
        try {
            writeDescription(folder, description);
        } catch (const Error& error) { // a full disk: the description from the start is still there, states unfinished
            if (!why) stop(std::string("the recording could not be marked as finished: ") + error.what());
            report.stopped = why;
        }
    }

    std::filesystem::path      folder;
    nlohmann::ordered_json     description;
    Complain                   complain;
    TickRing<TickRecord>       ring;
    TickFiles                  files;
    std::uint64_t              pushed = 0; ///< by the producer; read after finish() only
    SessionClocks              clocks;     ///< by the producer, before `begun`
    std::atomic<bool>          begun{false};
    bool                       noted = false; ///< of the writer: session.json has the clocks
    std::mutex                 mutex;         ///< of the next three; the producer never takes it
    std::vector<Marker>        markers;
    std::uint64_t              marksHeard = 0, marksMissed = 0;
    std::atomic<bool>          finishing{false};
    std::atomic<bool>          stopped{false};
    double                     longestGap = 0; ///< [s] of the writer
    std::optional<std::string> why;            ///< of the writer
    RecordingReport            report;
    std::thread                writer;
};

Recording::Recording(const std::filesystem::path& folder, const SessionInfo& info, Complain complain)
{
    makeFolder(folder);
    // Two sessions that begin in one folder at once would both find it empty, and the later one would clear it away.
    const FolderLock alone(folder, "another program begins a session in this folder; name another");
    expectEmpty(folder);
    try {
        impl_ = std::make_unique<Impl>(folder, info, std::move(complain));
    } catch (...) { // the folder was empty: it holds an incomplete beginning
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
            std::filesystem::remove(entry.path(), ignored);
        throw;
    }
}

Recording::~Recording()
{
    impl_->finish();
}

void Recording::begin(const SessionClocks& clocks) noexcept
{
    impl_->clocks = clocks;
    impl_->begun.store(true, std::memory_order_release);
}

void Recording::push(const TickRecord& record) noexcept
{
    if (impl_->pushed++ == 0) impl_->beginNow(record.time);
    if (!impl_->stopped.load(std::memory_order_relaxed)) static_cast<void>(impl_->ring.push(record));
}

void Recording::pushWaiting(const TickRecord& record) noexcept
{
    if (impl_->pushed++ == 0) impl_->beginNow(record.time);
    while (!impl_->stopped.load(std::memory_order_acquire) && !impl_->ring.push(record)) std::this_thread::yield();
}

void Recording::mark(const Marker& marker)
{
    const std::lock_guard lock(impl_->mutex);
    if (impl_->marksHeard++ < kMostMarkers && impl_->markers.size() < kMostMarkersAtOnce)
        impl_->markers.push_back(marker);
}

void Recording::lose(std::uint64_t markers)
{
    const std::lock_guard lock(impl_->mutex);
    impl_->marksMissed += markers;
}

RecordingReport Recording::finish()
{
    return impl_->finish();
}

} // namespace palp
