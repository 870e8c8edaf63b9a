// Listing Falcons by libusb, and the link to one.
#include "device/falcon/detail/libusb_link.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <libusb.h>
#include <unistd.h>

#include "device/detail/guardian.h"
#include "device/falcon/detail/byte_ring.h"
#include "device/falcon/detail/libusb_words.h"
#include "device/falcon/detail/usb_node.h"
#include "device/machine_time.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xCB48; ///< FTDI's vendor number, Novint's product number
constexpr int           kInterface = 0;
constexpr unsigned char kIn = 0x81, kOut = 0x02; ///< endpoints, bulk
constexpr std::uint8_t  kVendorRequest = 0x40;   ///< host to device, vendor, device

constexpr std::size_t kPacket = 64; ///< [bytes] at full speed; each incoming one starts with the status
constexpr std::size_t kStatus = 2;  ///< [bytes] of modem and line status

constexpr std::size_t kBuffer = 256;  ///< [bytes] of a transfer: the size of the chip's own buffer, in whole packets
constexpr std::size_t kQueued = 4;    ///< waiting transfers: 4 ms without reading, at a latency timer of 1 ms
constexpr std::size_t kInbox  = 4096; ///< [bytes] that came in and were not read; beyond it the oldest are discarded

constexpr double       kWriteTimeout   = 0.1;   ///< [s] as FalconLink::write() promises
constexpr double       kCancelTime     = 20e-3; ///< [s] for a hanging write to come back before another is sent
constexpr double       kCloseTimeout   = 1;     ///< [s] for transfers to come back; the kernel needs a few ms
constexpr unsigned int kControlTimeout = 100;   ///< [ms]
constexpr double       kLongestWait    = 3600;  ///< [s] of a read, so that it fits the system's clock

template <auto free>
struct By {
    void operator()(auto* it) const { free(it); }
};
using Context = std::unique_ptr<libusb_context, By<libusb_exit>>;
using Handle  = std::unique_ptr<libusb_device_handle, By<libusb_close>>; ///< its interface is claimed until it closes

Context start()
{
    libusb_context* context = nullptr;
    if (const int failed = libusb_init(&context); failed != 0)
        throw Error(std::string("USB cannot be used: libusb does not start: ") + libusb_error_name(failed) +
                    "; expected a folder /dev/bus/usb; in a container, pass it on");
    return Context(context);
}

/// "1-2.3", as the kernel calls it.
std::string pathOf(libusb_device* device)
{
    std::array<std::uint8_t, 7> ports{}; // deeper than USB allows
    const int                   count = libusb_get_port_numbers(device, ports.data(), int(ports.size()));
    std::string                 path  = std::to_string(libusb_get_bus_number(device));
    for (int n = 0; n < count; ++n) {
        path += n == 0 ? '-' : '.';
        path += std::to_string(ports[std::size_t(n)]);
    }
    return path;
}

std::string nameOf(const std::string& path)
{
    return "Novint Falcon at USB " + path;
}

/// Returns the serial number of an open device as FalconLink::serial() does.
std::string serialOf(libusb_device* device, libusb_device_handle* open)
{
    libusb_device_descriptor      descriptor{};
    std::array<unsigned char, 65> text{};
    if (libusb_get_device_descriptor(device, &descriptor) != 0 || descriptor.iSerialNumber == 0) return {};
    const int size = libusb_get_string_descriptor_ascii(open, descriptor.iSerialNumber, text.data(), int(text.size()));
    std::string serial;
    for (int n = 0; n < std::min(size, 64); ++n) {
        const auto c = char(text[std::size_t(n)]);
        if (c > ' ' && c < '\x7F' && c != '"' && c != '\\') serial += c;
    }
    return serial;
}

/// The devices of a context that are Falcons; they are valid as long as this object lives.
class Falcons {
public:
    explicit Falcons(libusb_context* context)
    {
        const auto count = libusb_get_device_list(context, &all_);
        if (count < 0) throw Error(std::string("USB devices cannot be listed: ") + libusb_error_name(int(count)));
        for (libusb_device** device = all_; device != all_ + count; ++device) {
            libusb_device_descriptor descriptor{};
            if (libusb_get_device_descriptor(*device, &descriptor) == 0 && descriptor.idVendor == kVendor &&
                descriptor.idProduct == kProduct)
                falcons_.push_back(*device);
        }
    }
    ~Falcons() { libusb_free_device_list(all_, 1); }
    Falcons(const Falcons&)            = delete;
    Falcons& operator=(const Falcons&) = delete;

    [[nodiscard]] auto begin() const { return falcons_.begin(); }
    [[nodiscard]] auto end() const { return falcons_.end(); }

private:
    libusb_device**             all_ = nullptr;
    std::vector<libusb_device*> falcons_;
};

/// A node of usbfs that closes itself.
class Node {
public:
    Node() = default;
    explicit Node(libusb_device* device)
        : line_(openUsbNode(libusb_get_bus_number(device), libusb_get_device_address(device), kOut))
    {
    }
    ~Node()
    {
        if (line_.fd >= 0) close(line_.fd);
    }
    Node(Node&& other) noexcept : line_(std::exchange(other.line_, {})) {}
    Node& operator=(Node&& other) noexcept
    {
        std::swap(line_, other.line_);
        return *this;
    }

    [[nodiscard]] const Guardian::Line& line() const noexcept { return line_; }

private:
    Guardian::Line line_;
};

/// Opens a device for exclusive use; returns null if that fails. `listing` receives the outcome.
/// \param node  of the device, which stays open; if it could not be opened, libusb says why, as it fails to as well
Handle claim(libusb_context* context, libusb_device* device, const Node& node, FalconListing& listing)
{
    listing.path               = pathOf(device);
    libusb_device_handle* open = nullptr;
    int                   found =
        node.line().fd >= 0 ? libusb_wrap_sys_device(context, node.line().fd, &open) : libusb_open(device, &open);
    Handle handle(found == 0 ? open : nullptr);
    if (handle) {
        // A serial driver of the kernel may hold it. Not every system can detach one; then the claim fails.
        static_cast<void>(libusb_set_auto_detach_kernel_driver(open, 1));
        found = libusb_claim_interface(open, kInterface);
    }
    listing.usable = found == 0;
    if (listing.usable) {
        listing.serial = serialOf(device, open);
        return handle;
    }

    const UsbRefusal because = refusal(found);
    listing.why              = because.why;
    listing.help             = because.help;
    return nullptr;
}

/// The link of openFalcon(). Once lost_ is set, only writeAnyway() still submits transfers. A pending transfer belongs
/// to libusb until its callback, which is only called from inside pump() and the control requests.
class LibusbLink final : public FalconLink {
public:
    LibusbLink(Context context, Node node, Handle handle, const FalconListing& listing)
        : context_(std::move(context)), node_(std::move(node)), handle_(std::move(handle)), path_(listing.path),
          serial_(listing.serial), guardian_(node_.line(), kFalconZero, nameOf(path_))
    {
        for (Transfer& transfer : in_) prepare(transfer, kIn, onIn);
        prepare(out_, kOut, onOut);
        for (Transfer& transfer : in_) submit(transfer);
    }

    ~LibusbLink() override
    {
        waitFor([&] { return !out_.pending; }, kWriteTimeout); // the last command is zero force
        lose("it is ", "closed");                              // so that nothing is submitted again
        const auto idle = [&] { return !out_.pending && std::ranges::none_of(in_, &Transfer::pending); };
        for (Transfer& transfer : in_)
            if (transfer.pending) libusb_cancel_transfer(transfer.raw.get());
        if (out_.pending) libusb_cancel_transfer(out_.raw.get());
        settle(idle, kCloseTimeout);
        // libusb forgets a transfer that has still not come back when it closes the handle, so they are freed after
        // that.
        libusb_release_interface(handle_.get(), kInterface);
        handle_.reset();
    }

    [[nodiscard]] double now() const noexcept override { return machineTime(); }

    void control(FtdiRequest request, std::uint16_t value) override
    {
        finishWriting(now() + kWriteTimeout);
        const int done = libusb_control_transfer(handle_.get(), kVendorRequest, std::uint8_t(request), value, 0,
                                                 nullptr, 0, kControlTimeout);
        if (done < 0) lose("a request failed: ", libusb_error_name(done), done == LIBUSB_ERROR_NO_DEVICE);
        throwIfLost();
    }

    void write(std::span<const std::uint8_t> bytes) override
    {
        if (lost_ && !lost_->isGone) return writeAnyway(bytes);
        const double end = now() + kWriteTimeout;
        do {
            finishWriting(end);
            const auto part = bytes.first(std::min(bytes.size(), kBuffer));
            bytes           = bytes.subspan(part.size());
            if (!part.empty()) submitWrite(part);
            throwIfLost();
        } while (!bytes.empty());
    }

    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        waitFor([&] { return !inbox_.empty(); }, timeout);
        if (inbox_.empty()) throwIfLost(); // bytes that came before the loss are returned first
        return inbox_.take(bytes);
    }

    [[nodiscard]] bool wasSilenced() noexcept override { return guardian_.hasSilenced(); }

    [[nodiscard]] std::string serial() const override { return serial_; }

    void keepAlive() noexcept override { guardian_.keepAlive(); }

    void throwIfLost() const
    {
        if (!lost_) return;
        const std::string what = nameOf(path_) + ": " + lost_->doing + lost_->reason;
        if (lost_->isGone) throw LinkGone(what);
        throw LinkLost(what);
    }

private:
    struct Transfer {
        LibusbLink*                                                link = nullptr;
        std::unique_ptr<libusb_transfer, By<libusb_free_transfer>> raw;
        std::array<unsigned char, kBuffer>                         buffer{};
        bool pending = false; ///< submitted, and its callback was not called yet
    };
    struct Loss {
        const char *doing, *reason; ///< static texts: a callback must not throw
        bool        isGone;         ///< the device is gone, not only the link
    };

    void prepare(Transfer& transfer, unsigned char endpoint, libusb_transfer_cb_fn callback)
    {
        transfer.link = this;
        transfer.raw.reset(libusb_alloc_transfer(0));
        if (!transfer.raw) throw Error(nameOf(path_) + " cannot be opened: out of memory");
        // libusb's time limit is not used: every wait here has its own.
        libusb_fill_bulk_transfer(transfer.raw.get(), handle_.get(), endpoint, transfer.buffer.data(), int(kBuffer),
                                  callback, &transfer, 0);
    }

    void submit(Transfer& transfer) noexcept
    {
        if (!lost_) submitAnyway(transfer);
    }

    void submitAnyway(Transfer& transfer) noexcept
    {
        const int failed = libusb_submit_transfer(transfer.raw.get());
        transfer.pending = failed == 0;
        if (failed) lose("a transfer was refused: ", libusb_error_name(failed), failed == LIBUSB_ERROR_NO_DEVICE);
    }

    void submitWrite(std::span<const std::uint8_t> part) noexcept
    {
        if (!lost_ && !guardian_.isWatching()) return lose("it is not driven: ", "its guardian process has ended");
        const std::span out = guardian_.pass(part);
        if (out.data() == part.data()) { // no packet of the firmware that runs
            std::ranges::copy(part, out_.buffer.begin());
            out_.raw->buffer = out_.buffer.data();
        } else {
            out_.raw->buffer = const_cast<unsigned char*>(out.data()); // libusb only reads it
        }
        out_.raw->length = int(part.size());
        submitAnyway(out_);
        guardian_.passed();
    }

    /// Writes on a lost link to a device that may still listen, see FalconLink::write(); one buffer at most.
    void writeAnyway(std::span<const std::uint8_t> bytes)
    {
        const auto isOut = [this] { return !out_.pending; };
        if (out_.pending) libusb_cancel_transfer(out_.raw.get()); // the hanging one
        settle(isOut, kCancelTime);
        if (std::exchange(isStalled_, false)) static_cast<void>(libusb_clear_halt(handle_.get(), kOut));
        if (!out_.pending && !bytes.empty()) submitWrite(bytes.first(std::min(bytes.size(), kBuffer)));
        settle(isOut, kWriteTimeout);
        throwIfLost();
    }

    /// Records the loss. The first cause is kept; isGone may still be set later.
    void lose(const char* doing, const char* reason, bool isGone = false) noexcept
    {
        if (!lost_) lost_ = Loss{doing, reason, isGone};
        lost_->isGone = lost_->isGone || isGone;
    }

    void lose(const char* doing, libusb_transfer_status status) noexcept
    {
        lose(doing, transferFailure(status), status == LIBUSB_TRANSFER_NO_DEVICE);
    }

    static void LIBUSB_CALL onIn(libusb_transfer* raw)
    {
        Transfer&   transfer = *static_cast<Transfer*>(raw->user_data);
        LibusbLink& link     = *transfer.link;
        transfer.pending     = false;
        if (raw->status != LIBUSB_TRANSFER_COMPLETED) return link.lose("reading failed: ", raw->status);

        std::span<const std::uint8_t> rest(raw->buffer, std::size_t(raw->actual_length));
        while (rest.size() > kStatus) {
            const auto packet = rest.first(std::min(rest.size(), kPacket));
            link.inbox_.put(packet.subspan(kStatus));
            rest = rest.subspan(packet.size());
        }
        link.submit(transfer);
    }

    static void LIBUSB_CALL onOut(libusb_transfer* raw)
    {
        Transfer& transfer = *static_cast<Transfer*>(raw->user_data);
        transfer.pending   = false;
        if (raw->status == LIBUSB_TRANSFER_STALL) transfer.link->isStalled_ = true;
        if (raw->status != LIBUSB_TRANSFER_COMPLETED)
            transfer.link->lose("writing failed: ", raw->status);
        else if (raw->actual_length != raw->length)
            transfer.link->lose("writing failed: ", "it took only a part");
    }

    /// Handles pending events, or waits for one up to `timeout` [s].
    /// \return false if that no longer works
    bool pump(double timeout) noexcept
    {
        const double whole = std::floor(timeout);
        timeval      time{time_t(whole), suseconds_t((timeout - whole) * 1e6)};
        const int    failed = libusb_handle_events_timeout_completed(context_.get(), &time, nullptr);
        const bool   works  = failed == 0 || failed == LIBUSB_ERROR_INTERRUPTED; // by a signal
        if (!works) lose("waiting failed: ", libusb_error_name(failed));
        return works;
    }

    /// Pumps at least once, until it is `done`, the link is lost or `timeout` [s] is over.
    template <class Done>
    void waitFor(const Done& done, double timeout) noexcept
    {
        const double end = now() + (timeout > 0 ? std::min(timeout, kLongestWait) : 0);
        pump(0);
        for (double left = end - now(); !done() && !lost_ && left > 0; left = end - now()) pump(left);
    }

    /// Does the same even if the link is lost.
    template <class Done>
    void settle(const Done& done, double timeout) noexcept
    {
        const double end = now() + timeout;
        while (!done() && now() < end && pump(end - now())) {
        }
    }

    void finishWriting(double end)
    {
        waitFor([&] { return !out_.pending; }, end - now());
        if (out_.pending) lose("writing failed: ", LIBUSB_TRANSFER_TIMED_OUT);
        throwIfLost();
    }

    // Destroyed from the last to the first: transfers, handle, context.
    Context                       context_;
    Node                          node_;
    Handle                        handle_;
    std::string                   path_, serial_;
    Guardian                      guardian_; ///< the packets that go out lie in it
    ByteRing<kInbox>              inbox_;
    std::array<Transfer, kQueued> in_;
    Transfer                      out_;
    std::optional<Loss>           lost_;
    bool                          isStalled_ = false; ///< the pipe to the device
};

} // namespace

std::string falconSupport()
{
    const libusb_version* v = libusb_get_version();
    return "libusb-1.0 " + std::to_string(v->major) + "." + std::to_string(v->minor) + "." + std::to_string(v->micro);
}

bool hasFalconSupport() noexcept
{
    return true;
}

std::vector<FalconListing> findFalcons()
{
    const Context              context = start();
    std::vector<FalconListing> listings;
    for (libusb_device* device : Falcons(context.get()))
        static_cast<void>(claim(context.get(), device, Node(), listings.emplace_back()));
    return listings;
}

std::unique_ptr<FalconLink> openFalcon(const std::string& path)
{
    Context       context = start();
    Node          node;
    Handle        handle;
    FalconListing listing;
    std::string   refused, elsewhere;
    for (const Falcons falcons(context.get()); libusb_device * device : falcons) {
        if (!path.empty() && pathOf(device) != path) {
            elsewhere += elsewhere.empty() ? "" : ", ";
            elsewhere += pathOf(device);
            continue;
        }
        node = Node(device);
        if ((handle = claim(context.get(), device, node, listing))) break;
        refused += refused.empty() ? "" : "; ";
        refused += nameOf(listing.path) + ": " + listing.why + "; " + listing.help;
    }
    if (!handle && !refused.empty()) throw Error(refused);
    if (!handle && !elsewhere.empty())
        throw Error("there is no Novint Falcon at USB " + path + "; found: " + elsewhere + "; name one of these");
    if (!handle)
        throw Error(
            "no Novint Falcon is plugged in: USB has no device 0403:cb48; check its cable and its power supply");

    auto link = std::make_unique<LibusbLink>(std::move(context), std::move(node), std::move(handle), listing);
    try {
        link->throwIfLost();
    } catch (const LinkLost& lost) {
        throw Error(std::string(lost.what()) + "; plug it in anew, without a hub");
    }
    return link;
}

} // namespace palp
