#include "tests/pipeline/crossing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/chart/resample.h"
#include "engine/force/force_law.h"
#include "tests/support/errors.h"
#include "tests/support/published_tables.h"

namespace palp {
namespace {

constexpr double kFoundation = 1e6;                                     // [Pa/m]
constexpr double kRigidity   = kFoundation * 6e-3 * 6e-3 * 6e-3 * 6e-3; // l = 6 mm [N m]
constexpr double kContact    = 1.6e6;   // k_c over D [1/m^2]: 6 times as stiff as the plate where D is kRigidity
constexpr double kEvery      = 0.25e-3; // between the places of the truth, straight in between [m]: 0.1 % of c
constexpr double kTick       = 1e-3;    // [s]

PlateSolver& host()
{
    static PlateSolver solver("host");
    return solver;
}

double relative(double logarithm)
{
    return std::exp(std::abs(logarithm)) - 1;
}

} // namespace

Sheet::Sheet(Factor factor) : factor_(std::move(factor))
{
    for (double x = -kReach; x < kReach + 2 * kEvery; x += kEvery) truth_.push_back(tableAt(x, 1).middle());
}

Chart Sheet::chartAt(double x)
{
    constexpr double kAngle = 0.5; // of the axes to the path [rad]: neither along a row nor across a diagonal
    return {Map::lambertAzimuthal, {x, 0, 0}, Frame{}.turned(kAngle), 0};
}

Plate Sheet::homogeneous()
{
    const PlateGrid grid = PatchWindow::square(kWindow, kCells).grid;
    return {grid, {}, 0.45, kFoundation, NodeField(grid, kRigidity)};
}

Plate Sheet::plateAt(double x) const
{
    const Chart       chart  = chartAt(x);
    const PatchWindow window = PatchWindow::square(kWindow, kCells);
    Plate             plate  = homogeneous();
    for (int i = 0; i < plate.grid.nodesX(); ++i)
        for (int j = 0; j < plate.grid.nodesZ(); ++j) {
            const auto place =
                *chart.lift({window.corner.x + i * plate.grid.spacingX, window.corner.z + j * plate.grid.spacingZ});
            plate.rigidity(i, j) *= factor_(place.x, place.y);
        }
    return plate;
}

const FootprintLattice& Sheet::latticeOf(int side)
{
    static std::array<std::optional<FootprintLattice>, ComplianceTable::kMostSide + 1> known;
    auto& lattice = known[std::size_t(side)];
    if (!lattice) {
        lattice = solveLattice(homogeneous(), {kRadius, side, kContact}, host(), kTolerance);
    }
    return *lattice;
}

ComplianceTable Sheet::tableAt(double x, int side) const
{
    ComplianceTable table = solveTable(plateAt(x), latticeOf(side), host(), kTolerance).table;
    table.chart           = chartAt(x);
    return table;
}

ComplianceTable::Values Sheet::truth(double x) const
{
    const double along = (x + kReach) / kEvery;
    const auto   n     = std::min(std::size_t(std::max(0.0, along)), truth_.size() - 2);
    const double t     = along - double(n);
    return {std::lerp(truth_[n].lnCompliance, truth_[n + 1].lnCompliance, t),
            std::lerp(truth_[n].lnContactStiffness, truth_[n + 1].lnContactStiffness, t), false};
}

double Sheet::range() const
{
    const auto [least, most] = std::minmax_element(
        truth_.begin(), truth_.end(), [](const auto& a, const auto& b) { return a.lnCompliance < b.lnCompliance; });
    return std::exp(most->lnCompliance - least->lnCompliance);
}

Sheet::Factor wart(double contrast)
{
    constexpr double kSize = 4e-3; // sd [m]
    return [contrast](double x, double y) {
        return 1 + (contrast - 1) * std::exp(-(x * x + y * y) / (2 * kSize * kSize));
    };
}

Sheet::Factor step(double contrast)
{
    constexpr double kSpread = 1e-3; // [m]
    return [contrast](double x, double) {
        return std::pow(contrast, 0.5 * std::erfc(-x / (kSpread * std::numbers::sqrt2)));
    };
}

Crossing atConstantSpeed(double speed)
{
    const double runUp = 0.11 * speed; // [m] 0.11 s, three periods at 30 Hz, until tables have caught up
    return {[=](double time) { return speed * time - runUp - Sheet::kReach; }, runUp / speed,
            (runUp + 2 * Sheet::kReach) / speed};
}

Crossing stroking(double fastest)
{
    constexpr double kAmplitude = 14e-3; // [m]
    const double     omega      = fastest / kAmplitude;
    return {[omega](double time) { return kAmplitude * std::sin(omega * time); }, std::numbers::pi / omega,
            3 * std::numbers::pi / omega}; // after half a cycle to warm up
}

Crossed crossed(const Sheet& sheet, const Crossing& crossing, ComplianceLaw law, double rate)
{
    const double period = 1 / rate;
    const int    side   = tableSide(law, period, Sheet::kRadius);

    Crossed                 result;
    ComplianceTracker       handOver(law);
    PublishedTables         places;
    RecentMotion            motion;
    ComplianceTable         coming, published; // what is being solved for, and what the servo sees
    std::uint64_t           sequence   = 0;
    double                  lastHanded = 0;
    ComplianceTable::Values lastTrue;
    for (int n = 0; n * kTick < crossing.until; ++n) {
        const double     time = n * kTick;
        const glm::dvec3 contact{crossing.along(time), 0, 0};
        motion.add(time, contact);
        if (time >= double(sequence) * period) { // the thread is done, publishes, and takes the newest contact
            published       = coming;
            coming          = sheet.tableAt(aheadOf(law, contact, motion.velocity(), 1.5 * period).x, side);
            coming.sequence = ++sequence;
            coming.time     = time;
        }
        const auto handed = handOver.tick({contact, time, kTick, places.place(published, handOver)});
        if (!handed || time < crossing.from) continue;

        const double                  logarithm = std::log(handed->compliance);
        const ComplianceTable::Values expected  = sheet.truth(contact.x);
        if (time >= crossing.from + kTick) {
            const double felt = feltStiffness(ForceLaw::series, handed->contactStiffness, handed->compliance);
            const double own =
                feltStiffness(ForceLaw::series, std::exp(expected.lnContactStiffness), std::exp(expected.lnCompliance));
            result.error      = worse(result.error, std::exp(expected.lnCompliance - logarithm) - 1);
            result.step       = worse(result.step, relative(logarithm - lastHanded));
            result.objectStep = std::max(result.objectStep, relative(expected.lnCompliance - lastTrue.lnCompliance));
            result.felt       = worse(result.felt, felt / own - 1);
            result.clamped += handed->clamped;
            result.judged += kTick / (crossing.until - crossing.from);
        }
        lastHanded = logarithm;
        lastTrue   = expected;
    }
    return result;
}

} // namespace palp
