#include "engine/plate/footprint.h"

#include "engine/core/contract.h"

namespace palp {

Footprint::Footprint(const NodeField& load, const NodeField& changeX, const NodeField& changeZ)
{
    const auto &force = load.values(), &x = changeX.values(), &z = changeZ.values();
    PALP_EXPECT(force.size() == x.size() && force.size() == z.size(), "a load and its changes are of one grid");
    for (std::size_t n = 0; n < force.size(); ++n)
        if (force[n] != 0 || x[n] != 0 || z[n] != 0) parts.push_back({std::uint32_t(n), force[n], x[n], z[n]});
}

Footprint::Footprint(const NodeField& load)
    : Footprint(load, NodeField(load.nodesX(), load.nodesZ()), NodeField(load.nodesX(), load.nodesZ()))
{
}

NodeField Footprint::load(const PlateGrid& grid) const
{
    NodeField field(grid);
    for (const Part& part : parts) field.values()[part.node] = part.force;
    return field;
}

FootprintResponse responseOf(const Footprint& footprint, const NodeField& deflection)
{
    FootprintResponse response;
    for (const Footprint::Part& part : footprint.parts) {
        const double w = deflection.values()[part.node];
        response.work += part.force * w;
        response.changeX += part.changeX * w;
        response.changeZ += part.changeZ * w;
    }
    return response;
}

} // namespace palp
