#include "engine/session/tick_stream.h"

#include <chrono>
#include <utility>

#include "engine/core/contract.h"
#include "engine/session/detail/quiet_thread.h"
#include "engine/session/lsl_outlet.h"
#include "engine/session/udp_outlet.h"

namespace palp {
namespace {

constexpr std::size_t kRing          = 4096; // records: 4 s at 1 kHz
constexpr std::size_t kMostMarkers   = 256;  // that wait
constexpr auto        kVisits        = std::chrono::milliseconds(1);
constexpr const char* kLabStreaming  = "lsl";
constexpr const char* kLabStreamName = "Palpate";

} // namespace

std::unique_ptr<TickOutlet> openOutlet(const std::string& name)
{
    const std::string named = std::string(kLabStreaming) + ":";
    if (name == kLabStreaming) return std::make_unique<LslOutlet>(kLabStreamName);
    if (name.starts_with(named) && name.size() > named.size())
        return std::make_unique<LslOutlet>(name.substr(named.size()));
    if (name.starts_with("udp:")) return std::make_unique<UdpOutlet>(parseUdpAddress(name, "--stream"));
    throw Error("--stream: expected udp:HOST:PORT, lsl or lsl:NAME, found \"" + name + "\"");
}

TickStream::TickStream(std::unique_ptr<TickOutlet> outlet)
    : outlet_(std::move(outlet)), ring_(kRing), thread_(quietThread([this] { work(); }))
{
}

TickStream::~TickStream()
{
    finish();
}

void TickStream::push(const TickRecord& record) noexcept
{
    static_cast<void>(ring_.push({record, clocks_, ++pushed_}));
}

void TickStream::pushWaiting(const TickRecord& record) noexcept
{
    const StreamedTick tick{record, clocks_, ++pushed_};
    while (!ring_.push(tick)) std::this_thread::yield();
}

void TickStream::mark(const Marker& marker, const SessionClocks& clocks)
{
    const std::lock_guard lock(mutex_);
    ++markersSeen_; // also of what finds no room: a gap in the numbers tells of it
    if (markers_.size() < kMostMarkers) markers_.push_back({marker, clocks, markersSeen_});
}

void TickStream::lose(std::uint64_t markers)
{
    const std::lock_guard lock(mutex_);
    markersSeen_ += markers; // likewise
}

StreamReport TickStream::finish()
{
    if (thread_.joinable()) {
        finishing_.store(true, std::memory_order_release);
        thread_.join();
    }
    const std::lock_guard lock(mutex_);
    return {outlet_->name(), sent_, pushed_ - sent_, markersSent_, markersSeen_ - markersSent_};
}

void TickStream::work()
{
    for (bool more = true; more;) {
        more = !finishing_.load(std::memory_order_acquire); // before the last look: earlier records are seen
        sendTicks();
        sendMarkers();
        if (more) std::this_thread::sleep_for(kVisits);
    }
}

void TickStream::sendTicks()
{
    for (auto ticks = ring_.front(); !ticks.empty(); ticks = ring_.front()) {
        for (const StreamedTick& tick : ticks)
            if (outlet_->send(tick)) ++sent_;
        ring_.pop(ticks.size());
    }
}

void TickStream::sendMarkers()
{
    std::vector<StreamedMarker> markers;
    {
        const std::lock_guard lock(mutex_);
        markers.swap(markers_);
    }
    for (const StreamedMarker& marker : markers)
        if (outlet_->send(marker)) ++markersSent_;
}

} // namespace palp
