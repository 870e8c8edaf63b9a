#include "engine/plate/multigrid/direct_plate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/plate/detail/hard_plates.h"
#include "engine/plate/detail/rigidity_unit.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/multigrid/detail/rim.h"

namespace palp {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsFrom(Clock::time_point began)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

void run(compute::HostKernel kernel, const shared::PlateLevel& level, std::initializer_list<void*> buffers)
{
    const shared::LevelPush push{level};
    kernel({buffers.begin(), &push, nullptr, {}, {}});
}

} // namespace

struct DirectPlate::Impl {
    Plate                     like; ///< without its rigidity
    double                    unit; ///< that rigidities are relative to [N m]
    GridHierarchy             hierarchy;
    Rim                       division;
    RimView                   view{};
    std::vector<int>          frontOf;  ///< by unknown
    std::vector<float>        rigidity; ///< relative to unit, then the foundation's shape [1]
    std::vector<double>       numbers;  ///< of eight loads at each unknown
    std::vector<std::uint8_t> needed;   ///< by front

    explicit Impl(const Plate& plate);
    [[nodiscard]] bool                             suits(const Plate& plate) const;
    [[nodiscard]] std::optional<FootprintSolution> solve(const Plate& plate, std::span<const Footprint> footprints,
                                                         std::size_t whole, double error);
    [[nodiscard]] bool                             factor(const Plate& plate);
    /// Solves for the load whose deflection is wanted, with a step of refinement.
    [[nodiscard]] PlateSolution solveWhole(const Plate& plate, const Footprint& footprint);
    /// Solves for up to eight others.
    void solveEight(std::span<const Footprint> footprints, std::span<const std::size_t> which,
                    std::vector<FootprintResponse>& responses);
    void findNeeded(std::span<const Footprint> footprints, std::span<const std::size_t> which);
};

bool DirectPlate::pays(const Plate& plate, std::size_t footprints)
{
    // Footprints from which it pays at 65 x 65 nodes, by the contrast of a rigidity that jumps; a factor grows faster
    // with the nodes than the rest does.
    constexpr double kUsual = 24, kStrong = 6, kStrongContrast = 3000, kLeastContrast = 30, kNodes = 65.0 * 65.0;
    const double     least = double(plate.grid.nodes()) / kNodes;
    if (double(footprints) < kStrong * least || !plate.rigidity.on(plate.grid)) return false;
    const double contrast = contrastOf(plate);
    return double(footprints) >= (contrast > kStrongContrast ? kStrong : kUsual) * least &&
           contrast >= kLeastContrast && largestJump(plate) > double(shared::kJump);
}

DirectPlate::Impl::Impl(const Plate& plate)
    : like(plate), unit(rigidityUnit(extremesOf(plate.rigidity.values()).most)), hierarchy(gridHierarchy(plate, unit))
{
    like.rigidity = {};
    division.divideAll(hierarchy.levels.front().plate);
    view = division.prepare(true);
    frontOf.resize(std::size_t(view.unknowns));
    for (int n = 0; n < view.frontCount; ++n)
        std::fill_n(frontOf.begin() + view.fronts[n].first, view.fronts[n].own, n);
    numbers.resize(std::size_t(view.unknowns) * kLoadsTogether);
    needed.resize(std::size_t(view.frontCount));
}

bool DirectPlate::Impl::suits(const Plate& plate) const
{
    return plate.grid == like.grid && plate.edges == like.edges && plate.poissonRatio == like.poissonRatio &&
           plate.foundation == like.foundation &&
           plate.foundationShape.values().size() == like.foundationShape.values().size() &&
           isUnitOf(unit, extremesOf(plate.rigidity.values()));
}

std::optional<FootprintSolution> DirectPlate::Impl::solve(const Plate& plate, std::span<const Footprint> footprints,
                                                          std::size_t whole, double error)
{
    for (const Footprint& footprint : footprints)
        for (const Footprint::Part& part : footprint.parts)
            PALP_EXPECT(part.node < plate.grid.nodes(), "a footprint lies on nodes that the plate does not have");
    const auto began = Clock::now();
    if (!factor(plate)) return std::nullopt;
    const double      setUp = millisecondsFrom(began);
    FootprintSolution solution;
    solution.whole = solveWhole(plate, footprints[whole]);
    solution.responses.resize(footprints.size());
    solution.responses[whole] = responseOf(footprints[whole], solution.whole.deflection);

    std::vector<std::size_t> others;
    for (std::size_t n = 0; n < footprints.size(); ++n)
        if (n != whole) others.push_back(n);
    for (std::span<const std::size_t> left = others; !left.empty();) {
        const auto eight = left.first(std::min<std::size_t>(kLoadsTogether, left.size()));
        left             = left.subspan(eight.size());
        solveEight(footprints, eight, solution.responses);
    }
    solution.whole.report.setUpMilliseconds = setUp;
    solution.whole.report.milliseconds      = millisecondsFrom(began) - setUp;
    const bool finite                       = std::ranges::all_of(solution.responses, [](const FootprintResponse& of) {
        return std::isfinite(of.work) && std::isfinite(of.changeX) && std::isfinite(of.changeZ);
    });
    if (!finite || !(*solution.whole.report.errorEstimate <= error)) return std::nullopt;
    return solution;
}

bool DirectPlate::Impl::factor(const Plate& plate)
{
    const std::size_t nodes = plate.grid.nodes();
    const auto&       shape = plate.foundationShape.values();
    rigidity.resize(nodes + shape.size());
    inRigidityUnits(plate.rigidity.values(), unit, std::span(rigidity).first(nodes));
    std::ranges::transform(shape, rigidity.begin() + std::ptrdiff_t(nodes), [](double s) { return float(s); });
    std::uint32_t lost = 1;
    run(hostVariant().kernels->rimFactor, hierarchy.levels.front().plate, {&view, rigidity.data(), &lost});
    return lost == 0;
}

PlateSolution DirectPlate::Impl::solveWhole(const Plate& plate, const Footprint& footprint)
{
    const shared::PlateLevel& level   = hierarchy.levels.front().plate;
    const HostKernels&        kernels = *hostVariant().kernels;
    const std::size_t         nodes   = plate.grid.nodes();
    std::vector<double>       left(nodes, 0.0), x(std::size_t(view.unknowns));
    std::vector<double>       sum(nodes + 2, 0.0), resists(nodes); // rows of the operator may read beside a field
    double* const             w = sum.data() + 1;
    for (const Footprint::Part& part : footprint.parts) left[part.node] = part.force;
    const auto force = left;
    double     gain[2]{}; // squared errors that a solve takes away, in the energy norm
    for (double& squared : gain) {
        for (std::size_t n = 0; n < x.size(); ++n) x[n] = left[std::size_t(view.nodes[n])];
        run(kernels.rimSolve, level, {&view, x.data(), nullptr});
        for (std::size_t n = 0; n < x.size(); ++n) {
            squared += x[n] * left[std::size_t(view.nodes[n])];
            w[view.nodes[n]] += x[n];
        }
        run(kernels.apply_f64, level, {rigidity.data(), w, resists.data()});
        for (std::size_t n = 0; n < nodes; ++n) left[n] = force[n] - resists[n];
    }

    constexpr double kRounding = 1e-7; // of the rigidity in floats [1]
    PlateSolution    solution;
    solution.deflection = NodeField(plate.grid);
    for (std::size_t n = 0; n < nodes; ++n) solution.deflection.values()[n] = w[n] / hierarchy.stiffness;
    solution.report.solver        = compute::kHostProcessor;
    solution.report.iterations    = 0;
    const double error            = gain[0] > 0 ? std::sqrt(std::max(gain[1], 0.0) / gain[0]) : 0;
    solution.report.errorEstimate = std::hypot(error, kRounding);
    return solution;
}

void DirectPlate::Impl::solveEight(std::span<const Footprint> footprints, std::span<const std::size_t> which,
                                   std::vector<FootprintResponse>& responses)
{
    findNeeded(footprints, which);
    std::ranges::fill(numbers, 0.0);
    const auto place = [&](const Footprint::Part& part) { return std::ptrdiff_t(view.numbers[part.node]); };
    for (std::size_t n = 0; n < which.size(); ++n)
        for (const Footprint::Part& part : footprints[which[n]].parts)
            if (place(part) >= 0) numbers[std::size_t(place(part)) * kLoadsTogether + n] = part.force;
    run(hostVariant().together->rimSolve, hierarchy.levels.front().plate, {&view, numbers.data(), needed.data()});
    for (std::size_t n = 0; n < which.size(); ++n)
        for (const Footprint::Part& part : footprints[which[n]].parts) {
            if (place(part) < 0) continue;
            const double       w  = numbers[std::size_t(place(part)) * kLoadsTogether + n] / hierarchy.stiffness;
            FootprintResponse& of = responses[which[n]];
            of.work += part.force * w;
            of.changeX += part.changeX * w;
            of.changeZ += part.changeZ * w;
        }
}

void DirectPlate::Impl::findNeeded(std::span<const Footprint> footprints, std::span<const std::size_t> which)
{
    std::ranges::fill(needed, std::uint8_t(0));
    for (const std::size_t n : which)
        for (const Footprint::Part& part : footprints[n].parts)
            if (const int unknown = view.numbers[part.node]; unknown >= 0) needed[frontOf[std::size_t(unknown)]] = 1;
    for (int n = 0; n < view.frontCount; ++n) {
        if (!needed[std::size_t(n)]) continue;
        const RimFront& front = view.fronts[n];
        for (int m = 0; m < front.border; ++m)
            needed[std::size_t(frontOf[std::size_t(view.borders[front.borderAt + m])])] = 1;
    }
}

DirectPlate::DirectPlate(const Plate& plate) : impl_(std::make_unique<Impl>(plate)) {}
DirectPlate::~DirectPlate()                                 = default;
DirectPlate::DirectPlate(DirectPlate&&) noexcept            = default;
DirectPlate& DirectPlate::operator=(DirectPlate&&) noexcept = default;

bool DirectPlate::suits(const Plate& plate) const
{
    return impl_->suits(plate);
}

std::optional<FootprintSolution> DirectPlate::solve(const Plate& plate, std::span<const Footprint> footprints,
                                                    std::size_t whole, double error)
{
    return impl_->solve(plate, footprints, whole, error);
}

} // namespace palp
