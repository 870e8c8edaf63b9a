#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <new>

#include "engine/cloud/point_cloud_io.h"
#include "engine/session/deformation.h"
#include "engine/session/recorded_session.h"
#include "engine/session/stepped_session.h"
#include "tests/session/sessions.h"
#include "tests/session/sheet_session.h"
#include "tests/support/failing_memory.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// Lets the n-th allocation fail, and all after it, for every n up to the number that the act needs; large ones by
/// strides. The act may throw, and what it leaves must be sound: `check` runs with memory again.
/// \param most  tries
/// \return the number of tries that failed
int sweep(const std::function<void()>& act, const std::function<void()>& check, int most, std::size_t leastBytes = 0)
{
    int          failures = 0;
    std::int64_t n        = 0;
    for (int tries = 0; tries < most; ++tries) {
        bool failed = false;
        try {
            const FailingMemory memory(n, leastBytes);
            act();
            failed = FailingMemory::failed();
        } catch (const std::exception&) {
            failed = true; // a sentence, or bad_alloc
        }
        check();
        if (!failed) return failures;
        ++failures;
        n += 1 + n / 12; // each of the first ones, then ever fewer
    }
    ADD_FAILURE() << "the act still fails with " << n << " allocations";
    return failures;
}

/// Allocations of JSON in its destructor end the program if they fail: nlohmann's json destroys its children by a list
/// of its own, 16 bytes each. Those of sessions and scenes are smaller than this; what is larger is swept.
constexpr std::size_t kAboveJson = 65536; // [bytes]

Scene smallScene()
{
    Scene scene  = sheetScene(kWart);
    scene.points = 500;
    return scene;
}

TEST(MemoryFaults, AnObjectIsLoadedOrRefused)
{
    Scene scene  = smallScene();
    scene.points = 20000; // so that its arrays are larger than what is left out
    EXPECT_GT(sweep([&] { static_cast<void>(loadObject(scene)); }, [] {}, 200, kAboveJson), 10);
}

TEST(MemoryFaults, PointsBecomeAnObjectOrAreRefused)
{
    const PointCloud cloud = loadObject(smallScene()).object.cloud();
    EXPECT_GT(sweep([&] { const SoftObject object(cloud); }, [] {}, 400), 10);
}

TEST(MemoryFaults, FilesOfPointsAreReadOrRefused)
{
    const TemporaryFolder folder;
    const SoftObject      object = loadObject(smallScene()).object;
    for (const char* const name : {"a.ply", "a.pcd", "a.csv"}) {
        writeCloud(folder / name, object.cloud(), {}, {});
        EXPECT_GT(sweep([&] { static_cast<void>(readCloud(folder / name)); }, [] {}, 300), 10) << name;
    }
}

TEST(MemoryFaults, AFileIsWrittenWholeOrNotAtAll)
{
    const TemporaryFolder folder;
    const SoftObject      object = loadObject(smallScene()).object;
    const std::string     old    = contentsOf(folder.write("a.ply", "what was there before"));
    writeCloud(folder / "whole.ply", object.cloud(), {}, {});
    const std::string whole = contentsOf(folder / "whole.ply");
    EXPECT_GT(sweep([&] { writeCloud(folder / "a.ply", object.cloud(), {}, {}); },
                    [&] {
                        const std::string found = contentsOf(folder / "a.ply");
                        EXPECT_TRUE(found == old || found == whole) << found.size() << " bytes of " << whole.size();
                    },
                    300),
              3);
}

TEST(MemoryFaults, ASolverStartsOrRefuses)
{
    const SheetSession session(smallScene());
    EXPECT_GT(sweep([&] { const Deformation deformation(session.object, session.scene); }, [] {}, 300), 20);
}

/// A session in real time goes on with the solver whose last solve threw.
TEST(MemoryFaults, AFailedSolveLeavesTheSolverSound)
{
    const SheetSession session(smallScene());
    Deformation        deformation(session.object, session.scene), whole(session.object, session.scene);
    Touch              touch;
    touch.sequence      = 1;
    touch.touching      = true;
    touch.point         = handPlace(session.scene, session.object).point;
    touch.outward       = {0, 0, 1};
    const auto expected = whole.solve(touch, 0.01).update;
    ASSERT_NE(expected, nullptr);
    EXPECT_GT(sweep([&] { static_cast<void>(deformation.solve(touch, 0.01)); },
                    [&] {
                        const auto found = deformation.solve(touch, 0.01).update;
                        ASSERT_NE(found, nullptr);
                        EXPECT_EQ(std::memcmp(&found->table.compliance, &expected->table.compliance,
                                              sizeof found->table.compliance),
                                  0);
                        EXPECT_EQ(found->rigidity, expected->rigidity);
                    },
                    400),
              20);
}

TEST(MemoryFaults, ARecordingIsReadOrRefused)
{
    const TemporaryFolder folder;
    {
        Recording recording(folder / "run", someInfo());
        for (int n = 0; n < 1000; ++n) recording.pushWaiting(recordNumber(n));
        recording.mark({0.05, "here"});
    }
    EXPECT_GT(sweep([&] { static_cast<void>(readSession(folder / "run")); }, [] {}, 300, kAboveJson), 0);
}

TEST(MemoryFaults, ASteppedSessionStartsOrRefuses)
{
    const SheetSession session(smallScene());
    EXPECT_GT(sweep([&] { const SteppedSession stepped(session.object, session.scene, {}); }, [] {}, 300), 20);
}

} // namespace
} // namespace palp
