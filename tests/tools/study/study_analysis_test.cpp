#include "engine/tools/study/study_analysis.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/perception/perception.h"
#include "engine/tools/plot/svg.h"

namespace palp::study {
namespace {

TrialRow rowOf(const std::string& participant, const std::string& kind, const std::string& first,
               const std::string& answer, std::optional<bool> correct = {}, const std::string& second = "")
{
    TrialRow row;
    row.participant = participant;
    row.task        = "task of " + kind;
    row.kind        = kind;
    row.first       = first;
    row.second      = second;
    row.answer      = answer;
    row.correct     = correct;
    return row;
}

TEST(WilsonInterval, IsThePublishedOne)
{
    // Newcombe 1998, "Two-sided confidence intervals for the single proportion", table I, method 3: four decimals.
    struct Published {
        std::size_t k, n;
        double      low, high;
    };
    for (const Published& p : {Published{81, 263, 0.2553, 0.3662}, Published{15, 148, 0.0624, 0.1605},
                               Published{0, 20, 0.0000, 0.1611}, Published{1, 29, 0.0061, 0.1718}}) {
        constexpr double kRounding = 0.00005; // four decimals
        EXPECT_NEAR(wilsonInterval(p.k, p.n).low, p.low, kRounding) << p.k << " of " << p.n;
        EXPECT_NEAR(wilsonInterval(p.k, p.n).high, p.high, kRounding) << p.k << " of " << p.n;
    }
    EXPECT_EQ(wilsonInterval(7, 7).high, 1);
    EXPECT_EQ(wilsonInterval(0, 7).low, 0);
}

TEST(WilsonInterval, EndsWhereTheScoreTestEnds)
{
    const Interval between = wilsonInterval(12, 40);
    for (const double p : {between.low, between.high})
        EXPECT_NEAR(std::abs(0.3 - p), 1.959963984540054 * std::sqrt(p * (1 - p) / 40), 1e-12) << "its definition";
}

TEST(Analysis, SumsUpRatingsOverParticipants)
{
    std::vector<TrialRow> rows;
    for (const auto& [who, rating] : {std::pair{"P01", "1"}, {"P01", "2"}, {"P02", "4"}, {"P02", "5"}, {"P03", "5"}})
        rows.push_back(rowOf(who, "rating", "soft", rating));

    const auto all = analyse(rows, {});

    ASSERT_EQ(all.size(), 1u);
    EXPECT_DOUBLE_EQ(*all[0].mean, 17.0 / 5);
    EXPECT_EQ(*all[0].median, 4);
    EXPECT_EQ(all[0].share.k, 3u);
    EXPECT_EQ(all[0].participants, 3u);
    // A draw may be all P01 (mean 1.5) or all P03 (5), each in 1 of 27 draws: beyond 2.5 % at either end.
    EXPECT_EQ(all[0].meanInterval->low, 1.5);
    EXPECT_EQ(all[0].meanInterval->high, 5);
    EXPECT_FALSE(analyse({rows[0], rows[1]}, {})[0].meanInterval) << "one participant says nothing of others";
}

TEST(Analysis, TheBootstrapIsAsWideAsTheStandardErrorSays)
{
    std::vector<TrialRow> rows;
    for (int p = 0; p < 40; ++p)
        for (int n = 0; n < 3; ++n) // who likes it likes it every time: 40 independent answers, not 120
            rows.push_back(rowOf(std::string("P").append(std::to_string(p)), "rating", "soft", p % 2 ? "2" : "4"));

    const AnswerSummary s = analyse(rows, {})[0];

    const double expected = 2 * 1.96 / std::sqrt(40.0); // sd 1; 2000 draws know a percentile to some 5 %, ties add 0.05
    EXPECT_NEAR(s.meanInterval->high - s.meanInterval->low, expected, 0.15 * expected);
    EXPECT_EQ(*s.mean, 3);
}

TEST(Analysis, PairsInEitherOrderAreOneAndThePredictionStandsBeside)
{
    std::vector<TrialRow> rows{rowOf("P01", "two-alternative", "soft", "second", true, "stiff"),
                               rowOf("P01", "two-alternative", "stiff", "second", false, "soft"),
                               rowOf("P01", "two-alternative", "stiff", "first", true, "soft")};

    const auto all = analyse(rows, {{"soft", 400}, {"stiff", 488}});

    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].what, "soft / stiff");
    EXPECT_EQ(all[0].right->k, 2u);
    EXPECT_EQ(all[0].right->n, 3u);
    EXPECT_NEAR(*all[0].steps, 1, 1e-12) << "22 % are one step through a handle";
    EXPECT_NEAR(*all[0].predicted, 0.75, 1e-12) << "which is told right in three of four";
    EXPECT_FALSE(analyse(rows, {{"soft", 400}})[0].predicted);
}

/// Somebody who likes one of two every time, in whichever order they come.
TEST(Analysis, OfPairsWithoutARightAnswerAConditionIsChosen)
{
    std::vector<TrialRow> rows;
    for (int n = 0; n < 10; ++n) {
        rows.push_back(rowOf("P01", "two-alternative", "soft", "first", {}, "stiff"));
        rows.push_back(rowOf("P01", "two-alternative", "stiff", "second", {}, "soft"));
    }
    rows.push_back(rowOf("P01", "two-alternative", "stiff", "first", {}, "soft"));

    const auto all = analyse(rows, {});

    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].chosen, "soft");
    EXPECT_EQ(all[0].share.k, 20u);
    EXPECT_EQ(all[0].share.n, 21u);
    EXPECT_EQ(all[0].early->k, 11u) << "orders are balanced, so that this tells of them alone";
    EXPECT_FALSE(all[0].right);
    EXPECT_NE(analysisSvg(all).find("chose soft"), std::string::npos);
}

TEST(Analysis, WhatATableSaysIsShownAsATerminalMayHaveIt)
{
    TrialRow row         = rowOf("p", "rating", "\x1b[31mred", "4");
    row.task             = row.first;
    const auto summaries = analyse({row}, {});
    EXPECT_EQ(summaries[0].task, "?[31mred");
    EXPECT_EQ(summaries[0].what, "?[31mred");
}

TEST(Analysis, YesAndRightAreCountedApart)
{
    const auto all = analyse({rowOf("P01", "yes-no", "even", "yes", false), rowOf("P02", "yes-no", "even", "no", true),
                              rowOf("P02", "yes-no", "linear", "yes", true), rowOf("P01", "yes-no", "open", "no")},
                             {});

    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].share.k, 1u);
    EXPECT_EQ(all[0].right->k, 1u);
    EXPECT_EQ(all[1].right->k, 1u);
    EXPECT_FALSE(all[2].right);
    const std::string svg = analysisSvg(all);
    EXPECT_NE(svg.find("share of trials [%]"), std::string::npos);
    EXPECT_NE(svg.find("linear: yes"), std::string::npos);
}

TEST(Analysis, TheDrawingHasRoomForItsLongestLabel)
{
    TrialRow row = rowOf("p", "rating", "a", "4");
    row.task     = "which of the two is the firmer one where the finger comes from the left, as seen by the hand";
    const std::string svg = analysisSvg(analyse({row}, {}));
    const auto        at  = svg.find(row.task);
    ASSERT_NE(at, std::string::npos);
    const auto x = svg.rfind("x=\"", at);
    EXPECT_GT(std::stod(svg.substr(x + 3)), textWidth(row.task, 12)) << "its end; it begins inside of the drawing";
}

} // namespace
} // namespace palp::study
