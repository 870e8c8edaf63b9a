#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/tools/study/study_order.h"

namespace palp {

/// Prints the whole order of a participant, conditions and right answers included: for the experimenter.
void printOrder(const study::StudyPlan& plan, const std::string& participant, bool json);

/// Prints a summary of the participants' answers, with predictions beside it.
/// \param folders  the folders of studies or of participants
/// \param plot     an SVG file; empty: none
/// \throws Error naming a folder that has no trials or is of another study than the first
void analyseStudies(const std::vector<std::string>& folders, const std::filesystem::path& plot, bool json);

} // namespace palp
