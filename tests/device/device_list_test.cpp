#include "device/device_list.h"

#include <gtest/gtest.h>

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

TEST(DeviceList, WithoutHardwareThereAreThoseThatNeedNone)
{
    FakeHidSystem                    hid;
    const std::vector<DeviceListing> devices = listDevices(hid);
    ASSERT_EQ(devices.size(), 3U);
    EXPECT_EQ(devices[0].name, "mouse");
    EXPECT_EQ(devices[1].name, "arm");
    for (const DeviceListing& device : devices) EXPECT_TRUE(device.usable && device.why.empty());
}

TEST(DeviceList, HoldsWhatADriverKnows)
{
    FakeHidSystem  hid;
    FakeHidDevice& mouse = hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 1, 8));
    hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 0, 0));       // the same once more, usage unknown
    hid.plug(listing("/dev/hidraw2", 0x256f, 0xc650, 1, 2));       // a CadMouse
    hid.plug(listing("/dev/hidraw3", 0x1209, 0x0001, 0xFF00, 80)); // a bridge
    hid.plug(listing("/dev/hidraw4", 0x1209, 0x0001, 0xFF00, 1));  // something else of that page

    const std::vector<DeviceListing> devices = listDevices(hid);
    ASSERT_EQ(devices.size(), 5U);
    EXPECT_EQ(devices[0].name, "spacemouse");
    EXPECT_EQ(devices[0].model, "SpaceMouse Compact");
    EXPECT_EQ(devices[0].path, "/dev/hidraw1");
    EXPECT_TRUE(devices[0].usable);
    EXPECT_EQ(devices[1].name, "bridge");
    EXPECT_EQ(devices[1].model, "by its own name");
    EXPECT_EQ(mouse.openPorts(), 0) << "let go again";
}

TEST(DeviceList, SaysWhyADeviceCannotBeUsed)
{
    FakeHidSystem hid;
    hid.plug(listing("/dev/hidraw1", 0x256f, 0xc635, 1, 8)).refusal = "no permission";
    const DeviceListing device                                      = listDevices(hid).at(0);
    EXPECT_FALSE(device.usable);
    EXPECT_EQ(device.why, "no permission");
    EXPECT_EQ(device.help, "the line that helps");
}

TEST(DeviceList, BeginsWithThoseFromElsewhere)
{
    FakeHidSystem                    hid;
    const std::vector<DeviceListing> devices =
        listDevices(hid, {{.name = "falcon", .model = "Novint Falcon", .path = "1-2", .why = "no permission"}});
    ASSERT_EQ(devices.size(), 4U);
    EXPECT_EQ(devices[0].name, "falcon");
    EXPECT_FALSE(devices[0].usable);
}

} // namespace
} // namespace palp
