// The only file that knows libusb: listing Falcons, and the link to one.
#include "device/falcon/libusb_link.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>

#include <libusb.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xCB48; ///< FTDI's number, and Novint's of theirs
constexpr int           kInterface = 0;
constexpr unsigned char kIn = 0x81, kOut = 0x02; ///< endpoints, bulk
constexpr std::uint8_t  kVendorRequest = 0x40;   ///< host to device, vendor, device

constexpr std::size_t kPacket = 64; ///< [bytes] at full speed; each that comes in starts with
constexpr std::size_t kStatus = 2;  ///< [bytes] of modem and line status

constexpr std::size_t kBuffer = 256;  ///< [bytes] of a transfer: what the chip itself can hold, in whole packets
constexpr std::size_t kQueued = 4;    ///< transfers that wait: at a latency timer of 1 ms, 4 ms of a host that is away
constexpr std::size_t kInbox  = 4096; ///< [bytes] that came in and were not read; then the oldest go

constexpr double       kWriteTimeout   = 0.1;  ///< [s] FalconLink::write() promises it
constexpr double       kCloseTimeout   = 1;    ///< [s] for transfers to come back; the kernel needs a few ms
constexpr unsigned int kControlTimeout = 100;  ///< [ms]
constexpr double       kLongestWait    = 3600; ///< [s] of a read, so that it fits the system's clock

struct Exit {
    void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct Close {
    void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
struct Free {
    void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};
using Context = std::unique_ptr<libusb_context, Exit>;
using Handle  = std::unique_ptr<libusb_device_handle, Close>; ///< its interface is claimed; closing gives it back

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

/// The devices of a context that are Falcons; good as long as this lives.
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

/// Opens a device for us alone; null where that fails. `listing` says what came of it.
Handle claim(libusb_device* device, FalconListing& listing)
{
    listing.path                = pathOf(device);
    libusb_device_handle* open  = nullptr;
    int                   found = libusb_open(device, &open);
    Handle                handle(found == 0 ? open : nullptr);
    if (handle) {
        // A serial driver of the kernel may hold it; not every system can detach one, and then the claim tells.
        static_cast<void>(libusb_set_auto_detach_kernel_driver(open, 1));
        found = libusb_claim_interface(open, kInterface);
    }
    listing.usable = found == 0;
    if (listing.usable) return handle;

    switch (found) {
    case LIBUSB_ERROR_ACCESS:
        listing.why  = "no permission to open it";
        listing.help = "put this line into /etc/udev/rules.d/70-palpate-falcon.rules and plug it in anew: " +
                       std::string(kFalconUdevLine);
        break;
    case LIBUSB_ERROR_BUSY:
        listing.why  = "a program has it open already";
        listing.help = "end the other program that uses it";
        break;
    default:
        listing.why  = std::string("it cannot be opened: ") + libusb_error_name(found);
        listing.help = "plug it in anew, without a hub";
    }
    return nullptr;
}

const char* reasonOf(libusb_transfer_status status)
{
    switch (status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
        return "it was unplugged";
    case LIBUSB_TRANSFER_STALL:
        return "it refused (stall)";
    case LIBUSB_TRANSFER_OVERFLOW:
        return "it sent too much at once";
    case LIBUSB_TRANSFER_CANCELLED:
        return "the transfer was cancelled";
    case LIBUSB_TRANSFER_TIMED_OUT:
        return "it took too long";
    default:
        return "the transfer failed";
    }
}

/// What came in and was not read yet: a ring of the newest kInbox bytes.
class Inbox {
public:
    [[nodiscard]] bool empty() const noexcept { return held_ == 0; }

    void put(std::span<const std::uint8_t> bytes) noexcept
    {
        for (const std::uint8_t byte : bytes) {
            bytes_[(oldest_ + held_) % kInbox] = byte;
            if (held_ < kInbox)
                ++held_;
            else
                oldest_ = (oldest_ + 1) % kInbox;
        }
    }

    std::size_t take(std::span<std::uint8_t> bytes) noexcept
    {
        const std::size_t taken = std::min(bytes.size(), held_);
        for (std::size_t n = 0; n < taken; ++n) bytes[n] = bytes_[(oldest_ + n) % kInbox];
        oldest_ = (oldest_ + taken) % kInbox;
        held_ -= taken;
        return taken;
    }

private:
    std::array<std::uint8_t, kInbox> bytes_{};
    std::size_t                      oldest_ = 0, held_ = 0;
};

/// See openFalcon(). Once lost_ is set no transfer is submitted any more; one that is pending belongs to libusb until
/// its callback, which only comes from inside pump() and the control requests.
class LibusbLink final : public FalconLink {
public:
    LibusbLink(Context context, Handle handle, std::string path)
        : context_(std::move(context)), handle_(std::move(handle)), path_(std::move(path))
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
        const double end = now() + kCloseTimeout;
        while (!idle() && now() < end)
            if (!pump(end - now())) break;
        // If one still has not come back: libusb forgets it as it closes the handle. So the transfers are freed after.
        libusb_release_interface(handle_.get(), kInterface);
        handle_.reset();
    }

    [[nodiscard]] double now() const noexcept override
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    void control(FtdiRequest request, std::uint16_t value) override
    {
        finishWriting(now() + kWriteTimeout);
        const int done = libusb_control_transfer(handle_.get(), kVendorRequest, std::uint8_t(request), value, 0,
                                                 nullptr, 0, kControlTimeout);
        if (done < 0) lose("a request failed: ", libusb_error_name(done));
        throwIfLost();
    }

    void write(std::span<const std::uint8_t> bytes) override
    {
        const double end = now() + kWriteTimeout;
        do {
            finishWriting(end);
            const auto part  = bytes.first(std::min(bytes.size(), kBuffer));
            bytes            = bytes.subspan(part.size());
            out_.raw->length = int(part.size());
            std::ranges::copy(part, out_.buffer.begin());
            if (!part.empty()) submit(out_);
            throwIfLost();
        } while (!bytes.empty());
    }

    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        waitFor([&] { return !inbox_.empty(); }, timeout);
        if (inbox_.empty()) throwIfLost(); // what came before that is given out first
        return inbox_.take(bytes);
    }

    void throwIfLost() const
    {
        if (lost_) throw LinkLost(nameOf(path_) + ": " + lost_->doing + lost_->reason);
    }

private:
    struct Transfer {
        LibusbLink*                            link = nullptr;
        std::unique_ptr<libusb_transfer, Free> raw;
        std::array<unsigned char, kBuffer>     buffer{};
        bool                                   pending = false; ///< submitted, and its callback has not come
    };
    struct Loss {
        const char *doing, *reason; ///< of static texts: a callback must not throw
    };

    void prepare(Transfer& transfer, unsigned char endpoint, libusb_transfer_cb_fn callback)
    {
        transfer.link = this;
        transfer.raw.reset(libusb_alloc_transfer(0));
        if (!transfer.raw) throw Error(nameOf(path_) + " cannot be opened: out of memory");
        // No time limit of libusb's: what waits has one of its own.
        libusb_fill_bulk_transfer(transfer.raw.get(), handle_.get(), endpoint, transfer.buffer.data(), int(kBuffer),
                                  callback, &transfer, 0);
    }

    void submit(Transfer& transfer) noexcept
    {
        if (lost_) return;
        const int failed = libusb_submit_transfer(transfer.raw.get());
        transfer.pending = failed == 0;
        if (failed) lose("a transfer was refused: ", libusb_error_name(failed));
    }

    void lose(const char* doing, const char* reason) noexcept
    {
        if (!lost_) lost_ = Loss{doing, reason};
    }

    static void LIBUSB_CALL onIn(libusb_transfer* raw)
    {
        Transfer&   transfer = *static_cast<Transfer*>(raw->user_data);
        LibusbLink& link     = *transfer.link;
        transfer.pending     = false;
        if (raw->status != LIBUSB_TRANSFER_COMPLETED) return link.lose("reading failed: ", reasonOf(raw->status));

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
        if (raw->status != LIBUSB_TRANSFER_COMPLETED)
            transfer.link->lose("writing failed: ", reasonOf(raw->status));
        else if (raw->actual_length != raw->length)
            transfer.link->lose("writing failed: ", "it took only a part");
    }

    /// Handles what has happened; if nothing has, waits for it up to `timeout` [s]. False: that does not work any more.
    bool pump(double timeout) noexcept
    {
        const double whole = std::floor(timeout);
        timeval      time{time_t(whole), suseconds_t((timeout - whole) * 1e6)};
        const int    failed = libusb_handle_events_timeout_completed(context_.get(), &time, nullptr);
        const bool   works  = failed == 0 || failed == LIBUSB_ERROR_INTERRUPTED; // by a signal
        if (!works) lose("waiting failed: ", libusb_error_name(failed));
        return works;
    }

    /// Pumps once, and on until it is `done`, the link is lost or `timeout` [s] is over.
    template <class Done>
    void waitFor(const Done& done, double timeout) noexcept
    {
        const double end = now() + (timeout > 0 ? std::min(timeout, kLongestWait) : 0);
        pump(0);
        for (double left = end - now(); !done() && !lost_ && left > 0; left = end - now()) pump(left);
    }

    void finishWriting(double end)
    {
        waitFor([&] { return !out_.pending; }, end - now());
        if (out_.pending) lose("writing failed: ", reasonOf(LIBUSB_TRANSFER_TIMED_OUT));
        throwIfLost();
    }

    // Destroyed from the last to the first: transfers, handle, context.
    Context                       context_;
    Handle                        handle_;
    std::string                   path_;
    Inbox                         inbox_;
    std::array<Transfer, kQueued> in_;
    Transfer                      out_;
    std::optional<Loss>           lost_;
};

} // namespace

std::string falconSupport()
{
    const libusb_version* v = libusb_get_version();
    return "libusb-1.0 " + std::to_string(v->major) + "." + std::to_string(v->minor) + "." + std::to_string(v->micro);
}

std::vector<FalconListing> listFalcons()
{
    const Context              context = start();
    std::vector<FalconListing> listings;
    for (libusb_device* device : Falcons(context.get())) static_cast<void>(claim(device, listings.emplace_back()));
    return listings;
}

std::unique_ptr<FalconLink> openFalcon(const std::string& path)
{
    Context       context = start();
    Handle        handle;
    FalconListing listing;
    std::string   refused, elsewhere;
    for (const Falcons falcons(context.get()); libusb_device * device : falcons) {
        if (!path.empty() && pathOf(device) != path) {
            elsewhere += elsewhere.empty() ? "" : ", ";
            elsewhere += pathOf(device);
            continue;
        }
        if ((handle = claim(device, listing))) break;
        refused += refused.empty() ? "" : "; ";
        refused += nameOf(listing.path) + ": " + listing.why + "; " + listing.help;
    }
    if (!handle && !refused.empty()) throw Error(refused);
    if (!handle && !elsewhere.empty())
        throw Error("there is no Novint Falcon at USB " + path + "; found: " + elsewhere + "; name one of these");
    if (!handle)
        throw Error(
            "no Novint Falcon is plugged in: USB has no device 0403:cb48; check its cable and its power supply");

    auto link = std::make_unique<LibusbLink>(std::move(context), std::move(handle), listing.path);
    try {
        link->throwIfLost();
    } catch (const LinkLost& lost) {
        throw Error(std::string(lost.what()) + "; plug it in anew, without a hub");
    }
    return link;
}

} // namespace palp
