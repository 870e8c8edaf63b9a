#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "device/hid/hid_port.h"

namespace palp {

/// One device of a FakeHidSystem, as the test sees it.
/// \thread any
class FakeHidDevice {
public:
    using Report = std::vector<std::uint8_t>;

    /// Called with each report that the host writes, and with the lock: it may call nothing but `in`.
    std::function<void(const Report& written, std::deque<Report>& in)> onWrite;
    std::string                                                        refusal; ///< not empty: why it cannot be opened

    void send(Report report)
    {
        const std::lock_guard lock(mutex_);
        in_.push_back(std::move(report));
        changed_.notify_all();
    }
    void unplug()
    {
        const std::lock_guard lock(mutex_);
        gone_ = true;
        changed_.notify_all();
    }
    void refuseWrites()
    {
        const std::lock_guard lock(mutex_);
        refusesWrites_ = true;
    }
    [[nodiscard]] std::vector<Report> written() const
    {
        const std::lock_guard lock(mutex_);
        return written_;
    }
    [[nodiscard]] int openPorts() const
    {
        const std::lock_guard lock(mutex_);
        return openPorts_;
    }

private:
    friend class FakeHidPort;

    mutable std::mutex      mutex_;
    std::condition_variable changed_;
    std::deque<Report>      in_;
    std::vector<Report>     written_;
    bool                    gone_ = false, refusesWrites_ = false;
    int                     openPorts_ = 0;
};

class FakeHidPort : public HidPort {
public:
    explicit FakeHidPort(FakeHidDevice& device) : device_(device)
    {
        const std::lock_guard lock(device_.mutex_);
        ++device_.openPorts_;
    }
    ~FakeHidPort() override
    {
        const std::lock_guard lock(device_.mutex_);
        --device_.openPorts_;
    }

    std::size_t read(std::span<std::uint8_t> report, double timeout) override
    {
        std::unique_lock lock(device_.mutex_);
        const auto       ready = [&] { return device_.gone_ || !device_.in_.empty(); };
        device_.changed_.wait_for(lock, std::chrono::duration<double>(timeout), ready);
        if (device_.gone_) throw HidLost("unplugged");
        if (device_.in_.empty()) return 0;
        const FakeHidDevice::Report next = std::move(device_.in_.front());
        device_.in_.pop_front();
        const std::size_t size = std::min(next.size(), report.size());
        std::copy_n(next.begin(), size, report.begin());
        return size;
    }

    void write(std::span<const std::uint8_t> report) override
    {
        const std::lock_guard lock(device_.mutex_);
        if (device_.gone_ || device_.refusesWrites_) throw HidLost("not written");
        device_.written_.emplace_back(report.begin(), report.end());
        if (device_.onWrite) device_.onWrite(device_.written_.back(), device_.in_);
        device_.changed_.notify_all();
    }

private:
    FakeHidDevice& device_;
};

/// HID devices without hardware. It outlives what it has opened.
class FakeHidSystem : public HidSystem {
public:
    FakeHidDevice& plug(const HidListing& listing)
    {
        listings_.push_back(listing);
        return devices_[listing.path];
    }

    std::vector<HidListing> list() override { return listings_; }

    std::unique_ptr<HidPort> open(const std::string& path) override
    {
        const auto device = devices_.find(path);
        if (device == devices_.end()) throw HidRefused(path + " is not there", "");
        if (!device->second.refusal.empty()) throw HidRefused(device->second.refusal, "the line that helps");
        return std::make_unique<FakeHidPort>(device->second);
    }

private:
    std::vector<HidListing>              listings_;
    std::map<std::string, FakeHidDevice> devices_;
};

} // namespace palp
