#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/tools/study/trial_table.h"

namespace palp::study {

struct Interval {
    double low = 0, high = 1; ///< in the unit of what it is of
};

/// The score interval of a share, 95 %: the shares p for which |k/n - p| <= z sqrt(p (1 - p) / n), z = 1.96.
/// \param k  of n, at most n  \param n  at least 1
/// \source Wilson 1927, "Probable inference, the law of succession, and statistical inference"; without correction for
///         continuity
[[nodiscard]] Interval wilsonInterval(std::size_t k, std::size_t n);

/// A share of answers: yes, right, or 4 and 5.
struct Share {
    std::size_t k = 0, n = 0; ///< of trials [1]

    [[nodiscard]] double   value() const { return double(k) / double(n); }
    [[nodiscard]] Interval interval() const { return wilsonInterval(k, n); } ///< takes trials for independent
};

/// What was answered in one task about one condition, or one pair.
struct AnswerSummary {
    std::string           task, kind, question, what; ///< what: the condition's name, or "a / b" in alphabetical order
    std::size_t           participants = 0;           ///< [1]
    Share                 share;          ///< of ratings of 4 and 5; of yes; of right answers (pairs without: "first")
    std::optional<Share>  right;          ///< of right answers of a question that has one
    std::optional<double> mean, median;   ///< of ratings, 1 to 5 [1]
    std::optional<Interval> meanInterval; ///< 95 %; empty with a single participant
    std::optional<double>   steps, predicted; ///< J and the share of right answers of a pair, W = 0.07: a prediction
};

/// Felt stiffness per condition, where it is known [N/m].
using Stiffnesses = std::map<std::string, double>;

/// Sums up answers over participants, in the order in which they first come. The interval of a mean rating is a
/// bootstrap over participants, whose own answers hang together: 2000 samples, percentiles, the same every time.
/// \source Efron 1979, "Bootstrap methods: another look at the jackknife"; predictions: engine/tools/paper/perception.h
[[nodiscard]] std::vector<AnswerSummary> analyse(const std::vector<TrialRow>& rows, const Stiffnesses& stiffnesses);

/// Shares with their intervals, and predictions beside them, as a self-contained SVG picture.
[[nodiscard]] std::string analysisSvg(const std::vector<AnswerSummary>& summaries);

} // namespace palp::study
