#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palp::study {

/// One row of a participant's table: a trial that was felt and answered.
struct TrialRow {
    std::string         participant;
    std::uint64_t       trial = 0, block = 0; ///< from 1
    std::string         task, kind;
    std::string         first, second;                ///< conditions; second empty except for pairs
    std::string         question, answer;             ///< "1" to "5"; yes, no; first, second
    std::optional<bool> correct;                      ///< empty: no answer is right
    double              reactionTime = 0;             ///< from the question to the answer [s]
    std::uint64_t       seed         = 0;             ///< the plan's
    std::string         firstSession, secondSession;  ///< folders, relative to the study's
    double              meanForce = 0, peakForce = 0; ///< over the time in contact [N]
    std::string         version;                      ///< of the program, with its commit
    std::optional<bool> felt; ///< in each touch a force came on; empty in tables of earlier versions

    /// Returns whether each touch had a force, as far as the table tells: an answer without one is not valid.
    [[nodiscard]] bool wasFelt() const noexcept { return felt.value_or(peakForce > 0); }
};

/// Reads the rows of a table that was written by TrialTable. A last line without an end was cut by a crash and counts
/// as not written. Tables of earlier versions lack the column "felt".
/// \throws Error naming the file, the line, what was expected and found
[[nodiscard]] std::vector<TrialRow> readTrials(const std::filesystem::path& file);

/// A participant's table on disk: RFC 4180, one line per trial, each written at once and flushed to the disk before
/// append() returns, so that a crash loses at most the current trial.
class TrialTable {
public:
    /// Creates the table, or opens an existing one; a line that was cut is removed, and to one of an earlier version
    /// the column that it lacks is added, empty.
    /// \throws Error naming the file and the reason
    explicit TrialTable(std::filesystem::path file);

    [[nodiscard]] const std::vector<TrialRow>& rows() const noexcept { return rows_; }

    /// Appends a row.
    /// \throws Error naming the file and the reason; then no part of the row remains
    void append(const TrialRow& row);

private:
    std::filesystem::path file_;
    std::vector<TrialRow> rows_;
};

} // namespace palp::study
