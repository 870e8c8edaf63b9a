#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/tools/bench/cpu_time.h"

namespace palp::bench {

/// One comparison: Palpate and a peer do the same work. A number that is not known is empty, and null in JSON.
struct BenchRow {
    std::string kind;               ///< new_map, new_load, contrast, jacobi, update, gather, grid_map, memory, batch,
                                    ///< table, shell, dispatches
    std::string           map;      ///< of the rigidity; empty where there is none
    std::optional<int>    nodes;    ///< a side
    std::string           accuracy; ///< discretisation, 1e-6, exact
    std::optional<double> target;   ///< the error that this accuracy allows [1]
    std::string           peer;

    std::optional<Quartiles> peerMs, palpateMs; ///< [ms]
    std::optional<double>    hidden;            ///< share of palpateMs that other threads than the caller's spent [1]
    std::vector<double>      peerPartsMs;       ///< medians: values, factors, solve [ms]
    std::vector<double>      palpatePartsMs;    ///< medians [ms], see partNames
    std::vector<std::string> partNames;         ///< of palpatePartsMs
    std::optional<double>    peerBytes, palpateBytes; ///< [byte]
    std::optional<double>    error, peerError; ///< see accuracy.h; of point queries the share of wrong answers [1]
    std::optional<double>    residual, peerResidual; ///< [1]
    std::optional<double>    tolerance;              ///< given to Palpate [1]
    std::optional<int>       iterations;
    std::optional<double>    workUnits;
    std::optional<double>    peerSweeps;   ///< of Jacobi
    std::optional<bool>      extrapolated; ///< of Jacobi: the time includes sweeps that were not made
    std::optional<double>    points, neighbours;
    std::optional<int>       loads, dispatchesPerCycle;     ///< of a batch: loads solved together, serial dispatches
    std::optional<double>    movedGigabytes, copyGigabytes; ///< least rate of a batch, rate of a plain copy [GB/s]
    std::string              schedule;                      ///< of dispatches
    std::optional<MultigridPlateSolver::CommandCounts> commands;
    std::string                                        note;

    /// Returns the peer's time or bytes over Palpate's; empty if Palpate's error is not known or exceeds the target.
    [[nodiscard]] std::optional<double> ratio() const
    {
        if (!error || (target && *error > *target)) return {};
        if (peerMs && palpateMs) return peerMs->median / palpateMs->median;
        if (peerBytes && palpateBytes) return *peerBytes / *palpateBytes;
        return {};
    }
};

} // namespace palp::bench
