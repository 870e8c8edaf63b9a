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

/// A sheet alone has no side; its faces give it one, but not to points that lie in none.
TEST(SoftObject, FacesSayWhichSideIsTheOuterOne)
{
    constexpr std::uint32_t kAlong = 12;
    for (const double up : {1.0, -1.0}) {
        std::vector<glm::dvec3> places;
        std::vector<Triangle>   faces;
        for (std::uint32_t i = 0; i < kAlong * kAlong; ++i) {
            const std::uint32_t x = i % kAlong, y = i / kAlong;
            places.emplace_back(x, y, 0);
            if (x + 1 == kAlong || y + 1 >= kAlong - 1) continue; // the last row lies in no face
            const std::uint32_t next = i + kAlong;
            faces.push_back(up > 0 ? Triangle{i, i + 1, next} : Triangle{i, next, i + 1});
            faces.push_back(up > 0 ? Triangle{i + 1, next + 1, next} : Triangle{i + 1, next, next + 1});
        }
        const SoftObject object(PointCloud(places, std::vector<double>(places.size(), 1), StiffnessKind::modulus), {},
                                faces);
        for (std::size_t i = 0; i < object.size(); ++i) {
            EXPECT_EQ(object.survey().given(i), i < kAlong * (kAlong - 1)) << i;
            EXPECT_TRUE(!object.survey().given(i) || up * object.survey().normal(i).z > 0.99) << i;
        }
    }
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
