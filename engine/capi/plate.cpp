#include <algorithm>
#include <limits>

#include "engine/capi/detail/border.h"
#include "engine/core/quantity.h"
#include "engine/plate/plate_solver.h"
#include "engine/plate/report_text.h"

// The plate alone.

namespace palp::capi {
namespace {

Edge edgeOf(int edge)
{
    switch (edge) {
    case PALPATE_CLAMPED:
        return Edge::clamped;
    case PALPATE_SUPPORTED:
        return Edge::supported;
    case PALPATE_FREE:
        return Edge::free;
    case PALPATE_GUIDED:
        return Edge::guided;
    default:
        throw Error("edges: expected PALPATE_CLAMPED, PALPATE_SUPPORTED, PALPATE_FREE or PALPATE_GUIDED, found " +
                    std::to_string(edge));
    }
}

Plate plateOf(const palpate_plate& given)
{
    constexpr int kMost = 4096;
    if (given.cells_x < kFewestPlateCells || given.cells_x > kMost || given.cells_z < kFewestPlateCells ||
        given.cells_z > kMost)
        throw Error("plate: expected 4 to 4096 cells along either side, found " + std::to_string(given.cells_x) +
                    " x " + std::to_string(given.cells_z));
    Plate plate;
    plate.grid  = {given.cells_x, given.cells_z, given.size_x / given.cells_x, given.size_z / given.cells_z};
    plate.edges = {edgeOf(given.edges[0]), edgeOf(given.edges[1]), edgeOf(given.edges[2]), edgeOf(given.edges[3])};
    plate.poissonRatio           = given.poisson;
    plate.foundation             = given.foundation;
    const double* const rigidity = &demand(given.rigidity, "rigidity");
    plate.rigidity = NodeField(plate.grid.nodesX(), plate.grid.nodesZ(), {rigidity, rigidity + plate.grid.nodes()});
    return plate;
}

} // namespace
} // namespace palp::capi

using namespace palp;
using namespace palp::capi;

int palpate_plate_solve(const palpate_plate* plate, const double* forces, double tolerance, double* deflection,
                        double* error)
{
    return guarded([&] {
        const Plate   of   = plateOf(taken(plate, "palpate_plate"));
        const double* from = &demand(forces, "forces");
        demand(deflection, "deflection");
        const NodeField     load(of.grid.nodesX(), of.grid.nodesZ(), {from, from + of.grid.nodes()});
        PlateSolver         solver("host");
        const PlateSolution solution = solver.solve(of, load, tolerance);
        keepTakeover(solver.takeoverSince(0));
        std::ranges::copy(solution.deflection.values(), deflection);
        if (error) *error = solution.report.errorEstimate.value_or(std::numeric_limits<double>::quiet_NaN());
        if (!solution.report.converged)
            throw Error("the plate: expected an error of at most " + formatNumber(tolerance) + ", but " +
                        errorText(solution.report) + "; take fewer cells or hold it at more sides");
    });
}
