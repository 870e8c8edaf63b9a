#include "engine/plate/thrust.h"

#include <Eigen/Cholesky>

#include "engine/plate/reference/plate_energy.h"
#include "engine/plate/shell_energy.h"

namespace palp {
namespace {

void takeOff(NodeField& from, const NodeField& what)
{
    for (std::size_t n = 0; n < from.values().size(); ++n) from.values()[n] -= what.values()[n];
}

} // namespace

ShellLoad leftOf(const Shell& shell, const ShellLoad& load, const NodeField& w, const NodeField& phi)
{
    const Plate membrane = membraneOf(shell);
    ShellLoad   left{energyResidual(shell.bending, load.onW, w), load.onPhi};
    takeOff(left.onW, couplingForces(shell, phi));
    takeOff(left.onPhi, couplingLoad(shell, w));
    takeOff(left.onPhi, energyResidual(membrane, NodeField(membrane.grid), phi)); // + C phi
    return left;
}

Thrusts::Thrusts(const Shell& shell)
{
    if (shell.thrusts.empty()) return;
    Plate membrane      = membraneOf(shell);
    membrane.foundation = 0; // the bed, which holds psi alone, as sides do
    membrane.edges      = {Edge::free, Edge::free, Edge::free, Edge::free};
    Shell loose         = shell;
    loose.stressEdges   = membrane.edges;
    const NodeField nothing(membrane.grid);
    for (const NodeField& thrust : shell.thrusts)
        loads_.push_back({couplingForces(loose, thrust), energyResidual(membrane, nothing, thrust)});
    for (const ShellLoad& load : loads_)
        for (const NodeField& thrust : shell.thrusts) own_.push_back(-dot(load.onPhi, thrust));
}

std::vector<double> Thrusts::numbers(std::span<const double> ofLoads, std::span<const double> right) const
{
    const auto      count = Eigen::Index(loads_.size());
    Eigen::MatrixXd matrix(count, count);
    for (Eigen::Index a = 0; a < count; ++a)
        for (Eigen::Index b = 0; b < count; ++b)
            matrix(a, b) = own(std::size_t(a), std::size_t(b)) +
                           (ofLoads[std::size_t(a * count + b)] + ofLoads[std::size_t(b * count + a)]) / 2;
    std::vector<double>                     numbers(right.size());
    const Eigen::Map<const Eigen::VectorXd> given(right.data(), count);
    Eigen::Map<Eigen::VectorXd>(numbers.data(), count) = matrix.ldlt().solve(given);
    return numbers;
}

} // namespace palp
