#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/enum_names.h"
#include "engine/session/scene.h"

namespace palp::study {

/// One object that participants feel.
struct Condition {
    std::string name; ///< never shown to participants
    Scene       scene;
};

enum class TaskKind {
    rating,        ///< a statement, 1 to 5
    yesNo,         ///< a question about one thing felt
    twoAlternative ///< a question about two, felt one after the other: the first or the second
};
constexpr auto namesOf(TaskKind)
{
    using enum TaskKind;
    return std::to_array<NamedValue<TaskKind>>(
        {{rating, "rating"}, {yesNo, "yes-no"}, {twoAlternative, "two-alternative"}});
}

/// A question that participants answer.
struct Task {
    std::string name, question;
    TaskKind    kind = TaskKind::rating;
    std::string least, most; ///< the meanings of 1 and 5; may be empty

    std::vector<std::optional<bool>>        yes;   ///< the right answer per condition; empty where none is stated
    std::vector<std::array<std::size_t, 2>> pairs; ///< of conditions, in the plan's order
    std::optional<std::size_t>              right; ///< 0 or 1: the right answer of each pair as listed
};

/// A study: its conditions, its questions and their repetitions.
///
/// Invariant of what readPlan() returns: names are unique, pairs are of known conditions, every scene is valid.
struct StudyPlan {
    std::string            title;
    std::uint64_t          seed        = 1;      ///< of orders
    double                 seconds     = 8;      ///< of one touch [s]
    std::string            hand        = "scan"; ///< as --hand, which overrides it; a file's path has the plan's folder
    int                    repetitions = 1;      ///< of each condition or pair in a task
    std::vector<Condition> conditions;
    std::vector<Task>      tasks;
    std::string            canonical; ///< all that defines the study, as one text, to compare plans
};

/// Reads a plan: JSON, comments allowed. Scenes, and the file of a hand, are paths from the plan's folder. A
/// condition's "preset" and "values" override its scene as flags do, and "values" override "preset". Environment
/// variables have no effect, so that the plan defines the study.
/// \throws Error naming the file, the condition or task, the key, what was expected and found
[[nodiscard]] StudyPlan readPlan(const std::filesystem::path& file);

/// Reads the same from a text that is called `name` and lies in `folder`.
[[nodiscard]] StudyPlan parsePlan(std::string_view text, const std::string& name, const std::filesystem::path& folder);

/// Returns how many trials each participant has by a plan's canonical text; none if the text is none of this version's.
[[nodiscard]] std::optional<std::size_t> trialsPlanned(std::string_view canonical);

} // namespace palp::study
