#include "engine/tools/bench/table_bench.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "engine/pipeline/compliance_table_solve.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/cpu_time.h"
#include "engine/tools/bench/outside_peers.h"

namespace palp::bench {
namespace {

constexpr int kFewestNodes = 65, kMostNodes = 129; // a side

/// A direct solver that solves for all loads at once, as dense columns.
class TablePeer {
public:
    TablePeer(std::string name, std::unique_ptr<Direct> direct, const FootprintLattice& lattice, const PlateGrid& grid)
        : name_(std::move(name)), direct_(std::move(direct)), lattice_(lattice)
    {
        const auto          unknowns = std::size_t(direct_->matrix.unknowns());
        std::vector<double> column(unknowns);
        for (const Footprint& load : lattice.loads) {
            direct_->matrix.gather(load.load(grid), column);
            right_.insert(right_.end(), column.begin(), column.end());
        }
        answer_.resize(right_.size());
    }

    [[nodiscard]] Contestant onNewMap(const Plate& plate)
    {
        return {name_,
                {[this, &plate] { direct_->matrix.assemble(plate); },
                 [this] { direct_->solver->factorise(direct_->matrix); },
                 [this] { direct_->solver->solve(right_, answer_); }}};
    }

    /// Returns the compliances of the last solve [m/N].
    [[nodiscard]] std::vector<double> compliances() const
    {
        std::vector<double> all;
        const std::size_t   n = right_.size() / lattice_.loads.size();
        for (std::size_t load = 0; load < lattice_.loads.size(); ++load) {
            const std::span<const double> column = std::span(answer_).subspan(load * n, n);
            all.push_back(responseOf(lattice_.loads[load], direct_->matrix.spread(column)).work);
        }
        return all;
    }

    [[nodiscard]] const std::string& name() const { return name_; }

private:
    std::string             name_;
    std::unique_ptr<Direct> direct_;
    const FootprintLattice& lattice_;
    std::vector<double>     right_, answer_; ///< a column for each load
};

std::vector<TablePeer> peersFor(const Plate& plate, const FootprintLattice& lattice)
{
    std::vector<TablePeer> peers;
    const auto             add = [&](std::string name, const auto& make) {
        auto direct    = std::make_unique<Direct>(Direct{PlateMatrix(plate), {}});
        direct->solver = make(direct->matrix);
        peers.emplace_back(std::move(name), std::move(direct), lattice, plate.grid);
    };
    if (outsidePeers().cholmod) add("CHOLMOD", outsidePeers().cholmod);
    add("Eigen SimplicialLDLT", eigenSolver);
    return peers;
}

double largestError(const std::vector<double>& found, const std::vector<double>& truth)
{
    double most = 0;
    for (std::size_t n = 0; n < truth.size(); ++n) most = std::max(most, std::abs(found[n] / truth[n] - 1));
    return most;
}

/// Returns the compliances that a table holds, with what a homogeneous plate has taken out of it put back.
std::vector<double> compliancesOf(const TableSolution& solved, const FootprintLattice& lattice, const Plate& plate)
{
    double sum = 0;
    for (const double d : plate.rigidity.values()) sum += std::log(d);
    const auto          own = lattice.homogeneous(std::exp(sum / double(plate.grid.nodes())));
    std::vector<double> all;
    for (std::size_t n = 0; n < lattice.loads.size(); ++n)
        all.push_back(std::exp(solved.table.compliance[n].value + own[n].value));
    return all;
}

std::vector<BenchRow> measureTable(const Map& map, int nodes, int side, int runs, PlateSolver& solver)
{
    const Plate    plate           = plateOf(map, nodes);
    constexpr auto kAny            = 1e9; // k_c over D is not looked at
    Plate          even            = plate;
    even.rigidity                  = NodeField(plate.grid, kSoftest);
    const FootprintLattice lattice = solveLattice(even, {kTableRadius, side, kAny}, solver, kTableTolerance);

    std::vector<TablePeer>  peers = peersFor(plate, lattice);
    std::vector<Contestant> contestants;
    for (TablePeer& peer : peers) contestants.push_back(peer.onNewMap(plate));
    TableSolution solved;
    contestants.push_back(
        {"Palpate", {[&] { solved = solveTable(plate, lattice, solver, kTableTolerance); }}, clockOf(solver)});
    const std::vector<Timing> timings = takeTurns(contestants, runs);

    std::vector<BenchRow> rows;
    for (std::size_t n = 0; n < peers.size(); ++n) {
        BenchRow row;
        row.kind      = "table";
        row.map       = map.name;
        row.nodes     = nodes;
        row.accuracy  = "1e-4 of c";
        row.target    = kTableTarget;
        row.loads     = side * side;
        row.peer      = peers[n].name();
        row.peerMs    = timings[n].total;
        row.palpateMs = timings.back().total;
        row.hidden    = timings.back().hidden;
        row.partNames = {"table"};
        for (const Quartiles& part : timings[n].parts) row.peerPartsMs.push_back(part.median);
        for (const Quartiles& part : timings.back().parts) row.palpatePartsMs.push_back(part.median);
        row.tolerance  = kTableTolerance;
        row.iterations = solved.middle.report.iterations;
        row.workUnits  = solved.middle.report.workUnits;
        // The first peer is the best of them; its own error is that of doubles, 1e-9 on these grids.
        row.error     = largestError(compliancesOf(solved, lattice, plate), peers.front().compliances());
        row.peerError = largestError(peers[n].compliances(), peers.front().compliances());
        row.note      = std::to_string(side * side) + " loads";
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace

std::vector<BenchRow> overTables(const std::vector<int>& nodes, const std::vector<std::string>& maps,
                                 const OnStep& onStep, const MeasureTable& measure)
{
    const std::vector<std::string> chosen =
        maps.empty() ? std::vector<std::string>{"linear", "wart", "disc_100"} : maps;
    std::vector<BenchRow> rows;
    const std::size_t     total = nodes.size() * chosen.size() * 2;
    std::size_t           done  = 0;
    for (const int n : nodes)
        for (const std::string& map : chosen)
            for (const int side : {3, 7}) {
                onStep(done++, total);
                if (n < kFewestNodes || n > kMostNodes) continue;
                for (BenchRow& row : measure(mapNamed(map), n, side)) rows.push_back(std::move(row));
            }
    return rows;
}

const std::vector<std::string>& tableCases()
{
    static const std::vector<std::string> names{"table"};
    return names;
}

std::vector<BenchRow> measureTables(const std::string& solver, const std::vector<int>& nodes,
                                    const std::vector<std::string>& maps, int runs, const OnStep& onStep)
{
    PlateSolver opened(solver);
    return overTables(nodes, maps, onStep,
                      [&](const Map& map, int n, int side) { return measureTable(map, n, side, runs, opened); });
}

} // namespace palp::bench
