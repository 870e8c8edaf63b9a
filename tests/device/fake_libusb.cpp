// A stand-in for libusb-1.0 with the functions that the link to the Falcon calls, so that its own code runs without
// hardware and with any fault. As in libusb, callbacks come from inside the calls that handle events, on the caller's
// thread.
#include "tests/device/fake_libusb.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <sys/socket.h>
#include <unistd.h>

#include "device/falcon/detail/usb_node.h"

struct libusb_context {};
struct libusb_device {
    std::shared_ptr<palp::FakeUsbDevice> fake;
    libusb_context*                      context;
    std::atomic<int>                     owners{1};
};
struct libusb_device_handle {
    libusb_device* device;
    bool           claimed = false;
};

namespace palp {

/// The node of a device that is no node of usbfs: a socket, which the guardian writes to.
Guardian::Line openUsbNode(int /*bus*/, int address, int /*endpoint*/) noexcept
{
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return {};
    const auto name = std::uint8_t(address);
    static_cast<void>(!write(ends[1], &name, 1));
    FakeUsbDevice& fake = *fakeUsb().devices.at(name);
    if (fake.node >= 0) close(fake.node);
    fake.node = ends[1];
    return {.fd = ends[0]};
}

FakeUsb& fakeUsb()
{
    static FakeUsb usb;
    return usb;
}

} // namespace palp

namespace {

using palp::fakeUsb;
using palp::FakeUsbDevice;

void release(libusb_device* device)
{
    if (--device->owners > 0) return;
    --fakeUsb().objects;
    delete device;
}

FakeUsbDevice& fakeOf(libusb_transfer* transfer)
{
    return *transfer->dev_handle->device->fake;
}

bool isIn(const libusb_transfer* transfer)
{
    return (transfer->endpoint & LIBUSB_ENDPOINT_IN) != 0;
}

/// A transfer that was submitted and has not come back.
struct UnderWay {
    libusb_transfer* transfer;
    libusb_context*  context;
    bool             cancelled = false;
};
std::vector<UnderWay> underWay; // the oldest first; with the lock of fakeUsb()

auto found(const libusb_transfer* transfer)
{
    return std::ranges::find(underWay, transfer, &UnderWay::transfer);
}

/// What becomes of a transfer now; nothing: it goes on waiting.
std::optional<libusb_transfer_status> outcomeOf(libusb_transfer* transfer, bool cancelled)
{
    FakeUsbDevice& fake     = fakeOf(transfer);
    transfer->actual_length = 0;
    if (isIn(transfer) && !fake.incoming.empty()) {
        const auto bytes        = fake.incoming.front();
        transfer->actual_length = std::min(int(bytes.size()), transfer->length);
        std::copy_n(bytes.begin(), transfer->actual_length, transfer->buffer);
        fake.incoming.pop_front();
        return LIBUSB_TRANSFER_COMPLETED;
    }
    if (cancelled) return LIBUSB_TRANSFER_CANCELLED; // too late for what has come in already
    if (fake.unplugged) return LIBUSB_TRANSFER_NO_DEVICE;
    if (isIn(transfer)) return std::exchange(fake.inFault, std::nullopt);
    if (!fake.takesBytes) return std::nullopt;
    if (fake.halted) return LIBUSB_TRANSFER_STALL;
    if (fake.outFault) {
        fake.halted = fake.outFault == LIBUSB_TRANSFER_STALL;
        return std::exchange(fake.outFault, std::nullopt);
    }
    if (!fake.answer.empty()) fake.incoming.push_back(fake.answer);
    transfer->actual_length = transfer->length - fake.outShort;
    fake.written.emplace_back(transfer->buffer, transfer->buffer + transfer->actual_length);
    return LIBUSB_TRANSFER_COMPLETED;
}

/// Completes all transfers that can be completed.
/// \return whether there was one
bool complete(libusb_context* context)
{
    std::vector<libusb_transfer*> done;
    {
        const std::lock_guard guard(fakeUsb().lock);
        std::erase_if(underWay, [&](const UnderWay& one) {
            if (one.context != context) return false;
            const auto outcome = outcomeOf(one.transfer, one.cancelled);
            if (!outcome) return false;
            one.transfer->status = *outcome;
            done.push_back(one.transfer);
            return true;
        });
    }
    for (libusb_transfer* transfer : done) transfer->callback(transfer);
    return !done.empty();
}

} // namespace

extern "C" {

int libusb_init(libusb_context** context)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (fakeUsb().initError != 0) return fakeUsb().initError;
    *context = new libusb_context;
    ++fakeUsb().objects;
    return 0;
}

void libusb_exit(libusb_context* context)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (std::ranges::find(underWay, context, &UnderWay::context) != underWay.end()) ++fakeUsb().mistakes;
    --fakeUsb().objects;
    delete context;
}

const libusb_version* libusb_get_version()
{
    static const libusb_version version{1, 0, 26, 0, "", "fake"};
    return &version;
}

const char* libusb_error_name(int code)
{
    switch (code) {
    case LIBUSB_ERROR_ACCESS:
        return "LIBUSB_ERROR_ACCESS";
    case LIBUSB_ERROR_NO_DEVICE:
        return "LIBUSB_ERROR_NO_DEVICE";
    default:
        return "LIBUSB_ERROR_OTHER";
    }
}

ssize_t libusb_get_device_list(libusb_context* context, libusb_device*** list)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (fakeUsb().listError != 0) return fakeUsb().listError;
    const auto& devices = fakeUsb().devices;
    *list               = new libusb_device*[devices.size() + 1];
    for (std::size_t n = 0; n < devices.size(); ++n) (*list)[n] = new libusb_device{devices[n], context};
    (*list)[devices.size()] = nullptr;
    fakeUsb().objects += 1 + int(devices.size());
    return ssize_t(devices.size());
}

void libusb_free_device_list(libusb_device** list, int unref)
{
    for (libusb_device** device = list; *device; ++device)
        if (unref) release(*device);
    --fakeUsb().objects;
    delete[] list;
}

int libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* descriptor)
{
    descriptor->idVendor  = device->fake->vendor;
    descriptor->idProduct = device->fake->product;

    descriptor->iSerialNumber = device->fake->serial.empty() ? 0 : 3;
    return 0;
}

int libusb_get_string_descriptor_ascii(libusb_device_handle* handle, std::uint8_t index, unsigned char* text, int room)
{
    const std::string& serial = handle->device->fake->serial;
    if (index != 3) ++fakeUsb().mistakes;
    if (handle->device->fake->controlError != 0) return handle->device->fake->controlError;
    const int size = std::min(int(serial.size()), room);
    std::copy_n(serial.begin(), size, text);
    return size;
}

std::uint8_t libusb_get_bus_number(libusb_device* device)
{
    return device->fake->bus;
}

int libusb_get_port_numbers(libusb_device* device, std::uint8_t* ports, int room)
{
    const auto& all = device->fake->ports;
    if (int(all.size()) > room) return LIBUSB_ERROR_OVERFLOW;
    std::copy(all.begin(), all.end(), ports);
    return int(all.size());
}

std::uint8_t libusb_get_device_address(libusb_device* device)
{
    return std::uint8_t(std::ranges::find(fakeUsb().devices, device->fake) - fakeUsb().devices.begin());
}

int libusb_wrap_sys_device(libusb_context* context, intptr_t node, libusb_device_handle** handle)
{
    std::uint8_t address = 0;
    if (recv(int(node), &address, 1, MSG_PEEK) != 1) return LIBUSB_ERROR_IO; // openUsbNode() has put it there
    auto* const device = new libusb_device{fakeUsb().devices.at(address), context};
    ++fakeUsb().objects;
    const int failed = libusb_open(device, handle);
    release(device);
    return failed;
}

int libusb_open(libusb_device* device, libusb_device_handle** handle)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (device->fake->openError != 0) return device->fake->openError;
    ++device->owners;
    *handle = new libusb_device_handle{device};
    ++fakeUsb().objects;
    return 0;
}

void libusb_close(libusb_device_handle* handle)
{
    const std::lock_guard guard(fakeUsb().lock);
    // libusb forgets what is still under way.
    if (std::erase_if(underWay, [&](const UnderWay& one) { return one.transfer->dev_handle == handle; }) > 0 &&
        handle->device->fake->cancels && fakeUsb().eventsError == 0)
        ++fakeUsb().mistakes; // they would have come back
    if (handle->claimed) --handle->device->fake->claims;
    release(handle->device);
    --fakeUsb().objects;
    delete handle;
}

int libusb_set_auto_detach_kernel_driver(libusb_device_handle* handle, int enable)
{
    const std::lock_guard guard(fakeUsb().lock);
    handle->device->fake->autoDetach = enable != 0;
    return 0;
}

int libusb_claim_interface(libusb_device_handle* handle, int interface)
{
    const std::lock_guard guard(fakeUsb().lock);
    FakeUsbDevice&        fake = *handle->device->fake;
    if (interface != 0) ++fakeUsb().mistakes;
    if (fake.claimError != 0) return fake.claimError;
    if (fake.claims > 0) return LIBUSB_ERROR_BUSY;
    ++fake.claims;
    handle->claimed = true;
    return 0;
}

int libusb_release_interface(libusb_device_handle* handle, int)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (std::exchange(handle->claimed, false)) --handle->device->fake->claims;
    return 0;
}

int libusb_control_transfer(libusb_device_handle* handle, std::uint8_t type, std::uint8_t request, std::uint16_t value,
                            std::uint16_t index, unsigned char*, std::uint16_t length, unsigned int timeout)
{
    complete(handle->device->context); // libusb handles events while it waits
    const std::lock_guard guard(fakeUsb().lock);
    FakeUsbDevice&        fake = *handle->device->fake;
    if (type != 0x40 || index != 0 || length != 0 || timeout == 0) ++fakeUsb().mistakes;
    if (fake.unplugged) return LIBUSB_ERROR_NO_DEVICE;
    if (fake.controlError != 0) return fake.controlError;
    fake.controls.emplace_back(request, value);
    return 0;
}

libusb_transfer* libusb_alloc_transfer(int)
{
    ++fakeUsb().objects;
    return new libusb_transfer{};
}

void libusb_free_transfer(libusb_transfer* transfer)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (found(transfer) != underWay.end()) ++fakeUsb().mistakes;
    --fakeUsb().objects;
    delete transfer;
}

int libusb_submit_transfer(libusb_transfer* transfer)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (found(transfer) != underWay.end()) {
        ++fakeUsb().mistakes;
        return LIBUSB_ERROR_BUSY;
    }
    if (fakeOf(transfer).submitError != 0) return fakeOf(transfer).submitError;
    underWay.push_back({transfer, transfer->dev_handle->device->context});
    return 0;
}

int libusb_cancel_transfer(libusb_transfer* transfer)
{
    const std::lock_guard guard(fakeUsb().lock);
    const auto            one = found(transfer);
    if (one == underWay.end()) return LIBUSB_ERROR_NOT_FOUND;
    one->cancelled = fakeOf(transfer).cancels;
    return 0;
}

int libusb_clear_halt(libusb_device_handle* handle, unsigned char endpoint)
{
    const std::lock_guard guard(fakeUsb().lock);
    if (endpoint & LIBUSB_ENDPOINT_IN) ++fakeUsb().mistakes;
    handle->device->fake->halted = false;
    return 0;
}

int libusb_handle_events_timeout_completed(libusb_context* context, timeval* time, int*)
{
    {
        const std::lock_guard guard(fakeUsb().lock);
        if (fakeUsb().eventsError != 0) return fakeUsb().eventsError;
        if (fakeUsb().interruptions > 0) return --fakeUsb().interruptions, LIBUSB_ERROR_INTERRUPTED;
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(time->tv_sec) +
                     std::chrono::microseconds(time->tv_usec);
    while (!complete(context)) {
        if (std::chrono::steady_clock::now() >= end) break;
        std::this_thread::sleep_for(std::chrono::microseconds(200)); // another thread may make something happen
    }
    return 0;
}

} // extern "C"
