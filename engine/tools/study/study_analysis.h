#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/tools/study/trial_table.h"

namespace palp::study {

/// An interval of a quantity.
struct Interval {
    double low = 0, high = 1; ///< in the quantity's unit
};

/// Returns the score interval of a share, 95 %: the shares p for which |k/n - p| <= z sqrt(p (1 - p) / n), z = 1.96.
/// \param k  at most n
/// \param n  at least 1
/// \source Wilson 1927, "Probable inference, the law of succession, and statistical inference"; without correction for
///         continuity
[[nodiscard]] Interval wilsonInterval(std::size_t k, std::size_t n);

/// A share of answers: yes, right, or 4 and 5.
struct Share {
    std::size_t k = 0, n = 0; ///< trials with such an answer, all trials

    [[nodiscard]] double   value() const { return double(k) / double(n); }
    [[nodiscard]] Interval interval() const { return wilsonInterval(k, n); } ///< treats trials as independent
};

/// The answers in one task about one condition, or one pair.
struct AnswerSummary {
    std::string           task, kind, question, what; ///< what: the condition's name, or "a / b" in alphabetical order
    std::size_t           participants = 0;
    Share                 share;  ///< of ratings of 4 and 5; of yes; of right answers; of pairs without: of `chosen`
    std::string           chosen; ///< the first condition of `what`, of a pair without a right answer
    std::optional<Share>  early;  ///< of a pair without a right answer: of what was presented first, whichever it was
    std::optional<Share>  right;  ///< of right answers, if the question has one
    std::optional<double> mean, median;   ///< of ratings, 1 to 5 [1]
    std::optional<Interval> meanInterval; ///< 95 %; empty with a single participant
    std::optional<double>   steps,
        predicted; ///< J and the share of right answers of a pair: a prediction for a rigid handle
};

/// The felt stiffness per condition, where it is known [N/m].
using Stiffnesses = std::map<std::string, double>;

/// Sums up answers over participants, in the order in which they first occur. The interval of a mean rating is a
/// bootstrap over participants, because the answers of one participant are not independent: 2000 random selections,
/// percentiles, the same in every run.
/// \source Efron 1979, "Bootstrap methods: another look at the jackknife"; predictions: engine/perception/perception.h
[[nodiscard]] std::vector<AnswerSummary> analyse(const std::vector<TrialRow>& rows, const Stiffnesses& stiffnesses);

/// Plots shares with their intervals, and predictions beside them, as a self-contained SVG picture.
[[nodiscard]] std::string analysisSvg(const std::vector<AnswerSummary>& summaries);

} // namespace palp::study
