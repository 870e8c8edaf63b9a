#include "engine/session/recording.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <iostream>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/session/recorded_session.h"
#include "engine/session/tick_ring.h"

namespace palp {
namespace {

using Clock = std::chrono::steady_clock;

static_assert(std::endian::native == std::endian::little, ".npy numbers are written as they lie in memory");

constexpr std::size_t kRing       = 4096; // records: 4 s at 1 kHz, longer than a disk should ever make us wait
constexpr auto        kVisits     = std::chrono::milliseconds(2); // of the writer; a kill may cost 10 ms
constexpr std::size_t kBatch      = 256;  // records written at once, all or none: what the end of a disk may cost
constexpr std::size_t kHeader     = 128;  // [bytes] of each .npy file, for every count below 2^64; a multiple of 64
constexpr std::size_t kMostOfLine = 1024; // [bytes] of samples.csv: 23 numbers of up to 25 characters

std::string reasonOfErrno()
{
    return errno ? std::strerror(errno) : "unknown reason";
}

std::string npyHeader(const SessionColumn& column, std::uint64_t rows)
{
    std::string text = "{'descr': '" + std::string(column.numpyType()) + "', 'fortran_order': False, 'shape': (" +
                       std::to_string(rows) + (column.components > 1 ? ", " + std::to_string(column.components) : ",") +
                       "), }";
    constexpr std::size_t kBefore = 10; // [bytes] magic, version, length
    text.resize(kHeader - kBefore - 1, ' ');
    const std::uint16_t length = std::uint16_t(text.size() + 1);
    return std::string("\x93NUMPY\x01\x00", 8) + char(length & 0xff) + char(length >> 8) + text + "\n";
}

/// A file that grows, and whose beginning may be written again.
class GrowingFile {
public:
    /// Makes the file.
    /// \throws Error if there is one of that name, or none can be made
    explicit GrowingFile(std::filesystem::path path)
        : path_(std::move(path)), handle_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644))
    {
        if (handle_ < 0) throw Error(path_.string() + ": cannot be made: " + reasonOfErrno());
    }
    ~GrowingFile()
    {
        if (handle_ >= 0) ::close(handle_);
    }
    GrowingFile(GrowingFile&& other) noexcept
        : path_(std::move(other.path_)), handle_(std::exchange(other.handle_, -1)), whole_(other.whole_)
    {
    }
    GrowingFile& operator=(GrowingFile&&) = delete;

    /// Writes bytes at a place.
    /// \throws Error naming the file and the reason; then some of the bytes may stand in it
    void write(std::string_view bytes, std::uint64_t at)
    {
        while (!bytes.empty()) {
            errno               = 0;
            const ssize_t count = ::pwrite(handle_, bytes.data(), bytes.size(), off_t(at));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) throw Error(path_.string() + ": cannot be written: " + reasonOfErrno());
            bytes.remove_prefix(std::size_t(count));
            at += std::uint64_t(count);
        }
    }

    /// Writes at the end of the complete part.
    void append(std::string_view bytes)
    {
        write(bytes, whole_ + pending_);
        pending_ += bytes.size();
    }
    void accept() noexcept { whole_ += std::exchange(pending_, 0); } ///< counts the appended bytes as complete
    void undo() noexcept                                             ///< drops the appended bytes
    {
        pending_ = 0;
        if (::ftruncate(handle_, off_t(whole_)) != 0) errno = 0; // then it stays, and the header does not count it
    }

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    std::filesystem::path path_;
    int                   handle_;
    std::uint64_t         whole_   = 0; ///< [bytes]
    std::uint64_t         pending_ = 0; ///< [bytes]
};

std::string csvHeader()
{
    std::string line;
    for (const SessionColumn& column : sessionColumns())
        for (std::size_t k = 0; k < column.components; ++k) {
            line += column.name;
            if (column.components > 1) {
                line += '_';
                line += "xyz"[k];
            }
            line += ',';
        }
    line.back() = '\n';
    return line;
}

/// Appends one number as text that brings the same bits back. `text` must have room.
void appendNumber(std::string& text, const SessionColumn& column, const char* bytes)
{
    std::array<char, 32> digits;
    const auto           append = [&](auto number) {
        std::memcpy(&number, bytes, sizeof number);
        const auto [end, status] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
        text.append(digits.data(), end);
    };
    switch (column.type) {
    case SessionColumn::Type::float64:
        return append(double{});
    case SessionColumn::Type::int32:
        return append(std::int32_t{});
    case SessionColumn::Type::uint32:
        return append(std::uint32_t{});
    }
}

void appendLine(std::string& text, const TickRecord& record)
{
    const char* const bytes = reinterpret_cast<const char*>(&record);
    for (const SessionColumn& column : sessionColumns())
        for (std::size_t k = 0; k < column.components; ++k) {
            appendNumber(text, column, bytes + column.offset + k * column.bytes() / column.components);
            text += ',';
        }
    text.back() = '\n';
}

/// The column files of a folder, which always end together.
class TickFiles {
public:
    explicit TickFiles(const std::filesystem::path& folder) : csv_(folder / "samples.csv")
    {
        buffer_.reserve(kBatch * kMostOfLine);
        for (const SessionColumn& column : sessionColumns())
            columns_.emplace_back(folder / (std::string(column.name) + ".npy"));
        for (std::size_t k = 0; k < columns_.size(); ++k) columns_[k].append(npyHeader(sessionColumns()[k], 0));
        csv_.append(csvHeader());
        accept();
    }

    /// Appends all of the records, at most kBatch, or none.
    /// \throws Error naming the file and the reason
    void append(std::span<const TickRecord> records)
    {
        try {
            for (std::size_t k = 0; k < columns_.size(); ++k) {
                const SessionColumn& column = sessionColumns()[k];
                buffer_.clear();
                for (const TickRecord& record : records)
                    buffer_.append(reinterpret_cast<const char*>(&record) + column.offset, column.bytes());
                columns_[k].append(buffer_);
            }
            buffer_.clear();
            for (const TickRecord& record : records) appendLine(buffer_, record);
            csv_.append(buffer_);
            for (std::size_t k = 0; k < columns_.size(); ++k)
                columns_[k].write(npyHeader(sessionColumns()[k], rows_ + records.size()), 0);
        } catch (const Error&) {
            // A header lies within blocks that the file has, so usually data found no room; but if not:
            for (std::size_t k = 0; k < columns_.size(); ++k) {
                columns_[k].undo();
                try {
                    columns_[k].write(npyHeader(sessionColumns()[k], rows_), 0);
                } catch (const Error&) { // the first complaint is the one to report
                }
            }
            csv_.undo();
            throw;
        }
        rows_ += records.size();
        accept();
    }

    [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }

private:
    void accept() noexcept
    {
        for (GrowingFile& column : columns_) column.accept();
        csv_.accept();
    }

    GrowingFile              csv_;
    std::vector<GrowingFile> columns_;
    std::string              buffer_;
    std::uint64_t            rows_ = 0;
};

std::string now()
{
    const std::time_t seconds = std::time(nullptr);
    std::tm           utc{};
    ::gmtime_r(&seconds, &utc);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

nlohmann::ordered_json describe(const SessionInfo& info)
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
    return {{"format", kSessionFormat},
            {"versions", info.versions},
            {"started", now()},
            {"command", info.command},
            {"clock", name(info.clock)},
            {"solver", info.solver},
            {"cloud", info.cloud},
            {"hand",
             {{"model", info.hand.model},
              {"maximum_force_N", info.hand.maximumForce},
              {"maximum_stiffness_N_per_m", info.hand.maximumStiffness},
              {"mass_kg", info.hand.mass},
              {"own_damping_N_s_per_m", info.hand.ownDamping}}},
            {"scene", nlohmann::ordered_json::parse(sceneJson(info.scene))},
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

/// Makes a folder for a session.
/// \throws Error if it is there and not empty
void makeFresh(const std::filesystem::path& folder)
{
    makeFolder(folder);
    std::error_code failure;
    if (!std::filesystem::is_empty(folder, failure) && !failure)
        throw Error(folder.string() + ": expected a new or empty folder for a session, found one with files, which " +
                    "would be overwritten; name another");
    if (failure) throw Error(folder.string() + ": cannot be read: " + failure.message());
}

/// Starts a thread that gets no signals: those are for the program's own thread, and a write beyond the limit on sizes
/// is then an error instead of the end.
template <class Work>
std::thread quietThread(Work work)
{
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::move(work));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

} // namespace

struct Recording::Impl {
    Impl(const std::filesystem::path& place, const SessionInfo& info, Complain hear)
        : folder(place), description(describe(info)), complain(std::move(hear)), ring(kRing), files(place)
    {
        writeDescription(folder, description);
        writer = quietThread([this] { work(); });
    }

    void work()
    {
        Clock::time_point last = Clock::now();
        for (bool more = true; more;) {
            more = !finishing.load(std::memory_order_acquire); // before the last look: earlier records are seen
            drain();
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

    void write(std::span<const TickRecord> batch)
    {
        try {
            files.append(batch);
        } catch (const std::exception& error) {
            why = "recording stopped after " + std::to_string(files.rows()) + " ticks: " + error.what();
            stopped.store(true, std::memory_order_release);
            if (complain)
                complain(*why);
            else
                std::cerr << "palpate: " << *why << "\n";
        }
    }

    RecordingReport finish()
    {
        if (writer.joinable()) {
            finishing.store(true, std::memory_order_release);
            writer.join();
            report = {files.rows(), pushed - files.rows(), longestGap, why};
            describeEnd();
        }
        return report;
    }

    void describeEnd()
    {
        description["finished"]      = true;
        description["samples"]       = report.ticks; // the format's word, as in samples.csv
        description["lost"]          = report.lost;
        description["longest_gap_s"] = report.longestGap;
        description["stopped"]       = report.stopped ? nlohmann::ordered_json(*report.stopped) : nullptr;
        try {
            writeDescription(folder, description);
        } catch (const Error&) { // a full disk: the description from the start is still there, and states unfinished
            if (!report.stopped) report.stopped = "session.json could not be completed";
        }
    }

    std::filesystem::path      folder;
    nlohmann::ordered_json     description;
    Complain                   complain;
    TickRing<TickRecord>       ring;
    TickFiles                  files;
    std::uint64_t              pushed = 0; ///< by the producer; read after finish() only
    std::atomic<bool>          finishing{false};
    std::atomic<bool>          stopped{false};
    double                     longestGap = 0; ///< [s] of the writer
    std::optional<std::string> why;            ///< of the writer
    RecordingReport            report;
    std::thread                writer;
};

Recording::Recording(const std::filesystem::path& folder, const SessionInfo& info, Complain complain)
{
    makeFresh(folder);
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

void Recording::push(const TickRecord& record) noexcept
{
    ++impl_->pushed;
    if (!impl_->stopped.load(std::memory_order_relaxed)) static_cast<void>(impl_->ring.push(record));
}

void Recording::pushWaiting(const TickRecord& record) noexcept
{
    ++impl_->pushed;
    while (!impl_->stopped.load(std::memory_order_acquire) && !impl_->ring.push(record)) std::this_thread::yield();
}

RecordingReport Recording::finish()
{
    return impl_->finish();
}

} // namespace palp
