#include "tests/soak/faulty_solver.h"

#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include "tests/support/failing_memory.h"

namespace palp::soak {

/// Solves as the thread of a session does: what is thrown costs this answer, and the next touch is solved again.
FaultySolver::Update FaultySolver::solve(const Touch& touch, double lead, bool isDry)
{
    ++solved_;
    std::optional<FailingMemory> dry;
    if (isDry) dry.emplace(std::int64_t(chance_.scaleFrom(1, 20'000)));
    try {
        return deformation_.solve(touch, lead).update;
    } catch (const std::exception&) {
        return nullptr;
    }
}

FaultySolver::Update FaultySolver::answer(const Touch& touch, double lead)
{
    const auto trouble =
        chance_.is(rate_) ? SolverTrouble(1 + chance_.below(int(SolverTrouble::count) - 1)) : SolverTrouble::none;
    troubles_ += trouble != SolverTrouble::none;
    if (late_ && --waits_ <= 0) { // answers keep their order, but this one is old
        const Update late = std::exchange(late_, nullptr);
        return numbered(late, late->table.time);
    }
    if (trouble == SolverTrouble::silent) return nullptr;

    const bool isDry = trouble == SolverTrouble::dry;
    Update     found;
    if (isDry || kept_.empty() || chance_.is(fresh_)) {
        found = solve(touch, lead, isDry);
        if (!found) return nullptr;
        found = numbered(found, touch.time);
        if (kept_.size() < kKept)
            kept_.push_back(found);
        else
            kept_[std::size_t(chance_.below(kKept))] = found;
    } else {
        found = numbered(kept_[std::size_t(chance_.below(int(kept_.size())))], touch.time);
    }
    if (trouble == SolverTrouble::garbage || trouble == SolverTrouble::extreme || trouble == SolverTrouble::replaced)
        found = spoiled(found);
    if (trouble != SolverTrouble::late) return found;
    late_  = found;
    waits_ = 1 + chance_.below(40);
    return nullptr;
}

/// Returns a copy with the next number: the deformation fills its own slots again.
FaultySolver::Update FaultySolver::numbered(const Update& update, double time)
{
    auto copy            = std::make_shared<PatchUpdate>(*update);
    copy->table.sequence = ++sequence_;
    copy->table.time     = time;
    return copy;
}

FaultySolver::Update FaultySolver::spoiled(const Update& update)
{
    auto             copy  = std::make_shared<PatchUpdate>(*update);
    ComplianceTable& table = copy->table;
    auto&            entry = (chance_.is(0.5) ? table.compliance
                                              : table.contactStiffness)[std::size_t(chance_.below(ComplianceTable::kMostEntries))];
    switch (chance_.below(8)) {
    case 0:
        entry.value = std::numeric_limits<double>::quiet_NaN();
        break;
    case 1:
        entry.slopeX = std::numeric_limits<double>::infinity();
        break;
    case 2:
        table.side = 9; // more than there are
        break;
    case 3:
        table.side = -1;
        break;
    case 4:
        table.spacing = std::numeric_limits<double>::quiet_NaN();
        break;
    case 5:
        for (auto& each : table.compliance) each.value -= 20; // hard as steel
        break;
    case 6:
        for (auto& each : table.contactStiffness) each.value += chance_.from(-30, 30);
        break;
    default:
        entry.value += chance_.from(-500, 500);
        break;
    }
    return copy;
}

} // namespace palp::soak
