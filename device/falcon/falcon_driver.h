#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "device/falcon/falcon_codec.h"
#include "device/falcon/falcon_link.h"

namespace palp {

/// Opens the bridge of one Falcon, the same one each time.
/// \throws Error, one sentence why it cannot be opened
using FalconLinkOpener = std::function<std::unique_ptr<FalconLink>()>;

struct FalconStartSettings {
    int    attempts = 10; ///< at most, each with a link opened anew; peers take 10 to 40
    double deadline = 30; ///< [s] for all of it; an attempt that goes well takes 0.8 s

    /// [s] of steady time after an attempt in which it could not be opened: a bridge needs some tenths of a second to
    /// be known to the system again.
    double reopenAfter = 0.3;

    /// Lets the bridge pass on each answer at its '>' in place of once a millisecond, which doubles the rate. Off until
    /// somebody has tried it on a device.
    bool eventCharacter = false;

    /// Told of each piece of the firmware that came back as it was sent: bytes so far, bytes in all. May take 20 ms.
    std::function<void(std::size_t, std::size_t)> onUpload{};
};

/// What a Falcon needs before forces can flow.
enum class FalconReadiness : std::uint8_t {
    ready,
    notHomed,  ///< its firmware runs
    noFirmware ///< or it is in no state to answer
};

/// Asks for answers, with packets of zero force and without lights, for 0.1 s at most. The link is to be closed then:
/// a boot loader that was asked may be deaf until it is opened anew.
/// \throws LinkLost
[[nodiscard]] FalconReadiness askFalcon(FalconLink& link);

/// A Falcon that answers.
struct StartedFalcon {
    std::unique_ptr<FalconLink> link;
    FalconReply                 reply{};      ///< its last answer
    int                         attempts = 0; ///< uploads that it took; 0: its firmware was running
};

/// Opens a Falcon and sees to it that its firmware runs: it is lost whenever the power is. Asks for answers first; then
/// uploads, in attempts that start from nothing; and believes none that does not end with answers. The motors get
/// nothing but zero.
///
/// \param firmware  bytes to upload; none: the firmware must be running
/// \param cancel    may become true on another thread: gives up within 0.1 s
/// \throws Error, one sentence: why, and what to try; what `open` throws, if that is at the first time
/// \source   libnifalcon (BSD-3), src/comm/FalconCommLibUSB.cpp: steps, divisors, lines, echo
/// \differs  it uploads without asking, reads the answer's length only, and does not look whether the result answers.
///           One author's driver found that asking spoils the upload; so the link is opened anew in between
StartedFalcon startFalcon(const FalconLinkOpener& open, std::span<const std::uint8_t> firmware,
                          const FalconStartSettings& settings = {}, const std::atomic<bool>* cancel = nullptr);

/// Three packets of zero force, each tried even where the one before failed; a device that is gone ends them.
/// \return false: it is gone
/// \param command  the lights of these packets
bool releaseMotors(FalconLink& link, const FalconCommand& command) noexcept;

} // namespace palp
