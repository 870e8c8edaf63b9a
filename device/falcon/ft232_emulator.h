#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "device/falcon/emulated_falcon.h"
#include "device/falcon/falcon_link.h"

namespace palp {

/// Troubles between a Falcon and the host.
enum class LinkTroubleKind : std::uint8_t {
    runt,         ///< answers lose their last two bytes
    merged,       ///< an answer is kept back until the next one, and comes with it
    split,        ///< an answer comes in two pieces, 1 ms apart
    garbage,      ///< five bytes of garbage before an answer
    replay,       ///< the answer of 50 packets ago comes in place of the new one
    repeat,       ///< an answer comes twice
    echoMismatch, ///< the loader's echo has a wrong bit
    silence,      ///< the device's answers are lost; it receives and acts
    stall,        ///< nothing moves in either direction; afterwards the link continues
    unplug        ///< LinkLost; afterwards it can be opened again
};

struct LinkTrouble {
    LinkTroubleKind kind  = LinkTroubleKind::silence;
    double          from  = 0;                                       ///< [s] by the emulator's clock
    double          until = std::numeric_limits<double>::infinity(); ///< [s]
};

struct Ft232EmulatorSettings {
    /// [s] of each transfer: a micro-frame of high-speed USB, as behind most hosts' and hubs' root ports [I].
    double                 transferTime = 125e-6;
    EmulatedFalconSettings falcon{};
    std::string            serial{}; ///< as FalconLink::serial()
};

/// A Falcon with its FT232R bridge on a USB in virtual time: only write, read and control let time pass. The same calls
/// give the same bytes and times, bit for bit.
///
///     write -> transfer -> 256 bytes of buffer -> 10 bits a byte at the divisor -> EmulatedFalcon
///     read  <- transfer <- packet of 2 status and at most 62 bytes <- 10 bits a byte <- its answer
///
/// The chip sends a packet when it has 62 bytes, when the event character comes, or when the latency timer runs out,
/// which restarts with each packet [I]. A byte is lost if the divisors of the two sides differ.
/// \thread one
/// \source Linux, drivers/usb/serial/ftdi_sio.h: requests, divisors, timer, event character; buffers of the FT232R: [I]
class Ft232Emulator final : public FalconLink {
public:
    explicit Ft232Emulator(const Ft232EmulatorSettings& settings = {}, EmulatedFalcon::Arm arm = {});

    /// Opens the link anew, which resets the chip. The link refers to this emulator, which must outlive it.
    /// \throws Error while it is unplugged
    [[nodiscard]] std::unique_ptr<FalconLink> connect();

    void cause(const LinkTrouble& trouble) { troubles_.push_back(trouble); }
    void waitUntil(double time); ///< [s] lets time pass until then; does nothing if that time is over

    [[nodiscard]] double      now() const noexcept override { return time_; }
    void                      control(FtdiRequest request, std::uint16_t value) override;
    void                      write(std::span<const std::uint8_t> bytes) override;
    std::size_t               read(std::span<std::uint8_t> bytes, double timeout) override;
    [[nodiscard]] std::string serial() const override { return settings_.serial; }

    [[nodiscard]] EmulatedFalcon&       falcon() noexcept { return falcon_; }
    [[nodiscard]] const EmulatedFalcon& falcon() const noexcept { return falcon_; }

private:
    struct WireByte {
        double        time; ///< [s] when its last bit has arrived
        std::uint8_t  value;
        std::uint16_t divisor;
    };
    struct UsbPacket {
        double                    time; ///< [s] when it reaches the host
        std::vector<std::uint8_t> bytes;
    };

    [[nodiscard]] bool   troubled(LinkTroubleKind kind, double time) const noexcept;
    [[nodiscard]] double unstalled(double time) const noexcept;
    void                 demandPlugged() const;
    [[nodiscard]] double nextEvent() const noexcept;
    void                 handleEvent();
    void                 answer(std::span<const std::uint8_t> bytes, std::uint16_t divisor, double time);
    void                 put(std::span<const std::uint8_t> bytes, std::uint16_t divisor, double time);
    void                 arrive(const WireByte& byte);
    void                 sendPacket(double time);
    void                 purge(bool received, bool toSend);

    Ft232EmulatorSettings     settings_;
    EmulatedFalcon            falcon_;
    std::vector<LinkTrouble>  troubles_;
    double                    time_           = 0;       ///< [s]
    std::uint16_t             divisor_        = 0x4138;  ///< of the host's side
    int                       eventCharacter_ = -1;      ///< none
    double                    latency_        = 16e-3;   ///< [s] the chip's initial value
    double                    timer_          = 16e-3;   ///< [s] when the latency timer runs out
    double                    outFree_ = 0, inFree_ = 0; ///< [s] when the wire is free
    std::deque<WireByte>      out_, in_;                 ///< on the wire, to the Falcon and from it
    std::vector<std::uint8_t> buffer_;                   ///< the chip's buffer towards the host
    std::deque<UsbPacket>     packets_;                  ///< on the way to the host
    std::deque<std::uint8_t>  host_;                     ///< bytes that reached the host, without the status bytes
    std::vector<std::uint8_t> held_;                     ///< an answer kept back: LinkTroubleKind::merged
    std::deque<FalconPacket>  past_;                     ///< for LinkTroubleKind::replay
    std::uint32_t             noise_ = 1;                ///< state of the garbage
};

} // namespace palp
