// Tests of the adapter on hidapi, against a stand-in for the library, see hidapi_fake.cpp.
#include "device/hid/hidapi_system.h"

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "device/hid/bridge_report.h"
#include "tests/device/hidapi_fake.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class Hidapi : public testing::Test {
protected:
    Hidapi()
    {
        fake.starts  = true;
        fake.devices = {{"/dev/hidraw3", 0x256f, 0xc635, 1, 8, L"SpaceMouse Compact"},
                        {"/dev/hidraw4", 1, 2, 3, 4, L""}};
        fake.openError.clear();
        fake.broken = false;
        fake.report.clear();
        fake.written.clear();
        fake.opened = 0;
    }
    ~Hidapi() override
    {
        EXPECT_EQ(fake.ports, 0) << "every port is closed";
        EXPECT_EQ(fake.entries, 0) << "every listing is freed";
    }

    HidapiFake&  fake = hidapiFake();
    HidapiSystem system;
};

TEST_F(Hidapi, ListsWhatTheSystemHas)
{
    const std::vector<HidListing> list = system.list();

    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].path, "/dev/hidraw3");
    EXPECT_EQ(list[0].vendor, 0x256f);
    EXPECT_EQ(list[0].product, 0xc635);
    EXPECT_EQ(list[0].usagePage, 1);
    EXPECT_EQ(list[0].usage, 8);
    EXPECT_EQ(list[0].model, "SpaceMouse Compact");
    EXPECT_EQ(list[0].manufacturer, "") << "a text that the system does not have";
    EXPECT_EQ(list[1].model, "");
    EXPECT_EQ(hidSupport(), "hidapi 0.13.1 (fake)");
}

TEST_F(Hidapi, TextsBecomeUtf8)
{
    fake.devices = {{"/dev/hidraw0", 1, 2, 3, 4, L"a\u00e9\u20ac\U0001F600" + std::wstring(1, wchar_t(0xD800))}};
    EXPECT_EQ(system.list().at(0).model, "a\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80\xEF\xBF\xBD");
}

TEST_F(Hidapi, OpensOnlyWhatTheLastListNamed)
{
    EXPECT_THROW(static_cast<void>(system.open("/dev/hidraw3")), HidRefused) << "nothing was listed yet";
    static_cast<void>(system.list());
    EXPECT_THROW(static_cast<void>(system.open("/dev/null")), HidRefused);
    EXPECT_EQ(fake.opened, 0) << "hidapi never saw these paths";

    EXPECT_TRUE(system.open("/dev/hidraw3"));
    EXPECT_EQ(fake.opened, 1);

    fake.devices.clear();
    static_cast<void>(system.list());
    EXPECT_THROW(static_cast<void>(system.open("/dev/hidraw3")), HidRefused) << "it is gone from the list";
    EXPECT_EQ(fake.opened, 1);
}

TEST_F(Hidapi, AMissingPermissionComesWithTheLineThatHelps)
{
    static_cast<void>(system.list());
    fake.openError = L"Failed to open a device with path '/dev/hidraw3': Permission denied";
    try {
        static_cast<void>(system.open("/dev/hidraw3"));
        FAIL() << "was opened";
    } catch (const HidRefused& refused) {
        EXPECT_NE(refused.why.find("SpaceMouse Compact (/dev/hidraw3)"), std::string::npos) << refused.why;
        EXPECT_NE(refused.why.find("Permission denied"), std::string::npos) << refused.why;
        EXPECT_NE(refused.help.find(R"(KERNELS=="*:256F:C635.*", TAG+="uaccess")"), std::string::npos) << refused.help;
        EXPECT_EQ(std::string(refused.what()), refused.why + "; " + refused.help);
    }

    fake.openError = L"No such file or directory";
    try {
        static_cast<void>(system.open("/dev/hidraw4"));
        FAIL() << "was opened";
    } catch (const HidRefused& refused) {
        EXPECT_EQ(refused.help.find("udev"), std::string::npos) << "rights are not what is missing: " << refused.help;
    }
}

TEST_F(Hidapi, ReadsAndWritesReports)
{
    static_cast<void>(system.list());
    const auto                  port = system.open("/dev/hidraw3");
    std::array<std::uint8_t, 8> report{};
    fake.report = {3, 1, 0};

    EXPECT_EQ(port->read(report, 0.0011), 3U);
    EXPECT_EQ(report[0], 3);
    EXPECT_EQ(fake.waited, 2) << "ms, rounded up: a short wait is not none";
    EXPECT_EQ(port->read(report, 0), 3U);
    EXPECT_EQ(fake.waited, 0);
    for (double odd : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(port->read(report, odd), 3U);
        EXPECT_EQ(fake.waited, 0) << "never -1, which waits for ever";
    }
    port->write(std::array<std::uint8_t, 2>{4, 1});
    EXPECT_EQ(fake.written, (std::vector<std::uint8_t>{4, 1}));
}

TEST_F(Hidapi, ADeviceThatWentAwayIsLost)
{
    static_cast<void>(system.list());
    const auto                  port = system.open("/dev/hidraw3");
    std::array<std::uint8_t, 8> report{};
    fake.broken = true;

    EXPECT_THROW(static_cast<void>(port->read(report, 0)), HidLost);
    EXPECT_THROW(port->write(report), HidLost);
}

TEST_F(Hidapi, AnHidapiThatDoesNotStartIsAnError)
{
    fake.starts = false;
    EXPECT_THROW(static_cast<void>(system.list()), Error);
}

TEST_F(Hidapi, SystemsOnSeveralThreadsTakeTurns)
{
    fake.openError         = L"Permission denied"; // each failure writes and reads the library's global text
    const auto listAndOpen = [] {
        HidapiSystem own;
        for (int n = 0; n < 200; ++n) {
            static_cast<void>(own.list());
            EXPECT_THROW(static_cast<void>(own.open("/dev/hidraw3")), HidRefused);
        }
    };
    std::thread other(listAndOpen);
    listAndOpen();
    other.join();
    EXPECT_EQ(fake.opened, 400);
}

TEST_F(Hidapi, APortWhoseProgramFallsSilentIsTakenOverThroughADescriptorOfItsOwn)
{
    const std::string path = testing::TempDir() + "palpate_hidapi_test";
    std::ofstream(path).close(); // in place of a node: the guardian's zero arrives in it
    fake.devices     = {{path, 1, 2, 3, 4, L""}};
    const auto list  = system.list();
    const auto port  = system.open(path);
    const auto bytes = [&](const BridgeBytes& report) { return std::vector(report.begin(), report.end()); };
    port->guard(kBridgeZero);
    const auto second = system.open(path);
    EXPECT_TRUE(
        holds(refusalOf([&] { second->guard(kBridgeZero); }), {path, "is driven by another program", "end that"}));

    BridgeCommand push{.sequence = 7, .enable = true, .force = {1, 2, 3}, .watchdog = 0.02, .lights = 2};
    port->write(encode(push));
    EXPECT_EQ(fake.written, bytes(encode(push)));
    std::vector<std::uint8_t> got(kBridgeSize);
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
         std::filesystem::file_size(path) < kBridgeSize && std::chrono::steady_clock::now() < end;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(got.data()), std::streamsize(got.size()));
    BridgeCommand zero;
    ASSERT_EQ(decode(got, zero), BridgeVerdict::good);
    EXPECT_FALSE(zero.enable);
    EXPECT_EQ(zero.sequence, 7 + kBridgeZeroAhead) << "what the program still sends is old";
    EXPECT_EQ(zero.lights, 2);

    ++push.sequence;
    port->write(encode(push));
    ASSERT_EQ(decode(fake.written, zero), BridgeVerdict::good);
    EXPECT_FALSE(zero.enable) << "zero comes first";
    EXPECT_TRUE(port->wasSilenced());
    std::filesystem::remove(path);
}

} // namespace
} // namespace palp
