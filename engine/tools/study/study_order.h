#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "engine/tools/study/study_plan.h"

namespace palp::study {

/// Returns orders of n conditions, one per row, in which each condition is equally often at each place and directly
/// after each other one: n rows for even n, twice as many for odd n, where each row is also reversed.
///
///     even n, row 0:  0 1 n-1 2 n-2 ...     row i: + i, modulo n
/// \param n  at least 1
/// \source Williams 1949, "Experimental designs balanced for the estimation of residual effects of treatments"
[[nodiscard]] std::vector<std::vector<std::size_t>> williamsDesign(std::size_t n);

/// One trial of one participant.
struct Trial {
    std::size_t                task = 0, block = 0; ///< index into StudyPlan::tasks, number in the study
    std::size_t                first = 0;           ///< index into StudyPlan::conditions
    std::optional<std::size_t> second{};            ///< the same, in a two-alternative task
    std::optional<std::string> right{};             ///< "yes", "no", "first", "second"; empty: no answer is right
};

/// Returns all trials of a participant, task by task. Each repetition of a rating or a question is a block: a row of
/// the Williams design, the next one for the next block and for the next participant. The orders are balanced over as
/// many participants as the design has rows, or a multiple. The seed assigns the conditions to the letters of the
/// design. A two-alternative task is one block with every pair as often in either order as its repetitions allow (an
/// odd one alternates from participant to participant), shuffled by seed and participant.
/// \param participant  number, from 1
[[nodiscard]] std::vector<Trial> trialsOf(const StudyPlan& plan, std::uint64_t participant);

/// Returns the number at the end of a participant's name, "P01": 1.
/// \throws Error if there is none, or the name cannot be a folder's (letters, digits, '-', '_')
[[nodiscard]] std::uint64_t participantNumber(std::string_view name);

} // namespace palp::study
