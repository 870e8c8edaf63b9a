#include "engine/session/tick_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"

namespace palp {
namespace {

static_assert(std::numeric_limits<std::uint64_t>::digits >= 64, "a bit for each column");

/// The header of a .npy file, and where its numbers begin.
struct Header {
    std::string   text;
    std::uint64_t begin = 0; ///< [bytes]
};

Header readHeader(std::istream& in, const std::string& name)
{
    constexpr std::size_t     kBefore = 10; // [bytes] magic, version 1, length of the header, which is below 65536
    std::array<char, kBefore> start{};
    in.read(start.data(), start.size());
    if (!in || std::memcmp(start.data(), "\x93NUMPY\x01", 7) != 0)
        throw Error(name + ": expected a .npy file of version 1, found something else");
    Header header;
    header.text.resize(std::size_t(static_cast<unsigned char>(start[8])) + 256u * static_cast<unsigned char>(start[9]));
    in.read(header.text.data(), std::streamsize(header.text.size()));
    if (!in) throw Error(name + ": the file ends within its header");
    header.begin = kBefore + header.text.size();
    return header;
}

/// Reads a text from its beginning, token by token.
class Tokens {
public:
    explicit Tokens(std::string_view text) : rest_(text) {}

    bool take(std::string_view token)
    {
        if (!rest_.starts_with(token)) return false;
        rest_.remove_prefix(token.size());
        return true;
    }
    /// Takes what stands before the next quote, and that quote.
    std::optional<std::string_view> quoted()
    {
        const std::size_t end = rest_.find('\'');
        if (end == std::string_view::npos) return {};
        const std::string_view word = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return word;
    }
    std::optional<std::uint64_t> number()
    {
        std::uint64_t value       = 0;
        const auto [end, failure] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (failure != std::errc()) return {};
        rest_.remove_prefix(std::size_t(end - rest_.data()));
        return value;
    }

private:
    std::string_view rest_;
};

/// Opens a file and checks that it holds the rows that its header counts.
class RowsFile {
public:
    RowsFile(const std::filesystem::path& path)
        : name_(path.string()), in_(openRegularFile(path)), header_(readHeader(in_, name_)), bytes_(sizeOfFile(path))
    {
    }

    void demandRows(std::uint64_t rows, std::size_t rowBytes) const
    {
        if (rows > there() / rowBytes)
            throw Error(name_ + ": the header counts " + counted(rows, "tick") + " of " + std::to_string(rowBytes) +
                        " bytes, found " + std::to_string(there()) + " bytes, " +
                        counted(there() / rowBytes, "whole tick") +
                        "; it may have been cut short while it was copied: copy it again");
    }

    /// Says what the file has beyond its rows; empty: nothing.
    /// \pre demandRows()
    [[nodiscard]] std::string beyond(std::uint64_t rows, std::size_t rowBytes) const
    {
        const std::uint64_t more = there() - rows * rowBytes;
        if (more == 0) return {};
        return name_ + ": expected the end after the " + counted(rows, "tick") + " that the header counts, found " +
               (more < rowBytes ? counted(more, "byte") : counted(more / rowBytes, "tick")) +
               " more; what lies beyond is not read";
    }

    void read(char* to, std::size_t bytes)
    {
        in_.read(to, std::streamsize(bytes));
        if (!in_) throw Error(name_ + ": the file ends within its numbers");
    }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] const std::string& header() const noexcept { return header_.text; }

private:
    [[nodiscard]] std::uint64_t there() const noexcept { return bytes_ - std::min(bytes_, header_.begin); } ///< [bytes]

    std::string   name_;
    InputFile     in_;
    Header        header_;
    std::uint64_t bytes_; ///< of the file, asked for after the header was read: a session may still write
};

constexpr std::size_t kPart = 4096; ///< rows that are read at once [1]

/// A field of a row: where it lies, and the column that it is.
struct Field {
    std::size_t          offset = 0; ///< [bytes]
    const SessionColumn* column = nullptr;
};

/// The rows of ticks.npy. numpy's text of such a layout is {'descr': [('time', '<f8'), ('hip', '<f8', (3,)), ...],
/// 'fortran_order': False, 'shape': (5000,), }.
class TickRows : public TickSource {
public:
    TickRows(const std::filesystem::path& path, bool finished) : file_(path)
    {
        Tokens tokens(file_.header());
        if (!tokens.take("{'descr': [")) refuse();
        while (!tokens.take("], 'fortran_order': False, 'shape': (")) {
            readField(tokens);
            static_cast<void>(tokens.take(", ") || tokens.take(","));
        }
        const auto rows = tokens.number();
        if (!rows || !tokens.take(",)")) refuse();
        rows_ = *rows;
        demandColumns();
        file_.demandRows(rows_, rowBytes_);
        if (finished) doubt(file_.beyond(rows_, rowBytes_)); // else rows may have been written and not yet counted
    }

    [[nodiscard]] std::uint64_t rows() const noexcept override { return rows_; }
    [[nodiscard]] std::uint64_t columns() const noexcept override { return columns_; }

    void readNext(std::span<TickRecord> records) override
    {
        for (std::size_t begin = 0; begin < records.size(); begin += kPart) {
            const std::size_t count = std::min(kPart, records.size() - begin);
            part_.resize(count * rowBytes_);
            file_.read(part_.data(), part_.size());
            for (std::size_t i = 0; i < count; ++i) {
                records[begin + i] = {};
                for (const Field& field : fields_)
                    for (std::size_t k = 0; k < field.column->components; ++k)
                        unpackComponent(*field.column, k,
                                        &part_[i * rowBytes_ + field.offset + k * field.column->storedBytes()],
                                        records[begin + i]);
            }
        }
    }
    [[nodiscard]] std::string fileOf(const SessionColumn&) const override { return file_.name(); }

private:
    [[noreturn]] void refuse() const
    {
        throw Error(file_.name() + ": expected rows {'descr': [('time', '<f8'), ...], 'fortran_order': False, " +
                    "'shape': (N,), }, found " + file_.header().substr(0, 100));
    }

    /// Reads ('hip', '<f8', (3,)) of the header.
    void readField(Tokens& tokens)
    {
        constexpr std::size_t           kMostFields = 256, kMostComponents = 64;
        std::optional<std::string_view> name, type;
        std::optional<std::uint64_t>    components = 1;
        if (!tokens.take("('") || !(name = tokens.quoted()) || !tokens.take(", '") || !(type = tokens.quoted()))
            refuse();
        if (tokens.take(", (") && (!(components = tokens.number()) || !tokens.take(",)"))) refuse();
        if (!tokens.take(")") || ++fieldsSeen_ > kMostFields) refuse();
        const bool known = type->size() == 3 && (type->front() == '<' || type->front() == '|') && type->back() >= '1' &&
                           type->back() <= '8';
        if (!known || *components < 1 || *components > kMostComponents) refuse();
        take(*name, *type, *components);
        rowBytes_ += std::size_t(type->back() - '0') * *components;
    }

    void take(std::string_view name, std::string_view type, std::uint64_t components)
    {
        const auto found = std::ranges::find(sessionColumns(), name, &SessionColumn::name);
        if (found == sessionColumns().end()) return;
        const std::uint64_t bit = std::uint64_t(1) << (found - sessionColumns().begin());
        if (type != found->numpyType() || components != found->components || (columns_ & bit) != 0)
            throw Error(file_.name() + ": column " + std::string(name) + ": expected once, " +
                        std::to_string(found->components) + " of type " + std::string(found->numpyType()) + ", found " +
                        std::to_string(components) + " of type " + std::string(type));
        columns_ |= bit;
        fields_.push_back({rowBytes_, &*found});
    }

    /// A session without these is none: a replay computes with them.
    void demandColumns() const
    {
        for (const std::string_view name : {"time", "hip", "hip_velocity", "missed", "device"})
            if (std::ranges::none_of(fields_, [&](const Field& field) { return field.column->name == name; }))
                throw Error(file_.name() + ": expected a column " + std::string(name) + ", found none");
    }

    RowsFile           file_;
    std::vector<Field> fields_;
    std::size_t        fieldsSeen_ = 0, rowBytes_ = 0;
    std::uint64_t      rows_ = 0, columns_ = 0;
    std::vector<char>  part_;
};

/// A column of format 1 as a file. Its numbers were all of eight bytes where they are float32 today.
struct ColumnFile {
    RowsFile             file;
    const SessionColumn* column;
    std::size_t          bytes; ///< of a component
    std::uint64_t        rows = 0;

    ColumnFile(const std::filesystem::path& folder, const SessionColumn& of)
        : file(folder / (std::string(of.name) + ".npy")), column(&of), bytes(of.recordBytes())
    {
        const std::string_view type   = of.type == SessionColumn::Type::float32 ? "<f8" : of.numpyType();
        const std::string      before = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (";
        const std::string      after  = of.components > 1 ? ", " + std::to_string(of.components) + ")" : ",)";
        Tokens                 tokens(file.header());
        const bool             begins = tokens.take(before);
        const auto             number = begins ? tokens.number() : std::nullopt;
        if (!number || !tokens.take(after))
            throw Error(file.name() + ": expected " + before + "N" + after + ", found " + file.header().substr(0, 100));
        rows = *number;
        file.demandRows(rows, of.components * bytes);
    }

    [[nodiscard]] std::string beyond() const { return file.beyond(rows, column->components * bytes); }
};

/// The columns of format 1.
class TickColumns : public TickSource {
public:
    TickColumns(const std::filesystem::path& folder, bool finished)
    {
        static constexpr std::string_view kThen[] = {
            "time",       "hip",        "hip_velocity", "proxy",          "force",     "normal",
            "rigidity",   "compliance", "w_max",        "error_estimate", "patch_age", "tick_time",
            "iterations", "faults",     "device",       "missed"};
        for (std::size_t k = 0; k < sessionColumns().size(); ++k) {
            if (std::ranges::find(kThen, sessionColumns()[k].name) == std::end(kThen)) continue;
            files_.emplace_back(folder, sessionColumns()[k]);
            columns_ |= std::uint64_t(1) << k;
            rows_ = std::min(rows_, files_.back().rows); // of a session that was killed, some are a visit longer
            if (finished && files_.back().rows != files_.front().rows)
                throw Error(files_.back().file.name() + ": expected the " + counted(files_.front().rows, "tick") +
                            " that " + files_.front().file.name() + " has, found " +
                            std::to_string(files_.back().rows) + "; the recording is damaged");
            if (finished) doubt(files_.back().beyond());
        }
    }

    [[nodiscard]] std::uint64_t rows() const noexcept override { return rows_; }
    [[nodiscard]] std::uint64_t columns() const noexcept override { return columns_; }

    void readNext(std::span<TickRecord> records) override
    {
        std::ranges::fill(records, TickRecord());
        for (std::size_t begin = 0; begin < records.size(); begin += kPart) {
            const std::size_t count = std::min(kPart, records.size() - begin);
            for (ColumnFile& from : files_) {
                const std::size_t each = from.column->components * from.bytes;
                part_.resize(count * each);
                from.file.read(part_.data(), part_.size());
                for (std::size_t i = 0; i < count; ++i) // as wide as in a record, all of them
                    std::memcpy(reinterpret_cast<char*>(&records[begin + i]) + from.column->offset, &part_[i * each],
                                each);
            }
        }
    }
    [[nodiscard]] std::string fileOf(const SessionColumn& column) const override
    {
        return std::ranges::find(files_, &column, &ColumnFile::column)->file.name();
    }

private:
    std::vector<ColumnFile> files_;
    std::uint64_t           rows_    = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t           columns_ = 0;
    std::vector<char>       part_;
};

/// A component of a record that is NaN or infinite.
struct NoNumber {
    const SessionColumn* column    = nullptr; ///< null: all are finite
    std::size_t          component = 0;
    double               value     = 0;
};

/// Returns the first one of a record.
/// \param columns  that are looked at: bit k is sessionColumns()[k]
NoNumber noNumberIn(const TickRecord& record, std::uint64_t columns)
{
    for (std::size_t k = 0; k < sessionColumns().size(); ++k) {
        const SessionColumn& column = sessionColumns()[k];
        if (column.recordBytes() != sizeof(double) || (columns & std::uint64_t(1) << k) == 0) continue;
        for (std::size_t n = 0; n < column.components; ++n) {
            double value = 0;
            std::memcpy(&value, reinterpret_cast<const char*>(&record) + column.offset + n * sizeof value,
                        sizeof value);
            if (!std::isfinite(value)) return {&column, n, value};
        }
    }
    return {};
}

} // namespace

void TickSource::read(std::span<TickRecord> records)
{
    readNext(records);
    for (const TickRecord& record : records) look(record);
}

void TickSource::look(const TickRecord& record)
{
    const NoNumber found = noNumberIn(record, columns());
    if (found.column && bad_++ == 0)
        firstBad_ = fileOf(*found.column) + ": tick " + std::to_string(looked_) + ": expected a number as " +
                    found.column->componentName(found.component) + ", found " +
                    (std::isnan(found.value) ? "NaN" : "infinity");
    ++looked_;
}

std::vector<std::string> TickSource::doubts() const
{
    std::vector<std::string> all = ofFiles_;
    if (bad_ > 0)
        all.push_back(firstBad_ +
                      (bad_ > 1 ? "; " + counted(bad_ - 1, "later tick", "lacks", "lack") + " one too" : ""));
    return all;
}

void TickSource::doubt(std::string sentence)
{
    if (!sentence.empty()) ofFiles_.push_back(std::move(sentence));
}

std::unique_ptr<TickSource> openTicks(const std::filesystem::path& folder, bool finished)
{
    std::error_code none;
    const auto      rows = folder / "ticks.npy";
    if (!std::filesystem::exists(rows, none) && std::filesystem::exists(folder / "time.npy", none))
        return std::make_unique<TickColumns>(folder, finished);
    return std::make_unique<TickRows>(rows, finished);
}

} // namespace palp
