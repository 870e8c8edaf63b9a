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
/// \throws Error saying in one sentence why it cannot be opened
using FalconLinkOpener = std::function<std::unique_ptr<FalconLink>()>;

struct FalconStartSettings {
    int    attempts = 10; ///< at most, each with a reopened link; other drivers take 10 to 40
    double deadline = 30; ///< [s] for all attempts; a successful one takes 0.8 s

    /// [s] wait in steady time after an attempt in which it could not be opened: the system needs some tenths of a
    /// second to list a bridge again.
    double reopenAfter = 0.3;

    /// Tries whether exchanges are faster if the bridge passes on each answer at its '>' instead of once a millisecond,
    /// and keeps it if they are: on the emulator that doubles the rate. It takes some 30 ms. False: it stays off.
    bool triesEventCharacter = true;

    /// Called for each piece of the firmware that was echoed correctly: bytes so far, bytes in all. It may take 20 ms.
    std::function<void(std::size_t, std::size_t)> onUpload{};

    /// Ends the start within 0.1 s once it is true; any thread may set it. Null: nothing does.
    const std::atomic<bool>* cancel = nullptr;
};

/// The state of a Falcon before forces can flow.
enum class FalconReadiness : std::uint8_t {
    ready,
    notHomed,  ///< its firmware runs
    noFirmware ///< or it cannot answer
};

/// Asks for answers, with packets of zero force and without lights, for 0.1 s at most. Close the link afterwards: a
/// boot loader that was asked may be deaf until the link is reopened.
/// \throws LinkLost if the link fails
[[nodiscard]] FalconReadiness askFalcon(FalconLink& link);

/// A Falcon that answers.
struct StartedFalcon {
    std::unique_ptr<FalconLink> link;
    FalconReply                 reply{};                    ///< its last answer
    int                         attempts           = 0;     ///< uploads that were needed; 0: its firmware was running
    bool                        usesEventCharacter = false; ///< its bridge passes on each answer at once
};

/// Opens a Falcon and makes sure that its firmware runs, which is lost with the power. It asks for answers first, then
/// uploads, in attempts that start from nothing; an attempt succeeds only if answers follow. At last it settles how the
/// bridge passes on answers, by which is faster. The motors get zero only.
///
/// \param firmware  bytes to upload; if empty, the firmware must be running
/// \throws Error saying in one sentence why and what to try; or what the first call of `open` throws
/// \source   libnifalcon (BSD-3), src/comm/FalconCommLibUSB.cpp: steps, divisors, lines, echo
/// \differs  libnifalcon uploads without asking, reads only the answer's length, and does not check whether the
///           firmware then answers. One author's driver found that asking spoils the upload, so the link is reopened in
///           between
StartedFalcon startFalcon(const FalconLinkOpener& open, std::span<const std::uint8_t> firmware,
                          const FalconStartSettings& settings = {});

/// Sends three packets of zero force, each even if the one before failed, unless the device is gone.
/// \param command  the lights of these packets
/// \return false if the device is gone
bool releaseMotors(FalconLink& link, const FalconCommand& command) noexcept;

} // namespace palp
