#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/session/tick_record.h"

namespace palp {

/// The ticks of a recording, read part by part: of ticks.npy, or of the .npy file per column that format 1 had.
///
/// Both state their own layout and are believed as little as any file: sizes are checked against the files before
/// memory is taken. Columns that this version does not know are passed over, those that the recording lacks keep a
/// record's defaults.
/// \thread one
class TickSource {
public:
    TickSource()                             = default;
    TickSource(const TickSource&)            = delete;
    TickSource& operator=(const TickSource&) = delete;
    virtual ~TickSource()                    = default;

    [[nodiscard]] virtual std::uint64_t rows() const noexcept = 0;
    /// Returns which columns are there: bit k is sessionColumns()[k].
    [[nodiscard]] virtual std::uint64_t columns() const noexcept = 0;

    /// Reads the next records.
    /// \pre as many are left
    /// \throws Error naming the file
    void read(std::span<TickRecord> records);

    /// Returns what is wrong with the files, and with the numbers that have been read so far: a sentence each that
    /// names the file and the tick. Nothing of it keeps a recording from being read.
    [[nodiscard]] std::vector<std::string> doubts() const;

protected:
    virtual void                      readNext(std::span<TickRecord> records)   = 0;
    [[nodiscard]] virtual std::string fileOf(const SessionColumn& column) const = 0; ///< that holds a column

    /// Notes a sentence about the files; an empty one says nothing.
    void doubt(std::string sentence);

private:
    void look(const TickRecord& record);

    std::vector<std::string> ofFiles_;
    std::string              firstBad_;             ///< about the first tick that has NaN or infinity
    std::uint64_t            looked_ = 0, bad_ = 0; ///< ticks; those with such
};

/// Opens the ticks of a recording's folder.
/// \param finished  the recording says that it was ended in order: then all of its files hold as many ticks
/// \throws Error naming the file, what was expected and found
[[nodiscard]] std::unique_ptr<TickSource> openTicks(const std::filesystem::path& folder, bool finished);

} // namespace palp
