#include "device/hid/hidapi_system.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstring>
#include <cwchar>
#include <mutex>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <sys/file.h>
#include <unistd.h>

#include "device/detail/guardian.h"
#include "device/hid/detail/udev_line.h"

namespace palp {
namespace {

/// Guards hidapi's globals: its start-up and the text of its last failure to open.
std::mutex& globals()
{
    static std::mutex mutex;
    return mutex;
}

/// Converts hidapi's wide strings; a lone surrogate or a number beyond Unicode becomes U+FFFD.
std::string utf8(const wchar_t* wide)
{
    std::string text;
    for (; wide && *wide; ++wide) {
        auto code = static_cast<char32_t>(*wide);
        if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) code = 0xFFFD;
        if (code < 0x80) {
            text += char(code);
            continue;
        }
        const int          more     = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3; // bytes that follow the first
        constexpr unsigned kFirst[] = {0, 0xC0, 0xE0, 0xF0};
        text += char(kFirst[more] | code >> (6 * more));
        for (int n = more - 1; n >= 0; --n) text += char(0x80 | (code >> (6 * n) & 0x3F));
    }
    return text;
}

class HidapiPort : public HidPort {
public:
    HidapiPort(hid_device* device, std::string path) : device_(device), path_(std::move(path)) {}
    ~HidapiPort() override
    {
        guardian_.reset();
        if (node_ >= 0) close(node_);
        hid_close(device_);
    }

    std::size_t read(std::span<std::uint8_t> report, double timeout) override
    {
        // Rounded up, so that a wait of 0.1 ms does not become zero; never -1, which would wait for ever.
        const double milliseconds = std::isfinite(timeout) ? std::clamp(std::ceil(timeout * 1e3), 0.0, 60e3) : 0;
        const int    got          = hid_read_timeout(device_, report.data(), report.size(), int(milliseconds));
        if (got < 0) lost("reading");
        return std::size_t(got);
    }

    void write(std::span<const std::uint8_t> report) override
    {
        // Told once; the zeros that end a session still pass.
        if (guardian_ && !guardian_->isWatching() && !std::exchange(unguarded_, true))
            throw HidLost(path_ + ": its guardian process has ended");
        const std::span out = guardian_ ? guardian_->pass(report) : report;
        if (hid_write(device_, out.data(), out.size()) < 0) lost("writing");
        if (guardian_) guardian_->passed();
    }

    /// The node is opened once more, because hidapi keeps its descriptor for itself; it takes reports from both.
    void guard(const ZeroRule& rule) override
    {
        node_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
        if (node_ < 0)
            throw HidRefused(path_ + " cannot be opened by its guardian process: " + std::strerror(errno),
                             "plug it in anew, and list the devices again");
        // Two programs would drive it in turns: it takes the newer numbers, and the other's force comes back all at
        // once.
        if (::flock(node_, LOCK_EX | LOCK_NB) != 0)
            throw HidRefused(path_ + " is driven by another program", "end that one first");
        guardian_.emplace(Guardian::Line{.fd = node_}, rule, path_);
    }

    [[nodiscard]] bool wasSilenced() noexcept override { return guardian_ && guardian_->hasSilenced(); }

private:
    [[noreturn]] void lost(const char* doing) const
    {
        throw HidLost(path_ + ": " + doing + " failed: " + utf8(hid_error(device_)));
    }

    hid_device*             device_;
    std::string             path_;
    int                     node_      = -1;    ///< the guardian's descriptor
    bool                    unguarded_ = false; ///< it has ended, and that was told
    std::optional<Guardian> guardian_;
};

HidListing listingOf(const hid_device_info& info)
{
    HidListing listing;
    listing.path         = info.path ? info.path : "";
    listing.vendor       = info.vendor_id;
    listing.product      = info.product_id;
    listing.usagePage    = info.usage_page;
    listing.usage        = info.usage;
    listing.manufacturer = utf8(info.manufacturer_string);
    listing.model        = utf8(info.product_string);
    listing.serial       = utf8(info.serial_number);
    return listing;
}

} // namespace

std::string hidSupport()
{
    return std::string("hidapi ") + hid_version_str();
}

bool hasHidSupport() noexcept
{
    return true;
}

// There is no hid_exit(): it would break other systems and their ports, and frees only a few bytes.
HidapiSystem::HidapiSystem()  = default;
HidapiSystem::~HidapiSystem() = default;

std::vector<HidListing> HidapiSystem::list()
{
    const std::lock_guard lock(globals());
    if (hid_init() != 0) throw Error("HID devices cannot be listed: hidapi does not start");
    const std::unique_ptr<hid_device_info, void (*)(hid_device_info*)> first(hid_enumerate(0, 0), hid_free_enumeration);
    last_.clear();
    for (const hid_device_info* info = first.get(); info; info = info->next)
        if (info->path) last_.push_back(listingOf(*info));
    return last_;
}

std::unique_ptr<HidPort> HidapiSystem::open(const std::string& path)
{
    const auto known = std::ranges::find(last_, path, &HidListing::path);
    if (known == last_.end())
        throw HidRefused(path + " is not a HID device of the last listing", "list the devices anew");

    const std::lock_guard lock(globals());
    if (hid_device* device = hid_open_path(path.c_str())) return std::make_unique<HidapiPort>(device, path);
    const std::string name    = known->model.empty() ? path : known->model + " (" + path + ")";
    const std::string reason  = utf8(hid_error(nullptr));
    const bool        allowed = reason.find("ermission") == std::string::npos;
    throw HidRefused(name + " cannot be opened: " + reason,
                     allowed ? "plug it in anew, and list the devices again"
                             : "put this line into /etc/udev/rules.d/70-palpate-hid.rules and plug it in anew: " +
                                   udevLine(known->vendor, known->product));
}

} // namespace palp
