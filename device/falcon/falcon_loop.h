#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include <glm/vec3.hpp>

#include "device/falcon/falcon_codec.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/falcon/falcon_link.h"
#include "device/falcon/falcon_motors.h"
#include "device/haptic_device.h"
#include "device/velocity_filter.h"

namespace palp {

struct FalconLoopSettings {
    double         countsPerTorque = FalconMotors::kCountsPerTorque; ///< [counts/(N m)] see FalconCalibration
    FalconGeometry geometry{};
    double         workspaceRadius = 0.04;   ///< [m] sphere about the middle; 44 mm is the largest in reach of all legs
    double         velocityWindow  = 15e-3;  ///< [s] as in the simulated arm and CHAI3D
    double         answerTimeout   = 2.5e-3; ///< [s] for an answer; with a latency timer of 1 ms it takes 1 to 1.5
    bool           showsState      = true;   ///< by falconLight(); else the light is as the host says
};

/// Returns the light of a Falcon that shows its state, see FalconLoopSettings::showsState.
/// \param host  a sum of DeviceLight: forces flow only where the host's light is green too
[[nodiscard]] DeviceLight falconLight(const HapticState& state, std::uint8_t host = 0) noexcept;

/// Returns the meaning of that light for the user: "green  forces flow".
[[nodiscard]] const char* meaningOf(DeviceLight light) noexcept;

/// The host's request to one exchange.
struct FalconRequest {
    glm::dvec3   force{};             ///< [N] on the hand, device's frame
    std::uint8_t lights = 0;          ///< a sum of DeviceLight: green where the host lets forces flow
    double       share  = 1;          ///< [1] most share of the force; if it rises the force comes on as after a break
    bool         silent = false;      ///< nothing is sent: the motors keep the last force until the firmware lets go
    double       countsPerTorque = 0; ///< [counts/(N m)] from now on; 0: as before
    DeviceFault  host            = DeviceFault::none; ///< the host's own fault; no force flows while there is one
};

/// The conversation with a Falcon whose firmware runs: packet out, packet in.
///
/// A force is sent only while the arm is homed and in its workspace, the last answer is less than 10 ms old and there
/// is no fault; after any break it rises within 20 ms. A fault of the line ends after 20 good answers in a row, but a
/// lost link stays lost: `unplugged` if the device is gone, else `linkLost`. An answer that comes sooner than possible
/// belongs to another packet, late or repeated: it counts, but the loop waits for the next.
///
/// An answer by which the grip moves faster than 4 m/s is not believed. From then on there is no force until the grip
/// is back where it was within 5 ms, or 20 answers in a row agree on another place; after 5 ms the fault is
/// `kinematics`.
/// \thread one
class FalconLoop {
public:
    /// \throws Error naming a setting out of its range
    FalconLoop(std::unique_ptr<FalconLink> link, const FalconLoopSettings& settings);
    ~FalconLoop(); ///< sends three packets without force

    /// Sends one packet and reads answers until the newest is there, for settings.answerTimeout at most.
    /// \return the state after that; its time is by the link's clock
    const HapticState& exchange(const FalconRequest& request) noexcept;

    /// Reads answers until the link's clock shows `until` [s].
    void listen(double until) noexcept;

    [[nodiscard]] double             now() const noexcept { return link_->now(); } ///< [s] the link's clock
    [[nodiscard]] const HapticState& state() const noexcept { return state_; }

    /// Returns whether the link is lost. exchange() then does nothing; the state's fault says how the link was lost.
    [[nodiscard]] bool isLost() const noexcept { return loss_ != Loss::none; }

private:
    enum class Loss : std::uint8_t { none, broken, gone }; ///< of the link; a broken one may still take a packet

    void                      keepSilent();
    void                      send(const FalconRequest& request, double now);
    [[nodiscard]] glm::dvec3  allowed(const FalconRequest& request, double now) noexcept;
    [[nodiscard]] FalconDrive drive(const FalconRequest& request, double now) noexcept;
    bool                      collect(double timeout);
    bool                      accept(const FalconReply& reply) noexcept;
    bool                      placeGrip(const FalconReply& reply, double now) noexcept;
    [[nodiscard]] bool        isCredible(const glm::dvec3& here, double now) noexcept;
    void                      forgetPlace() noexcept;
    void                      miss() noexcept;
    void                      lose(Loss loss) noexcept;
    bool                      release() noexcept;

    std::unique_ptr<FalconLink> link_;
    FalconLoopSettings          settings_;
    FalconKinematics            kinematics_;
    FalconMotors                motors_;
    FalconParser                parser_;
    VelocityFilter              velocityFilter_;
    HapticState                 state_{};
    FalconCommand               command_{};
    DeviceFault                 line_      = DeviceFault::none; ///< what is wrong with the line or the arm
    double                      gain_      = 0;                 ///< [1] share of the force that is sent
    double                      sent_      = 0;                 ///< [s] when the last packet went out
    double                      answered_  = 0;                 ///< [s] when the last believed answer came
    double                      placed_    = 0;                 ///< [s] when the last position came
    bool                        hasPlace_  = false;             ///< there is a position to compare the next with
    bool                        disbelief_ = false;             ///< an answer since the last believed one was not
    bool                        inDoubt_   = false;             ///< the grip jumped and its place is uncertain
    glm::dvec3                  elsewhere_{};                   ///< [m] its place while in doubt, by the last answer
    double                      seen_     = 0;                  ///< [s] when that answer came
    int                         agreed_   = 0;                  ///< answers in a row that agree while in doubt
    Loss                        loss_     = Loss::none;
    int                         good_     = 0; ///< answers with a position in a row
    int                         unsolved_ = 0; ///< answers without a position in a row
    std::uint64_t               skipped_  = 0; ///< [byte] skipped by the parser up to the last answer
};

} // namespace palp
