#include "device/haply/haply_record.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "device/detail/shared_library.h"
#include "device/detail/tcp_line.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::array kOptions{kHaplyEvents};

constexpr double kConnect = 1;   ///< [s] for a service elsewhere; on this machine it answers at once
constexpr double kLook    = 0.3; ///< [s] for each of its answers while devices are listed

HaplyOpener openerOf(const HaplyPath& path, std::uint16_t events = kHaplyEventsPort)
{
    return [path, events](HaplyPort port) {
        return connectTcp({path.host, port == HaplyPort::service ? path.port : events}, kConnect);
    };
}

/// Returns where a service is that nobody named: on this machine, or where PALPATE_HAPLY says.
HaplyPath usualPath()
{
    const std::string address = environmentOf("PALPATE_HAPLY");
    if (address.empty()) return {};
    try {
        HaplyPath path = parseHaplyPath(address);
        if (path.id.empty()) return path;
    } catch (const Error&) { // named below
    }
    throw Error("PALPATE_HAPLY: expected HOST:PORT, found \"" + address + "\"");
}

std::vector<DeviceListing> list(HidSystem& /*hid*/)
{
    const HaplyPath            path = usualPath();
    std::vector<DeviceListing> devices;
    try {
        for (const HaplyDescription& device : inspectHaply(openerOf(path), kLook).devices) {
            DeviceListing listing{
                .model = haplyInfo(device.type).model, .path = path.address() + "/" + device.id, .usable = true};
            listing.answers = true;
            if (!device.calibrated || !device.ready) {
                listing.why  = device.calibrated ? "it is not ready" : "it is not calibrated";
                listing.help = "switch it on, and move it as its service tells";
            }
            devices.push_back(std::move(listing));
        }
    } catch (const LineEnded&) { // there is no service, and so no device
    } catch (const WebSocketError& error) {
        throw Error("the program at " + path.address() + ", Haply's port, is no Inverse Service: " + error.what());
    }
    return devices;
}

std::unique_ptr<HapticDevice> make(const DeviceRequest& request)
{
    const HaplyPath   path   = parseHaplyPath(request.path, usualPath());
    const std::string events = textOf(request.options, kHaplyEvents);
    const auto        port   = events.empty() ? kHaplyEventsPort : std::uint16_t(numberOf(kHaplyEvents, events));
    return makeHaply(openerOf(path, port), {.id = path.id, .host = path.address()});
}

DeviceSupport support()
{
    constexpr const char* kService = "a socket to Haply's Inverse Service";
    try {
        return {true, std::string(kService) + " at " + usualPath().address(), ""};
    } catch (const Error&) { // list() says what is wrong with the address
        return {true, kService, ""};
    }
}

/// Returns what the service is, and what it does to a force.
std::vector<Finding> findings()
{
    const char* part = "haply service";
    try {
        const HaplyService   service = inspectHaply(openerOf(usualPath()), kLook);
        std::vector<Finding> found{
            {part, Verdict::ok, service.version.empty() ? "it does not say its version" : service.version}};
        for (const HaplyDescription& device : service.devices) {
            if (const std::string gate = describeGate(device); !gate.empty())
                found.push_back({part, Verdict::ok, gate});
            if (const std::string changed = describeFilters(device, service.forceScale); !changed.empty())
                found.push_back({part, Verdict::warning, changed, "set them back in the service's settings"});
        }
        return found;
    } catch (const LineEnded&) {
        return {{part, Verdict::ok, "not running; an Inverse3 or Minverse needs it, nothing else does"}};
    } catch (const WebSocketError& error) {
        return {{part, Verdict::warning, std::string("another program has its port: ") + error.what(),
                 "name the service's own by PALPATE_HAPLY=HOST:PORT"}};
    } catch (const Error& error) {
        return {{part, Verdict::missing, error.what()}};
    }
}

} // namespace

const DeviceRecord kHaplyRecord{.name     = "haply",
                                .model    = "Haply Inverse3 or Minverse",
                                .options  = kOptions,
                                .list     = list,
                                .make     = make,
                                .support  = support,
                                .findings = findings};

HaplyPath parseHaplyPath(const std::string& text, HaplyPath usual)
{
    HaplyPath         path    = std::move(usual);
    const std::size_t slash   = text.find('/');
    std::string       address = text.substr(0, slash);
    if (slash != std::string::npos) path.id = text.substr(slash + 1);
    constexpr const char* kForms =
        "haply: expected HOST:PORT, a device's number such as 049D, or HOST:PORT/NUMBER, found \"";
    const bool        isNumbered = address.starts_with('['); // [::1], an address of IPv6, perhaps with a port behind it
    const std::size_t bracket    = isNumbered ? address.find(']') : 0;
    const bool        isClosed   = bracket != std::string::npos;
    if (!isClosed || (isNumbered && bracket + 1 < address.size() && address[bracket + 1] != ':'))
        throw Error(kForms + text + "\"");
    const std::size_t colon = address.find(':', bracket) == std::string::npos ? std::string::npos : address.rfind(':');
    if (colon == std::string::npos && slash == std::string::npos && !isNumbered) {
        if (!address.empty() && !isHaplyId(address)) throw Error(kForms + text + "\"");
        path.id = std::exchange(address, {});
    } else if (colon != std::string::npos) {
        const char* const begin  = address.data() + colon + 1;
        const char* const end    = address.data() + address.size();
        const auto        number = std::from_chars(begin, end, path.port);
        if (number.ec != std::errc() || number.ptr != end || path.port == 0 || colon == 0)
            throw Error(kForms + text + "\"");
        path.host = address.substr(0, colon);
    } else if (!address.empty()) {
        path.host = address;
    }
    if (path.host.starts_with('[') && path.host.ends_with(']')) path.host = path.host.substr(1, path.host.size() - 2);
    if (!path.id.empty() && !isHaplyId(path.id))
        throw Error("haply: expected a device's number such as 049D, found \"" + path.id + "\"");
    return path;
}

std::unique_ptr<LineDevice> makeHaply(HaplyOpener open, const HaplyLineSettings& settings, const LineSettings& line)
{
    return std::make_unique<LineDevice>(std::make_unique<HaplyLine>(std::move(open), settings), haplyInfo("inverse3"),
                                        line);
}

} // namespace palp
