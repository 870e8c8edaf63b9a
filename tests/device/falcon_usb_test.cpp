// Tests of the link to the Falcon over libusb, against a stand-in for the library.
#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string>
#include <thread>

#include <sys/socket.h>

#include "device/falcon/detail/libusb_link.h"
#include "tests/device/falcon_usb_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr double kSoon = 5; ///< [s] more than any wait of these tests, however busy the machine is

/// [s] that `act` takes.
template <class Act>
double secondsOf(const Act& act)
{
    const auto start = std::chrono::steady_clock::now();
    act();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Bytes counted(std::size_t size, unsigned first = 0)
{
    Bytes bytes(size);
    for (std::size_t n = 0; n < size; ++n) bytes[n] = static_cast<unsigned char>(first + n);
    return bytes;
}

/// One transfer as the chip makes it: packets of up to 64 bytes, two of status in front of each.
Bytes fromTheChip(const Bytes& payload)
{
    Bytes sent;
    for (std::size_t at = 0; at == 0 || at < payload.size(); at += 62) {
        sent.insert(sent.end(), {0x01, 0x60});
        sent.insert(sent.end(), payload.begin() + std::ptrdiff_t(at),
                    payload.begin() + std::ptrdiff_t(std::min(at + 62, payload.size())));
    }
    return sent;
}

/// What comes in until nothing does for 10 ms.
Bytes readAll(FalconLink& link)
{
    Bytes                         all;
    std::array<unsigned char, 50> part{};
    while (const std::size_t got = link.read(part, 0.01)) all.insert(all.end(), part.begin(), part.begin() + got);
    return all;
}

std::string lossOf(const auto& act)
{
    try {
        act();
    } catch (const LinkLost& lost) {
        return lost.what();
    }
    return "";
}

TEST_F(FalconUsb, ReadsWithoutTheStatusBytesOfEachPacket)
{
    const auto link = openFalcon();
    // Status alone, a runt of one byte, one packet, and three and a bit merged into one transfer.
    for (const Bytes& payload : {Bytes{}, counted(16), Bytes{}, counted(200, 16)})
        falcon_->incoming.push_back(fromTheChip(payload));
    falcon_->incoming.push_back({0x01});

    EXPECT_EQ(readAll(*link), counted(216));
}

TEST_F(FalconUsb, NothingIsLostBetweenTwoReads)
{
    const auto link = openFalcon();
    for (unsigned n = 0; n < 50; ++n) falcon_->incoming.push_back(fromTheChip(counted(16, 16 * n)));

    EXPECT_EQ(readAll(*link), counted(800));
}

TEST_F(FalconUsb, KeepsTheNewest4096BytesWhenNobodyReads)
{
    const auto link = openFalcon();
    for (unsigned n = 0; n < 50; ++n) falcon_->incoming.push_back(fromTheChip(counted(100, 100 * n)));
    while (!falcon_->incoming.empty()) link->write(counted(16)); // which handles what comes in too

    EXPECT_EQ(readAll(*link), counted(4096, 5000 - 4096));
}

TEST_F(FalconUsb, AReadEndsWhenItsTimeIsOver)
{
    const auto                    link = openFalcon();
    std::array<unsigned char, 16> bytes{};

    std::size_t  got  = 1;
    const double took = secondsOf([&] { got = link->read(bytes, 0.02); });

    EXPECT_EQ(got, 0u);
    EXPECT_GE(took, 0.019);
    EXPECT_LT(took, kSoon);
    for (double none : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_LT(secondsOf([&] { static_cast<void>(link->read(bytes, none)); }), kSoon);
}

TEST_F(FalconUsb, AReadEndsWhenSomethingComes)
{
    const auto   link = openFalcon();
    std::jthread sender([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        const std::lock_guard guard(usb_.lock);
        falcon_->incoming.push_back(fromTheChip(counted(3)));
    });

    std::array<unsigned char, 16> bytes{};
    std::size_t                   got  = 0;
    const double                  took = secondsOf([&] { got = link->read(bytes, 10 * kSoon); });

    EXPECT_EQ(got, 3u);
    EXPECT_LT(took, kSoon);
}

TEST_F(FalconUsb, ASignalDoesNotEndAWait)
{
    const auto link    = openFalcon();
    usb_.interruptions = 20;
    falcon_->incoming.push_back(fromTheChip(counted(7)));

    std::array<unsigned char, 16> bytes{};
    EXPECT_EQ(link->read(bytes, kSoon), 7u);
}

TEST_F(FalconUsb, WritesAllOfItInOrder)
{
    const auto link = openFalcon();

    link->write(counted(16));
    link->write(counted(1000, 16));
    link->write({});
    link->control(FtdiRequest::divisor, 2); // waits for the writes

    Bytes all;
    for (const Bytes& part : falcon_->written) all.insert(all.end(), part.begin(), part.end());
    EXPECT_EQ(all, counted(1016));
    EXPECT_EQ(falcon_->controls, (std::vector<std::pair<std::uint8_t, std::uint16_t>>{{0x03, 2}}));
}

TEST_F(FalconUsb, UnpluggedWhileReadingItIsLostForGoodAfterWhatCameBefore)
{
    const auto link = openFalcon();
    falcon_->incoming.push_back(fromTheChip(counted(5)));
    falcon_->unplugged = true;

    std::array<unsigned char, 16> bytes{};
    EXPECT_EQ(link->read(bytes, kSoon), 5u);
    EXPECT_TRUE(holds(lossOf([&] { static_cast<void>(link->read(bytes, kSoon)); }), {"1-2", "unplugged"}));
    falcon_->unplugged = false; // plugged in again: another device to the system
    EXPECT_NE(lossOf([&] { static_cast<void>(link->read(bytes, 0)); }), "");
    EXPECT_NE(lossOf([&] { link->write(counted(16)); }), "");
    EXPECT_NE(lossOf([&] { link->control(FtdiRequest::reset, 0); }), "");
}

TEST_F(FalconUsb, UnpluggedWhileWritingTheNextCallSaysSo)
{
    const auto link     = openFalcon();
    falcon_->takesBytes = false;
    link->write(counted(16));
    falcon_->unplugged = true;

    EXPECT_TRUE(holds(lossOf([&] { link->write(counted(16)); }), {"1-2"}));
}

TEST_F(FalconUsb, ADeviceThatTakesNothingIsLostAfterATenthOfASecond)
{
    const auto link     = openFalcon();
    falcon_->takesBytes = false;
    link->write(counted(16)); // on its way

    std::string  loss;
    const double took = secondsOf([&] { loss = lossOf([&] { link->write(counted(16)); }); });

    EXPECT_TRUE(holds(loss, {"too long"})) << loss;
    EXPECT_GE(took, 0.099);
    EXPECT_LT(took, kSoon);
}

/// Returns whether it is lost although the device is not gone.
bool isBroken(const auto& act)
{
    try {
        act();
    } catch (const LinkGone&) {
        return false;
    } catch (const LinkLost&) {
        return true;
    }
    return false;
}

TEST_F(FalconUsb, WhatALinkThatBrokeIsToldStillGoesOut)
{
    std::array<unsigned char, 16> bytes{};
    const auto                    write = [&](FalconLink& link) { return isBroken([&] { link.write(counted(16)); }); };
    {
        const auto link  = openFalcon();
        falcon_->inFault = LIBUSB_TRANSFER_ERROR;
        EXPECT_TRUE(isBroken([&] { static_cast<void>(link->read(bytes, kSoon)); }));
        for (std::size_t n = 1; n <= 3; ++n) {
            EXPECT_TRUE(write(*link)) << "it says so all the same";
            EXPECT_EQ(falcon_->written.size(), n);
        }
    }
    falcon_->written.clear();
    {
        const auto link   = openFalcon();
        falcon_->outFault = LIBUSB_TRANSFER_STALL;
        link->write(counted(16));
        EXPECT_TRUE(isBroken([&] { static_cast<void>(link->read(bytes, kSoon)); }));
        EXPECT_TRUE(write(*link));
        EXPECT_EQ(falcon_->written.size(), 1u) << "the stall was cleared first";
    }
    falcon_->written.clear();
    {
        const auto link     = openFalcon();
        falcon_->takesBytes = false;
        link->write(counted(16));
        EXPECT_TRUE(write(*link)) << "the first one hangs";
        falcon_->takesBytes = true;
        EXPECT_TRUE(write(*link));
        EXPECT_EQ(falcon_->written.size(), 1u) << "in the place of the one that hung";
    }
}

TEST_F(FalconUsb, OnlyADeviceThatIsAwayIsGone)
{
    std::array<unsigned char, 16> bytes{};
    const auto                    link = openFalcon();
    falcon_->inFault                   = LIBUSB_TRANSFER_ERROR; // as some systems have it when a plug is pulled
    EXPECT_TRUE(isBroken([&] { static_cast<void>(link->read(bytes, kSoon)); }));
    falcon_->unplugged = true;

    EXPECT_THROW(link->write(counted(16)), LinkGone);
    EXPECT_THROW(link->write(counted(16)), LinkGone) << "for good";
    EXPECT_TRUE(falcon_->written.empty());
    EXPECT_THROW(static_cast<void>(link->read(bytes, 0)), LinkGone);
    EXPECT_THROW(link->control(FtdiRequest::reset, 0), LinkGone);
}

TEST_F(FalconUsb, ShortWritesAndFaultsOfTransfersLoseTheLink)
{
    std::array<unsigned char, 16> bytes{};
    {
        const auto link   = openFalcon();
        falcon_->outShort = 1;
        link->write(counted(16));
        EXPECT_TRUE(holds(lossOf([&] { static_cast<void>(link->read(bytes, kSoon)); }), {"only a part"}));
        falcon_->unplugged = true;
        EXPECT_TRUE(holds(lossOf([&] { static_cast<void>(link->read(bytes, 0)); }), {"only a part"})) << "the cause";
        falcon_->unplugged = false;
        falcon_->outShort  = 0;
    }
    for (const auto fault : {LIBUSB_TRANSFER_ERROR, LIBUSB_TRANSFER_STALL, LIBUSB_TRANSFER_OVERFLOW,
                             LIBUSB_TRANSFER_TIMED_OUT, LIBUSB_TRANSFER_CANCELLED}) {
        const auto link  = openFalcon();
        falcon_->inFault = fault;
        EXPECT_NE(lossOf([&] { static_cast<void>(link->read(bytes, kSoon)); }), "") << fault;
    }
    {
        const auto link       = openFalcon();
        falcon_->controlError = LIBUSB_ERROR_PIPE;
        EXPECT_NE(lossOf([&] { link->control(FtdiRequest::divisor, 2); }), "");
    }
    {
        const auto link      = openFalcon();
        falcon_->submitError = LIBUSB_ERROR_NO_DEVICE;
        EXPECT_TRUE(holds(lossOf([&] { link->write(counted(16)); }), {"NO_DEVICE"}));
        falcon_->submitError = 0;
    }
    {
        auto link        = openFalcon();
        usb_.eventsError = LIBUSB_ERROR_OTHER;
        EXPECT_TRUE(holds(lossOf([&] { static_cast<void>(link->read(bytes, kSoon)); }), {"waiting"}));
        EXPECT_LT(secondsOf([&] { link.reset(); }), 0.5) << "it does not try for the second that transfers get";
    }
}

TEST_F(FalconUsb, AFaultIsNotHiddenByWhatComesAfterIt)
{
    const auto link  = openFalcon();
    falcon_->inFault = LIBUSB_TRANSFER_ERROR;

    const std::string loss = lossOf([&] {
        std::array<unsigned char, 16> bytes{};
        for (int n = 0; n < 10; ++n) {
            falcon_->incoming.push_back(fromTheChip(counted(16)));
            static_cast<void>(link->read(bytes, 0));
        }
    });

    EXPECT_NE(loss, "") << "three transfers were left when one failed";
}

TEST_F(FalconUsb, ClosingWaitsForNothingThatStillComesIn)
{
    auto link = openFalcon();
    for (int n = 0; n < 6; ++n) falcon_->incoming.push_back(fromTheChip(counted(16)));
    link->write(counted(16));
    for (int n = 0; n < 20; ++n) falcon_->incoming.push_back(fromTheChip(counted(16)));

    link.reset();

    EXPECT_EQ(falcon_->written.size(), 1u);
    EXPECT_GE(falcon_->incoming.size(), 10u) << "no transfer was submitted again to take these";
}

TEST_F(FalconUsb, ARequestWaitsForTheWriteBeforeIt)
{
    const auto link     = openFalcon();
    falcon_->takesBytes = false;
    link->write(counted(16));

    EXPECT_TRUE(holds(lossOf([&] { link->control(FtdiRequest::divisor, 2); }), {"too long"}));
    EXPECT_TRUE(falcon_->controls.empty());
}

TEST_F(FalconUsb, TheLastWriteGoesOutBeforeTheLinkIsClosed)
{
    std::jthread slow;
    {
        const auto link     = openFalcon();
        falcon_->takesBytes = false;
        link->write(counted(16)); // such as zero force
        slow = std::jthread([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            const std::lock_guard guard(usb_.lock);
            falcon_->takesBytes = true;
        });
    }
    EXPECT_EQ(falcon_->written, std::vector<Bytes>{counted(16)});
}

TEST_F(FalconUsb, ClosingEndsAlthoughTheDeviceHangs)
{
    auto link           = openFalcon();
    falcon_->takesBytes = falcon_->cancels = false;
    link->write(counted(16));

    EXPECT_LT(secondsOf([&] { link.reset(); }), kSoon) << "0.1 s for the write, 1 s for the rest";
}

TEST_F(FalconUsb, TwoLinksOnTwoThreadsDoNotDisturbEachOther)
{
    const auto second = plugIn(5);
    const auto work   = [&](FakeUsbDevice& device, const std::string& path, unsigned first) {
        const auto link = openFalcon(path);
        Bytes      got;
        for (unsigned n = 0; n < 100; ++n) {
            {
                const std::lock_guard guard(usb_.lock);
                device.incoming.push_back(fromTheChip(counted(16, first + 16 * n)));
            }
            link->write(counted(16));
            std::array<unsigned char, 16> bytes{};
            const std::size_t             taken = link->read(bytes, kSoon);
            got.insert(got.end(), bytes.begin(), bytes.begin() + taken);
        }
        EXPECT_EQ(got, counted(1600, first));
    };

    std::jthread other([&] { work(*second, "1-5", 7); });
    work(*falcon_, "1-2", 0);
    other.join();

    EXPECT_EQ(second->written.size(), 100u);
}

TEST_F(FalconUsb, ALinkMayBeHandedFromThreadToThread)
{
    auto link = openFalcon();
    falcon_->incoming.push_back(fromTheChip(counted(9)));

    std::jthread([&] { EXPECT_EQ(readAll(*link), counted(9)); }).join();
    link->write(counted(16));
    std::jthread([&] { link.reset(); }).join();

    EXPECT_EQ(falcon_->written.size(), 1u);
}

/// What a guardian's descriptor got within 5 s, if it is anything.
Bytes heardAt(int node, std::size_t size)
{
    Bytes heard(size);
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
         recv(node, heard.data(), size, MSG_DONTWAIT | MSG_PEEK) < ssize_t(size);) {
        if (std::chrono::steady_clock::now() > end) return {};
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return heard;
}

TEST_F(FalconUsb, ALinkThatPushesAndFallsSilentIsTakenOverThroughItsOwnDescriptor)
{
    const FalconPacket push = encode(FalconCommand{.motors = {100, -200, 300}, .lights = 2});
    const FalconPacket zero = encode(FalconCommand{.lights = 2});
    auto               link = openFalcon();
    link->write(encode(FalconCommand{}));
    EXPECT_FALSE(link->wasSilenced());
    link->write(push);
    std::array<std::uint8_t, 8> bytes{};
    static_cast<void>(link->read(bytes, 0));
    ASSERT_EQ(falcon_->written.back(), Bytes(push.begin(), push.end()));

    EXPECT_EQ(heardAt(falcon_->node, push.size()), Bytes(zero.begin(), zero.end())) << "the guardian, 25 ms later";
    link->write(push);
    static_cast<void>(link->read(bytes, 0));
    EXPECT_EQ(falcon_->written.back(), Bytes(zero.begin(), zero.end())) << "zero comes first";
    EXPECT_TRUE(link->wasSilenced());
    EXPECT_FALSE(link->wasSilenced()) << "it is said once";
    link->write(push);
    static_cast<void>(link->read(bytes, 0));
    EXPECT_EQ(falcon_->written.back(), Bytes(push.begin(), push.end()));
}

} // namespace
} // namespace palp
