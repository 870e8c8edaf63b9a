// Tests of listing and opening Falcons by libusb, against a stand-in for the library.
#include <chrono>
#include <string>

#include "device/falcon/detail/libusb_link.h"
#include "tests/device/falcon_usb_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// What firmware says to each packet, as the chip passes it on.
std::vector<unsigned char> answerOf(const FalconReply& reply)
{
    std::vector<unsigned char> sent{0x01, 0x60};
    for (const std::uint8_t byte : encode(reply)) sent.push_back(byte);
    return sent;
}

TEST_F(FalconUsb, ListsFalconsByTheirPlacesAndNothingElse)
{
    falcon_->answer    = answerOf({.homedLegs = 7});
    plugIn(3)->product = 0x6001; // a serial cable
    const auto deep    = plugIn(4);
    deep->bus          = 3;
    deep->ports        = {4, 1, 7};

    const auto listings = listFalcons();

    ASSERT_EQ(listings.size(), 2u);
    EXPECT_EQ(listings[0].path, "1-2");
    EXPECT_EQ(listings[1].path, "3-4.1.7");
    EXPECT_TRUE(listings[0].usable);
    EXPECT_EQ(listings[0].why + listings[0].help, "");
    EXPECT_EQ(falconSupport(), "libusb-1.0 1.0.26");
    EXPECT_TRUE(hasFalconSupport());
}

/// It names a file and stands in JSON, so it has no signs that those know.
TEST_F(FalconUsb, TheSerialNumberIsReadWithoutUnusualSigns)
{
    falcon_->serial = "FT\"1\\2\n 3\x80";
    EXPECT_EQ(listFalcons().at(0).serial, "FT123");
    EXPECT_EQ(openFalcon()->serial(), "FT123");
    falcon_->serial = std::string(200, 'x');
    EXPECT_EQ(openFalcon()->serial(), std::string(64, 'x'));
    falcon_->serial = "";
    EXPECT_EQ(openFalcon()->serial(), "");
}

TEST_F(FalconUsb, TheListingSaysWhatAFalconStillNeeds)
{
    using enum FalconReadiness;
    struct Case {
        std::vector<unsigned char> answer;
        FalconReadiness            readiness;
        const char *               why, *help;
    };
    for (const auto& [answer, readiness, why, help] :
         {Case{{}, noFirmware, "no firmware", "FALCON_FIRMWARE"},
          Case{{0x01, 0x60, 0x44, 0x2C}, noFirmware, "no firmware", "FALCON_FIRMWARE"}, // not what firmware says
          Case{answerOf({.homedLegs = 3}), notHomed, "not homed", "pull the grip out"},
          Case{answerOf({.homedLegs = 7}), ready, "", ""}}) {
        falcon_->answer = answer;
        falcon_->written.clear();
        falcon_->incoming.clear();

        const auto listings = listFalcons();

        ASSERT_EQ(listings.size(), 1u);
        EXPECT_EQ(listings[0].readiness, readiness) << why;
        EXPECT_TRUE(listings[0].usable) << why;
        EXPECT_TRUE(holds(listings[0].why, {why})) << listings[0].why;
        EXPECT_TRUE(holds(listings[0].help, {help})) << listings[0].help;
        EXPECT_EQ(listings[0].why.empty(), readiness == ready);
        EXPECT_EQ(listings[0].help.empty(), readiness == ready);
        EXPECT_FALSE(falcon_->written.empty());
        const FalconPacket zero = encode(FalconCommand{});
        for (const auto& packet : falcon_->written)
            EXPECT_EQ(packet, std::vector<unsigned char>(zero.begin(), zero.end())) << "no force, no lights";
        EXPECT_EQ(falcon_->claims, 0) << "let go again";
    }
}

TEST_F(FalconUsb, AFalconThatBreaksOffWhileItIsAskedIsNotUsable)
{
    falcon_->controlError = LIBUSB_ERROR_PIPE;

    const auto listings = listFalcons();

    ASSERT_EQ(listings.size(), 1u);
    EXPECT_FALSE(listings[0].usable);
    EXPECT_FALSE(listings[0].readiness.has_value());
    EXPECT_TRUE(holds(listings[0].why, {"cannot be asked", "1-2"})) << listings[0].why;
    EXPECT_TRUE(holds(listings[0].help, {"plug it in anew"}));
}

TEST_F(FalconUsb, WithoutPermissionTheListingGivesTheLineThatHelps)
{
    falcon_->openError = LIBUSB_ERROR_ACCESS;

    const auto listings = listFalcons();

    ASSERT_EQ(listings.size(), 1u);
    EXPECT_FALSE(listings[0].usable);
    EXPECT_TRUE(holds(listings[0].why, {"permission"})) << listings[0].why;
    EXPECT_TRUE(holds(listings[0].help, {"/etc/udev/rules.d", kFalconUdevLine})) << listings[0].help;
    const std::string refusal = refusalOf([] { static_cast<void>(openFalcon()); });
    EXPECT_TRUE(holds(refusal, {"1-2", "permission", kFalconUdevLine})) << refusal;
}

TEST_F(FalconUsb, TheInstalledRuleIsTheLineThatHelps)
{
    EXPECT_TRUE(holds(contentsOf(PALPATE_FALCON_RULES), {kFalconUdevLine}));
}

TEST_F(FalconUsb, AFalconThatIsOpenIsBusyUntilItIsClosed)
{
    auto link = openFalcon();
    EXPECT_TRUE(falcon_->autoDetach) << "a serial driver of the kernel must give way";

    EXPECT_TRUE(holds(listFalcons().at(0).why, {"open already"}));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(openFalcon("1-2")); }), {"1-2", "open already"}));
    link.reset();

    EXPECT_TRUE(listFalcons().at(0).usable);
}

TEST_F(FalconUsb, TheFirstUsableOneIsTakenUnlessAPathIsGiven)
{
    falcon_->openError = LIBUSB_ERROR_ACCESS;
    const auto second  = plugIn(5);

    static_cast<void>(openFalcon()->control(FtdiRequest::latencyTimer, 1));

    EXPECT_EQ(second->controls.size(), 1u);
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(openFalcon("1-2")); }), {"permission"}));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(openFalcon("9-9")); }), {"9-9", "1-2, 1-5"}));
    usb_.devices.clear();
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(openFalcon()); }), {"plugged in", "0403:cb48"}));
}

TEST_F(FalconUsb, WhenNothingStartsTheReasonIsGivenAndNothingIsLeft)
{
    const auto open = [] { static_cast<void>(openFalcon()); };
    usb_.initError  = LIBUSB_ERROR_OTHER;
    EXPECT_TRUE(holds(refusalOf(open), {"libusb does not start"}));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(listFalcons()); }), {"libusb does not start"}));
    usb_.initError = 0;
    usb_.listError = LIBUSB_ERROR_OTHER;
    EXPECT_TRUE(holds(refusalOf(open), {"cannot be listed"}));
    usb_.listError      = 0;
    falcon_->claimError = LIBUSB_ERROR_NO_DEVICE;
    EXPECT_TRUE(holds(refusalOf(open), {"NO_DEVICE"}));
    falcon_->claimError  = 0;
    falcon_->submitError = LIBUSB_ERROR_NO_DEVICE;
    EXPECT_TRUE(holds(refusalOf(open), {"NO_DEVICE", "plug it in anew"}));
}

} // namespace
} // namespace palp
