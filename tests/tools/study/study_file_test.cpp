// Tests of study.json: what is written is read, files of version 0.1.0 too, and every mistake is named.
#include "engine/tools/study/study_file.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.h"

namespace palp::study {
namespace {

TEST(StudyFiles, WhatIsWrittenIsRead)
{
    const StudyFile written{.participant   = "P01",
                            .title         = "Which is \"stiffer\"?\n",
                            .plan          = R"({"title": "t"})",
                            .clouds        = {"0a", "1b"},
                            .hand          = "falcon@3",
                            .path          = "2c",
                            .clock         = "real",
                            .motion        = "speed 0.05 m/s",
                            .feltStiffness = {{"SOFT", 300.25}, {"AIR", std::nullopt}},
                            .version       = "0.2.0 abc"};
    const StudyFile read = parseStudyFile(studyJson(written), "study.json");

    EXPECT_TRUE(read == written) << studyJson(read);
}

TEST(StudyFiles, OlderOnesNameNeitherHandNorClock)
{
    const StudyFile read =
        parseStudyFile(R"({"format": 1, "participant": "p", "plan": "{}", "clouds": ["0"]})", "study.json");
    EXPECT_EQ(read.participant, "p");
    EXPECT_FALSE(read.hand || read.path || read.clock || read.motion);
    EXPECT_TRUE(read.feltStiffness.empty());
}

TEST(StudyFiles, APipeInItsPlaceIsNotWaitedFor)
{
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "study.json").c_str(), 0666), 0);
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readStudyFile(folder.path())); }), {"found a pipe"}));
}

TEST(StudyFiles, OfMoreThan16MegabytesIsRefused)
{
    const TemporaryFolder folder;
    const auto            file = folder.write("study.json", R"({"format": 1, "participant": "p")");
    std::filesystem::resize_file(file, (std::size_t(16) << 20) + 1);
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readStudyFile(folder.path())); }),
                      {"study.json: longer than 16777216 bytes; expected a study's description"}));
}

TEST(StudyFiles, AMistakeIsNamed)
{
    struct Case {
        const char *text, *word;
    };
    for (const Case& one :
         {Case{R"({"format": 2, "participant": "p", "plan": "{}", "clouds": []})", "\"format\""},
          Case{R"({"format": 1, "plan": "{}", "clouds": []})", "\"participant\""},
          Case{R"({"format": 1, "participant": "p", "plan": {}, "clouds": []})", "\"plan\""},
          Case{R"({"format": 1, "participant": "p", "plan": "{}", "clouds": [1]})", "\"clouds\""},
          Case{R"({"format": 1, "participant": "p", "plan": "{}", "clouds": "0"})", "\"clouds\""},
          Case{R"({"format": 1, "participant": "p", "plan": "{}", "clouds": [], "felt_stiffness_N_per_m": {"a": "1"}})",
               "\"felt_stiffness_N_per_m\""},
          Case{"[]", "object"}, Case{"{", "line 1"}}) {
        const std::string said = refusalOf([&] { static_cast<void>(parseStudyFile(one.text, "P/study.json")); });
        EXPECT_TRUE(holds(said, {"P/study.json", one.word})) << said;
    }
}

} // namespace
} // namespace palp::study
