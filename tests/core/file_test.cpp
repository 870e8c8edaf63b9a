#include "engine/core/file.h"

#include <csignal>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class Files : public testing::Test {
protected:
    std::vector<std::string> namesInFolder() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            names.push_back(entry.path().filename().string());
        return names;
    }

    TemporaryFolder folder_;
};

void writeNew(std::ostream& stream)
{
    stream << "new";
}

TEST_F(Files, AWrittenFileHoldsTheBytesAndNothingElseRemains)
{
    const std::string bytes("\0\r\n\xff", 4);

    writeFileWhole(folder_ / "a", [&](std::ostream& stream) { stream << bytes; });

    EXPECT_EQ(contentsOf(folder_ / "a"), bytes);
    EXPECT_EQ(namesInFolder(), std::vector<std::string>{"a"});
}

TEST_F(Files, APipeIsRefusedAndNotWaitedFor)
{
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);

    try {
        static_cast<void>(openRegularFile(folder_ / "pipe"));
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).find("found a pipe") != std::string::npos) << error.what();
    }
}

TEST_F(Files, AnOlderFileIsReplacedWhole)
{
    writeFileWhole(folder_ / "a", [](std::ostream& stream) { stream << "a longer text"; });
    writeFileWhole(folder_ / "a", writeNew);

    EXPECT_EQ(contentsOf(folder_ / "a"), "new");
}

TEST_F(Files, TheOlderFileIsThereUntilTheNewOneIsWhole)
{
    writeFileWhole(folder_ / "a", [](std::ostream& stream) { stream << "old"; });
    std::string seen;

    writeFileWhole(folder_ / "a", [&](std::ostream& stream) {
        stream << "new" << std::flush;
        seen = contentsOf(folder_ / "a");
    });

    EXPECT_EQ(seen, "old");
    EXPECT_EQ(contentsOf(folder_ / "a"), "new");
}

TEST_F(Files, AnExceptionWhileWritingLeavesTheOlderFileAndNoDraft)
{
    writeFileWhole(folder_ / "a", [](std::ostream& stream) { stream << "old"; });
    const auto interrupted = [](std::ostream& stream) {
        stream << "half";
        throw std::runtime_error("stop");
    };

    EXPECT_THROW(writeFileWhole(folder_ / "a", interrupted), std::runtime_error);
    EXPECT_THROW(writeFileWhole(folder_ / "b", interrupted), std::runtime_error);

    EXPECT_EQ(contentsOf(folder_ / "a"), "old");
    EXPECT_EQ(namesInFolder(), std::vector<std::string>{"a"});
}

TEST_F(Files, AStreamThatFailedLeavesTheOlderFileAndNoDraft)
{
    writeFileWhole(folder_ / "a", [](std::ostream& stream) { stream << "old"; });

    const std::string refusal = refusalOf(
        [&] { writeFileWhole(folder_ / "a", [](std::ostream& stream) { stream.setstate(std::ios::badbit); }); });

    EXPECT_NE(refusal.find((folder_ / "a").string() + ": cannot be written"), std::string::npos) << refusal;
    EXPECT_EQ(contentsOf(folder_ / "a"), "old");
    EXPECT_EQ(namesInFolder(), std::vector<std::string>{"a"});
}

TEST_F(Files, AFullDiskIsReported)
{
    if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "there is no /dev/full, which is always full";
    // A name that leads to the device, because a writer with a mistake would replace the device itself.
    std::filesystem::create_symlink("/dev/full", folder_ / "full");

    const std::string refusal = refusalOf([&] { writeFileWhole(folder_ / "full", writeNew); });

    EXPECT_NE(refusal.find((folder_ / "full").string() + ": cannot be written: No space left"), std::string::npos)
        << refusal;
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "full"));

    // More than a buffer holds: the disk is full while `write` still writes.
    const auto writeMuch = [](std::ostream& stream) {
        for (int line = 0; line < 100'000; ++line) stream << "much\n";
    };
    const std::string early = refusalOf([&] { writeFileWhole(folder_ / "full", writeMuch); });
    EXPECT_NE(early.find("cannot be written: No space left"), std::string::npos) << early;
}

TEST_F(Files, ADeviceIsWrittenToAndNotReplaced)
{
    // A name that leads to the device, for the same reason.
    std::filesystem::create_symlink("/dev/null", folder_ / "null");

    writeFileWhole(folder_ / "null", writeNew);

    EXPECT_TRUE(std::filesystem::is_character_file(folder_ / "null"));
    EXPECT_EQ(namesInFolder(), std::vector<std::string>{"null"});
}

TEST_F(Files, ALinkStaysALinkToTheNewContents)
{
    std::ofstream(folder_ / "file") << "old";
    std::filesystem::create_symlink(folder_ / "file", folder_ / "link");

    writeFileWhole(folder_ / "link", writeNew);

    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
    EXPECT_EQ(contentsOf(folder_ / "file"), "new");
}

TEST_F(Files, ALinkThatLeadsNowhereYetGetsItsFile)
{
    std::filesystem::create_symlink("link", folder_ / "first");
    std::filesystem::create_symlink("file", folder_ / "link");

    writeFileWhole(folder_ / "first", writeNew);

    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "first"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
    EXPECT_EQ(contentsOf(folder_ / "file"), "new");

    std::filesystem::create_symlink("circle", folder_ / "circle");
    const std::string refusal = refusalOf([&] { writeFileWhole(folder_ / "circle", writeNew); });
    EXPECT_NE(refusal.find("too many links"), std::string::npos) << refusal;
}

TEST_F(Files, AKilledWriterLeavesNothingBesideTheOlderFile)
{
    const int probe = ::open(folder_.path().c_str(), O_WRONLY | O_TMPFILE, 0600);
    if (probe < 0) GTEST_SKIP() << "this file system makes no file without a name";
    ::close(probe);
    std::ofstream(folder_ / "a") << "old";
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            writeFileWhole(folder_ / "a", [](std::ostream& stream) {
                stream << std::string(100'000, 'x') << std::flush;
                ::raise(SIGKILL);
            });
        } catch (...) { // a child that goes on would run the other tests once more
        }
        ::_exit(1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    EXPECT_EQ(namesInFolder(), std::vector<std::string>{"a"});
    EXPECT_EQ(contentsOf(folder_ / "a"), "old");
}

TEST_F(Files, AFolderIsLockedForOneAtATime)
{
    {
        const FolderLock first(folder_.path(), "taken");
        EXPECT_TRUE(holds(refusalOf([&] { const FolderLock second(folder_.path(), "taken"); }),
                          {folder_.path().c_str(), "taken"}));
    }
    EXPECT_EQ(refusalOf([&] { const FolderLock again(folder_.path(), "taken"); }), "");
    EXPECT_TRUE(holds(refusalOf([&] { const FolderLock none(folder_ / "none", "taken"); }), {"none", "No such file"}));
}

/// Whoever can write into the folder could have foreseen the draft's name.
TEST_F(Files, ALinkThatWaitsForTheDraftIsNotFollowed)
{
    std::ofstream(folder_ / "precious") << "kept";
    const std::filesystem::path waits = folder_ / ("a." + std::to_string(::getpid()) + ".part");
    std::filesystem::create_symlink(folder_ / "precious", waits);

    writeFileWhole(folder_ / "a", writeNew);

    EXPECT_EQ(contentsOf(folder_ / "precious"), "kept");
    EXPECT_EQ(contentsOf(folder_ / "a"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(waits));
    EXPECT_FALSE(std::filesystem::is_symlink(folder_ / "a"));
}

TEST_F(Files, AStrangersLinkInAFolderOfAnybodyIsRefused)
{
    if (::geteuid() != 0) GTEST_SKIP() << "only root can make another user's link";
    constexpr uid_t kStranger = 65534;
    std::ofstream(folder_ / "precious") << "kept";
    const std::filesystem::path link = folder_ / "b" / "link";
    makeFolder(folder_ / "b");
    std::filesystem::create_symlink(folder_ / "precious", link);
    ASSERT_EQ(::lchown(link.c_str(), kStranger, kStranger), 0);

    ASSERT_EQ(::chmod((folder_ / "b").c_str(), 01777), 0);
    const std::string refusal = refusalOf([&] { writeFileWhole(link, writeNew); });
    EXPECT_NE(refusal.find("a link that another user put"), std::string::npos) << refusal;
    std::filesystem::create_symlink(link, folder_ / "own");
    EXPECT_NE(refusalOf([&] { writeFileWhole(folder_ / "own", writeNew); }), "") << "by way of an own link";
    EXPECT_EQ(contentsOf(folder_ / "precious"), "kept");

    ASSERT_EQ(::chmod((folder_ / "b").c_str(), 0755), 0);
    writeFileWhole(link, writeNew);
    EXPECT_EQ(contentsOf(folder_ / "precious"), "new") << "in a folder of our own we know of it";

    ASSERT_EQ(::chmod((folder_ / "b").c_str(), 01777), 0);
    ASSERT_EQ(::chown((folder_ / "b").c_str(), kStranger - 1, kStranger - 1), 0);
    std::filesystem::create_symlink(folder_ / "mine", folder_ / "b" / "mine");
    writeFileWhole(folder_ / "b" / "mine", writeNew);
    EXPECT_EQ(contentsOf(folder_ / "mine"), "new") << "a link of our own may lie anywhere";
}

/// Acts as another user while it lives.
class AsUser {
public:
    explicit AsUser(uid_t user) { EXPECT_EQ(::seteuid(user), 0); }
    ~AsUser() { EXPECT_EQ(::seteuid(0), 0); }
    AsUser(const AsUser&)            = delete;
    AsUser& operator=(const AsUser&) = delete;
};

/// A folder of mine, one of anybody's beside it, and another user who puts links into that.
class FilesBesideStrangers : public Files {
protected:
    static constexpr uid_t kStranger = 65534, kOwner = 65533, kMe = 65532;

    void SetUp() override
    {
        if (::geteuid() != 0) GTEST_SKIP() << "only root can make another user's link";
        makeFolder(mine_);
        makeFolder(shared_);
        std::ofstream(mine_ / "a") << "kept";
        ASSERT_EQ(::chmod(shared_.c_str(), 01777), 0);
    }

    static void linkOf(uid_t user, const std::filesystem::path& link, const std::filesystem::path& target)
    {
        std::filesystem::create_symlink(target, link);
        ASSERT_EQ(::lchown(link.c_str(), user, user), 0);
    }

    /// Writes into a folder in each way there is, and expects each to be refused and nothing to be changed.
    void expectAllRefused(const std::filesystem::path& folder) const
    {
        const auto expectRefused = [](const auto& write) {
            const std::string refusal = refusalOf(write);
            EXPECT_TRUE(holds(refusal, {"a link that another user put"})) << refusal;
        };
        expectRefused([&] { writeFileWhole(folder / "a", writeNew); });
        expectRefused([&] { writeFileWhole(folder / "b", writeNew); });
        expectRefused([&] { appendToFile(folder / "a", "new"); });
        expectRefused([&] { ::close(makeFile(folder / "b")); });
        expectRefused([&] { makeFolder(folder); });
        expectRefused([&] { makeFolder(folder / ""); });
        expectRefused([&] { makeFolder(folder / "b" / "c"); });
        EXPECT_EQ(contentsOf(mine_ / "a"), "kept");
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(mine_), {}), 1);
    }

    const std::filesystem::path mine_ = folder_ / "mine", shared_ = folder_ / "everybodys";
};

TEST_F(FilesBesideStrangers, ALinkInTheMiddleOfAPathIsRefused)
{
    linkOf(kStranger, shared_ / "out", mine_);
    linkOf(kStranger, shared_ / "far", folder_.path());
    expectAllRefused(shared_ / "out");
    expectAllRefused(shared_ / "far" / "mine");
    expectAllRefused(std::filesystem::proximate(shared_) / "out");
    expectAllRefused(shared_ / ".." / "everybodys" / "." / "out");
}

TEST_F(FilesBesideStrangers, ALinkBehindOwnLinksIsRefused)
{
    linkOf(kStranger, shared_ / "out", mine_);
    std::filesystem::create_symlink("everybodys/out", folder_ / "relative");
    std::filesystem::create_symlink(shared_ / "out" / "", folder_ / "absolute");
    std::filesystem::create_symlink("../everybodys/../relative", shared_ / "chain");
    for (const char* const first : {"relative", "absolute", "everybodys/chain"}) expectAllRefused(folder_ / first);
}

TEST_F(FilesBesideStrangers, ALinkThatIsReachedByANewFolderIsRefused)
{
    linkOf(kStranger, shared_ / "out", mine_);
    EXPECT_NE(refusalOf([&] { makeFolder(shared_ / "new" / ".." / "out" / "b"); }), "");
    EXPECT_FALSE(std::filesystem::exists(mine_ / "b"));
}

TEST_F(FilesBesideStrangers, LinksOfOnesOwnOfRootAndOfTheFoldersOwnerAreFollowed)
{
    ASSERT_EQ(::chown(shared_.c_str(), kOwner, kOwner), 0);
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
    for (const auto& path : {mine_, mine_ / "a"}) ASSERT_EQ(::chown(path.c_str(), kMe, kMe), 0);
    linkOf(kMe, shared_ / "own", mine_);
    linkOf(0, shared_ / "roots", mine_);
    linkOf(kOwner, shared_ / "owners", mine_);
    linkOf(kStranger, shared_ / "strangers", mine_);

    const AsUser me(kMe);
    for (const std::string whose : {"own", "roots", "owners"}) {
        writeFileWhole(shared_ / whose / "a", writeNew);
        makeFolder(shared_ / whose / whose / "b");
        ::close(makeFile(shared_ / whose / "b" += whose));
        EXPECT_TRUE(std::filesystem::is_directory(mine_ / whose / "b"));
        EXPECT_TRUE(std::filesystem::exists(mine_ / "b" += whose));
    }
    EXPECT_NE(refusalOf([&] { writeFileWhole(shared_ / "strangers" / "a", [](std::ostream&) {}); }), "");
    EXPECT_EQ(contentsOf(mine_ / "a"), "new");
}

TEST_F(FilesBesideStrangers, WhatIsReadIsNotConcerned)
{
    ASSERT_EQ(::chmod(shared_.c_str(), 0777), 0); // where it is sticky the system may refuse (fs.protected_symlinks)
    linkOf(kStranger, shared_ / "out", mine_);
    EXPECT_EQ(readWhole(shared_ / "out" / "a", 10, "a text"), "kept");
    expectAllRefused(shared_ / "out");
}

TEST_F(FilesBesideStrangers, APipeIsNotAppendedToNorWaitedForAndAFileIs)
{
    ASSERT_EQ(::mkfifo((shared_ / "pipe").c_str(), 0666), 0);
    std::ofstream(shared_ / "file") << "theirs";
    for (const char* const name : {"pipe", "file"})
        ASSERT_EQ(::chown((shared_ / name).c_str(), kStranger, kStranger), 0);
    const std::string refusal = refusalOf([&] { appendToFile(shared_ / "pipe", "new"); });
    EXPECT_TRUE(holds(refusal, {"a pipe that another user put"})) << refusal;
    appendToFile(shared_ / "file", " and ours");
    EXPECT_EQ(contentsOf(shared_ / "file"), "theirs and ours");
}

TEST_F(Files, AsManyLinksAreFollowedAsTheSystemFollows)
{
    makeFolder(folder_ / "0");
    for (int n = 1; n <= 41; ++n) std::filesystem::create_symlink(std::to_string(n - 1), folder_ / std::to_string(n));
    writeFileWhole(folder_ / "40" / "a", writeNew);
    EXPECT_EQ(contentsOf(folder_ / "0" / "a"), "new");
    const std::string refusal = refusalOf([&] { writeFileWhole(folder_ / "41" / "a", writeNew); });
    EXPECT_TRUE(holds(refusal, {"too many links"})) << refusal;
}

TEST_F(Files, WhatCannotBeWrittenIsRefusedBeforeTheWork)
{
    makeFolder(folder_ / "b");
    std::ofstream(folder_ / "file") << "old";
    for (const auto& of : {std::pair("none/a", "none/a: cannot be written: No such file"),
                           std::pair("file/a", "file/a: cannot be written: Not a directory"),
                           std::pair("b", "b: cannot be written: it is a folder")}) {
        const char* const path    = of.first; // clang 14 captures no name of a pair's part
        const std::string refusal = refusalOf([&] { expectWritable(folder_ / path); });
        EXPECT_TRUE(holds(refusal, {of.second})) << path << ": " << refusal;
        EXPECT_EQ(refusalOf([&] { writeFileWhole(folder_ / path, writeNew); }), refusal);
    }
    const std::string refusal = refusalOf([&] { expectWritableFolder(folder_ / "file" / "b" / "c"); });
    EXPECT_TRUE(holds(refusal, {"file/b/c: cannot be written: Not a directory"})) << refusal;
    for (const char* const path : {"a", "file"}) EXPECT_EQ(refusalOf([&] { expectWritable(folder_ / path); }), "");
    for (const char* const path : {"b", "b/", "c/d/e"})
        EXPECT_EQ(refusalOf([&] { expectWritableFolder(folder_ / path); }), "");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a") || std::filesystem::exists(folder_ / "c"));
}

TEST_F(Files, WhatIsProtectedStaysAsItIs)
{
    constexpr uid_t kStranger = 65534;
    makeFolder(folder_ / "closed");
    std::ofstream(folder_ / "file") << "old";
    std::filesystem::permissions(folder_ / ".", std::filesystem::perms(0777));
    std::filesystem::permissions(folder_ / "file", std::filesystem::perms(0444));
    std::filesystem::permissions(folder_ / "closed", std::filesystem::perms(0555));
    const uid_t own = ::geteuid();
    if (own == 0) { // root may write everything
        ASSERT_EQ(::seteuid(kStranger), 0);
    }
    for (const char* const path : {"file", "closed/a"}) {
        const std::string refusal = refusalOf([&] { expectWritable(folder_ / path); });
        EXPECT_TRUE(holds(refusal, {path, "cannot be written: Permission denied"})) << refusal;
        EXPECT_EQ(refusalOf([&] { writeFileWhole(folder_ / path, writeNew); }), refusal);
    }
    const std::string refusal = refusalOf([&] { expectWritableFolder(folder_ / "closed" / "a" / "b"); });
    EXPECT_TRUE(holds(refusal, {"cannot be written: Permission denied"})) << refusal;
    ASSERT_EQ(::seteuid(own), 0);
    EXPECT_EQ(contentsOf(folder_ / "file"), "old");
}

TEST_F(Files, WhatIsAppendedStandsAtTheEndOfAFileThatIsThere)
{
    std::ofstream(folder_ / "a") << "old";
    std::filesystem::create_symlink("a", folder_ / "link");
    appendToFile(folder_ / "link", " and new");
    EXPECT_EQ(contentsOf(folder_ / "a"), "old and new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
    const std::string missing = refusalOf([&] { appendToFile(folder_ / "b", "new"); });
    EXPECT_TRUE(holds(missing, {"b: cannot be written: No such file"})) << missing;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b"));
}

TEST_F(Files, ANewFileIsNotMadeWhereThereIsOne)
{
    std::ofstream(folder_ / "a") << "old";
    std::filesystem::create_symlink("nowhere", folder_ / "link");
    const std::string refusal = refusalOf([&] { ::close(makeFile(folder_ / "a")); });
    EXPECT_TRUE(holds(refusal, {"a: cannot be made: File exists"})) << refusal;
    EXPECT_EQ(contentsOf(folder_ / "a"), "old");
}

TEST_F(Files, AStrangersPipeInAFolderOfAnybodyIsRefused)
{
    if (::geteuid() != 0) GTEST_SKIP() << "only root can make another user's pipe";
    constexpr uid_t kStranger = 65534;
    makeFolder(folder_ / "b");
    const std::filesystem::path pipe = folder_ / "b" / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0666), 0);
    ASSERT_EQ(::chmod((folder_ / "b").c_str(), 01777), 0);
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    const auto read = [&] {
        char text[8]{};
        return std::string(text, std::size_t(std::max<ssize_t>(::read(reader, text, sizeof text), 0)));
    };
    writeFileWhole(pipe, writeNew);
    EXPECT_EQ(read(), "new") << "an own pipe is what was meant";
    ASSERT_EQ(::lchown(pipe.c_str(), kStranger, kStranger), 0);
    const std::string refusal = refusalOf([&] { writeFileWhole(pipe, writeNew); });
    EXPECT_NE(refusal.find("a pipe that another user put"), std::string::npos) << refusal;
    EXPECT_EQ(read(), "");
    ::close(reader);
    EXPECT_NE(refusalOf([&] { writeFileWhole(pipe, writeNew); }), "") << "nor is a reader waited for";
}

TEST_F(Files, APipeIsWrittenByTheLinkThatStandardOutputIs)
{
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    writeFileWhole("/proc/self/fd/" + std::to_string(ends[1]), writeNew); // as /dev/stdout leads there
    char text[8]{};
    EXPECT_EQ(::read(ends[0], text, sizeof text), 3);
    EXPECT_STREQ(text, "new");
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_F(Files, APipeWhereNobodyMeansOneIsRefusedAndNotWaitedFor)
{
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0666), 0);
    const std::string refusal =
        refusalOf([&] { static_cast<void>(readWhole(folder_ / "pipe", 10, "a text", Pipes::refused)); });
    EXPECT_NE(refusal.find("found a pipe"), std::string::npos) << refusal;
}

TEST_F(Files, AFileForOneUsersEyesStaysSo)
{
    std::ofstream(folder_ / "a") << "old";
    ASSERT_EQ(::chmod((folder_ / "a").c_str(), 0600), 0);

    writeFileWhole(folder_ / "a", writeNew);

    struct stat found {};
    ASSERT_EQ(::stat((folder_ / "a").c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0600U);
}

TEST_F(Files, AFolderOrAMissingFolderCannotBeWritten)
{
    const std::string folder  = refusalOf([&] { writeFileWhole(folder_.path(), writeNew); });
    const std::string missing = refusalOf([&] { writeFileWhole(folder_ / "no" / "a", writeNew); });

    EXPECT_NE(folder.find("it is a folder"), std::string::npos) << folder;
    EXPECT_NE(missing.find((folder_ / "no" / "a").string()), std::string::npos) << missing;
    EXPECT_NE(missing.find("No such file"), std::string::npos) << missing;
    EXPECT_TRUE(namesInFolder().empty());
}

TEST_F(Files, ReadingGivesTheBytesUnchanged)
{
    const std::string bytes("a\r\n\0b", 5);
    writeFileWhole(folder_ / "a", [&](std::ostream& stream) { stream << bytes; });

    InputFile file = openForReading(folder_ / "a");

    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), bytes);
}

TEST_F(Files, AReadThatFailsIsNoEndOfTheFile)
{
    const char* const broken = "/proc/self/mem"; // nothing is mapped at its first byte: EIO
    const std::string whole  = refusalOf([&] { static_cast<void>(readWhole(broken, 1 << 20, "a text")); });
    EXPECT_TRUE(holds(whole, {broken, "cannot be read to its end", "Input/output error"})) << whole;
    InputFile   lines = openForReading(broken);
    std::string line;
    EXPECT_THROW(std::getline(lines, line), Error);
    InputFile blocks = openRegularFile(broken);
    char      block[16];
    EXPECT_THROW(blocks.read(block, sizeof block), Error);
    InputFile moved = std::move(lines);
    moved.clear();
    EXPECT_THROW(static_cast<void>(moved.get()), Error);
}

TEST_F(Files, AMissingFileOrAFolderCannotBeRead)
{
    const std::string missing = refusalOf([&] { static_cast<void>(openForReading(folder_ / "a")); });
    const std::string folder  = refusalOf([&] { static_cast<void>(openForReading(folder_.path())); });

    EXPECT_NE(missing.find((folder_ / "a").string() + ": cannot be read: No such file"), std::string::npos) << missing;
    EXPECT_NE(folder.find("it is a folder"), std::string::npos) << folder;
}

TEST_F(Files, FoldersAreMadeWithTheirParentsAndMayExistAlready)
{
    makeFolder(folder_ / "b" / "c");
    makeFolder(folder_ / "b" / "c");

    EXPECT_TRUE(std::filesystem::is_directory(folder_ / "b" / "c"));
}

TEST_F(Files, AFolderIsNotMadeWhereAFileIs)
{
    writeFileWhole(folder_ / "a", writeNew);

    for (const auto& path : {folder_ / "a", folder_ / "a" / "b"}) {
        const std::string refusal = refusalOf([&] { makeFolder(path); });
        EXPECT_NE(refusal.find(path.string() + ": the folder cannot be made"), std::string::npos) << refusal;
    }
    EXPECT_EQ(contentsOf(folder_ / "a"), "new");
}

TEST(IsThere, ThrowsWhereTheSystemCannotSay)
{
    const TemporaryFolder folder;
    static_cast<void>(folder.write("file", "x"));
    EXPECT_TRUE(isThere(folder / "file"));
    EXPECT_FALSE(isThere(folder / "other"));
    EXPECT_FALSE(isThere(folder / "file" / "below"));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(isThere(folder / std::string(300, 'a'))); }),
                      {"...aaa", "aaa: cannot be read: File name too long"}));
}

} // namespace
} // namespace palp
