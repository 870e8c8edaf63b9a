#include "engine/tools/gui/workbench.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/tools/gui/numbered_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/gui/blank_screen.h"

// A workbench without a window: what happens in one is a list of steps, what it shows is counted.

namespace palp {
namespace {

constexpr glm::ivec2  kSize{640, 480};
constexpr const char* kRamp = "linear:from=2e4,to=2e6,axis=x"; ///< the brush paints the largest value

/// A screen that only remembers.
class SeenScreen final : public BlankScreen {
public:
    bool show(const ViewScene& scene, const Camera& now, const PictureSize&, const Overlay*) override
    {
        if (isLost) throw Error("the screen is lost");
        ++pictures;
        camera = now;
        points = scene.positions.size();
        end    = scene.colours.range.high;
        brush  = !scene.brush.empty();
        patch  = !scene.outline.empty();
        if (scene.note != said) said = scene.note;
        notes += said + "\n";
        return true;
    }

    [[nodiscard]] bool said_(const std::string& words) const { return notes.find(words) != std::string::npos; }

    bool        isLost = false, brush = false, patch = false; ///< the rims of both are shown
    int         pictures = 0;
    std::size_t points   = 0; ///< of what is shown
    double      end      = 0; ///< of the colours [m]
    Camera      camera;
    std::string said, notes; ///< now; all of it
};

/// A hand that stays where it is, inside of the object, and remembers what it was given.
class StillHand final : public HapticDevice {
public:
    StillHand()
    {
        info_.model            = "still hand";
        info_.maximumForce     = 8;
        info_.maximumStiffness = 2000;
        info_.maximumDamping   = 10;
        info_.workspaceRadius  = 1;
    }
    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }
    void                                  open() override {}
    void                                  close() noexcept override {}
    void                                  render(const GovernedForce& force) noexcept override
    {
        last = glm::length(force.newtons());
        most = std::max<double>(most, last);
        if (now_ < 1e-3) first = std::max<double>(first, last); // of a session: its clock begins anew
    }
    HapticState read(double now) noexcept override
    {
        now_ = now;
        HapticState state;
        state.time     = now;
        state.sequence = ++sequence_;
        // From above into the object within a tenth of a second: which side it is on is known from where it comes.
        state.position = {0, 10e-3 - 11.5e-3 * (stays ? 1.0 : std::min(1.0, now / 0.1)), 0};
        state.velocity = {0, 0, hurries ? 2.0 : 0.0};
        state.homed = state.inBox = true;
        state.fault               = DeviceFault::none;
        return state;
    }
    std::atomic<double> last = 0, most = 0,
                        first = 0;     ///< of the newest tick, of all, of the first of any session [N]
    std::atomic<bool> hurries = false; ///< faster than the governor lets a hand be
    std::atomic<bool> stays   = false; ///< inside, also as a session begins

private:
    HapticDeviceInfo info_;
    std::uint64_t    sequence_ = 0;
    double           now_      = 0; ///< [s]
};

/// What a user does: steps one after the other, each once the one before has come to pass.
class WorkbenchTest : public ::testing::Test {
protected:
    WorkbenchTest() : before_(std::filesystem::current_path())
    {
        std::filesystem::current_path(folder_.path()); // where pictures and recordings go
        settings_.what       = "sample:sheet";
        settings_.values     = {{"points", "2000"}, {"cells", "32"}, {"solver", "host"}};
        settings_.open       = [](const std::string& what, const SceneValues& values) { return sceneOf(what, values); };
        settings_.complained = [this](const std::string& sentence) { complaints_ += sentence + "\n"; };
        input_.size          = kSize;
        input_.pointer       = glm::dvec2(kSize) / 2.0;
    }
    ~WorkbenchTest() override { std::filesystem::current_path(before_); }

    static Scene sceneOf(const std::string& what, SceneValues values)
    {
        values.try_emplace("solver", "host");
        return parseScene(R"({"cloud": ")" + what + R"(", "place": [0, 0, 0]})", what, ".", {values, {}});
    }

    /// \param until  the next step comes then; at the latest after forty seconds, which fails
    void step(
        const std::string& what, const std::function<void(WindowInput&)>& act,
        const std::function<bool()>& until = [] { return true; })
    {
        steps_.push_back({what, act, until});
    }
    void press(int key, bool control = false)
    {
        step("a key", [=](WindowInput& input) { input.keys = {{key, control, false}}; });
    }
    void wait(const std::string& what, const std::function<bool()>& until)
    {
        step(
            what, [](WindowInput&) {}, until);
    }
    void rest(double seconds)
    {
        wait("a rest", [=, this] { return sinceStep() > seconds; });
    }
    void drop(const std::filesystem::path& path)
    {
        step("a drop", [=](WindowInput& input) { input.dropped = {path}; });
    }
    void touch(const std::function<bool()>& until)
    {
        step(
            "touching", [](WindowInput& input) { input.touch = true; }, until);
    }
    /// The hand is a device.
    void takeHand()
    {
        settings_.hand = [this](const Stage& stage, const HandWait&) {
            return WorkbenchHand{&hand_, deviceFrame(stage.place().point, stage.place().outward), 1e9};
        };
    }
    void record()
    {
        settings_.recorded = [](const Stage& stage, const HapticDevice& device) {
            SessionInfo info;
            info.scene  = stage.scene();
            info.solver = "host";
            info.clock  = SessionClock::real;
            info.cloud  = fingerprint(stage.object().cloud());
            info.hand   = device.info();
            return info;
        };
    }

    /// Paints a dab on the object of 2000 points, once it is there.
    void paint()
    {
        wait("the object", [this] { return screen_.points == 2000; });
        press('B');
        step("a dab", [](WindowInput& input) { input.left = true; });
    }
    /// Opens a file of 2000 points, paints on it and saves that.
    void savePainted(const std::string& file)
    {
        settings_.what = file;
        settings_.values.erase("points");
        settings_.values.emplace("stiffness", kRamp);
        paint();
        press('B');
        press('S', true);
        wait("the paint as a file", [] { return std::filesystem::exists("part-painted-0001.ply"); });
        run();
        EXPECT_EQ(complaints_, "");
    }

    /// Does all steps, then closes.
    WorkbenchReport run()
    {
        Workbench bench(settings_, screen_);
        bench_  = &bench;
        stepAt_ = Clock::now();
        return bench.run([this](double patience) { return poll(patience); }, nullptr);
    }

    WindowInput poll(double patience)
    {
        std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(patience, 2e-3, 2e-2)));
        input_.keys.clear();
        input_.dropped.clear();
        input_.moved               = {};
        input_.closing             = false;
        constexpr double kPatience = 40; // [s] sanitizers make all of it ten times slower
        if (begun_ && !steps_.front().until()) {
            if (sinceStep() < kPatience) return input_;
            ADD_FAILURE() << "waited in vain: " << steps_.front().what << "; complaints: " << complaints_;
            inVain_ = true;
            steps_.resize(1);
        }
        if (begun_) steps_.pop_front();
        begun_       = !steps_.empty();
        stepAt_      = Clock::now();
        input_.touch = input_.left = false;
        if (begun_)
            steps_.front().act(input_);
        else
            input_.closing = true;
        return input_;
    }
    [[nodiscard]] double sinceStep() const { return std::chrono::duration<double>(Clock::now() - stepAt_).count(); }
    [[nodiscard]] bool   complainedOf(const std::string& words) const
    {
        return complaints_.find(words) != std::string::npos;
    }

    using Clock = std::chrono::steady_clock;
    struct Step {
        std::string                       what;
        std::function<void(WindowInput&)> act;
        std::function<bool()>             until;
    };
    Workbench*            bench_ = nullptr; ///< while it runs
    TemporaryFolder       folder_;
    std::filesystem::path before_;
    WorkbenchSettings     settings_;
    SeenScreen            screen_;
    StillHand             hand_;
    WindowInput           input_;
    std::deque<Step>      steps_;
    bool                  begun_ = false; ///< the first of them
    Clock::time_point     stepAt_;
    std::atomic<bool>     inVain_ = false; ///< a step has not come to pass: who waits for another, waits no more
    std::string           complaints_;
};

/// The forces of a recording [N].
std::vector<double> forcesOf(const std::filesystem::path& folder)
{
    std::vector<double> forces;
    for (const TickRecord& record : readSession(folder).records) forces.push_back(glm::length(record.force));
    return forces;
}

TEST_F(WorkbenchTest, EscapeLetsGoOfADeviceAndNeverQuits)
{
    takeHand();
    wait("a force", [this] { return hand_.last > 0.05; });
    press(kEscapeKey);
    wait("no force", [this] { return hand_.last == 0; });
    rest(0.3);
    step("still there", [this](WindowInput&) { EXPECT_EQ(hand_.last, 0) << "until R"; });
    press('R');
    wait("a force again", [this] { return hand_.last > 0.05; });
    press(kEscapeKey);
    press(kEscapeKey);
    const int pictures = 3;
    int       then     = 0;
    step("nothing", [&](WindowInput&) { then = screen_.pictures; });
    press(kF1Key);
    wait("more pictures", [&] { return screen_.pictures > then + pictures; });
    run();

    EXPECT_EQ(hand_.last, 0);
    EXPECT_TRUE(screen_.said_("let go")) << screen_.notes;
}

TEST_F(WorkbenchTest, AfterAFaultOfTheGovernorThereIsAForceAgainByR)
{
    takeHand();
    wait("a force", [this] { return hand_.last > 0.05; });
    step("a fast hand", [this](WindowInput&) { hand_.hurries = true; });
    wait("no force", [this] { return hand_.last == 0; });
    wait("why", [this] { return screen_.said_("The hand moved faster than 1.2 m/s. Hold it still"); });
    press(kF7Key); // has a message
    rest(0.3);
    step("still why", [this](WindowInput&) {
        EXPECT_TRUE(screen_.said.starts_with("no force: The hand moved faster")) << screen_.said;
    });
    step("a slow one", [this](WindowInput&) { hand_.hurries = false; });
    rest(0.5);
    step("it stays off", [this](WindowInput&) { EXPECT_EQ(hand_.last, 0); });
    press('R');
    wait("a force again", [this] { return hand_.last > 0.05; });
    run();

    EXPECT_TRUE(screen_.said_("R starts anew")) << screen_.notes;
}

TEST_F(WorkbenchTest, ClosingWhileADevicePressesEndsInZeroForce)
{
    takeHand();
    wait("a force", [this] { return hand_.last > 0.05; });
    run();

    EXPECT_EQ(hand_.last, 0);
}

TEST_F(WorkbenchTest, EverySessionBeginsWithoutAForce)
{
    takeHand();
    wait("a force", [this] { return hand_.last > 0.05; });
    drop("sample:palm");
    wait("a force", [this] { return screen_.points != 2000 && hand_.last > 0.05; });
    run();

    EXPECT_EQ(hand_.first, 0) << "although the hand was inside of the object before";
    EXPECT_GT(hand_.most, 0.05);
}

/// The side that a session's hand is on is not forgotten by the next: what presses from above goes on doing so.
TEST_F(WorkbenchTest, ASessionThatBeginsWhileADevicePressesGoesOnFromItsTool)
{
    settings_.hand = [this](const Stage& stage, const HandWait&) {
        const auto [point, outward] = stage.place();
        return WorkbenchHand{&hand_, deviceFrame(point, outward), 1e9, point + 10e-3 * outward};
    };
    record();
    wait("a force", [this] { return hand_.last > 0.05; });
    step("it stays", [this](WindowInput&) { hand_.stays = true; });
    press(kF5Key);
    rest(0.3);
    press(kF5Key);
    rest(0.2);
    run();

    const RecordedSession session = readSession("session-0001");
    ASSERT_TRUE(session.from);
    EXPECT_LT(glm::length(*session.from), 5e-3) << "where the tool was, not 10 mm above";
    EXPECT_LT(session.records.front().hip.z, -1e-3) << "the hand is inside from the first tick on";
    for (const TickRecord& record : session.records) ASSERT_GT(record.proxy.z, -0.1e-3) << record.time;
}

TEST_F(WorkbenchTest, APointersRecordingBeginsWithoutAForceWhileItPresses)
{
    record();
    wait("the object", [this] { return screen_.points == 2000; });
    touch([this] { return sinceStep() > 0.5; });
    step("F5 while it presses", [](WindowInput& input) {
        input.touch = true;
        input.keys  = {{kF5Key, false, false}};
    });
    touch([this] { return sinceStep() > 1; });
    press(kF5Key);
    rest(0.2);
    run();

    const std::vector<double> forces = forcesOf("session-0001");
    ASSERT_GT(forces.size(), 500U);
    EXPECT_EQ(forces.front(), 0);
    EXPECT_GT(*std::ranges::max_element(forces), 0.05) << "it goes on pressing";
}

TEST_F(WorkbenchTest, AKeyMarksTheMomentOfARecording)
{
    record();
    wait("the object", [this] { return screen_.points == 2000; });
    press(kF7Key);
    press(kF5Key);
    touch([this] { return sinceStep() > 0.5; });
    press(kF7Key);
    rest(0.2);
    step("a datagram", [this](WindowInput&) { std::thread([this] { bench_->mark("left hand"); }).join(); });
    rest(0.1);
    press(kF5Key);
    rest(0.1);
    step("another", [this](WindowInput&) { bench_->mark("nobody records"); });
    run();

    EXPECT_TRUE(screen_.said_("nothing is recorded now"));
    EXPECT_TRUE(screen_.said_("marker 1 of this session"));
    const RecordedSession session = readSession("session-0001");
    ASSERT_EQ(session.markers.size(), 2U);
    EXPECT_EQ(session.markers[0].text, "F7");
    EXPECT_GT(session.markers[0].time, 0.4) << "of 0.5: the session begins some time after its key";
    EXPECT_EQ(session.markers[1].text, "left hand");
    EXPECT_GT(session.markers[1].time, session.markers[0].time);
    EXPECT_LT(session.markers[1].time, session.records.back().time);
}

TEST_F(WorkbenchTest, WhatWasRecordedIsReplayedAndThenThePointerIsBack)
{
    record();
    wait("the object", [this] { return screen_.points == 2000; });
    press(kF5Key);
    touch([this] { return sinceStep() > 0.5; });
    press(kF5Key);
    rest(0.1);
    press(kF6Key);
    rest(0.2);
    press(kF5Key); // refused: a replay runs
    wait("the end of the replay", [this] { return screen_.said_("the replay is over"); });
    press(kF5Key);
    rest(0.3);
    run();

    EXPECT_TRUE(std::filesystem::exists("session-0002")) << "a recording after the replay";
    EXPECT_FALSE(std::filesystem::exists("session-0003"));
    EXPECT_TRUE(screen_.said_("nothing can be recorded now"));
    EXPECT_EQ(complaints_, "");
}

TEST_F(WorkbenchTest, ARecordingThatStopsIsComplainedOfAtOnce)
{
    takeHand();
    record();
    wait("a force", [this] { return hand_.last > 0.05; });
    press(kF5Key);
    wait("rows", [] {
        std::error_code none;
        return std::filesystem::file_size("session-0001/ticks.npy", none) > 10'000 && !none;
    });
    step("another program cuts it", [](WindowInput&) { std::filesystem::resize_file("session-0001/ticks.npy", 0); });
    wait("a sentence", [this] { return complainedOf("ticks.npy: another program has cut it short"); });
    wait("a force", [this] { return hand_.last > 0.05; });
    const WorkbenchReport report = run();

    EXPECT_TRUE(report.hasLost);
    EXPECT_EQ(std::ranges::count(complaints_, '\n'), 1) << complaints_;
}

TEST_F(WorkbenchTest, PaintStaysFromSessionToSessionAndIsAskedForBeforeItIsLost)
{
    settings_.values["stiffness"] = kRamp;
    paint();
    press('B');
    drop("sample:palm");
    wait("a question", [this] { return complainedOf("what is painted is not saved"); });
    rest(0.3);
    step("it is still there", [this](WindowInput&) { EXPECT_EQ(screen_.points, 2000U); });
    press('S', true);
    wait("the paint as a file", [] { return std::filesystem::exists("sheet-painted-0001.ply"); });
    drop("sample:palm");
    wait("the palm", [this] { return screen_.points != 2000; });
    const WorkbenchReport report = run();

    EXPECT_EQ(report.said, "") << "nothing is left to be saved";
    const LoadedCloud painted = readCloud("sheet-painted-0001.ply", {});
    EXPECT_GT(std::ranges::max(painted.cloud.stiffness()), 1.01 * std::ranges::min(painted.cloud.stiffness()));
}

TEST_F(WorkbenchTest, PaintIsDiscardedByTheRequestThatWasWarnedOfAndByNoOther)
{
    settings_.values["stiffness"] = kRamp;
    const auto warned             = [this](const std::string& of) {
        return [=, this] { return complainedOf("asking again for " + of + " discards it"); };
    };
    const auto asksAgain = [&](const std::string& of) {
        rest(0.3);
        step("it is still there", [this](WindowInput&) {
            EXPECT_EQ(screen_.points, 2000U);
            complaints_.clear();
        });
        drop(of);
        wait("a question", warned(of));
    };
    paint();
    press('B');
    drop("sample:palm");
    wait("a question", warned("sample:palm"));
    asksAgain("sample:ellipsoid");
    press('R'); // leaves the warning
    asksAgain("sample:ellipsoid");
    step("other values", [this](WindowInput&) { bench_->change({{"thickness", "5 mm"}}); });
    asksAgain("sample:ellipsoid");
    drop("sample:ellipsoid");
    wait("the ellipsoid", [this] { return screen_.points != 2000; });
    run();
}

TEST_F(WorkbenchTest, TheBrushsRimIsNotTakenForThePatchs)
{
    wait("the object", [this] { return screen_.points == 2000; });
    press('B');
    wait("the brush", [this] { return screen_.brush; });
    step("no patch", [this](WindowInput&) { EXPECT_FALSE(screen_.patch); });
    press('B');
    wait("no brush", [this] { return !screen_.brush; });
    run();
}

TEST_F(WorkbenchTest, ARecordingEndsWhereAStrokeIsPaintedAgain)
{
    settings_.values["stiffness"] = kRamp;
    record();
    paint();
    press('B');
    press('Z', true);
    press(kF5Key);
    wait("a recording", [this] { return screen_.said_("recording session-0001"); });
    press('Y', true);
    wait("its end", [this] { return screen_.said_("the recording has ended, because its object is being painted"); });
    run();
    EXPECT_TRUE(readSession("session-0001").finished);
}

TEST_F(WorkbenchTest, TheBrushShowsOnACloudOfOneStiffness)
{
    settings_.values["stiffness"] = "constant:value=1e5";
    paint();
    rest(0.1);
    const WorkbenchReport report = run();

    ASSERT_TRUE(holds(report.said, {"saved", "sheet-painted-0001.ply"})) << report.said;
    EXPECT_GT(std::ranges::max(readCloud("sheet-painted-0001.ply", {}).cloud.stiffness()), 1.5e5);
}

TEST_F(WorkbenchTest, PaintThatIsUndoneIsNotSaved)
{
    settings_.values["stiffness"] = kRamp;
    paint();
    press('B');
    press('Z', true);
    press('S', true);
    wait("words", [this] { return screen_.said_("nothing is to be saved"); });
    EXPECT_EQ(run().said, "");
    EXPECT_FALSE(std::filesystem::exists("sheet-painted-0001.ply"));
}

TEST_F(WorkbenchTest, WhatIsSavedIsNotSavedAgainBecauseNothingCouldBeRedone)
{
    settings_.values["stiffness"] = kRamp;
    paint();
    press('B');
    press('S', true);
    wait("the paint as a file", [] { return std::filesystem::exists("sheet-painted-0001.ply"); });
    press('Y', true);
    EXPECT_EQ(run().said, "");
    EXPECT_FALSE(std::filesystem::exists("sheet-painted-0002.ply"));
}

TEST_F(WorkbenchTest, PaintThatNobodySavedIsSavedWhenTheWindowCloses)
{
    settings_.values["stiffness"] = kRamp;
    paint();
    rest(0.1);
    const WorkbenchReport report = run();

    EXPECT_TRUE(holds(report.said, {"saved", "sheet-painted-0001.ply"})) << report.said;
    EXPECT_TRUE(std::filesystem::exists("sheet-painted-0001.ply"));
    EXPECT_FALSE(report.hasLost);
}

/// A variable of the environment, for a time.
class Variable {
public:
    Variable(const char* name, const std::filesystem::path& value) : name_(name)
    {
        if (const char* const was = std::getenv(name)) before_ = was;
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
    Variable(const Variable&)            = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char*                name_;
    std::optional<std::string> before_;
};

TEST_F(WorkbenchTest, PaintIsSavedElsewhereWhereThisFolderIsGone)
{
    const auto home = folder_ / "home", here = folder_ / "here";
    for (const auto& folder : {home, here}) std::filesystem::create_directory(folder);
    std::filesystem::current_path(here);
    const Variable atHome("HOME", home);
    settings_.values["stiffness"] = kRamp;
    paint();
    step("its folder goes", [&](WindowInput&) { std::filesystem::remove(here); });
    const WorkbenchReport report = run();

    EXPECT_TRUE(holds(report.said, {"saved", "home/sheet-painted-0001.ply"})) << report.said;
    EXPECT_TRUE(std::filesystem::exists(home / "sheet-painted-0001.ply"));
    EXPECT_TRUE(complainedOf("sheet-painted-0001.ply: cannot be")) << complaints_;
    EXPECT_FALSE(report.hasLost);
}

TEST_F(WorkbenchTest, PaintThatCannotBeSavedAnywhereIsReportedAsLost)
{
    const auto here = folder_ / "here";
    std::filesystem::create_directory(here);
    std::filesystem::current_path(here);
    const Variable home("HOME", here), temporary("TMPDIR", here);
    settings_.values["stiffness"] = kRamp;
    paint();
    step("its folder goes", [&](WindowInput&) { std::filesystem::remove(here); });
    const WorkbenchReport report = run();

    EXPECT_EQ(report.said, "");
    EXPECT_TRUE(report.hasLost);
    EXPECT_TRUE(complainedOf("sheet-painted-0001.ply: cannot be")) << complaints_;
}

TEST_F(WorkbenchTest, PaintIsSavedWhenTheScreenIsLost)
{
    settings_.values["stiffness"] = kRamp;
    paint();
    rest(0.1);
    step("the screen goes", [this](WindowInput& input) {
        screen_.isLost = true;
        input.moved    = {3, 3};
    });
    rest(1);

    EXPECT_TRUE(holds(refusalOf([this] { static_cast<void>(run()); }), {"the screen is lost"}));
    EXPECT_TRUE(std::filesystem::exists("sheet-painted-0001.ply"));
    EXPECT_TRUE(complainedOf("saved sheet-painted-0001.ply")) << complaints_;
}

TEST_F(WorkbenchTest, PaintOfAFileThatIsGoneIsSavedWithItsPoints)
{
    settings_.values = {{"cells", "32"}};
    settings_.what   = "scan.ply";
    writeCloud("scan.ply", loadCloud(sceneOf("sample:sheet", {{"points", "2000"}, {"stiffness", kRamp}})).cloud);
    paint();
    step("its disk is pulled out", [](WindowInput&) { std::filesystem::remove("scan.ply"); });
    rest(0.1);
    const WorkbenchReport report = run();

    EXPECT_FALSE(report.hasLost);
    EXPECT_EQ(readCloud("scan-painted-0001.ply", {}).cloud.size(), 2000U);
    EXPECT_TRUE(complainedOf("scan.ply has changed or gone")) << complaints_;
}

TEST_F(WorkbenchTest, AFolderThatCannotBeAskedIsOneSentence)
{
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(unusedPath(std::string(300, 'a'), ".ply")); }),
                      {"...aaa", "-0001.ply: cannot be read: File name too long"}));
}

TEST_F(WorkbenchTest, ASavedObjectKeepsItsProperties)
{
    const LoadedCloud         sheet = loadCloud(sceneOf("sample:sheet", {{"points", "2000"}}));
    const std::vector<double> held(sheet.cloud.size(), 0.25);
    const NamedField          field{"held", "1", held};
    writeCloud("part.pcd", sheet.cloud, {&field, 1});
    savePainted("part.pcd");

    EXPECT_EQ(readCloud("part-painted-0001.ply", {}).held, held);
}

TEST_F(WorkbenchTest, ASavedObjectKeepsItsFaces)
{
    const LoadedCloud sheet = loadCloud(sceneOf("sample:sheet", {{"points", "2000"}}));
    std::ofstream     file("part.obj");
    for (const glm::dvec3& p : sheet.cloud.positions()) file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    file << "f 1 2 3\n";
    file.close();
    settings_.values = {{"scatter", "off"}, {"length_unit", "m"}};
    savePainted("part.obj");

    EXPECT_EQ(readCloud("part-painted-0001.ply", {}).faces.size(), 1U);
}

TEST_F(WorkbenchTest, FilesThatCannotBeOpenedAreOneSentenceAndTheObjectStays)
{
    takeHand();
    settings_.open = [](const std::string& what, const SceneValues& values) {
        return what.starts_with("sample:") ? sceneOf(what, values) : throw Error(what + ": expected a cloud");
    };
    wait("the object", [this] { return screen_.points == 2000; });
    drop("bad.ply");
    wait("a sentence", [this] { return complainedOf("bad.ply: expected a cloud"); });
    std::filesystem::create_directory("empty");
    drop("empty");
    wait("a sentence", [this] { return complainedOf("empty"); });
    wait("a force", [this] { return hand_.last > 0.05; });
    run();

    EXPECT_EQ(std::ranges::count(complaints_, '\n'), 2) << complaints_;
    EXPECT_EQ(screen_.points, 2000U);
}

TEST_F(WorkbenchTest, AValueThatASceneDoesNotTakeIsExplainedAndTheSessionGoesOn)
{
    takeHand();
    wait("a force", [this] { return hand_.last > 0.05; });
    step("too thick", [this](WindowInput&) { bench_->change({{"thickness", "9 km"}}); });
    wait("a sentence", [this] { return complainedOf("thickness"); });
    wait("a force", [this] { return hand_.last > 0.05; });
    step("a law that is none", [this](WindowInput&) { bench_->change({{"stiffness", "steep"}}); });
    wait("a sentence", [this] { return complainedOf("steep"); });
    wait("a force", [this] { return hand_.last > 0.05; });
    run();

    EXPECT_TRUE(holds(complaints_, {"9 km", "1e-6 to 1 m", "such as 4 mm"}))
        << "found, expected, remedy: " << complaints_;
}

TEST_F(WorkbenchTest, AValueThatIsRefusedEndsNoRecording)
{
    record();
    wait("the object", [this] { return screen_.points == 2000; });
    press(kF5Key);
    wait("a recording", [] { return std::filesystem::exists("session-0001"); });
    step("too thick", [this](WindowInput&) { bench_->change({{"thickness", "9 km"}}); });
    wait("a sentence", [this] { return complainedOf("thickness"); });
    rest(0.3);
    press(kF5Key);
    rest(0.3);
    run();

    EXPECT_TRUE(screen_.said_("recorded session-0001"));
    EXPECT_FALSE(std::filesystem::exists("session-0002")) << "F5 would begin another, if the first had ended";
}

TEST_F(WorkbenchTest, OnlyAHuntHasNoWelcome)
{
    class NothingHidden final : public CloudOverlay {
    public:
        PointCloud                over(const PointCloud& cloud, const Scene&) const override { return cloud; }
        std::vector<BuriedNodule> below(const PointCloud&, const Scene&) const override { return {}; }
    };
    settings_.welcome = "welcome";
    for (const bool hunts : {false, true}) {
        screen_.notes  = "";
        screen_.points = 0;
        settings_.open = [hunts](const std::string& what, const SceneValues& values) {
            Scene scene = sceneOf(what, values);
            if (hunts) scene.overlay = std::make_shared<const NothingHidden>();
            return scene;
        };
        wait("the object", [this] { return screen_.points == 2000; });
        rest(0.1);
        run();
        EXPECT_EQ(screen_.said_("welcome"), !hunts);
    }
}

TEST_F(WorkbenchTest, ColoursReachAsFarAsTheTheoryIsTrusted)
{
    settings_.values["thickness"] = "2 mm";
    wait("half the thickness", [this] { return std::abs(screen_.end - 1e-3) < 1e-9; });
    step("large dents", [this](WindowInput&) { bench_->change({{"large", "on"}}); });
    wait("two thicknesses", [this] { return std::abs(screen_.end - 4e-3) < 1e-9; });
    run();
}

TEST_F(WorkbenchTest, ALawGoesBackToTheCloudsOwn)
{
    settings_.what = "sample:skin";
    std::string now;
    settings_.recorded = [&](const Stage& stage, const HapticDevice& device) {
        now = stage.report().stiffnessSource;
        SessionInfo info;
        info.scene = stage.scene();
        info.hand  = device.info();
        return info;
    };
    wait("the object", [this] { return screen_.points == 2000; });
    step("a law", [this](WindowInput&) { bench_->change({{"stiffness", "constant:value=1e5"}}); });
    rest(0.5);
    press(kF5Key);
    wait("the law", [&] { return now == "the scene's law [Pa]"; });
    press(kF5Key);
    step("none", [this](WindowInput&) { bench_->change({{"stiffness", "own"}}); });
    rest(0.5);
    press(kF5Key);
    wait("the cloud's own", [&] { return now == "the sample's own law [Pa]"; });
    run();

    EXPECT_EQ(complaints_, "");
}

TEST_F(WorkbenchTest, WhatCannotBeOpenedAtFirstIsThrown)
{
    settings_.what = "sample:nothing";
    EXPECT_NE(refusalOf([this] { run(); }), "");
}

TEST_F(WorkbenchTest, WhileSomethingLargeIsOpenedTheWindowSaysSoAndLives)
{
    std::atomic<bool> opened = false;
    settings_.open           = [&](const std::string& what, const SceneValues& values) {
        while (what != "sample:sheet" && !opened && !inVain_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return sceneOf(what, values);
    };
    wait("the object", [this] { return screen_.points == 2000; });
    int then = 0;
    step("a drop", [&](WindowInput& input) {
        input.dropped = {"sample:palm"};
        then          = screen_.pictures;
    });
    wait("words", [this] { return screen_.said == "opening sample:palm ..."; });
    wait("pictures", [&] { return screen_.pictures > then + 5; });
    step("it is there", [&](WindowInput&) { opened = true; });
    wait("the palm", [this] { return screen_.points != 2000; });
    run();

    EXPECT_EQ(complaints_, "");
}

TEST_F(WorkbenchTest, NothingIsPaintedOnAnObjectThatIsAboutToGo)
{
    settings_.values["stiffness"] = kRamp;
    std::atomic<bool> fails       = false;
    settings_.open                = [&](const std::string& what, const SceneValues& values) {
        if (what == "sample:sheet") return sceneOf(what, values);
        while (!fails && !inVain_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        throw Error("it cannot be opened");
    };
    wait("the object", [this] { return screen_.points == 2000; });
    press('B');
    drop("other");
    wait("words", [this] { return screen_.said == "opening other ..."; });
    step("a dab", [](WindowInput& input) { input.left = true; });
    step("it fails, so that the old object and its paint can be looked at", [&](WindowInput&) { fails = true; });
    wait("a sentence", [this] { return complainedOf("it cannot be opened"); });
    EXPECT_EQ(run().said, "") << "or else: that paint was saved";
}

TEST_F(WorkbenchTest, WhoIsToHomeADeviceIsToldAndMayGiveUp)
{
    std::atomic<int> asked = 0, gaveUp = 0;
    settings_.hand = [&](const Stage& stage, const HandWait& wait) {
        if (++asked == 2) return WorkbenchHand{&hand_, deviceFrame(stage.place().point, stage.place().outward), 1e9};
        wait.tell("home it: pull the grip out");
        while (!wait.givenUp && !inVain_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++gaveUp;
        throw Error("homing was given up");
    };
    wait("advice", [this] { return screen_.said_("home it: pull the grip out"); });
    press(kEscapeKey);
    wait("giving up", [&] { return gaveUp == 1; });
    rest(0.2);
    press('R');
    wait("a force", [this] { return hand_.last > 0.05; });
    run();

    EXPECT_EQ(complaints_, "") << "who lets go knows";
    EXPECT_EQ(asked, 2);
}

TEST_F(WorkbenchTest, ClosingWhileADeviceIsToBeHomedEnds)
{
    settings_.hand = [&](const Stage&, const HandWait& wait) -> WorkbenchHand {
        wait.tell("home it");
        while (!wait.givenUp && !inVain_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        throw Error("homing was given up");
    };
    wait("advice", [this] { return screen_.said_("home it"); });
    run(); // and does not throw
}

TEST_F(WorkbenchTest, AHandThatIsNotThereIsThrownBeforeTheFirstSession)
{
    settings_.hand = [](const Stage&, const HandWait&) -> WorkbenchHand { throw Error("there is no such device"); };
    wait("the end", [] { return false; });
    EXPECT_EQ(refusalOf([this] { run(); }), "there is no such device");
}

TEST_F(WorkbenchTest, TheFirstViewHasAllOfTheObject)
{
    wait("the object", [this] { return screen_.points == 2000; });
    run();

    const Camera first = screen_.camera;
    const Stage  stage(sceneOf("sample:sheet", settings_.values));
    for (const glm::dvec3& point : stage.object().positions()) {
        const CameraMatrices matrices = matricesOf(first, {}, 1, double(kSize.x) / kSize.y);
        const glm::dvec4     clip     = matrices.clipFromView * (matrices.viewFromWorld * glm::dvec4(point, 1));
        ASSERT_LT(std::abs(clip.x / clip.w), 1);
        ASSERT_LT(std::abs(clip.y / clip.w), 1);
    }
}

} // namespace
} // namespace palp
