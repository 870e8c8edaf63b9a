#include "engine/plate/reference/plate_matrix.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/plate/plates.h"

namespace palp {
namespace {

Plate somePlate(const PlateEdges& edges)
{
    Plate plate = reference::makePlate(13, 9, 1.3, 1, edges, 0.3, [](double x, double z) { return 1 + 9 * x * z; });
    plate.foundation = 2;
    return plate;
}

// Matrix times w against the gradient term by term, which needs no matrix.
TEST(PlateMatrix, IsTheEnergysSecondDerivative)
{
    using enum Edge;
    for (const PlateEdges& edges :
         {PlateEdges{}, PlateEdges{supported, free, clamped, supported}, PlateEdges{free, free, free, free}}) {
        const Plate         plate = somePlate(edges);
        const PlateMatrix   matrix(plate);
        std::vector<double> w(std::size_t(matrix.unknowns())), product(w.size(), 0.0);
        for (std::size_t n = 0; n < w.size(); ++n) w[n] = std::sin(double(n) * 0.7);

        for (std::size_t c = 0; c < w.size(); ++c)
            for (int k = matrix.columnStart()[c]; k < matrix.columnStart()[c + 1]; ++k) {
                const auto   r = std::size_t(matrix.row()[std::size_t(k)]);
                const double a = matrix.value()[std::size_t(k)];
                product[r] += a * w[c];
                if (r != c) product[c] += a * w[r];
            }

        const NodeField     rest = energyResidual(plate, NodeField(plate.grid), matrix.spread(w));
        std::vector<double> gradient(w.size());
        matrix.gather(rest, gradient);
        double most = 0;
        for (const double g : gradient) most = std::max(most, std::abs(g));
        for (std::size_t n = 0; n < w.size(); ++n) EXPECT_NEAR(product[n], -gradient[n], 1e-12 * most) << n;
    }
}

TEST(PlateMatrix, AssemblesAnotherRigidityInPlace)
{
    Plate       plate = somePlate({});
    PlateMatrix again(plate);
    for (double& d : plate.rigidity.values()) d = 3 / d;

    again.assemble(plate);

    const PlateMatrix fresh(plate);
    EXPECT_TRUE(std::ranges::equal(again.value(), fresh.value()));
    EXPECT_TRUE(std::ranges::equal(again.row(), fresh.row()));
}

TEST(PlateMatrix, RefusesAnotherGrid)
{
    PlateMatrix matrix(somePlate({}));

    EXPECT_THROW(matrix.assemble(reference::unitSquare(8)), ContractViolation);
}

TEST(PlateMatrix, HasNoRowForHeldNodes)
{
    const PlateMatrix matrix(reference::unitSquare(8));

    EXPECT_EQ(matrix.unknowns(), 7 * 7);
    for (const int node : matrix.nodeOf()) {
        EXPECT_TRUE(node / 9 > 0 && node / 9 < 8 && node % 9 > 0 && node % 9 < 8) << node;
    }
}

} // namespace
} // namespace palp
