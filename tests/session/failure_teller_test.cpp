#include "engine/session/failure_teller.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/session/real_session.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

TEST(FailureTeller, SaysEachKindOfReasonOnceWhateverItsNumbers)
{
    std::vector<std::string> answers = {"at (1, 2, 3) m: it holds 4 points, which are 9.8 mm apart",
                                        "at (1.5, 2, -3) m: it holds 12 points, which are 11 um apart",
                                        "the points determine no surface", "throw", ""};
    std::vector<std::string> told;
    std::size_t              next   = 0;
    const PatchSolver        solver = tellingFailures(
        [&](const Touch&, double) -> DeformationAnswer {
            const std::string& why = answers[next++ % answers.size()];
            if (why == "throw") throw std::runtime_error("the processor is lost");
            if (why.empty()) return {std::make_shared<PatchUpdate>(), {}, {}};
            return {{}, {}, why};
        },
        [&](const std::string& sentence) { told.push_back(sentence); });
    const auto round = [&] {
        for (std::size_t n = 0; n < answers.size(); ++n) try {
                static_cast<void>(solver(Touch(), 1.0 / 60));
            } catch (const std::runtime_error&) {
                EXPECT_EQ(answers[(next - 1) % answers.size()], "throw") << "the session catches it, too";
            }
    };

    round();
    ASSERT_EQ(told.size(), 3U);
    EXPECT_NE(
        told[0].find("feels nothing after a quarter of a second, because the plate cannot be solved: at (1, 2, 3) m"),
        std::string::npos);
    EXPECT_NE(told[1].find("the points determine no surface"), std::string::npos);
    EXPECT_NE(told[2].find("the processor is lost"), std::string::npos);
    round(); // after an answer: the hand feels that one, which is another thing to say
    ASSERT_EQ(told.size(), 6U);
    EXPECT_NE(told[3].find("for a quarter of a second more: at (1, 2, 3) m"), std::string::npos);
    round();
    EXPECT_EQ(told.size(), 6U) << "nothing is said twice";
}

TEST(FailureTeller, SaysWhoTookOverThoughTheTouchHasAPatch)
{
    std::vector<std::string> told;
    std::string              takeover;
    const PatchSolver        solver = tellingFailures(
        [&](const Touch&, double) -> DeformationAnswer {
            return {std::make_shared<PatchUpdate>(), {}, {}, takeover};
        },
        [&](const std::string& sentence) { told.push_back(sentence); });
    static_cast<void>(solver(Touch(), 1.0 / 60));
    EXPECT_TRUE(told.empty());
    for (const char* const next : {"the reference solver took over: it stopped at an error of about 0.2",
                                   "the reference solver took over: it stopped at an error of about 0.3",
                                   "the host took over: the GPU is lost"}) {
        takeover = next;
        static_cast<void>(solver(Touch(), 1.0 / 60));
    }
    ASSERT_EQ(told.size(), 2U) << "each kind once";
    EXPECT_EQ(told[1], "the host took over: the GPU is lost");
}

/// A sheet whose points are so far apart that a patch window holds no more than four.
SoftObject coarseSheet(const Material& material)
{
    std::vector<glm::dvec3> points;
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j) points.emplace_back(i * 12e-3 + 6e-3, j * 12e-3 + 6e-3, 0);
    std::vector<double> stiffness(points.size(), 0.5e6);
    return SoftObject(PointCloud(std::move(points), std::move(stiffness), StiffnessKind::modulus), material);
}

struct CoarseSession {
    Scene                    scene = sheetScene(R"({"law": "constant", "value": 0.5e6})");
    SoftObject               object;
    HandPath                 hand{{{0, {0, 0, 2e-3}}, {0.1, {0, 0, -2e-3}}, {20, {0, 0, -2e-3}}}}; // and stays there
    ScriptedHand             device{hand};
    Deformation              deformation;
    std::vector<std::string> told;

    CoarseSession() : object(coarseSheet(scene.material)), deformation(object, narrow(scene)) {}

    static const Scene& narrow(Scene& scene)
    {
        scene.patch.window = 20e-3;
        return scene;
    }
    SessionParts parts()
    {
        return {
            scene, object,
            tellingFailures(deformation.solver(), [this](const std::string& sentence) { told.push_back(sentence); }),
            device};
    }
    void expectWords(const SessionSummary& summary) const
    {
        ASSERT_EQ(told.size(), 1U) << "at once, and once: it fails 60 times a second";
        EXPECT_NE(told[0].find("feels nothing"), std::string::npos) << told[0];
        EXPECT_NE(told[0].find("4 points of the touched surface"), std::string::npos) << told[0];
        EXPECT_EQ(summary.patches, 0U);
        EXPECT_GT(summary.failedPatches, 1U);
        EXPECT_EQ(summary.mostForce, 0);
        EXPECT_EQ(summary.forceless, summary.patchless) << "it pressed whenever it touched";
        EXPECT_GT(summary.forceless, 100U) << "of the 250 ticks below the surface";
        EXPECT_NE(summary.whyForceless().find("4 points of the touched surface"), std::string::npos)
            << summary.whyForceless();
    }
};

TEST(ContactWithoutPatch, IsSaidInWordsAndCounted)
{
    CoarseSession session;
    session.expectWords(runVirtual(session.parts(), 0.3, {}));
}

TEST(ContactWithoutPatch, IsSaidInRealTimeToo)
{
    CoarseSession session;
    std::string   warning;
    session.expectWords(runReal(session.parts(), {.seconds = 0.6}, warning));
}

TEST(ContactWithoutPatch, IsNoReasonOnceThereAreAnswers)
{
    const SheetSession session(sheetScene(kWart), HandMotion::press);
    Deformation        deformation(session.object, session.scene);
    ScriptedHand       device(session.hand);
    const auto         summary = runVirtual({session.scene, session.object, deformation.solver(), device, {}}, 0.8, {});
    ASSERT_GT(summary.mostForce, 0);
    EXPECT_EQ(summary.whyPatchless, "");
    EXPECT_LT(summary.forceless, 60U) << "two periods of the deformation at 60 Hz are 34 ticks";
    EXPECT_EQ(SessionSummary().whyForceless(), "") << "nobody touched";
}

TEST(ContactWithoutPatch, TheReasonIsThatOfTheLastTick)
{
    TickRecord pressing;
    pressing.normal = {0, 0, 1};
    pressing.hip    = {0, 0, -1e-3};
    pressing.faults = static_cast<std::uint32_t>(SessionFlag::noPatch);
    SessionSummary summary;
    summary.add(pressing);
    EXPECT_EQ(summary.whyForceless(), "the plate had no answer yet");
    summary.addPatch(false, "a hole");
    EXPECT_EQ(summary.whyForceless(), "a hole");
    pressing.faults = static_cast<std::uint32_t>(GovernorFault::tooFast);
    summary.add(pressing);
    EXPECT_NE(summary.whyForceless().find(name(GovernorFault::tooFast)), std::string::npos);
    pressing.force = {0, 0, 1};
    summary.add(pressing);
    EXPECT_EQ(summary.forceless, 2U) << "a force is felt";
    pressing = {};
    summary.add(pressing);
    EXPECT_EQ(summary.forceless, 2U) << "away from the surface none is due";
}

} // namespace
} // namespace palp
