#include "engine/tools/bench/cpu_time.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "engine/compute/context.h"
#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/plate/plate_solver.h"

namespace palp::bench {
namespace {

double milliseconds(clockid_t clock)
{
    timespec now{};
    clock_gettime(clock, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

} // namespace

double threadMilliseconds()
{
    return milliseconds(CLOCK_THREAD_CPUTIME_ID);
}

double processMilliseconds()
{
    return milliseconds(CLOCK_PROCESS_CPUTIME_ID);
}

double wallMilliseconds()
{
    return milliseconds(CLOCK_MONOTONIC);
}

double now(Clock clock)
{
    return clock == Clock::processor ? processMilliseconds() : wallMilliseconds();
}

Quartiles quartiles(std::vector<double> values)
{
    PALP_EXPECT(!values.empty(), "no values");
    std::sort(values.begin(), values.end());
    const auto at = [&](double q) { // linear between the values
        const double place = q * double(values.size() - 1);
        const auto   below = std::size_t(place);
        const double share = place - double(below);
        return values[below] + share * (values[std::min(below + 1, values.size() - 1)] - values[below]);
    };
    return {at(0.25), at(0.5), at(0.75)};
}

Clock clockOf(compute::ProcessorKind kind)
{
    return kind == compute::ProcessorKind::software || kind == compute::ProcessorKind::host ? Clock::processor
                                                                                            : Clock::wall;
}

Clock clockOf(const compute::Context& context)
{
    return clockOf(context.processor().kind);
}

Clock clockOf(const PlateSolver& solver)
{
    if (solver.name() == compute::kHostProcessor || solver.name() == PlateSolver::kReference) return Clock::processor;
    const auto all   = compute::listProcessors();
    const auto found = std::ranges::find(all, solver.name(), &compute::Processor::name);
    return found == all.end() ? Clock::processor : clockOf(found->kind);
}

std::vector<Timing> takeTurns(const std::vector<Contestant>& contestants, int runs)
{
    struct Turns {
        std::vector<std::vector<double>> parts;
        std::vector<double>              total;
        double                           thread = 0, process = 0;
    };
    std::vector<Turns> turns(contestants.size());
    for (int run = -1; run < runs; ++run)
        for (std::size_t c = 0; c < contestants.size(); ++c) {
            Turns& s = turns[c];
            s.parts.resize(contestants[c].parts.size());
            const double thread = threadMilliseconds(), process = processMilliseconds();
            double       total = 0;
            for (std::size_t p = 0; p < contestants[c].parts.size(); ++p) {
                const double start = now(contestants[c].clock);
                contestants[c].parts[p]();
                const double took = now(contestants[c].clock) - start;
                if (run >= 0) s.parts[p].push_back(took);
                total += took;
            }
            if (run < 0) continue;
            s.total.push_back(total);
            s.thread += threadMilliseconds() - thread;
            s.process += processMilliseconds() - process;
        }
    std::vector<Timing> timings;
    for (const Turns& s : turns) {
        Timing timing{quartiles(s.total), {}, s.process > 0 ? std::max(0.0, 1 - s.thread / s.process) : 0};
        for (const auto& part : s.parts) timing.parts.push_back(quartiles(part));
        timings.push_back(std::move(timing));
    }
    return timings;
}

} // namespace palp::bench
