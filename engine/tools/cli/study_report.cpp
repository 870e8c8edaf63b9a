#include "engine/tools/cli/study_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/perception/perception.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/study/study_analysis.h"
#include "engine/tools/study/study_file.h"

namespace palp {
namespace {

using study::AnswerSummary;
using study::Interval;
using study::Share;
using Json = nlohmann::json;

/// A participant who has answered fewer trials than the plan has.
struct Unfinished {
    std::string participant;
    std::size_t answered = 0, planned = 0;
};

/// All answers of one study.
struct Answers {
    std::vector<study::TrialRow> rows;
    study::Stiffnesses           stiffnesses;
    std::size_t                  participants = 0;
    std::size_t                  leftOut      = 0; ///< trials with a touch in which nothing was felt
    std::vector<Unfinished>      unfinished;
};

std::vector<std::filesystem::path> participantsIn(const std::filesystem::path& folder)
{
    std::error_code                    failure;
    std::vector<std::filesystem::path> found;
    if (std::filesystem::exists(folder / "trials.csv", failure)) return {folder};
    for (const auto& entry : std::filesystem::directory_iterator(folder, failure))
        if (isThere(entry.path() / "trials.csv")) found.push_back(entry.path());
    if (failure) throw Error(folder.string() + ": cannot be read: " + failure.message());
    if (found.empty())
        throw Error(folder.string() +
                    ": expected the folder of a study or a participant, with a trials.csv, found none");
    std::ranges::sort(found);
    return found;
}

Answers answersIn(const std::vector<std::string>& folders)
{
    Answers                                      all;
    std::map<std::string, std::filesystem::path> seen; // folders by their participants' names
    std::string                                  plan;
    for (const std::string& folder : folders)
        for (const auto& participant : participantsIn(folder)) {
            const study::StudyFile file = study::readStudyFile(participant);
            if (!plan.empty() && file.plan != plan)
                throw Error(participant.string() + ": expected participants of one study, found another plan than that "
                                                   "of the first; analyse each plan's participants by themselves");
            const auto [before, isNew] = seen.try_emplace(file.participant, participant);
            if (std::error_code ignored; !isNew && std::filesystem::equivalent(before->second, participant, ignored))
                throw Error(participant.string() + ": expected each folder once, found it again; name it once");
            if (!isNew)
                throw Error(participant.string() + ": expected each participant once, found " +
                            inQuotes(file.participant) + " again, who is also in " + before->second.string() +
                            "; analyse the folders one by one");
            plan                     = file.plan;
            const std::size_t others = all.rows.size(), othersLeftOut = all.leftOut;
            for (study::TrialRow& row : study::readTrials(participant / "trials.csv")) {
                if (row.participant != file.participant)
                    throw Error((participant / "trials.csv").string() + ": trial " + std::to_string(row.trial) +
                                ": expected the participant of " + study::kStudyFile + ", " +
                                inQuotes(file.participant) + ", found " + inQuotes(row.participant) +
                                "; was the table changed by another program?");
                if (row.wasFelt())
                    all.rows.push_back(std::move(row));
                else
                    ++all.leftOut;
            }
            all.participants += all.rows.size() > others;
            const std::size_t answered = all.rows.size() - others + all.leftOut - othersLeftOut;
            if (const auto planned = study::trialsPlanned(file.plan); planned && answered < *planned)
                all.unfinished.push_back({file.participant, answered, *planned});
            for (const auto& [condition, stiffness] : file.feltStiffness)
                if (stiffness) all.stiffnesses[condition] = *stiffness;
        }
    return all;
}

Json listOf(const Interval& interval)
{
    return {interval.low, interval.high};
}

template <class Value>
Json orNull(const std::optional<Value>& value)
{
    return value ? Json(*value) : Json();
}

Json jsonOf(const Share& share)
{
    return {{"count", share.k}, {"trials", share.n}, {"share", share.value()}, {"wilson_95", listOf(share.interval())}};
}

Json jsonOf(const AnswerSummary& s)
{
    Json all{{"task", s.task},
             {"kind", s.kind},
             {"question", s.question},
             {"conditions", s.what},
             {"participants", s.participants},
             {"answers", jsonOf(s.share)},
             {"right", s.right ? jsonOf(*s.right) : Json()}};
    if (s.early) all["chosen"] = s.chosen, all["presented_first"] = jsonOf(*s.early);
    if (s.mean)
        all["rating"] = {{"mean", *s.mean},
                         {"median", *s.median},
                         {"mean_bootstrap_95", s.meanInterval ? listOf(*s.meanInterval) : Json()}};
    all["prediction"] = {
        {"noticeable_steps", orNull(s.steps)}, {"right", orNull(s.predicted)}, {"weber", kRigidHandleWeber}};
    return all;
}

std::string percent(const Share& share)
{
    const Interval between = share.interval();
    char           text[96];
    std::snprintf(text, sizeof text, "%zu of %zu, %.0f %% (%.0f to %.0f %%)", share.k, share.n, 100 * share.value(),
                  100 * between.low, 100 * between.high);
    return text;
}

std::string decimals(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

void printText(const AnswerSummary& s)
{
    std::cout << s.task << ", " << s.what << " (" << counted(s.participants, "participant") << ")\n";
    if (s.mean) {
        std::cout << "  rating " << decimals(*s.mean) << " on average";
        if (s.meanInterval)
            std::cout << " (" << decimals(s.meanInterval->low) << " to " << decimals(s.meanInterval->high) << ")";
        std::cout << ", median " << *s.median << "; rated 4 or 5: " << percent(s.share) << "\n";
    } else if (s.kind == "yes-no") {
        std::cout << "  yes: " << percent(s.share) << "\n";
    } else if (s.early) {
        std::cout << "  chose " << s.chosen << ": " << percent(s.share)
                  << "; what was presented first: " << percent(*s.early) << "\n";
    }
    if (s.right) std::cout << "  right: " << percent(*s.right) << "\n";
    if (s.predicted)
        std::cout << "  predicted, not measured: " << std::lround(100 * *s.predicted)
                  << " % right, J = " << decimals(*s.steps) << " steps of " << std::lround(100 * kRigidHandleWeber)
                  << " %\n";
}

} // namespace

void printOrder(const study::StudyPlan& plan, const std::string& participant, bool json)
{
    const auto trials = trialsOf(plan, study::participantNumber(participant));
    Json       list   = Json::array();
    for (const study::Trial& trial : trials) {
        const std::string first  = plan.conditions[trial.first].name;
        const std::string second = trial.second ? plan.conditions[*trial.second].name : "";
        list.push_back({{"trial", list.size() + 1},
                        {"block", trial.block},
                        {"task", plan.tasks[trial.task].name},
                        {"condition", first},
                        {"condition_second", second.empty() ? Json() : Json(second)},
                        {"right", orNull(trial.right)}});
        if (!json)
            std::cout << "trial " << list.size() << ", block " << trial.block << ", " << plan.tasks[trial.task].name
                      << ": " << first << (second.empty() ? "" : ", then " + second)
                      << (trial.right ? "; right: " + *trial.right : "") << "\n";
    }
    if (json) std::cout << jsonText(Json{{"participant", participant}, {"trials", list}});
}

void analyseStudies(const std::vector<std::string>& folders, const std::filesystem::path& plot, bool json)
{
    const Answers     all     = answersIn(folders);
    const std::string leftOut = all.leftOut == 0 ? ""
                                                 : counted(all.leftOut, "trial") +
                                                       " left out, because nothing was felt in a touch and so the "
                                                       "answer is not valid";
    if (all.rows.empty())
        throw Error(folders.front() + (leftOut.empty() ? ": expected answered trials, found none yet"
                                                       : ": expected trials that were felt, found none; " + leftOut));
    const auto summaries = study::analyse(all.rows, all.stiffnesses);
    if (!plot.empty()) writeFileWhole(plot, [&](std::ostream& file) { file << study::analysisSvg(summaries); });
    if (json) {
        Json list = Json::array(), unfinished = Json::array();
        for (const AnswerSummary& s : summaries) list.push_back(jsonOf(s));
        for (const Unfinished& u : all.unfinished)
            unfinished.push_back({{"participant", u.participant}, {"answered", u.answered}, {"planned", u.planned}});
        std::cout << jsonText(Json{{"participants", all.participants},
                                   {"trials", all.rows.size()},
                                   {"left_out", all.leftOut},
                                   {"unfinished", unfinished},
                                   {"answers", list}});
        return;
    }
    std::cout << counted(all.rows.size(), "trial") << " of " << counted(all.participants, "participant")
              << "; intervals of 95 %: shares by Wilson's score, which assumes independent trials"
              << (std::ranges::any_of(summaries, [](const AnswerSummary& s) { return s.meanInterval.has_value(); })
                      ? ", means by a bootstrap over participants\n"
                      : "\n");
    if (!leftOut.empty()) std::cout << leftOut << "\n";
    for (const Unfinished& u : all.unfinished)
        std::cout << shownText(u.participant, kMostOfWord) << " has not finished: " << u.answered << " of "
                  << counted(u.planned, "trial") << "\n";
    for (const AnswerSummary& s : summaries) printText(s);
}

} // namespace palp
