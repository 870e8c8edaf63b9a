#include "engine/tools/study/study_order.h"

#include <algorithm>
#include <numeric>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/shown_text.h"
#include "engine/core/uniform.h"

namespace palp::study {
namespace {

/// Shuffles by Fisher and Yates, with numbers that are the same on every machine.
template <class T>
void shuffle(std::vector<T>& list, Uniform& random)
{
    for (std::size_t left = list.size(); left > 1; --left)
        std::swap(list[left - 1], list[std::min(std::size_t(random() * double(left)), left - 1)]);
}

/// Returns a separate random stream for each use of the plan's seed.
/// \param use  identifies the use, below 2^16
std::uint64_t seedFor(const StudyPlan& plan, std::uint64_t participant, std::uint64_t use)
{
    return plan.seed ^ participant << 32U ^ use << 48U;
}

std::vector<Trial> pairTrials(const StudyPlan& plan, std::size_t number, std::uint64_t participant)
{
    const Task&        task = plan.tasks[number];
    Uniform            random(seedFor(plan, participant, number + 1));
    std::vector<Trial> trials;
    for (std::size_t k = 0; k < task.pairs.size(); ++k)
        for (int n = 0; n < plan.repetitions; ++n) {
            const bool turned = (std::uint64_t(n) + k + participant) % 2 == 0;
            Trial      trial{.task = number, .first = task.pairs[k][turned], .second = task.pairs[k][!turned]};
            if (task.right) trial.right = (*task.right == 1) != turned ? "second" : "first";
            trials.push_back(trial);
        }
    shuffle(trials, random);
    return trials;
}

} // namespace

std::vector<std::vector<std::size_t>> williamsDesign(std::size_t n)
{
    PALP_EXPECT(n >= 1, "a design needs a condition");
    std::vector<std::size_t> row{0};
    for (std::size_t k = 1; k < n; ++k) row.push_back(k % 2 ? (k + 1) / 2 : n - k / 2);
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t i = 0; i < n; ++i) {
        rows.push_back(row);
        for (std::size_t& condition : rows.back()) condition = (condition + i) % n;
    }
    if (n % 2 && n > 1)
        for (std::size_t i = 0; i < n; ++i) rows.emplace_back(rows[i].rbegin(), rows[i].rend());
    return rows;
}

std::vector<Trial> trialsOf(const StudyPlan& plan, std::uint64_t participant)
{
    const auto               rows = williamsDesign(plan.conditions.size());
    std::vector<std::size_t> letters(plan.conditions.size());
    std::iota(letters.begin(), letters.end(), 0);
    Uniform random(seedFor(plan, 0, 0));
    shuffle(letters, random);
    std::vector<Trial> trials;
    std::size_t        block = 0;
    const auto         add   = [&](Trial trial) {
        trial.block = block;
        trials.push_back(std::move(trial));
    };
    for (std::size_t number = 0; number < plan.tasks.size(); ++number) {
        const Task& task = plan.tasks[number];
        if (task.kind == TaskKind::twoAlternative) {
            ++block;
            for (Trial& trial : pairTrials(plan, number, participant)) add(std::move(trial));
            continue;
        }
        for (int n = 0; n < plan.repetitions; ++n) {
            ++block;
            for (const std::size_t place : rows[(participant - 1 + block - 1) % rows.size()]) {
                Trial trial{.task = number, .first = letters[place]};
                if (task.kind == TaskKind::yesNo && task.yes[trial.first])
                    trial.right = *task.yes[trial.first] ? "yes" : "no";
                add(std::move(trial));
            }
        }
    }
    return trials;
}

std::uint64_t participantNumber(std::string_view name)
{
    const auto isDigit  = [](char c) { return c >= '0' && c <= '9'; };
    const auto isLetter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
    };
    constexpr std::size_t kLongest = 64; // [bytes] it names a folder
    if (name.size() > kLongest)
        throw Error("--participant: expected a name of at most " + std::to_string(kLongest) + " characters, found " +
                    std::to_string(name.size()) + ": " + inQuotes(name));
    const bool  good  = !name.empty() && std::ranges::all_of(name, [&](char c) { return isDigit(c) || isLetter(c); });
    std::size_t begin = name.size();
    while (begin > 0 && isDigit(name[begin - 1])) --begin;
    constexpr std::uint64_t kMost  = 1'000'000; // participants; orders repeat long before
    const auto              number = parseCount(name.substr(begin));
    if (!good || name.starts_with('-') || !number || *number < 1 || *number > kMost)
        throw Error("--participant: expected letters, digits, - and _ that end in a number from 1 on, such as P01 "
                    "(orders are balanced over the numbers), found \"" +
                    shownText(name) + "\"");
    return *number;
}

} // namespace palp::study
