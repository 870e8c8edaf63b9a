#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/device/fake_libusb.h"

namespace palp {

/// Around each test: one Falcon at USB 1-2. After it nothing of libusb's is left over.
class FalconUsb : public ::testing::Test {
protected:
    void SetUp() override { usb_.devices.push_back(falcon_); }
    void TearDown() override
    {
        EXPECT_EQ(usb_.objects, 0) << "contexts, lists, devices, handles or transfers were left";
        EXPECT_EQ(usb_.mistakes, 0);
        EXPECT_EQ(falcon_->claims, 0);
        usb_.devices.clear();
        usb_.initError = usb_.listError = usb_.eventsError = usb_.interruptions = 0;
        usb_.mistakes                                                           = 0;
    }

    /// One more device at USB 1-PORT.
    std::shared_ptr<FakeUsbDevice> plugIn(std::uint8_t port)
    {
        usb_.devices.push_back(std::make_shared<FakeUsbDevice>());
        usb_.devices.back()->ports = {port};
        return usb_.devices.back();
    }

    FakeUsb&                       usb_    = fakeUsb();
    std::shared_ptr<FakeUsbDevice> falcon_ = std::make_shared<FakeUsbDevice>();
};

} // namespace palp
