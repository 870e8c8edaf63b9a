#include "engine/session/session_tap.h"

#include <utility>

#include "engine/session/marker.h"

namespace palp {

SessionTap::SessionTap(Recording* recording, std::vector<TickStream*> streams)
    : recording_(recording), streams_(std::move(streams))
{
}

void SessionTap::begin(std::chrono::steady_clock::time_point start) noexcept
{
    const SessionClocks clocks = SessionClocks::at(start);
    clocks_.draft()            = clocks;
    clocks_.publish();
    if (recording_ && !begun_) recording_->begin(clocks);
    begun_ = true;
    for (TickStream* const stream : streams_) stream->begin(clocks);
}

void SessionTap::push(const TickRecord& record) noexcept
{
    newest_.store(record.time, std::memory_order_relaxed);
    if (recording_) recording_->push(record);
    for (TickStream* const stream : streams_) stream->push(record);
}

void SessionTap::pushWaiting(const TickRecord& record) noexcept
{
    if (!begun_) begin(std::chrono::steady_clock::now()); // of the virtual clock's first tick
    newest_.store(record.time, std::memory_order_relaxed);
    if (recording_) recording_->pushWaiting(record);
    for (TickStream* const stream : streams_) stream->pushWaiting(record);
}

void SessionTap::mark(std::string_view text)
{
    const std::lock_guard lock(mutex_);
    clocks_.take();
    const SessionClocks* const known  = clocks_.held();
    const SessionClocks        clocks = known ? *known : SessionClocks::at(std::chrono::steady_clock::now());
    const Marker               marker{newest_.load(std::memory_order_relaxed), markerText(text)};
    if (recording_) recording_->mark(marker);
    for (TickStream* const stream : streams_) stream->mark(marker, clocks);
    ++marked_;
}

void SessionTap::lose(std::uint64_t markers)
{
    if (recording_) recording_->lose(markers);
    for (TickStream* const stream : streams_) stream->lose(markers);
}

} // namespace palp
