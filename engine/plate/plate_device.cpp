#include "engine/plate/plate_device.h"

#include <chrono>
#include <cstdio>
#include <optional>

#include "engine/core/quantity.h"
#include "engine/gpu/context.h"
#include "engine/gpu/device_error.h"
#include "engine/plate/plate_solver_reference.h"
#include "engine/plate/plate_solver_vulkan.h"

namespace palp {
namespace {

/// Beyond, factorising takes a minute and gigabytes; an answer that is not good, and says so, is better then.
bool fitsReference(const PlateGrid& grid)
{
    return grid.nodes() <= 513 * 513;
}

bool sameButRigidity(const Plate& a, const Plate& b)
{
    return a.grid == b.grid && a.edges == b.edges && a.poissonRatio == b.poissonRatio && a.foundation == b.foundation;
}

} // namespace

struct PlateDevice::Multigrid {
    gpu::Context                     context;
    PlateKernels                     kernels;
    std::optional<VulkanPlateSolver> solver;
    Plate                            plate; ///< of the solver
    double                           tolerance = 0;

    explicit Multigrid(const gpu::ContextSettings& settings) : context(settings), kernels(context) {}

    [[nodiscard]] PlateSolution solve(const Plate& wanted, const NodeField& nodalForce, double wantedTolerance)
    {
        const auto began = std::chrono::steady_clock::now();
        if (solver && sameButRigidity(plate, wanted) && tolerance == wantedTolerance) {
            solver->setRigidity(wanted.rigidity);
        } else {
            solver.reset(); // its memory goes before the next one's comes
            solver.emplace(context, kernels, wanted, VulkanPlateSolver::Settings{.tolerance = wantedTolerance});
            plate     = wanted;
            tolerance = wantedTolerance;
        }
        const std::chrono::duration<double, std::milli> setUp = std::chrono::steady_clock::now() - began;

        PlateSolution solution            = solver->solve(nodalForce);
        solution.report.setUpMilliseconds = setUp.count();
        return solution;
    }
};

PlateDevice::PlateDevice(std::string_view wanted, double patience)
{
    if (gpu::isDeviceWord(wanted, kReference)) return;
    gpu::ContextSettings settings;
    settings.device   = std::string(wanted);
    settings.patience = patience;
    try {
        multigrid_ = std::make_unique<Multigrid>(settings);
        note_      = multigrid_->context.note();
    } catch (const std::exception& error) { // the kernels do not compile, or the device that is asked for is refused
        if (!gpu::isDeviceWord(wanted, gpu::kAutoDevice)) throw;
        note_           = error.what();
        settings.device = gpu::kHostDevice;
        multigrid_      = std::make_unique<Multigrid>(settings);
    }
    name_ = multigrid_->context.device().name;
}

PlateDevice::~PlateDevice()                                 = default;
PlateDevice::PlateDevice(PlateDevice&&) noexcept            = default;
PlateDevice& PlateDevice::operator=(PlateDevice&&) noexcept = default;

const std::string& PlateDevice::name() const noexcept
{
    return name_;
}

const std::string& PlateDevice::note() const noexcept
{
    return note_;
}

PlateSolution PlateDevice::solve(const Plate& plate, const NodeField& nodalForce, double tolerance)
{
    if (multigrid_) {
        try {
            PlateSolution solution = multigrid_->solve(plate, nodalForce, tolerance);
            if (solution.report.converged || !fitsReference(plate.grid)) return solution;
            note_ = "the multigrid solver stopped at an error of about " + formatNumber(*solution.report.errorEstimate);
        } catch (const gpu::DeviceLost& error) {
            note_ = error.what();
            name_ = kReference;
            multigrid_.reset();
        }
    }
    const ReferencePlateSolver solver(plate);
    PlateSolution              solution = solver.solve(nodalForce);
    solution.report.setUpMilliseconds   = solver.factoriseMilliseconds();
    // The estimate is of the error before the step of refinement, which takes off as large a share again.
    const double before       = solution.report.errorEstimate.value_or(0);
    solution.report.converged = before * before <= tolerance;
    return solution;
}

} // namespace palp
