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
#include "device/velocity_window.h"

namespace palp {

struct FalconLoopSettings {
    double         countsPerTorque = FalconMotors::kCountsPerTorque; ///< [counts/(N m)] see FalconCalibration
    FalconGeometry geometry{};
    double         workspaceRadius = 0.04;   ///< [m] sphere about the middle; 44 mm is the largest in reach of all legs
    double         velocityWindow  = 15e-3;  ///< [s] as the simulated arm and CHAI3D
    double         answerTimeout   = 2.5e-3; ///< [s] for an answer; with a latency timer of 1 ms it takes 1 to 1.5
    bool           showsState      = true;   ///< by falconLight()
};

/// The light of a Falcon that shows its state, FalconLoopSettings::showsState: red: to be homed; blue: no force flows;
/// green: forces flow.
[[nodiscard]] DeviceLight falconLight(const HapticState& state) noexcept;

/// What the host wants of one exchange.
struct FalconRequest {
    glm::dvec3   force{};                    ///< [N] on the hand, device's frame
    std::uint8_t lights = 0;                 ///< a sum of DeviceLight, where settings.showsState is off
    DeviceFault  host   = DeviceFault::none; ///< what the host itself has to complain of: then no force
};

/// The conversation with a Falcon whose firmware runs: packet out, packet in.
///
/// A force goes out only while the arm is homed and in its workspace, the last answer is less than 10 ms old and
/// nothing is at fault; after any break it comes on within 20 ms. What a fault of the line was is over after 20 good
/// answers in a row, except unplugged. An answer that would have the grip move faster than 4 m/s is not believed. An
/// answer that comes sooner than one can is another packet's, late or repeated: it counts, but the next is waited for.
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

private:
    enum class Placing : std::uint8_t { good, unknown, incredible }; ///< an answer's position

    void                      send(const FalconRequest& request, double now);
    [[nodiscard]] glm::dvec3  allowed(const FalconRequest& request, double now) noexcept;
    [[nodiscard]] FalconDrive drive(const FalconRequest& request, double now) noexcept;
    bool                      collect(double timeout);
    bool                      accept(const FalconReply& reply) noexcept;
    Placing                   place(const FalconReply& reply, double now) noexcept;
    void                      miss() noexcept;
    void                      lose() noexcept;

    std::unique_ptr<FalconLink> link_;
    FalconLoopSettings          settings_;
    FalconKinematics            kinematics_;
    FalconMotors                motors_;
    FalconParser                parser_;
    VelocityWindow              window_;
    HapticState                 state_{};
    FalconCommand               command_{};
    DeviceFault                 line_      = DeviceFault::none; ///< what is wrong with the line or the arm
    double                      gain_      = 0;                 ///< [1] of the force
    double                      sent_      = 0;                 ///< [s] when the last packet went out
    double                      answered_  = 0;                 ///< [s] when the last answer came that was believed
    double                      placed_    = 0;                 ///< [s] when the last position came
    bool                        hasPlace_  = false;             ///< there is one to compare the next with
    bool                        disbelief_ = false;             ///< an answer was not believed since the last that was
    int                         good_      = 0;                 ///< [1] answers with a position in a row
    int                         unsolved_  = 0;                 ///< [1] without one in a row
    std::uint64_t               skipped_   = 0;                 ///< [byte] by the parser at the last answer
};

} // namespace palp
