#include "engine/session/detail/deformation_loop.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "engine/core/real_time.h"
#include "engine/session/detail/solve_pace.h"

namespace palp {

using Clock   = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

void DeformationLoop::run(const std::atomic<bool>& over, const std::atomic<Clock::rep>* stopped)
{
    Metronome     metronome(std::chrono::duration_cast<std::chrono::nanoseconds>(Seconds(period_)));
    SolvePace     pace(period_);
    std::uint64_t done = 0;
    while (!over) {
        metronome.wait();
        touch.take();
        const Touch* const newest = touch.held();
        if (!newest || newest->sequence == done) continue;
        done                     = newest->sequence;
        const auto        began  = Clock::now();
        const auto        before = stopped ? stopped->load() : 0;
        DeformationAnswer answer = solved(*newest, pace.begins(Seconds(began.time_since_epoch()).count()));
        const auto        pause  = Clock::duration((stopped ? stopped->load() : 0) - before); // stopped is not solving
        const double      took   = std::max(0.0, Seconds(Clock::now() - began - pause).count());
        if (!answer.update && !newest->touching) continue; // nothing is near
        if (answer.isSolved) pace.ended(took);
        slow.solve.add(took);
        slow.addPatch(answer.update != nullptr, answer.why);
        if (answer.ends) {
            update_.draft() = std::move(answer.ends);
            update_.publish();
        }
        if (!answer.update) continue;
        update_.draft() = std::move(answer.update);
        update_.publish();
        patch.draft() = {std::move(answer.patch), took};
        patch.publish();
    }
}

const PatchUpdate* DeformationLoop::newest(const ComplianceTable* inUse) noexcept
{
    update_.take([&](const auto& update) { return update && &update->table == inUse; });
    const auto* const taken = update_.newest();
    return taken ? taken->get() : nullptr; // no share of it: the last one may not end on the servo's thread
}

/// Solves one patch. If anything fails there is no patch for this touch, and the session goes on with the one before.
DeformationAnswer DeformationLoop::solved(const Touch& wanted, double lead)
{
    try {
        return solver_(wanted, lead);
    } catch (const std::exception& error) {
        return {{}, {}, error.what()};
    }
}

} // namespace palp
