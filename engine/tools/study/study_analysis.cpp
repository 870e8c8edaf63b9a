#include "engine/tools/study/study_analysis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "engine/core/contract.h"
#include "engine/core/shown_text.h"
#include "engine/core/uniform.h"
#include "engine/perception/perception.h"
#include "engine/tools/plot/colour_map.h"
#include "engine/tools/plot/legend.h"
#include "engine/tools/plot/svg.h"

namespace palp::study {
namespace {

constexpr double kZ = 1.959963984540054; ///< the normal's 97.5 % [1]

/// Ratings of one participant.
struct Rated {
    double      sum = 0;
    std::size_t n   = 0;
};

/// All answers about one condition in one task.
struct Group {
    AnswerSummary                summary;
    std::vector<double>          ratings;
    std::map<std::string, Rated> byParticipant;
    std::set<std::string>        participants;
    std::string                  first, second; ///< conditions
};

/// Returns the condition that a pair is named after first, whichever order it was presented in.
const std::string& firstNamed(const TrialRow& row)
{
    return std::min(row.first, row.second);
}

std::string whatOf(const TrialRow& row)
{
    return row.second.empty() ? row.first : firstNamed(row) + " / " + std::max(row.first, row.second);
}

void count(Share& share, bool yes)
{
    share.k += yes;
    ++share.n;
}

void add(Group& group, const TrialRow& row)
{
    AnswerSummary& s = group.summary;
    group.participants.insert(row.participant);
    if (row.correct) {
        if (!s.right) s.right.emplace();
        count(*s.right, *row.correct);
    }
    if (row.kind == "rating") {
        const double rating = row.answer.size() == 1 ? row.answer[0] - '0' : 0;
        if (!(rating >= 1 && rating <= 5))
            throw Error("trial " + std::to_string(row.trial) + " of " + row.participant +
                        ": expected a rating from 1 to 5, found \"" + row.answer + "\"");
        group.ratings.push_back(rating);
        Rated& own = group.byParticipant[row.participant];
        own.sum += rating, ++own.n;
        count(s.share, rating >= 4);
    } else if (row.kind == "yes-no") {
        count(s.share, row.answer == "yes");
    } else if (row.correct) {
        count(s.share, *row.correct);
    } else {
        const bool early = row.answer == "first";
        if (!s.early) s.early.emplace();
        count(*s.early, early);
        count(s.share, (early ? row.first : row.second) == firstNamed(row));
    }
}

Interval bootstrap(const std::map<std::string, Rated>& byParticipant)
{
    constexpr int      kDraws = 2000;
    std::vector<Rated> all;
    for (const auto& [name, rated] : byParticipant) all.push_back(rated);
    Uniform             random(1);
    std::vector<double> means;
    for (int k = 0; k < kDraws; ++k) {
        Rated drawn;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Rated& one = all[std::min(std::size_t(random() * double(all.size())), all.size() - 1)];
            drawn.sum += one.sum, drawn.n += one.n;
        }
        means.push_back(drawn.sum / double(drawn.n));
    }
    std::ranges::sort(means);
    return {means[kDraws / 40], means[kDraws - 1 - kDraws / 40]};
}

double medianOf(std::vector<double> values)
{
    std::ranges::sort(values);
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

AnswerSummary finished(const Group& group, const Stiffnesses& stiffnesses)
{
    AnswerSummary s = group.summary;
    s.participants  = group.participants.size();
    if (!group.ratings.empty()) {
        double sum = 0;
        for (const double rating : group.ratings) sum += rating;
        s.mean   = sum / double(group.ratings.size());
        s.median = medianOf(group.ratings);
        if (s.participants > 1) s.meanInterval = bootstrap(group.byParticipant);
    }
    const auto a = stiffnesses.find(group.first), b = stiffnesses.find(group.second);
    if (!group.second.empty() && s.right && a != stiffnesses.end() && b != stiffnesses.end()) {
        s.steps     = noticeableSteps(a->second, b->second, kRigidHandleWeber);
        s.predicted = rightAnswers(*s.steps);
    }
    return s;
}

std::string shareOf(const AnswerSummary& s)
{
    if (s.kind == "rating") return "rated 4 or 5";
    if (s.kind == "yes-no") return "yes";
    return s.right ? "right" : "chose " + s.chosen;
}

} // namespace

Interval wilsonInterval(std::size_t k, std::size_t n)
{
    PALP_EXPECT(n >= 1 && k <= n, "found " + std::to_string(k) + " of " + std::to_string(n));
    const double p = double(k) / double(n), z2 = kZ * kZ / double(n), middle = (p + z2 / 2) / (1 + z2);
    const double half = kZ / (1 + z2) * std::sqrt(p * (1 - p) / double(n) + z2 / (4 * double(n)));
    return {k == 0 ? 0 : middle - half, k == n ? 1 : middle + half};
}

std::vector<AnswerSummary> analyse(const std::vector<TrialRow>& rows, const Stiffnesses& stiffnesses)
{
    std::vector<Group>                                         groups; // in the order of the rows
    std::map<std::pair<std::string, std::string>, std::size_t> places; // of a task and what it asks about
    for (const TrialRow& row : rows) {
        const std::string what    = whatOf(row);
        const auto [place, isNew] = places.try_emplace({row.task, what}, groups.size());
        if (isNew) {
            Group& group           = groups.emplace_back();
            group.summary.task     = shownText(row.task); // it is printed, and stands in a drawing
            group.summary.kind     = row.kind;
            group.summary.question = shownText(row.question);
            group.summary.what     = shownText(what);
            group.first            = row.first;
            group.second           = row.second;
            if (!row.second.empty()) group.summary.chosen = shownText(firstNamed(row));
        }
        add(groups[place->second], row);
    }
    std::vector<AnswerSummary> summaries;
    for (const Group& group : groups) summaries.push_back(finished(group, stiffnesses));
    return summaries;
}

std::string analysisSvg(const std::vector<AnswerSummary>& summaries)
{
    constexpr double  kWidth = 400, kRow = 26, kTop = 66, kSymbol = 5, kLabel = 12, kAside = 12; // [px]
    const std::string ink = hexColour(kNamedColours[0]), other = hexColour(kNamedColours[1]);
    const auto        labelOf = [](const AnswerSummary& s) { return s.task + ", " + s.what + ": " + shareOf(s); };
    double            left    = 0; // of the axis, which leaves room for every label [px]
    for (const AnswerSummary& s : summaries) left = std::max(left, textWidth(labelOf(s), kLabel) + 2 * kAside);
    const auto   x   = [&](double share) { return left + kWidth * share; };
    const double end = kTop + kRow * double(summaries.size());
    SvgDrawing   svg;
    svg.text({14, 25}, "Share of answers, with 95 % intervals (Wilson)", {.size = 15, .bold = true});
    const auto dot = [&](Symbol symbol, const std::string& colour) {
        return [=](SvgDrawing& drawing, glm::dvec2 at) { drawSymbol(drawing, symbol, at, kSymbol, colour); };
    };
    drawLegend(svg,
               {{"answered", dot(Symbol::circle, ink)}, {"predicted for pairs, W = 0.22", dot(Symbol::diamond, other)}},
               {14, 36}, 600);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        svg.line({x(share), kTop}, {x(share), end}, {"#e4e4e4", 1});
        svg.text({x(share), end + 18}, std::to_string(int(100 * share)), {.anchor = Anchor::middle});
    }
    double y = kTop + kRow / 2;
    for (const AnswerSummary& s : summaries) {
        const Interval between = s.share.interval();
        svg.text({left - kAside, y + 4}, labelOf(s), {.size = kLabel, .anchor = Anchor::end});
        svg.line({x(between.low), y}, {x(between.high), y}, {ink, 2});
        if (s.predicted) drawSymbol(svg, Symbol::diamond, {x(*s.predicted), y}, kSymbol, other);
        drawSymbol(svg, Symbol::circle, {x(s.share.value()), y}, kSymbol, ink);
        y += kRow;
    }
    svg.text({x(0.5), end + 38}, "share of trials [%]", {.size = 13, .anchor = Anchor::middle});
    return svg.finish({left + kWidth + 24, end + 52}, "Share of answers");
}

} // namespace palp::study
