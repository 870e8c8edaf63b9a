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

/// One thing that participants feel.
struct Condition {
    std::string name; ///< never shown to them
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

/// What participants are asked.
struct Task {
    std::string name, question;
    TaskKind    kind = TaskKind::rating;
    std::string least, most; ///< what 1 and 5 mean; may be empty

    std::vector<std::optional<bool>>        yes;   ///< the right answer per condition; empty where none is stated
    std::vector<std::array<std::size_t, 2>> pairs; ///< of conditions, as the plan lists them
    std::optional<std::size_t>              right; ///< 0 or 1: which of a pair as listed is the right answer
};

/// A study: what is felt, what is asked, how often.
///
/// Invariant of what readPlan() returns: names are unique, pairs are of known conditions, every scene is valid.
struct StudyPlan {
    std::string            title;
    std::uint64_t          seed        = 1;      ///< of orders [1]
    double                 seconds     = 8;      ///< of one touch [s]
    std::string            hand        = "scan"; ///< as --hand; the command line wins
    int                    repetitions = 1;      ///< of each condition or pair in a task [1]
    std::vector<Condition> conditions;
    std::vector<Task>      tasks;
    std::string            canonical; ///< everything that decides the study, as one text: two plans are equal or not
};

/// Reads a plan: JSON, comments allowed. Scenes are paths from the plan's folder; a condition's "preset" and "values"
/// lie over its scene as flags do, "values" over "preset". The environment says nothing: a study is its plan.
/// \throws Error, one sentence: the file, the condition or task, the key, what was expected and found
[[nodiscard]] StudyPlan readPlan(const std::filesystem::path& file);

/// The same from a text that is called `name` and lies in `folder`.
[[nodiscard]] StudyPlan parsePlan(std::string_view text, const std::string& name, const std::filesystem::path& folder);

} // namespace palp::study
