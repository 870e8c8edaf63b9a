#include "engine/cloud/soft_object.h"

#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

SoftObject square()
{
    return SoftObject(PointCloud({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {1, 2, 3, 4}, StiffnessKind::modulus),
                      {.thickness = 2e-3, .poissonRatio = 0.3}, {{0, 1, 2}, {1, 3, 2}});
}

TEST(SoftObject, RepaintedKeepsAllButTheStiffnessAndSharesIndexPositionsAndFaces)
{
    const SoftObject object  = square();
    const SoftObject painted = object.repainted({5, 6, 7, 8});
    EXPECT_EQ(painted.cloud().stiffness()[3], 8);
    EXPECT_EQ(object.cloud().stiffness()[3], 4) << "the first one is as it was";
    EXPECT_EQ(&painted.index(), &object.index()) << "an index of a million points takes 0.3 s";
    EXPECT_EQ(painted.positions().data(), object.positions().data());
    EXPECT_EQ(painted.faces().data(), object.faces().data());
    EXPECT_EQ(painted.material().thickness, 2e-3);
    EXPECT_THROW(static_cast<void>(object.repainted({5, 6, 7, 0})), Error);
    EXPECT_THROW(static_cast<void>(object.repainted({5, 6, 7})), ContractViolation);
}

TEST(SoftObject, AnotherMaterialSharesEverythingElseAndGivesAnotherRigidity)
{
    const SoftObject object = square();
    const SoftObject thick  = object.withMaterial({.thickness = 4e-3, .poissonRatio = 0.3});
    EXPECT_EQ(&thick.index(), &object.index());
    EXPECT_EQ(thick.positions().data(), object.positions().data());
    EXPECT_EQ(thick.faces().data(), object.faces().data());
    EXPECT_DOUBLE_EQ(object.rigidity(1), 2 * 8e-9 / (12 * 0.91)) << "E h^3 / (12 (1 - nu^2)) by hand";
    EXPECT_DOUBLE_EQ(thick.rigidity(1), 8 * object.rigidity(1));
}

TEST(SoftObject, AnswersAfterItWasMovedAndAfterItsOriginIsGone)
{
    std::optional<SoftObject> first   = square();
    SoftObject                moved   = std::move(*first);
    const SoftObject          painted = moved.repainted({1, 1, 1, 1});
    first.reset();
    const SoftObject last = std::move(moved);
    for (const SoftObject* object : {&painted, &last}) {
        const std::uint32_t nearest = object->index().nearest({0.9, 0.9, 1}, 1).front().point;
        EXPECT_EQ(object->positions()[nearest], glm::dvec3(1, 1, 0));
        EXPECT_EQ(object->faces().size(), 2u);
    }
}

} // namespace
} // namespace palp
