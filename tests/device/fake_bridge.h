#pragma once
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "device/hid/bridge_report.h"
#include "tests/device/fake_hid.h"

namespace palp {

/// What the system says of it.
inline HidListing ours()
{
    HidListing listing;
    listing.path      = "/dev/hidraw7";
    listing.usagePage = kBridgeUsagePage;
    listing.usage     = kBridgeUsage;
    listing.model     = "Workshop arm";
    return listing;
}

/// The firmware of a bridge, as device/README.md tells to write it: the last command counts, with a watchdog.
/// \thread any; its clock moves by tick() only
class FakeBridge {
public:
    explicit FakeBridge(FakeHidDevice& device) : device_(device)
    {
        answer.flags           = BridgeFlag::homed | BridgeFlag::inBox;
        answer.workspaceRadius = 0.05;
        answer.maximumForce    = 4;
        answer.buttonCount     = 2;
        device.onWrite         = [this](const FakeHidDevice::Report& written, std::deque<FakeHidDevice::Report>&) {
            BridgeCommand command;
            if (decode(written, command) != BridgeVerdict::good) return;
            const std::lock_guard lock(mutex_);
            heard_ = now_;
            commands_.push_back(command);
            times_.push_back(std::chrono::steady_clock::now());
            if (!command.enable) stopped_ = false;
            force_ = command.enable && !stopped_ ? command.force : glm::dvec3(0);
        };
    }
    ~FakeBridge() { device_.onWrite = nullptr; }

    /// One period of the firmware: the watchdog, then an answer.
    void tick(double seconds)
    {
        device_.send([&] {
            const std::lock_guard lock(mutex_);
            now_ += seconds;
            if (!commands_.empty() && commands_.back().enable && now_ - heard_ > commands_.back().watchdog) {
                force_   = {};
                stopped_ = true;
            }
            BridgeAnswer report = answer;
            report.sequence     = ++answer.sequence;
            report.deviceTime   = now_;
            report.rendered     = force_;
            report.command      = foreign ? std::uint16_t(foreignCommand_ += 1) : commandOf(late);
            if (stopped_) report.flags = report.flags | BridgeFlag::stopped;
            if (force_ != glm::dvec3(0)) report.flags = report.flags | BridgeFlag::motorsOn;
            const BridgeBytes bytes = encode(report);
            return FakeHidDevice::Report(bytes.begin(), bytes.end());
        }());
    }

    [[nodiscard]] glm::dvec3 force() const ///< [N] what the motors do
    {
        const std::lock_guard lock(mutex_);
        return force_;
    }
    [[nodiscard]] bool stopped() const
    {
        const std::lock_guard lock(mutex_);
        return stopped_;
    }
    [[nodiscard]] std::vector<BridgeCommand> commands() const
    {
        const std::lock_guard lock(mutex_);
        return commands_;
    }

    [[nodiscard]] std::vector<std::chrono::steady_clock::time_point> times() const ///< of the commands
    {
        const std::lock_guard lock(mutex_);
        return times_;
    }

    BridgeAnswer answer;          ///< the next one's; change it between ticks
    std::size_t  late    = 0;     ///< commands that wait on their way to the device
    bool         foreign = false; ///< it follows the commands of another program

private:
    [[nodiscard]] std::uint16_t commandOf(std::size_t back) const
    {
        return commands_.size() > back ? commands_[commands_.size() - 1 - back].sequence : std::uint16_t(0);
    }

    std::uint16_t                                      foreignCommand_ = 40'000;
    FakeHidDevice&                                     device_;
    mutable std::mutex                                 mutex_;
    double                                             now_ = 0, heard_ = 0; ///< [s]
    glm::dvec3                                         force_{};
    bool                                               stopped_ = false;
    std::vector<BridgeCommand>                         commands_;
    std::vector<std::chrono::steady_clock::time_point> times_;
};

} // namespace palp
