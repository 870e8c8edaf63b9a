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
    double         velocityWindow  = 15e-3;  ///< [s] as the simulated arm and CHAI3D
    double         answerTimeout   = 2.5e-3; ///< [s] for an answer; with a latency timer of 1 ms it takes 1 to 1.5
    bool           showsState      = true;   ///< by falconLight()
};

/// The light of a Falcon that shows its state, see FalconLoopSettings::showsState.
[[nodiscard]] DeviceLight falconLight(const HapticState& state) noexcept;

/// What that light tells the user: "green  forces flow".
[[nodiscard]] const char* meaningOf(DeviceLight light) noexcept;

/// What the host wants of one exchange.
struct FalconRequest {
    glm::dvec3   force{};    ///< [N] on the hand, device's frame
    std::uint8_t lights = 0; ///< a sum of DeviceLight, where settings.showsState is off
    double       share  = 1; ///< [1] of the force at most; beyond it the force comes on as after a break
    DeviceFault  host   = DeviceFault::none; ///< what the host itself has to complain of: then no force
};

/// The conversation with a Falcon whose firmware runs: packet out, packet in.
///
/// A force goes out only while the arm is homed and in its workspace, the last answer is less than 10 ms old and
/// nothing is at fault; after any break it comes on within 20 ms. What a fault of the line was is over after 20 good
/// answers in a row; but a link that is lost stays so, `unplugged` if the device is gone, else `silent`. An answer that
/// comes sooner than one can is another packet's, late or repeated: it counts, but the next is waited for.
///
/// An answer that would have the grip move faster than 4 m/s is not believed. From then on there is no force until the
/// grip is back where it was within 5 ms, or 20 answers in a row agree on another place; after 5 ms it is a fault,
/// `kinematics`.
/// \thread one
class FalconLoop {
public:
    /// \throws Error naming a setting out of its range
    FalconLoop(std::unique_ptr<FalconLink> link, const FalconLoopSettings& settings);
    ~FalconLoop(); ///< three packets without force

    /// One packet out, and answers in until the newest is there: settings.answerTimeout at most.
    /// \return the state then; time by the link's clock
    const HapticState& exchange(const FalconRequest& request) noexcept;

    /// Takes in what comes until the link's clock shows `until` [s].
    void listen(double until) noexcept;

    [[nodiscard]] double             now() const noexcept { return link_->now(); } ///< [s] the link's clock
    [[nodiscard]] const HapticState& state() const noexcept { return state_; }

    /// The link is lost: exchange() does nothing any more. The state's fault says how.
    [[nodiscard]] bool isLost() const noexcept { return loss_ != Loss::none; }

private:
    enum class Loss : std::uint8_t { none, broken, gone }; ///< of the link: broken, it may still take a packet

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
    double                      gain_      = 0;                 ///< [1] of the force
    double                      sent_      = 0;                 ///< [s] when the last packet went out
    double                      answered_  = 0;                 ///< [s] when the last answer came that was believed
    double                      placed_    = 0;                 ///< [s] when the last position came
    bool                        hasPlace_  = false;             ///< there is one to compare the next with
    bool                        disbelief_ = false;             ///< an answer was not believed since the last that was
    bool                        inDoubt_   = false;             ///< it jumped, and where it is now is not settled
    glm::dvec3                  elsewhere_{};                   ///< [m] where it was then, by the last answer
    double                      seen_     = 0;                  ///< [s] when that answer came
    int                         agreed_   = 0;                  ///< answers in a row that agree with each other then
    Loss                        loss_     = Loss::none;
    int                         good_     = 0; ///< answers with a position in a row
    int                         unsolved_ = 0; ///< without one in a row
    std::uint64_t               skipped_  = 0; ///< [byte] by the parser at the last answer
};

} // namespace palp
