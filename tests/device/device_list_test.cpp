#include "device/device_record.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "device/falcon/emulated_falcon.h"
#include "device/falcon/falcon_calibration.h"
#include "device/falcon/falcon_record.h"
#include "device/hid/hid_records.h"
#include "device/mouse_device.h"
#include "tests/device/fake_hid.h"

namespace palp {
namespace {

HidListing listing(const char* path, int vendor, int product, int page, int usage)
{
    HidListing out;
    out.path      = path;
    out.vendor    = std::uint16_t(vendor);
    out.product   = std::uint16_t(product);
    out.usagePage = std::uint16_t(page);
    out.usage     = std::uint16_t(usage);
    out.model     = "by its own name";
    return out;
}

constexpr std::array kRecords{&kBridgeRecord, &kSpaceMouseRecord, &kMouseRecord};

TEST(DeviceList, WithoutHardwareThereAreThoseThatNeedNone)
{
    FakeHidSystem    hid;
    const DeviceList list = listDevices(kRecords, hid);
    ASSERT_EQ(list.devices.size(), 1U);
    EXPECT_EQ(list.devices[0].name, "mouse");
    EXPECT_EQ(list.devices[0].model, kMouseRecord.model);
    EXPECT_TRUE(list.devices[0].usable && list.devices[0].why.empty());
    EXPECT_TRUE(list.troubles.empty());
}

TEST(DeviceList, HoldsWhatADriverKnows)
{
    FakeHidSystem  hid;
    FakeHidDevice& mouse = hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 1, 8));
    hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 0, 0));       // the same once more, usage unknown
    hid.plug(listing("/dev/hidraw2", 0x256f, 0xc650, 1, 2));       // a CadMouse
    hid.plug(listing("/dev/hidraw3", 0x1209, 0x0001, 0xFF00, 80)); // a bridge
    hid.plug(listing("/dev/hidraw4", 0x1209, 0x0001, 0xFF00, 1));  // something else of that page

    const std::vector<DeviceListing> devices = listDevices(kRecords, hid).devices;
    ASSERT_EQ(devices.size(), 3U);
    EXPECT_EQ(devices[0].name, "bridge");
    EXPECT_EQ(devices[0].model, "by its own name");
    EXPECT_EQ(devices[1].name, "spacemouse");
    EXPECT_EQ(devices[1].model, "SpaceMouse Compact");
    EXPECT_EQ(devices[1].path, "/dev/hidraw1");
    EXPECT_TRUE(devices[1].usable);
    EXPECT_EQ(mouse.openPorts(), 0) << "let go again";
}

TEST(DeviceList, SaysWhatIsKnownOfASimulatedForce)
{
    FakeHidSystem                 hid;
    static constexpr DeviceRecord kSimulated{
        .name = "emulator", .model = "no device", .calibration = [] { return std::string("4200 counts"); }};
    const std::array records{&kSimulated, &kMouseRecord};
    const auto       devices = listDevices(records, hid).devices;
    EXPECT_EQ(devices.at(0).calibration, "4200 counts");
    EXPECT_EQ(devices.at(1).calibration, "");
}

TEST(DeviceList, WhereNobodyNamesOneTheFirstThatCanBeOpenedIsTaken)
{
    FakeHidSystem hid;
    hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 1, 8)).refusal = "no permission";
    EXPECT_EQ(kSpaceMouseRecord.make({.hid = hid})->info().path, "/dev/hidraw1") << "whose opening then says why not";
    FakeHidDevice& usable = hid.plug(listing("/dev/hidraw2", 0x256f, 0xc62e, 1, 8));
    EXPECT_EQ(kSpaceMouseRecord.make({.hid = hid})->info().path, "/dev/hidraw2");
    EXPECT_EQ(usable.openPorts(), 0) << "let go again";
    EXPECT_EQ(kSpaceMouseRecord.make({.hid = hid, .path = "/dev/hidraw1"})->info().path, "/dev/hidraw1");
}

TEST(DeviceList, SaysWhyADeviceCannotBeUsed)
{
    FakeHidSystem hid;
    hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 1, 8)).refusal = "no permission";
    const DeviceListing device                                      = listDevices(kRecords, hid).devices.at(0);
    EXPECT_FALSE(device.usable);
    EXPECT_EQ(device.why, "no permission");
    EXPECT_EQ(device.help, "the line that helps");
}

TEST(DeviceList, IsInTheOrderOfTheRecordsWhateverTheyFind)
{
    FakeHidSystem                 hid;
    static constexpr DeviceRecord kElsewhere{
        .name = "falcon", .model = "Novint Falcon", .list = [](HidSystem&) -> std::vector<DeviceListing> {
            return {{.path = "1-2", .why = "no permission"}};
        }};
    const std::array records{&kElsewhere, &kMouseRecord};
    const auto       devices = listDevices(records, hid).devices;
    ASSERT_EQ(devices.size(), 2U);
    EXPECT_EQ(devices[0].name, "falcon");
    EXPECT_EQ(devices[0].path, "1-2");
    EXPECT_FALSE(devices[0].usable);
}

/// Two kinds of device on one bus that does not work are one trouble; the others are listed all the same.
TEST(DeviceList, ABusThatDoesNotWorkIsOneTrouble)
{
    FakeHidSystem                 hid;
    static constexpr DeviceRecord kBroken{
        .name = "broken", .model = "no device", .list = [](HidSystem&) -> std::vector<DeviceListing> {
            throw Error("no bus");
        }};
    const std::array records{&kBroken, &kMouseRecord, &kBroken};
    const DeviceList list = listDevices(records, hid);
    EXPECT_EQ(list.devices.size(), 1U);
    EXPECT_EQ(list.troubles, std::vector<std::string>{"no bus"});
}

TEST(DeviceRecords, MakeWhatIsAtThePathThatIsAskedFor)
{
    FakeHidSystem hid;
    hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 1, 8));
    hid.plug(listing("/dev/hidraw2", 0x256f, 0xc635, 1, 8));
    EXPECT_EQ(kSpaceMouseRecord.make({.hid = hid, .path = "/dev/hidraw2"})->info().path, "/dev/hidraw2");
    EXPECT_EQ(kSpaceMouseRecord.make({.hid = hid})->info().path, "/dev/hidraw1");
    EXPECT_THROW((void)kSpaceMouseRecord.make({.hid = hid, .path = "/dev/hidraw3"}), Error);
    EXPECT_THROW((void)kBridgeRecord.make({.hid = hid}), Error) << "there is no bridge";
}

/// The option, the driver's setting, the motors and the calibration have one bound; each refuses in one sentence.
TEST(DeviceRecords, CountsPerTorqueHaveOneBoundAtEveryDoor)
{
    FakeHidSystem hid;
    const auto    refusal = [](const auto& door) -> std::string {
        try {
            door();
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(kFalconCounts.least, FalconMotors::kLeastCountsPerTorque);
    EXPECT_EQ(kFalconCounts.most, FalconMotors::kMostCountsPerTorque);
    for (const char* text : {"1", "1999", "10001", "50000", "-4200", "nan", "inf"}) {
        const double counts = std::strtod(text, nullptr);
        EXPECT_NE(refusal([&] {
                      (void)kFalconRecord.make({.hid = hid, .options = {{"--falcon-counts", text}}});
                  }),
                  "")
            << text;
        EXPECT_NE(refusal([&] { (void)FalconMotors(FalconKinematics{}, counts); }), "") << text;
        EXPECT_NE(refusal([&] { (void)FalconCalibration({.countsPerTorque = counts}); }), "") << text;
        EXPECT_NE(refusal([&] { (void)EmulatedFalcon({.countsPerTorque = counts}); }), "") << text;
    }
    for (const char* text : {"2000", "4200", "10000"}) {
        const double counts = std::strtod(text, nullptr);
        EXPECT_EQ(falconSettings({.hid = hid, .options = {{"--falcon-counts", text}}}).loop.countsPerTorque, counts);
        EXPECT_EQ(refusal([&] { (void)FalconMotors(FalconKinematics{}, counts); }), "") << text;
        EXPECT_EQ(refusal([&] { (void)FalconCalibration({.countsPerTorque = counts}); }), "") << text;
    }
    EXPECT_EQ(refusal([&] {
                  (void)kFalconRecord.make({.hid = hid, .options = {{"--falcon-counts", "50000"}}});
              }),
              "--falcon-counts: expected 2000 to 10000, found 50000");
}

} // namespace
} // namespace palp
