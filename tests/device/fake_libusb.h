#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <libusb.h>
#include <unistd.h>

namespace palp {

/// A device at the stand-in of libusb: what it does, and what was done to it.
/// \thread one that holds the lock of fakeUsb(), or the only one
struct FakeUsbDevice {
    std::uint16_t             vendor = 0x0403, product = 0xCB48;
    std::uint8_t              bus = 1;
    std::vector<std::uint8_t> ports{2};
    std::string               serial;    ///< empty: it has none
    int                       node = -1; ///< our end of its node, once that is open: what the guardian writes

    int                                        openError = 0, claimError = 0, controlError = 0, submitError = 0;
    std::deque<std::vector<unsigned char>>     incoming; ///< each completes one IN transfer, status bytes and all
    std::optional<enum libusb_transfer_status> inFault;  ///< of one IN transfer, once nothing is incoming
    std::optional<enum libusb_transfer_status> outFault; ///< of one OUT transfer; after a stall all fail until cleared
    bool                                       halted = false; ///< so it is
    std::vector<unsigned char>                 answer; ///< to each OUT transfer, status bytes and all; empty: none
    bool                                       unplugged  = false; ///< once nothing is incoming
    bool                                       takesBytes = true;  ///< else OUT transfers stay
    int                                        outShort   = 0;     ///< [bytes] fewer are taken than were sent
    bool                                       cancels    = true;  ///< else a cancelled transfer never comes back

    std::vector<std::vector<unsigned char>>             written;  ///< one entry for each transfer
    std::vector<std::pair<std::uint8_t, std::uint16_t>> controls; ///< request and value
    bool                                                autoDetach = false;
    int                                                 claims     = 0; ///< now

    ~FakeUsbDevice()
    {
        if (node >= 0) close(node);
    }
};

/// The stand-in of libusb of this program.
struct FakeUsb {
    int                                         initError = 0, listError = 0, eventsError = 0;
    int                                         interruptions = 0; ///< waits that a signal ends, from now on
    std::vector<std::shared_ptr<FakeUsbDevice>> devices;

    std::atomic<int> objects{0};  ///< contexts, lists, devices, handles and transfers that live
    std::atomic<int> mistakes{0}; ///< calls that libusb forbids, such as freeing a transfer that is under way
    std::mutex       lock;        ///< of all this
};
[[nodiscard]] FakeUsb& fakeUsb();

} // namespace palp
