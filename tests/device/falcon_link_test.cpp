// Tests of this machine's own USB, with the real libusb or without any; no Falcon need be plugged in.
#include "device/falcon/detail/libusb_link.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

TEST(FalconLink, ThisBuildSaysWhatItCanDo)
{
    EXPECT_TRUE(holds(falconSupport(), {"libusb-1.0"})) << falconSupport();
    EXPECT_EQ(hasFalconSupport(), !holds(falconSupport(), {"without"})) << falconSupport();
}

TEST(FalconLink, APlaceWithoutAFalconIsRefusedInWords)
{
    const std::string refusal = refusalOf([] { static_cast<void>(openFalcon("no-such-place")); });
    EXPECT_TRUE(holds(refusal, {"Falcon", ";"}) || holds(refusal, {"USB cannot be used", ";"})) << refusal;
}

TEST(FalconLink, EveryFalconThatIsListedIsUsableOrSaysWhyNot)
{
    std::vector<FalconListing> listings;
    try {
        listings = listFalcons();
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();
    }
    for (const FalconListing& listing : listings) {
        EXPECT_NE(listing.path, "");
        EXPECT_EQ(listing.why.empty(), listing.help.empty());
        EXPECT_TRUE(listing.usable || !listing.why.empty());
    }
}

} // namespace
} // namespace palp
