#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "device/byte_line.h"
#include "device/haply/haply_line.h"
#include "device/haply/haply_message.h"
#include "device/haply/web_socket.h"

namespace palp {

/// What goes wrong between the service and a client.
enum class HaplyTrouble : std::uint8_t {
    none,
    silence,     ///< no answer
    garbage,     ///< answers are no JSON
    brokenFrame, ///< bytes that are no WebSocket
    notANumber,  ///< "x": NaN
    huge,        ///< "x": 1e308
    keyless,     ///< no position
    unlisted,    ///< the device is not in the answers
    split,       ///< byte by byte
    merged,      ///< each answer twice
    fragments,   ///< each answer in three frames, with a ping between them
    cut,         ///< the connection ends in the middle of a frame
    uncalibrated ///< the status says so
};

struct EmulatedHaplySettings {
    std::string              version    = "3.5.0";
    HaplyDialect             dialect    = HaplyDialect::vector; ///< that it understands
    bool                     takesForce = true;                 ///< false: it ignores forces in either
    std::vector<std::string> ids        = {"049D"}; ///< of its Inverse3; the first one has the arm; empty: none yet
    bool                     echoes     = true;     ///< it says what it renders
    bool                     hasGrip    = true;
    bool                     hasSpeed   = true; ///< it tells the velocity
    double                   forceGate  = 0.3;  ///< as in Haply's own example; the force is rendered whole
    double                   forceScale = 1;
    double                   hold       = 5e-3; ///< [s] assumed: without a message it renders nothing after that
    double                   start      = 0;    ///< [s] of its clock
};

/// Haply's Inverse Service with one Inverse3, down to the bytes of its sockets: HTTP, WebSocket, JSON. The real driver
/// talks to it. Written from the published conversation; where that is silent, what is assumed stands at the field.
/// \thread one; each line that connect() returns belongs to it too
class EmulatedHaply {
public:
    /// Moves the arm with a force [N] for a time [s] and returns its position [m], in our frame.
    using Arm = std::function<glm::dvec3(const glm::dvec3& force, double dt)>;

    /// One connection of a client.
    class Peer {
    public:
        Peer(EmulatedHaply& service, HaplyPort port) : service_(service), port_(port) {}

        void               receive(std::span<const std::uint8_t> bytes);
        [[nodiscard]] bool isSlow() const noexcept { return service_.trouble_ == HaplyTrouble::split; }

        std::string out{};            ///< bytes for the client
        bool        isClosed = false; ///< by the service
        bool        isSocket = false; ///< it is a WebSocket

    private:
        friend class EmulatedHaply;
        void answerHttp(const HttpHead& head);
        void obey(const std::string& message);
        void reply(const std::string& json);

        EmulatedHaply&  service_;
        HaplyPort       port_;
        std::string     head_{};
        WebSocketReader reader_{WebSocketSide::client};
        bool            hasPreset_ = false;
    };

    /// \param arm  if empty, the cursor stays in the middle
    explicit EmulatedHaply(EmulatedHaplySettings settings = {}, Arm arm = {});

    [[nodiscard]] std::unique_ptr<ByteLine> connect(HaplyPort port); ///< a line in this process
    [[nodiscard]] std::shared_ptr<Peer>     accept(HaplyPort port);  ///< for a server of sockets
    [[nodiscard]] HaplyOpener               opener();

    void moveTo(double time); ///< [s] moves the arm until then
    void press(std::uint32_t buttons) noexcept { buttons_ = buttons; }
    void turn(const glm::dquat& orientation) noexcept { orientation_ = orientation; } ///< of the grip, in our frame
    void cause(HaplyTrouble trouble) noexcept { trouble_ = trouble; }
    void plug(std::vector<std::string> ids) { settings_.ids = std::move(ids); }
    void raise(const std::string& event);                          ///< JSON, to every listener
    void endEvents();                                              ///< it ends the connections that hear events
    void repeat();                                                 ///< its state to every client, asked or not
    void ignoreForces() noexcept { settings_.takesForce = false; } ///< from now on, as if another client had them
    void stop();                                                   ///< it ends all connections, and takes no more

    [[nodiscard]] glm::dvec3         force() const noexcept;                           ///< [N] now, in our frame
    [[nodiscard]] const glm::dvec3&  position() const noexcept { return position_; }   ///< [m]
    [[nodiscard]] double             now() const noexcept { return time_; }            ///< [s]
    [[nodiscard]] double             lastForce() const noexcept { return lastForce_; } ///< [s] when it last pushed
    [[nodiscard]] std::uint64_t      requests() const noexcept { return requests_; }   ///< so far
    [[nodiscard]] const std::string& profile() const noexcept { return profile_; }     ///< of the last session

private:
    friend class Peer;
    [[nodiscard]] std::string picture(bool isFull, bool hasPreset) const;

    EmulatedHaplySettings              settings_;
    Arm                                arm_;
    std::vector<std::shared_ptr<Peer>> peers_;
    HaplyTrouble                       trouble_   = HaplyTrouble::none;
    bool                               isStopped_ = false;
    std::string                        profile_;
    std::uint64_t                      requests_ = 0;
    std::uint32_t                      buttons_  = 0;
    glm::dquat                         orientation_{1, 0, 0, 0};
    double                             time_ = 0, commanded_ = -1, lastForce_ = -1; ///< [s]
    glm::dvec3                         force_{}, position_{}, velocity_{};          ///< [N], [m], [m/s]
};

} // namespace palp
