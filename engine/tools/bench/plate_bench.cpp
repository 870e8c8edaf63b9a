#include "engine/tools/bench/plate_bench.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/compute/context.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/bench/batch_bench.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/damped_jacobi.h"
#include "engine/tools/bench/outside_peers.h"

namespace palp::bench {
namespace {

constexpr double kTight = 1e-6; // the second accuracy, of the largest deflection [1]

/// Largest grid for which Eigen computes the truth. Larger ones need CHOLMOD: Eigen would take minutes and gigabytes.
constexpr int kMostNodesWithoutCholmod = 513; // a side

/// Palpate at the loosest tolerance that gives an accuracy.
///
/// A tolerance bounds an estimate in the energy norm, which for smooth rigidities is 10 to 30 times the largest error,
/// so it says little about the error itself. Comparing times at equal errors needs the tolerance that just suffices: it
/// is found by trial, half a decade at a time, and is in the row.
struct Tuned {
    std::unique_ptr<MultigridPlateSolver> solver;
    double                                tolerance = 0, error = 0, target = 0;
    SolveReport                           report;
    NodeField                             answer;
    std::size_t                           bytes = 0; ///< of its buffers
};

class PlateBench {
public:
    PlateBench(compute::Context& context, const PlateKernels& kernels, const PlateBenchOptions& options,
               const OnStep& onStep)
        : context_(context), kernels_(kernels), o_(options), onStep_(onStep), clock_(clockOf(context))
    {
    }

    std::vector<BenchRow> measure()
    {
        struct Step {
            const char*           kind; ///< null: not a comparison
            int                   nodes;
            std::function<void()> work;
        };
        std::vector<Step> steps;
        for (const int nodes : o_.nodes) {
            if (has("memory") && nodes == largestForMemory())
                steps.push_back({"memory", nodes, [this, nodes] { compareMemory(nodes); }});
            for (const Map& map : maps()) {
                const bool wanted = map.smooth ? has("new_map") || loadsOn(map) : has("contrast");
                if (wanted && nodes >= kFewestNodes && isFor(map, nodes))
                    steps.push_back({map.smooth ? "new_map" : "contrast", nodes,
                                     [this, &map, nodes] { compareDirect(map, nodes); }});
            }
            if (has("batch") && nodes <= kMostNodesForBatch)
                steps.push_back({"batch", nodes, [this, nodes] {
                                     for (BenchRow& row : measureBatches(context_, kernels_, nodes, o_.runs))
                                         rows_.push_back(std::move(row));
                                 }});
            if (has("jacobi") && nodes <= kMostNodesForJacobi)
                steps.push_back({"jacobi", nodes, [this, nodes] { compareJacobi(nodes); }});
            steps.push_back(
                {nullptr, nodes, [this, nodes] { directs_.erase(nodes / 2 + 1); }}); // no finer grid needs it
        }
        const double start = wallMilliseconds();
        for (std::size_t n = 0; n < steps.size(); ++n) {
            onStep_(n, steps.size());
            if (steps[n].kind && wallMilliseconds() - start > 1e3 * o_.patience) {
                rows_.push_back(rowOf(steps[n].kind, {}, steps[n].nodes, "", ""));
                rows_.back().note = "omitted: the time is up";
            } else {
                steps[n].work();
            }
        }
        return std::move(rows_);
    }

private:
    static constexpr int kFewestNodes        = 65;
    static constexpr int kMostNodesForJacobi = 65;
    static constexpr int kMostNodesForBatch  = 257; ///< 49 loads beyond take gigabytes

    [[nodiscard]] bool has(const char* kind) const { return std::ranges::find(o_.cases, kind) != o_.cases.end(); }

    /// Selects the maps for new loads: the work hardly differs between smooth maps.
    [[nodiscard]] bool loadsOn(const Map& map) const
    {
        return has("new_load") && map.smooth && (!o_.quick || map.name == "linear");
    }

    [[nodiscard]] bool isFor(const Map& map, int nodes) const
    {
        constexpr int kMostNodesForAll = 129; // a side, of --quick
        if (!o_.maps.empty()) return std::ranges::find(o_.maps, map.name) != o_.maps.end();
        if (!o_.quick) return true;
        if (nodes <= kMostNodesForAll) return map.name != "discs";
        return map.name == "linear" || map.name == "wart" || map.name == "disc_100" || map.name == "disc_0.1";
    }

    [[nodiscard]] int largestForMemory() const
    {
        int most = 0;
        for (const int nodes : o_.nodes)
            if (nodes <= o_.mostMemory) most = std::max(most, nodes);
        return most;
    }

    // --- truth

    /// Returns the best direct solver for a grid, analysed once; empty if none would finish soon.
    Direct* directFor(int nodes)
    {
        if (!outsidePeers().cholmod && nodes > kMostNodesWithoutCholmod) return nullptr;
        auto at = directs_.find(nodes);
        if (at == directs_.end()) {
            Direct direct{PlateMatrix(plateOf(maps().front(), nodes)), {}};
            direct.solver = outsidePeers().cholmod ? outsidePeers().cholmod(direct.matrix) : eigenSolver(direct.matrix);
            at            = directs_.emplace(nodes, std::move(direct)).first;
        }
        return &at->second;
    }

    struct Goal {
        NodeField             force;
        std::optional<Truth>  truth;
        std::optional<double> discretisation; ///< error of the grid [1], where it is of second order
    };

    Goal goalFor(const Map& map, int nodes, double x, double z)
    {
        const Plate plate = plateOf(map, nodes);
        Goal        goal{fingertip(plate.grid, x, z), {}, {}};
        Direct*     direct = directFor(nodes);
        if (!direct) return goal;
        goal.truth = refinedTruth(*direct, plate, goal.force);
        if (map.smooth && nodes % 2 == 1) {
            const int   fewer   = nodes / 2 + 1;
            const Plate coarse  = plateOf(map, fewer);
            goal.discretisation = discretisationError(
                goal.truth->w, refinedTruth(*directFor(fewer), coarse, fingertip(coarse.grid, x, z)).w);
        }
        return goal;
    }

    // --- Palpate

    Tuned tryTolerance(const Plate& plate, const Goal& goal, double tolerance, double target)
    {
        const std::size_t before = context_.allocatedBytes();
        Tuned             tuned;
        tuned.solver           = std::make_unique<MultigridPlateSolver>(context_, kernels_, plate,
                                                              MultigridPlateSolver::Settings{.tolerance = tolerance});
        PlateSolution solution = tuned.solver->solve(goal.force);
        tuned.bytes            = context_.allocatedBytes() - before;
        tuned.tolerance        = tolerance;
        tuned.target           = target;
        tuned.error            = errorOf(solution.deflection, goal.truth->w);
        tuned.report           = solution.report;
        tuned.answer           = std::move(solution.deflection);
        return tuned;
    }

    Tuned tuned(const Plate& plate, const Goal& goal, double target)
    {
        constexpr double kStep = 0.31622776601683794, kLoosest = 0.3; // half a decade [1]
        double           tolerance = std::min(kLoosest, 10 * target);
        Tuned            found     = tryTolerance(plate, goal, tolerance, target);
        if (found.error <= target) {
            while (tolerance / kStep <= kLoosest) {
                tolerance /= kStep;
                Tuned looser = tryTolerance(plate, goal, tolerance, target);
                if (looser.error > target) break;
                found = std::move(looser);
            }
            return found;
        }
        while (found.error > target && tolerance * kStep >= MultigridPlateSolver::kLeastTolerance) {
            tolerance *= kStep;
            found.solver.reset(); // frees its memory before the next one is made
            found = tryTolerance(plate, goal, tolerance, target);
        }
        return found;
    }

    // --- rows

    BenchRow rowOf(const char* kind, std::string_view map, int nodes, const char* accuracy,
                   const std::string& peer) const
    {
        BenchRow row;
        row.kind     = kind;
        row.map      = map;
        row.nodes    = nodes;
        row.accuracy = accuracy;
        row.peer     = peer;
        return row;
    }

    static void put(BenchRow& row, const Tuned& t)
    {
        row.error      = t.error;
        row.target     = t.target;
        row.tolerance  = t.tolerance;
        row.iterations = t.report.iterations;
        row.workUnits  = t.report.workUnits;
        if (t.error > t.target) row.note = "Palpate does not reach this accuracy here";
    }

    static void put(BenchRow& row, const Timing& ours)
    {
        row.palpateMs = ours.total;
        row.hidden    = ours.hidden;
        for (const Quartiles& part : ours.parts) row.palpatePartsMs.push_back(part.median);
    }

    /// A peer and its measurements for one grid.
    struct Rival {
        std::string             name, note;
        std::unique_ptr<Direct> direct; ///< empty if the library is missing
        std::vector<double>     right, answer;
        double                  newMapError = 0, newLoadError = 0;
    };

    std::vector<Rival> rivalsFor(const Map& map, int nodes)
    {
        std::vector<Rival> rivals;
        const auto         add = [&](std::string name, const auto& make) {
            auto direct         = std::make_unique<Direct>(Direct{PlateMatrix(plateOf(map, nodes)), {}});
            direct->solver      = make(direct->matrix);
            const std::size_t n = std::size_t(direct->matrix.unknowns());
            rivals.push_back(
                        {std::move(name), {}, std::move(direct), std::vector<double>(n), std::vector<double>(n), 0, 0});
        };
        if (outsidePeers().cholmod)
            add("CHOLMOD", outsidePeers().cholmod);
        else
            rivals.push_back({"CHOLMOD", outsidePeers().cholmodNote, {}, {}, {}, 0, 0});
        // A direct solver's work depends on the pattern alone: one map represents all.
        if (map.name == "linear" && nodes <= o_.mostEigen) add("Eigen SimplicialLDLT", eigenSolver);
        return rivals;
    }

    /// Compares a new map and a new load with direct solvers, all in turns.
    void compareDirect(const Map& map, int nodes)
    {
        const Plate plate   = plateOf(map, nodes);
        const bool  mapRows = !map.smooth || has("new_map"), loadRows = loadsOn(map);
        const Goal  goal  = goalFor(map, nodes, 0.5, 0.5);
        const Goal  other = loadRows ? goalFor(map, nodes, 0.35, 0.6) : Goal{};
        const char* kind  = map.smooth ? "new_map" : "contrast";
        if (!goal.truth) {
            for (const char* k : {mapRows ? kind : "", loadRows ? "new_load" : ""})
                if (*k) {
                    rows_.push_back(rowOf(k, map.name, nodes, "1e-6", "CHOLMOD"));
                    rows_.back().note = outsidePeers().cholmodNote + "; without it there is no truth for this grid";
                }
            return;
        }
        struct Accuracy {
            const char* name;
            double      target;
        };
        std::vector<Accuracy> accuracies;
        if (goal.discretisation) accuracies.push_back({"discretisation", *goal.discretisation});
        accuracies.push_back({"1e-6", kTight});

        std::vector<Rival> rivals = rivalsFor(map, nodes);
        if (mapRows) {
            std::vector<Contestant> contestants;
            for (Rival& r : rivals)
                if (r.direct) contestants.push_back(newMapOf(r, plate, goal.force));
            std::vector<Tuned> ours;
            for (const Accuracy& a : accuracies) ours.push_back(tuned(plate, goal, a.target));
            for (Tuned& t : ours)
                contestants.push_back({"Palpate",
                                       {[&t, &plate] { t.solver->setRigidity(plate.rigidity); },
                                        [&t, &goal] { t.answer = t.solver->solve(goal.force).deflection; }},
                                       clock_});
            emit(kind, map, nodes, rivals, contestants, ours, accuracies, goal, {"rigidity", "solve"});
        }
        if (loadRows) {
            std::vector<Contestant> contestants;
            for (Rival& r : rivals)
                if (r.direct) {
                    r.direct->factorise(plate);
                    r.direct->matrix.gather(other.force, r.right);
                    contestants.push_back({r.name, {[&r] { r.direct->solver->solve(r.right, r.answer); }}});
                }
            std::vector<Accuracy> own = accuracies;
            own.front().target        = *other.discretisation;
            std::vector<Tuned> ours;
            for (const Accuracy& a : own) ours.push_back(tuned(plate, other, a.target));
            for (Tuned& t : ours)
                contestants.push_back(
                    {"Palpate", {[&t, &other] { t.answer = t.solver->solve(other.force).deflection; }}, clock_});
            emit("new_load", map, nodes, rivals, contestants, ours, own, other, {"solve"});
        }
    }

    static Contestant newMapOf(Rival& r, const Plate& plate, const NodeField& force)
    {
        r.direct->matrix.gather(force, r.right);
        return {r.name,
                {[&r, &plate] { r.direct->matrix.assemble(plate); },
                 [&r] { r.direct->solver->factorise(r.direct->matrix); },
                 [&r] { r.direct->solver->solve(r.right, r.answer); }}};
    }

    template <class Accuracies>
    void emit(const char* kind, const Map& map, int nodes, const std::vector<Rival>& rivals,
              const std::vector<Contestant>& contestants, std::vector<Tuned>& ours, const Accuracies& accuracies,
              const Goal& goal, const std::vector<std::string>& partNames)
    {
        const std::vector<Timing> timings   = takeTurns(contestants, o_.runs);
        const std::size_t         firstOurs = timings.size() - ours.size();
        std::size_t               at        = 0;
        for (const Rival& r : rivals) {
            const Timing* theirs = r.direct ? &timings[at++] : nullptr;
            for (std::size_t a = 0; a < ours.size(); ++a) {
                ours[a].error = errorOf(ours[a].answer, goal.truth->w); // of the last run that was timed
                BenchRow row  = rowOf(kind, map.name, nodes, accuracies[a].name, r.name);
                row.partNames = partNames;
                put(row, ours[a]);
                put(row, timings[firstOurs + a]);
                if (theirs) {
                    row.peerMs = theirs->total;
                    for (const Quartiles& part : theirs->parts) row.peerPartsMs.push_back(part.median);
                    row.peerError = errorOf(r.direct->matrix.spread(r.answer), goal.truth->w);
                    if (*row.peerError > ours[a].target)
                        row.note += (row.note.empty() ? "" : "; ") + r.name +
                                    " does not reach this accuracy without refinement";
                } else {
                    row.note += (row.note.empty() ? "" : "; ") + r.note;
                }
                rows_.push_back(std::move(row));
            }
        }
    }

    // --- the paper's iteration

    /// One moment of an iteration.
    struct Moment {
        double sweeps, residual, error;
    };

    /// Returns the logarithm of a quantity's factor per sweep over the last tenth of the moments; empty if it has not
    /// settled to 2 %. By then only the slowest mode is left, which decays at this rate from there on.
    static std::optional<double> decay(const std::vector<Moment>& moments, double Moment::*quantity)
    {
        constexpr double  kSettled = 0.02; // [1]
        const std::size_t last = moments.size() - 1, mid = last - last / 20, early = last - last / 10;
        if (mid == last || early == mid) return {};
        const auto rate = [&](std::size_t a, std::size_t b) {
            return std::log(moments[b].*quantity / moments[a].*quantity) / (moments[b].sweeps - moments[a].sweeps);
        };
        const double before = rate(early, mid), now = rate(mid, last);
        if (!(now < 0) || std::abs(now - before) > kSettled * std::abs(now)) return {};
        return now;
    }

    /// Returns the first moment at which a quantity is down to `limit`: one of these, or a later one that follows from
    /// the decay; empty if the decay has not settled.
    static std::optional<Moment> momentOf(const std::vector<Moment>& moments, double Moment::*quantity, double limit)
    {
        for (const Moment& m : moments)
            if (m.*quantity <= limit) return m;
        const auto ofQuantity = decay(moments, quantity), ofResidual = decay(moments, &Moment::residual),
                   ofError = decay(moments, &Moment::error);
        if (!ofQuantity || !ofResidual || !ofError) return {};
        const Moment& last = moments.back();
        const double  more = std::log(limit / last.*quantity) / *ofQuantity;
        return Moment{last.sweeps + more, last.residual * std::exp(*ofResidual * more),
                      last.error * std::exp(*ofError * more)};
    }

    void compareJacobi(int nodes)
    {
        const Map&  map   = mapNamed("linear");
        const Plate plate = plateOf(map, nodes);
        const Goal  goal  = goalFor(map, nodes, 0.5, 0.5);
        struct Aim {
            const char*         accuracy;
            Tuned               ours;
            double              residual;
            std::vector<double> times; ///< [ms]
        };
        std::vector<Aim> aims;
        for (const auto& [name, target] : {std::pair<const char*, double>{"discretisation", *goal.discretisation},
                                           std::pair<const char*, double>{"1e-6", kTight}}) {
            Tuned        t        = tuned(plate, goal, target);
            const double residual = residualOf(plate, goal.force, t.answer);
            aims.push_back({name, std::move(t), residual, {}});
        }
        const auto finished = [&](const Moment& m) {
            return std::ranges::all_of(
                aims, [&](const Aim& aim) { return m.residual <= aim.residual && m.error <= aim.ours.error; });
        };

        // They take turns: a few thousand sweeps, then Palpate once, in its first `runs` turns.
        const int           perTurn = nodes <= 33 ? 1000 : 4000;
        DampedJacobi        jacobi(plate, goal.force);
        std::vector<double> sweepMs;
        std::vector<Moment> moments{{0, 1, 1}};
        jacobi.sweep(100);
        for (double spent = 0, sweeps = 100; spent < 1e3 * o_.jacobiSeconds && !finished(moments.back());) {
            const double start = processMilliseconds();
            jacobi.sweep(perTurn);
            const double took = processMilliseconds() - start;
            spent += took;
            sweeps += perTurn;
            sweepMs.push_back(took / perTurn);
            const NodeField w = jacobi.answer();
            moments.push_back({sweeps, residualOf(plate, goal.force, w), errorOf(w, goal.truth->w)});
            for (Aim& aim : aims)
                if (aim.times.size() < std::size_t(o_.runs)) aim.times.push_back(newMapMs(aim.ours, plate, goal.force));
        }
        for (Aim& aim : aims)
            while (aim.times.size() < std::size_t(o_.runs)) aim.times.push_back(newMapMs(aim.ours, plate, goal.force));

        const Quartiles perSweep = quartiles(sweepMs);
        for (Aim& aim : aims)
            for (const bool byResidual : {true, false}) {
                BenchRow row = rowOf("jacobi", map.name, nodes, aim.accuracy,
                                     byResidual ? "Jacobi 0.6, same residual" : "Jacobi 0.6, same error");
                put(row, aim.ours);
                row.residual     = aim.residual;
                row.palpateMs    = quartiles(aim.times);
                const auto found = byResidual ? momentOf(moments, &Moment::residual, aim.residual)
                                              : momentOf(moments, &Moment::error, aim.ours.error);
                if (found) {
                    const double n   = found->sweeps;
                    row.peerSweeps   = n;
                    row.extrapolated = n > moments.back().sweeps;
                    row.peerMs       = Quartiles{n * perSweep.lower, n * perSweep.median, n * perSweep.upper};
                    row.peerResidual = found->residual;
                    row.peerError    = found->error;
                } else {
                    row.note = "the iteration's contraction has not settled: nothing to extrapolate from";
                }
                rows_.push_back(std::move(row));
            }
    }

    [[nodiscard]] double newMapMs(Tuned& t, const Plate& plate, const NodeField& force) const
    {
        const double start = now(clock_);
        t.solver->setRigidity(plate.rigidity);
        t.answer = t.solver->solve(force).deflection;
        return now(clock_) - start;
    }

    // --- memory

    void compareMemory(int nodes)
    {
        const Map&  map   = mapNamed("linear");
        const Plate plate = plateOf(map, nodes);
        BenchRow    row   = rowOf("memory", map.name, nodes, "1e-6", "CHOLMOD");
        const Goal  goal  = goalFor(map, nodes, 0.5, 0.5);
        if (goal.truth) {
            const Tuned t = tuned(plate, goal, kTight);
            put(row, t);
            row.palpateBytes = double(t.bytes);
        }
        if (outsidePeers().cholmod) {
            Direct fresh{PlateMatrix(plate), {}};
            fresh.solver = outsidePeers().cholmod(fresh.matrix);
            fresh.factorise(plate);
            row.peerError = errorOf(fresh.solve(goal.force), goal.truth->w);
            if (const auto bytes = fresh.solver->peakBytes()) row.peerBytes = double(*bytes);
        } else {
            row.note = outsidePeers().cholmodNote;
        }
        rows_.push_back(std::move(row));
    }

    compute::Context&        context_;
    const PlateKernels&      kernels_;
    const PlateBenchOptions& o_;
    const OnStep&            onStep_;
    Clock                    clock_;
    std::map<int, Direct>    directs_;
    std::vector<BenchRow>    rows_;
};

} // namespace

const std::vector<std::string>& plateCases()
{
    static const std::vector<std::string> names{"new_map", "new_load", "contrast", "jacobi", "memory", "batch"};
    return names;
}

std::vector<BenchRow> measurePlates(compute::Context& context, const PlateKernels& kernels,
                                    const PlateBenchOptions& options, const OnStep& onStep)
{
    return PlateBench(context, kernels, options, onStep).measure();
}

} // namespace palp::bench
