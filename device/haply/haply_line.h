#pragma once
#include <functional>
#include <memory>
#include <string>

#include "device/byte_line.h"
#include "device/haply/haply_message.h"
#include "device/haply/web_socket.h"
#include "device/line_device.h"
#include "device/velocity_filter.h"

namespace palp {

/// A client's end of a WebSocket.
/// \thread one
class WebSocketClient {
public:
    /// Opens a connection on a line that was just made.
    /// \param timeout  [s] for the other side's answer
    /// \throws LineEnded, WebSocketError
    WebSocketClient(std::unique_ptr<ByteLine> line, const std::string& host, double timeout);

    /// \throws LineEnded
    void send(std::string_view text);
    void sendForce(std::string_view text); ///< by way of the guardian

    /// Returns the next text; waits up to `timeout` [s]. Answers pings.
    /// \throws LineEnded, also where the other side says goodbye; WebSocketError
    [[nodiscard]] std::optional<std::string> receive(double timeout);

    void                    sayGoodbye() noexcept;
    [[nodiscard]] ByteLine& line() noexcept { return *line_; }

private:
    [[nodiscard]] std::array<std::uint8_t, 4> mask() noexcept;

    std::unique_ptr<ByteLine> line_;
    WebSocketReader           reader_{WebSocketSide::server};
    std::uint64_t             random_;
};

/// The two ports of the service.
enum class HaplyPort : std::uint8_t {
    service, ///< 10001: requests and answers, and HTTP
    events   ///< 10020: what happens to the devices
};

/// Connects to a port.
/// \throws LineEnded saying why
using HaplyOpener = std::function<std::unique_ptr<ByteLine>(HaplyPort port)>;

/// Asks the service by HTTP GET.
/// \return the body of its answer; empty if it has none
/// \throws LineEnded if it cannot be reached
[[nodiscard]] std::string askHaply(const HaplyOpener& open, std::string_view path, double timeout);

/// What the service says of itself and its devices.
struct HaplyService {
    std::string                   version{}; ///< empty: it did not say
    std::optional<double>         forceScale{};
    std::vector<HaplyDescription> devices{};
    bool                          hasGrips = false;
};

/// Asks for it; the connection is closed again.
/// \throws LineEnded, WebSocketError
[[nodiscard]] HaplyService inspectHaply(const HaplyOpener& open, double timeout);

/// Says in sentences what the service does to a force on its way to the motors; empty if it says that it does nothing.
[[nodiscard]] std::string describeFilters(const HaplyDescription& device, std::optional<double> forceScale);

/// Returns what a device's force gate does, as a sentence; empty if it has none, or does not say.
[[nodiscard]] std::string describeGate(const HaplyDescription& device);

/// Returns the limits of a type of device: "inverse3", "minverse".
[[nodiscard]] HapticDeviceInfo haplyInfo(const std::string& type);

struct HaplyLineSettings {
    std::string id{};                           ///< of the device; empty: the first
    std::string host       = "127.0.0.1:10001"; ///< for messages
    double      openWait   = 2;                 ///< [s] for the service and its device, which may come late
    double      answerWait = 5e-3;              ///< [s] for one answer
};

/// The conversation with Haply's Inverse Service about one Inverse3 or Minverse.
///
/// One request is in flight; each brings one answer. A force lasts for one tick of the service, so that a client that
/// falls silent renders nothing. Which word the service takes before a force follows from its version, and is confirmed
/// by the force that it says it renders: after 20 answers without it the other word is tried, once, after a fault that
/// makes the governor engage anew. No force is ever sent to find out.
class HaplyLine : public DeviceLine {
public:
    HaplyLine(HaplyOpener open, const HaplyLineSettings& settings);
    ~HaplyLine() override { close(); }

    void open(HapticDeviceInfo& info) override;
    void exchange(const LineOrder& order, LineSample& sample) noexcept override;
    void close() noexcept override;

private:
    [[nodiscard]] HaplyDescription findDevice(double until, HaplyService& service);
    [[nodiscard]] HaplyDescription greet(HaplyDescription device);
    [[noreturn]] void              refuse(const HaplyService& service) const;
    void                           hearEvents(double now);
    bool                           hear(double timeout, LineSample& sample);
    void                           take(const std::string& answer, LineSample& sample);
    void                           checkEcho();
    void                           stop(double until, const char* words) noexcept;
    [[nodiscard]] const char*      whyStopped() const noexcept;
    void                           say(const LineOrder& order, double now);
    void                           letGo() noexcept; ///< asks for no force any more
    void                           lose(LineSample& sample, DeviceFault fault, const char* words) noexcept;

    HaplyOpener                      open_;
    HaplyLineSettings                settings_;
    std::unique_ptr<WebSocketClient> client_, events_;
    std::string                      id_;
    HaplyDialect                     dialect_ = HaplyDialect::vector;
    HaplyState                       state_;
    VelocityFilter                   moved_{15e-3};         ///< [s] of positions, where the service tells no velocity
    double                           clock_        = 0;     ///< [s] of the line
    double                           asked_        = 0;     ///< [s] when the last request left
    bool                             inFlight_     = false; ///< its answer has not come
    bool                             pushes_       = false; ///< the last request had a force
    double                           sent_         = 0;     ///< [N] its size
    int                              unheard_      = 0;     ///< answers in a row that deny the force
    int                              unasked_      = 0;     ///< exchanges in a row with answers to nothing
    int                              absent_       = 0;     ///< answers in a row that do not list the device
    bool                             confirmed_    = false; ///< an answer has shown a force
    bool                             swapped_      = false; ///< the other word is tried
    bool                             isGone_       = false; ///< an event says so
    bool                             isBraked_     = false; ///< the emergency brake acts, until it is released
    bool                             takesNone_    = false; ///< the service takes no forces
    double                           stoppedUntil_ = 0;     ///< by anything else [s]
    const char*                      stopWords_    = "";    ///< why, for anything else
    const char*                      brakeWords_   = "";
    std::uint64_t                    silenced_     = 0;
};

} // namespace palp
