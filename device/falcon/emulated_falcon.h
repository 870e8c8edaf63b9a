#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "device/falcon/falcon_codec.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/falcon/falcon_link.h"
#include "device/falcon/falcon_motors.h"

namespace palp {

/// The behaviour of an emulated Falcon. Values that were not measured are marked [I] for inferred.
struct EmulatedFalconSettings {
    bool running = false; ///< the firmware is up from an earlier session
    bool homed   = false; ///< the legs have met their stops as well

    /// Bytes at another baud before the firmware is up make the boot loader deaf until the link is reopened.
    /// [I] One driver's author reports that asking for running firmware spoils the upload that follows.
    bool probingDeafens = true;

    double holdTime        = 20e-3; ///< [s] without a packet, after which the motors let go [I]
    double answerTime      = 50e-6; ///< [s] from the end of a packet to the start of the answer [I]
    double countsPerTorque = FalconMotors::kCountsPerTorque; ///< [counts/(N m)]

    std::array<int, 3> offset{-700, 300, 512}; ///< [counts] error of the encoders before homing
    double             outerStop = 600;        ///< [counts] a leg is homed after it was as far out as this [I] ...
    double             innerStop = -1300;      ///< [counts] ... and then as far in as this [I]

    FalconGeometry geometry{};
};

/// The program that runs on the Falcon's own processor.
enum class FalconStage : std::uint8_t {
    asleep,  ///< no firmware; needs a pulse of DTR: low, then high
    hello,   ///< waits for 0A 43 0D at 9600 baud, answers 0A 44 2C 0D
    greeted, ///< waits for 41 with DTR low, and answers it
    loader,  ///< stores and echoes every byte, until one comes at 1.5 Mbaud
    running
};

/// A Falcon behind its serial bridge: boot loader, firmware, motors, encoders and the arm, without USB. Any 4096 to
/// 16384 bytes are a firmware. After `holdTime` without a packet its motors let go.
/// \thread one
/// \source libnifalcon (BSD-3), src/comm/FalconCommLibUSB.cpp and src/firmware/FalconFirmwareNovintSDK.cpp: the bytes
class EmulatedFalcon {
public:
    /// Moves the arm; both vectors in the device's frame, as HapticState's.
    /// \param force  [N] on the hand
    /// \param dt     [s] 0 to 1 ms; 0 only asks for the position
    /// \return position of the grip after `dt` [m]
    using Arm = std::function<glm::dvec3(const glm::dvec3& force, double dt)>;

    /// \param arm  if empty, the grip stays in the middle
    /// \throws Error naming a setting out of its range
    explicit EmulatedFalcon(const EmulatedFalconSettings& settings = {}, Arm arm = {});

    /// Takes one complete byte, received at that divisor and time [s].
    /// \return the answer, which is valid until the next call
    std::span<const std::uint8_t> receive(std::uint8_t byte, std::uint16_t divisor, double time);

    void setDtr(bool high) noexcept;
    void linkOpened() noexcept { deaf_ = false; }                  ///< as by replugging
    void press(std::uint8_t buttons) noexcept { grip_ = buttons; } ///< bits as FalconReply::grip
    void powerCycle();                                             ///< the firmware and the homing are lost

    void moveTo(double time); ///< [s] moves the arm until then

    [[nodiscard]] FalconStage                      stage() const noexcept { return stage_; }
    [[nodiscard]] const std::vector<std::uint8_t>& image() const noexcept { return image_; }     ///< the firmware
    [[nodiscard]] const FalconCommand&             command() const noexcept { return command_; } ///< the last one
    [[nodiscard]] std::array<std::int16_t, 3>      motors() const noexcept; ///< [counts] zero once they have let go
    [[nodiscard]] const glm::dvec3&                position() const noexcept { return position_; } ///< [m] true
    [[nodiscard]] double                           answerTime() const noexcept { return settings_.answerTime; } ///< [s]
    [[nodiscard]] double        lastTorque() const noexcept { return lastTorque_; } ///< [s] when a motor last pushed
    [[nodiscard]] std::uint64_t packets() const noexcept { return packets_; }       ///< good ones so far

private:
    [[nodiscard]] std::uint16_t   divisor() const noexcept;
    std::span<const std::uint8_t> boot(std::uint8_t byte);
    std::span<const std::uint8_t> load(std::uint8_t byte);
    std::span<const std::uint8_t> run(std::uint8_t byte, double time);
    [[nodiscard]] FalconReply     reply();
    [[nodiscard]] glm::dvec3      force() const;
    std::span<const std::uint8_t> say(std::initializer_list<std::uint8_t> bytes);

    EmulatedFalconSettings      settings_;
    Arm                         arm_;
    FalconKinematics            kinematics_;
    FalconMotors                motors_;
    FalconStage                 stage_ = FalconStage::asleep;
    bool                        dtr_   = true;
    bool                        deaf_  = false;
    std::array<std::uint8_t, 3> heard_{}; ///< the last bytes, the newest at the end
    std::vector<std::uint8_t>   image_;
    FalconPacket                incoming_{};
    std::size_t                 filled_ = 0; ///< bytes of incoming_
    FalconPacket                outgoing_{};
    FalconCommand               command_{};
    double                      commanded_ = -1; ///< [s] time of the last command
    std::uint64_t               packets_   = 0;
    std::uint8_t                grip_ = 0, homedLegs_ = 0, wasOut_ = 0;
    double                      time_       = 0;  ///< [s] time up to which the arm has moved
    double                      lastTorque_ = -1; ///< [s]
    glm::dvec3                  position_{};      ///< [m]
};

} // namespace palp
