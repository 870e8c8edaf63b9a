#include "engine/tools/study/trial_table.h"

#include <csignal>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace palp::study {
namespace {

TrialRow rowNumber(std::uint64_t n)
{
    TrialRow row;
    row.participant  = "P01";
    row.trial        = n;
    row.block        = 1;
    row.task         = "stiffer";
    row.kind         = "two-alternative";
    row.first        = "homogeneous, \"soft\"";
    row.second       = "wart";
    row.question     = "Which, the first or the second?";
    row.answer       = "first";
    row.correct      = n % 3 == 0 ? std::optional<bool>() : n % 3 == 1;
    row.reactionTime = 0.1 * double(n);
    row.seed         = 2005;
    row.firstSession = "P01/trial_001";
    row.meanForce    = 1.0 / 3;
    row.peakForce    = 1.25;
    row.version      = "0.1.0 abc";
    return row;
}

void demandSame(const TrialRow& a, const TrialRow& b)
{
    EXPECT_EQ(a.trial, b.trial);
    EXPECT_EQ(a.first, b.first);
    EXPECT_EQ(a.question, b.question);
    EXPECT_EQ(a.correct, b.correct);
    EXPECT_EQ(a.reactionTime, b.reactionTime);
    EXPECT_EQ(a.meanForce, b.meanForce);
    EXPECT_EQ(a.version, b.version);
}

TEST(TrialTable, GivesBackWhatWasAppendedAlsoCommasQuotesAndEmptyCells)
{
    const TemporaryFolder folder;
    {
        TrialTable table(folder / "trials.csv");
        for (std::uint64_t n = 1; n <= 3; ++n) {
            table.append(rowNumber(n));
            EXPECT_EQ(readTrials(folder / "trials.csv").size(), n) << "a row is on the disk at once";
            EXPECT_EQ(table.rows().size(), n);
        }
    }

    const TrialTable again(folder / "trials.csv");
    ASSERT_EQ(again.rows().size(), 3u);
    for (std::uint64_t n = 1; n <= 3; ++n) demandSame(again.rows()[n - 1], rowNumber(n));
}

TEST(TrialTable, ThatASpreadsheetHasSavedIsRead)
{
    const TemporaryFolder folder;
    {
        TrialTable table(folder / "trials.csv");
        for (std::uint64_t n = 1; n <= 2; ++n) table.append(rowNumber(n));
    }
    std::string saved = "\xEF\xBB\xBF";
    for (const char c : contentsOf(folder / "trials.csv")) saved += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const auto rows = readTrials(folder.write("saved.csv", saved));
    ASSERT_EQ(rows.size(), 2U);
    for (std::uint64_t n = 1; n <= 2; ++n) demandSame(rows[n - 1], rowNumber(n));
}

TEST(TrialTable, OfAnEarlierVersionGetsTheColumnThatSaysWhetherTheTrialWasFelt)
{
    const TemporaryFolder folder;
    const std::string     head = "participant,trial,block,task,kind,condition,condition_second,question,answer,correct,"
                                 "reaction_time_s,seed,session,session_second,force_mean_N,force_peak_N,version";
    const auto file = folder.write("trials.csv", head + "\np,1,1,r,rating,c,,\"a, \"\"b\"\"\",4,,1.50,7,s,,1,1.2,v\n"
                                                        "p,2,1,r,rating,c,,q,4,,1,7,s,,0,0,v\np,3,");
    ASSERT_EQ(readTrials(file).size(), 2u);
    EXPECT_TRUE(readTrials(file)[0].wasFelt());
    EXPECT_FALSE(readTrials(file)[1].wasFelt());

    TrialTable table(file);
    TrialRow   row = rowNumber(3);
    row.felt       = false; // in one touch of two
    table.append(row);
    EXPECT_TRUE(
        contentsOf(file).starts_with(head + ",felt\np,1,1,r,rating,c,,\"a, \"\"b\"\"\",4,,1.50,7,s,,1,1.2,v,\n"))
        << contentsOf(file);
    ASSERT_EQ(readTrials(file).size(), 3u);
    EXPECT_FALSE(readTrials(file)[2].wasFelt());
}

TEST(TrialTable, OfMoreThanAHundredThousandTrialsIsRefusedAndNotWritten)
{
    const TemporaryFolder folder;
    const auto            file = folder / "trials.csv";
    {
        TrialTable table(file);
    }
    {
        std::ofstream out(file, std::ios::app);
        for (int n = 1; n <= 100'000; ++n) out << "p," << n << ",1,r,rating,c,,q,4,,1,7,s,,1,1,v,1\n";
    }
    TrialTable table(file);
    const auto size = std::filesystem::file_size(file);
    ASSERT_EQ(table.rows().size(), 100'000u);
    EXPECT_TRUE(holds(refusalOf([&] { table.append(rowNumber(100'001)); }), {"trials.csv", "100000 trials"}));
    EXPECT_EQ(std::filesystem::file_size(file), size) << "a table that nobody can read is not written";
    std::ofstream(file, std::ios::app) << "p,100001,1,r,rating,c,,q,4,,1,7,s,,1,1,v,1\n";
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readTrials(file)); }),
                      {"trials.csv: line 100002", "at most 100000 trials"}));
}

TEST(TrialTable, APipeInItsPlaceIsNotWaitedFor)
{
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "trials.csv").c_str(), 0666), 0);
    EXPECT_TRUE(holds(refusalOf([&] { TrialTable table(folder / "trials.csv"); }), {"found a pipe"}));
}

TEST(TrialTable, IsNotContinuedThroughALinkThatAnotherUserPutIntoAFolderOfAnybody)
{
    if (::geteuid() != 0) GTEST_SKIP() << "only root can make another user's link";
    constexpr uid_t       kStranger = 65534;
    const TemporaryFolder folder;
    const auto            file = folder / "trials.csv", away = folder / "away.csv";
    TrialTable            table(file);
    table.append(rowNumber(1));
    const std::string whole = contentsOf(file);
    std::filesystem::rename(file, away);
    std::filesystem::create_symlink(away, file);
    ASSERT_EQ(::lchown(file.c_str(), kStranger, kStranger), 0);
    ASSERT_EQ(::chmod(folder.path().c_str(), 01777), 0);
    const std::string said = refusalOf([&] { table.append(rowNumber(2)); });
    EXPECT_TRUE(holds(said, {"trials.csv: cannot be written", "a link that another user put"})) << said;
    EXPECT_EQ(contentsOf(away), whole);
    EXPECT_EQ(table.rows().size(), 1u);
}

/// A limit on the sizes of files, as a full disk has it, while the object lives.
class SizeLimit {
public:
    explicit SizeLimit(std::size_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN))
    {
        EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before_), 0);
        const rlimit limit{bytes, before_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    }
    ~SizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        static_cast<void>(std::signal(SIGXFSZ, signal_));
    }
    SizeLimit(const SizeLimit&)            = delete;
    SizeLimit& operator=(const SizeLimit&) = delete;

private:
    void (*signal_)(int);
    rlimit before_{};
};

TEST(TrialTable, ARowForWhichThereIsNoRoomLeavesTheTableAsItWas)
{
    const TemporaryFolder folder;
    const auto            file = folder / "trials.csv";
    TrialTable            table(file);
    table.append(rowNumber(1));
    const std::string whole = contentsOf(file);
    for (const std::size_t room : {0, 1, 50}) {
        const std::string said = [&] {
            const SizeLimit limit(whole.size() + room);
            return refusalOf([&] { table.append(rowNumber(2)); });
        }();
        EXPECT_TRUE(holds(said, {"trials.csv: cannot be written: ", "File too large"})) << said;
        EXPECT_EQ(contentsOf(file), whole) << room;
        EXPECT_EQ(table.rows().size(), 1u);
    }
    table.append(rowNumber(2));
    EXPECT_EQ(readTrials(file).size(), 2u);
}

/// Cut anywhere within the last row, as by a crash: the rows before it stay, and the next one follows them.
TEST(TrialTable, ATornLastRowIsRemovedWhereverItWasTorn)
{
    const TemporaryFolder folder;
    const auto            file = folder / "trials.csv";
    {
        TrialTable table(file);
        table.append(rowNumber(1));
        table.append(rowNumber(2));
    }
    const std::string whole = contentsOf(file);
    const std::size_t end   = whole.rfind('\n', whole.size() - 2) + 1; // of row 1
    for (std::size_t bytes = end; bytes < whole.size(); ++bytes) {
        static_cast<void>(folder.write("trials.csv", whole.substr(0, bytes)));
        TrialTable table(file);
        ASSERT_EQ(table.rows().size(), 1u) << bytes;
        table.append(rowNumber(2));
        ASSERT_EQ(contentsOf(file), whole) << bytes;
    }
}

TEST(TrialTable, ATornHeaderIsWrittenAnewAndOthersTablesAreRefused)
{
    const TemporaryFolder folder;
    static_cast<void>(folder.write("trials.csv", "participant,tri"));
    EXPECT_TRUE(TrialTable(folder / "trials.csv").rows().empty());

    const auto refused = [&](const std::string& text, const std::string& word) {
        static_cast<void>(folder.write("trials.csv", text));
        EXPECT_NE(refusalOf([&] { TrialTable(folder / "trials.csv"); }).find(word), std::string::npos) << text;
        EXPECT_EQ(contentsOf(folder / "trials.csv"), text) << "it is not ours to change";
    };
    const std::string header = [&] {
        const TemporaryFolder other;
        TrialTable(other / "t.csv");
        return contentsOf(other / "t.csv");
    }();
    refused("a,b\n1,2\n", "line 1: expected the columns " + header.substr(0, header.size() - 1) + ", found \"a,b\"");
    refused(header + "P01,1\n", "line 2: expected 18 columns, found 2");
    refused(header + "P01,one,1,,,,,,,,1,1,,,1,1,,\n", "column trial");
    refused(header + "P01,1,1,,,,,,,maybe,1,1,,,1,1,,\n", "column correct");
    refused(header + "P01,1,1,,taste,,,,4,,1,1,,,1,1,,\n", "column kind: expected rating, yes-no or two-alternative");
    refused(header + "P01,2,1,,rating,,,,4,,1,1,,,1,1,,\n", "line 2: column trial: expected 1, found 2");
    refused(header + "P01,1,1,,rating,,,,6,,1,1,,,1,1,,\n", "column answer: expected 1 to 5, found \"6\"");
    refused(header + "P01,1,1,,yes-no,,,,first,,1,1,,,1,1,,\n", "expected yes or no");
    refused(header + "P01,1,1,,two-alternative,,,,banana,,1,1,,,1,1,,\n", "expected first or second");
}

} // namespace
} // namespace palp::study
