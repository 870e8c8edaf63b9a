#include "engine/tools/study/study_order.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/pipeline/presets.h"
#include "tests/support/temporary_folder.h"

namespace palp::study {
namespace {

using Order = std::vector<std::size_t>;

/// A plan of so many conditions, all the same sheet.
StudyPlan plan(int conditions, const std::string& tasks, int repetitions = 1, int seed = 1)
{
    const TemporaryFolder folder;
    static_cast<void>(folder.write("sheet.json", R"({"cloud": "sample:sheet"})"));
    std::ostringstream text;
    text << R"({"title": "t", "seed": )" << seed << R"(, "repetitions": )" << repetitions << R"(, "conditions": [)";
    for (int n = 0; n < conditions; ++n)
        text << (n ? "," : "") << R"({"name": ")" << char('a' + n) << R"(", "scene": "sheet.json"})";
    text << R"(], "tasks": [)" << tasks << "]}";
    return parsePlan(text.str(), "plan.json", folder.path());
}

const std::string kRating = R"({"name": "real", "kind": "rating", "statement": "It felt real."})";
const std::string kPairs  = R"({"name": "stiffer", "kind": "two-alternative", "question": "Which?",
                               "pairs": [["a", "b"], ["a", "c"]], "right": "second"})";

Order conditionsOf(const std::vector<Trial>& trials)
{
    Order order;
    for (const Trial& trial : trials) order.push_back(trial.first);
    return order;
}

/// How often each condition follows each other one, and stands at each place.
void demandBalanced(const std::vector<Order>& orders, std::size_t n, int timesEach)
{
    std::map<std::pair<std::size_t, std::size_t>, int> follows, stands;
    for (const Order& order : orders) {
        ASSERT_EQ(std::set(order.begin(), order.end()).size(), n) << "each once";
        for (std::size_t k = 0; k < n; ++k) {
            ++stands[{order[k], k}];
            if (k > 0) ++follows[{order[k - 1], order[k]}];
        }
    }
    EXPECT_EQ(follows.size(), n * (n - 1));
    for (const auto& [pair, times] : follows) EXPECT_EQ(times, timesEach) << pair.first << " then " << pair.second;
    for (const auto& [place, times] : stands) EXPECT_EQ(times, timesEach) << place.first << " at " << place.second;
}

TEST(WilliamsDesign, EachConditionFollowsEachOtherEquallyOften)
{
    for (std::size_t n = 2; n <= 12; ++n) {
        SCOPED_TRACE(n);
        const auto rows = williamsDesign(n);
        EXPECT_EQ(rows.size(), n % 2 ? 2 * n : n);
        demandBalanced(rows, n, n % 2 ? 2 : 1);
    }
}

TEST(WilliamsDesign, IsThePublishedSquareOfFour)
{
    // Williams 1949, up to letters: ABDC, BCAD, CDBA, DACB.
    EXPECT_EQ(williamsDesign(4), (std::vector<Order>{{0, 1, 3, 2}, {1, 2, 0, 3}, {2, 3, 1, 0}, {3, 0, 2, 1}}));
    EXPECT_EQ(williamsDesign(1), std::vector<Order>{{0}});
}

TEST(StudyOrder, AsManyParticipantsAsTheDesignHasRowsBalanceIt)
{
    for (const int n : {3, 4}) {
        const StudyPlan    study = plan(n, kRating);
        const std::size_t  rows  = n % 2 ? 2 * n : n;
        std::vector<Order> orders;
        for (std::size_t p = 1; p <= rows; ++p) orders.push_back(conditionsOf(trialsOf(study, p)));
        demandBalanced(orders, std::size_t(n), n % 2 ? 2 : 1);
    }
}

TEST(StudyOrder, IsTheSameForTheSameSeedAndParticipantAndElseAnother)
{
    const StudyPlan study = plan(4, kRating, 2), seeded = plan(4, kRating, 2, 2);

    EXPECT_EQ(conditionsOf(trialsOf(study, 1)), conditionsOf(trialsOf(study, 1)));
    for (std::uint64_t p = 2; p <= 4; ++p)
        EXPECT_NE(conditionsOf(trialsOf(study, 1)), conditionsOf(trialsOf(study, p)));
    EXPECT_NE(conditionsOf(trialsOf(study, 1)), conditionsOf(trialsOf(seeded, 1)));
    const auto trials = trialsOf(study, 1);
    ASSERT_EQ(trials.size(), 8u);
    EXPECT_EQ(trials[3].block, 1u);
    EXPECT_EQ(trials[4].block, 2u);
    EXPECT_NE(Order({trials[0].first, trials[1].first, trials[2].first, trials[3].first}),
              Order({trials[4].first, trials[5].first, trials[6].first, trials[7].first}))
        << "the next block takes the next row";
}

TEST(StudyOrder, PairsComeEquallyOftenInEitherOrderAndTheRightAnswerFollows)
{
    const StudyPlan            study = plan(3, kPairs, 6);
    std::set<std::vector<int>> all;
    for (std::uint64_t p = 1; p <= 5; ++p) {
        std::map<std::pair<std::size_t, std::size_t>, int> times;
        std::vector<int>                                   turned;
        for (const Trial& trial : trialsOf(study, p)) {
            ASSERT_TRUE(trial.second && trial.right);
            ++times[{trial.first, *trial.second}];
            turned.push_back(int(trial.first));
            EXPECT_EQ(*trial.right, trial.first == 0 ? "second" : "first")
                << "the second as listed is right, a is first";
        }
        EXPECT_EQ(times, (decltype(times){{{0, 1}, 3}, {{1, 0}, 3}, {{0, 2}, 3}, {{2, 0}, 3}}));
        all.insert(turned);
    }
    EXPECT_EQ(all.size(), 5u) << "each participant's shuffle is another";
}

TEST(StudyOrder, AnOddNumberOfRepetitionsIsEvenedOutOverTwoParticipants)
{
    const StudyPlan                                    study = plan(3, kPairs, 3);
    std::map<std::pair<std::size_t, std::size_t>, int> times;
    for (const std::uint64_t p : {1, 2})
        for (const Trial& trial : trialsOf(study, p)) ++times[{trial.first, *trial.second}];
    for (const auto& [pair, n] : times) EXPECT_EQ(n, 3);
}

TEST(StudyOrder, ThePlansTextTellsTheNumberOfTrials)
{
    for (const std::string& tasks : {kRating, kPairs, kRating + "," + kPairs})
        for (const int repetitions : {1, 3}) {
            const StudyPlan studied = plan(5, tasks, repetitions);
            EXPECT_EQ(trialsPlanned(studied.canonical), trialsOf(studied, 1).size()) << tasks << repetitions;
        }
    for (const char* none : {"", "{}", "[1]", R"({"tasks": [3]})", R"({"tasks": [], "repetitions": "x"})"})
        EXPECT_FALSE(trialsPlanned(none)) << none;
}

TEST(StudyOrder, AParticipantsNameEndsInItsNumber)
{
    EXPECT_EQ(participantNumber("P01"), 1u);
    EXPECT_EQ(participantNumber("12"), 12u);
    EXPECT_EQ(participantNumber("group-2_p030"), 30u);
    for (const char* bad : {"", "P", "P0", "../P1", "P 1", "-P1", "P1.", "P99999999999999999999"})
        EXPECT_NE(refusalOf([&] { static_cast<void>(participantNumber(bad)); }).find("--participant"),
                  std::string::npos)
            << bad;
}

TEST(StudyPlan, APresetAndValuesLieOverTheScene)
{
    const TemporaryFolder folder;
    static_cast<void>(folder.write("s.json", R"({"cloud": "sample:sheet", "foundation": 1e6, "max_force": 3})"));
    const StudyPlan study = parsePlan(
        R"({"title": "t", "seconds": 3600, "conditions": [{"name": "p", "scene": "s.json", "preset": "paper", "values":
            {"resampling": "log-mean", "from": [0, 0, 2],
             "held": [{"ball": [0, 0, 0], "radius": 1e-3}, {"box": [[1, 1, 1], [2, 2, 2]]}],
             "stiffness": {"law": "constant", "value": 5e4}, "points": 5000}}],
            "tasks": [{"name": "n", "kind": "yes-no", "question": "?", "yes_for": ["p"]}]})",
        "plan.json", folder.path());

    const Scene& scene = study.conditions[0].scene;
    EXPECT_EQ(scene.patch.forceLaw, ForceLaw::paper);
    EXPECT_EQ(scene.patch.map, Map::gallPeters);
    EXPECT_EQ(scene.patch.resampling, Resampling::logMean) << "values win over the preset";
    EXPECT_EQ(scene.patch.foundation, 0);
    EXPECT_EQ(scene.maxForce, 3);
    EXPECT_EQ(scene.points, 5000u);
    EXPECT_TRUE(scene.held.isThere()) << "a list of objects keeps its brackets";
    EXPECT_EQ(loadCloud(scene).cloud.stiffness()[7], 5e4);
    EXPECT_EQ(trialsOf(study, 1)[0].right, "yes");
    EXPECT_EQ(study.seconds, 3600) << "the most";
}

TEST(StudyPlan, TheOnesInSamplesAreGoodAndRepeatThePapersProtocol)
{
    const std::filesystem::path folder = std::filesystem::path(PALPATE_SAMPLES) / "studies";
    const StudyPlan             paper = readPlan(folder / "paper.json"), warts = readPlan(folder / "wart_2afc.json");

    EXPECT_EQ(trialsOf(paper, 1).size(), 8u);
    for (const Condition& condition : paper.conditions)
        EXPECT_TRUE(differencesFromPaper(condition.scene.patch).empty()) << condition.name;
    EXPECT_EQ(trialsOf(warts, 1).size(), 24u);
}

TEST(StudyPlan, TasksAreAskedAsTheyAreWritten)
{
    const StudyPlan study =
        plan(3, R"({"name": "r", "kind": "rating", "statement": "Real?", "least": "no", "most": "so"},
                                       {"name": "w", "kind": "yes-no", "question": "A wart?", "yes_for": ["b"],
                                        "no_for": ["a"]}, )" +
                    kPairs);
    ASSERT_EQ(study.tasks.size(), 3u);
    const Task &rating = study.tasks[0], &wart = study.tasks[1], &stiffer = study.tasks[2];
    EXPECT_EQ(rating.question + "/" + rating.least + "/" + rating.most, "Real?/no/so");
    EXPECT_EQ(wart.question, "A wart?");
    EXPECT_EQ(wart.yes, (std::vector<std::optional<bool>>{false, true, std::nullopt}));
    EXPECT_EQ(stiffer.question, "Which?");
    EXPECT_EQ(stiffer.pairs, (std::vector<std::array<std::size_t, 2>>{{0, 1}, {0, 2}}));
    EXPECT_EQ(stiffer.right, 1u);
}

TEST(StudyPlan, HasAsManyConditionsTasksAndRepetitionsAsParticipantsBear)
{
    const auto said = [](int conditions, int tasks, int repetitions, int pairs = 1, std::size_t text = 1) {
        std::string list = R"({"name": "p", "kind": "two-alternative", "question": "?", "pairs": [["a", "b"])";
        for (int n = 1; n < pairs; ++n) list += R"(, ["b", "a"])";
        list += "]}";
        for (int n = 1; n < tasks; ++n)
            list += R"(, {"name": ")" + std::to_string(n) + R"(", "kind": "rating", "statement": ")" +
                    std::string(text, 's') + R"("})";
        return refusalOf([&] { static_cast<void>(plan(conditions, list, repetitions)); });
    };
    EXPECT_EQ(said(26, 20, 100, 26, 500), "");
    EXPECT_TRUE(holds(said(27, 20, 100), {"conditions", "a list of 1 to 26 objects"}));
    EXPECT_TRUE(holds(said(26, 21, 100), {"tasks", "a list of 1 to 20 objects"}));
    EXPECT_TRUE(holds(said(26, 20, 101), {"repetitions", "1 to 100", "found 101"}));
    EXPECT_TRUE(holds(said(2, 1, 1, 27), {"pairs", "a list of 1 to 26 pairs"}));
    EXPECT_TRUE(holds(said(2, 2, 1, 1, 501), {"statement", "a text of 1 to 500 bytes"}));
}

TEST(StudyPlan, TheFileOfAHandIsLookedForFromThePlan)
{
    const TemporaryFolder folder;
    static_cast<void>(folder.write("s.json", R"({"cloud": "sample:sheet"})"));
    const std::filesystem::path there  = folder.write("hand.csv", "");
    const auto                  handOf = [&](const std::string& hand) {
        return parsePlan(R"({"title": "t", "hand": ")" + hand + R"(", "conditions": [{"name": "a", "scene": "s.json"}],
            "tasks": [)" + kRating +
                                              "]}",
                                          "plan.json", folder.path())
            .hand;
    };
    EXPECT_EQ(handOf("hand.csv"), folder / "hand.csv");
    EXPECT_EQ(handOf(there.string()), there);
    EXPECT_EQ(handOf("press"), "press");
    EXPECT_EQ(handOf("falcon"), "falcon");
    EXPECT_TRUE(holds(refusalOf([&] { (void)handOf("pres"); }),
                      {"plan.json: key \"hand\": pres: there is no such hand or file; did you mean press?", "scan"}));
}

TEST(StudyPlan, PairsMayBeInBothOrdersWhereNoAnswerIsRight)
{
    EXPECT_EQ(plan(2, R"({"name": "s", "kind": "two-alternative", "question": "?", "pairs": [["a", "b"], ["b", "a"]]})")
                  .tasks[0]
                  .pairs.size(),
              2u);
}

TEST(StudyPlan, BadOnesAreRefusedInOneSentence)
{
    const TemporaryFolder folder;
    static_cast<void>(folder.write("s.json", R"({"cloud": "sample:sheet"})"));
    const auto refused = [&](const std::string& conditions, const std::string& tasks, const std::string& word,
                             const std::string& more = "") {
        const std::string said = refusalOf([&] {
            static_cast<void>(parsePlan(R"({"title": "t", "conditions": [)" + conditions + R"(], "tasks": [)" + tasks +
                                            "]" + more + "}",
                                        "plan.json", folder.path()));
        });
        EXPECT_NE(said.find(word), std::string::npos) << said;
        EXPECT_NE(said.find("plan.json"), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    };
    const std::string a = R"({"name": "a", "scene": "s.json"})", b = R"({"name": "b", "scene": "s.json"})";
    refused("", kRating, "conditions");
    refused(a, "", "tasks");
    refused(a + "," + a, kRating, "\"a\" again");
    refused(a, kRating + "," + kRating, "\"real\" again");
    refused(R"({"name": "a", "scene": "none.json"})", kRating, "none.json");
    refused(R"({"name": "a", "scene": "s.json", "preset": "papre"})", kRating, "palpate or paper");
    refused(R"({"name": "a", "scene": "s.json", "values": {"thicknes": 1}})", kRating, "thickness");
    refused(R"({"name": "a", "scene": "s.json", "values": {"thickness": "nan"}})", kRating, "condition 1");
    refused(R"({"name": "a\n", "scene": "s.json"})", kRating, "without line ends");
    refused(a, R"({"name": "n", "kind": "ratings", "statement": "?"})", "rating, yes-no or two-alternative");
    refused(a, R"({"name": "n", "kind": "rating", "question": "?"})", "statement");
    refused(a, R"({"name": "n", "kind": "yes-no", "question": "?", "yes_for": ["aa"]})", "name of a condition");
    refused(a, R"({"name": "n", "kind": "yes-no", "question": "?", "yes_for": ["a"], "no_for": ["a"]})", "already");
    refused(a, R"({"name": "n", "kind": "yes-no", "question": "?", "pairs": [["a", "b"]]})", "yes_for, no_for");
    refused(a + "," + b,
            R"({"name": "n", "kind": "two-alternative", "question": "?", "pairs": [["a", "b"]], "least": "l"})",
            "question, pairs, right");
    refused(a, R"({"name": "n", "kind": "yes-no", "question": "?", "yes_for": "a"})",
            "key \"yes_for\": expected a list of names of conditions, found \"a\"");
    refused(a + "," + b, R"({"name": "n", "kind": "two-alternative", "question": "?", "pairs": [["a", 2]]})",
            "key \"pairs\": expected the name of a condition, found 2");
    refused(a + "," + b, R"({"name": "n", "kind": "two-alternative", "question": "?", "pairs": [["a"]]})", "two names");
    refused(a + "," + b, R"({"name": "n", "kind": "two-alternative", "question": "?", "pairs": [["a", "a"]]})",
            "twice");
    refused(a + "," + b,
            R"({"name": "n", "kind": "two-alternative", "question": "?", "pairs": [["a", "b"]], "right": "b"})",
            "first or second");
    for (const char* right : {"first", "second"})
        refused(
            a + "," + b,
            R"({"name": "n", "kind": "two-alternative", "question": "?", "pairs": [["a", "b"], ["b", "a"]], "right": ")" +
                std::string(right) + R"("})",
            "\"a\" and \"b\" in both");
    refused(a, kRating, "repetitions", R"(, "repetitions": 0)");
    refused(a, kRating, "seconds", R"(, "seconds": 0)");
    refused(a, kRating, "to 3600 s, found 3600.5", R"(, "seconds": 3600.5)");
    refused(a, kRating, "1.5 s, which a force needs", R"(, "seconds": 1.4)");
    refused(a, kRating, "hands", R"(, "hands": "scan")");
    const auto large = folder.write("large.json", std::string((std::size_t(1) << 20) + 1, ' '));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readPlan(large)); }),
                      {"large.json: longer than 1048576 bytes; expected a plan of a study"}));
}

} // namespace
} // namespace palp::study
