#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/core/enum_names.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// The two ways to run the pipeline; engine/method.md says how they differ.
enum class Preset {
    palpate, ///< the method that we hold to be right
    paper    ///< as Kumari & Chaudhuri published it
};
constexpr auto namesOf(Preset)
{
    using enum Preset;
    return std::to_array<NamedValue<Preset>>({{palpate, "palpate"}, {paper, "paper"}});
}

/// Returns these settings with the preset's map, resampling, edges, foundation and force law.
/// `palpate` leaves foundation and theory as they are; `paper` removes the foundation and bends a plate.
[[nodiscard]] PatchSettings withPreset(PatchSettings settings, Preset preset);

/// Returns one line per respect in which the settings differ from the paper's method; empty for the preset `paper`.
[[nodiscard]] std::vector<std::string> differencesFromPaper(const PatchSettings& settings);

} // namespace palp
