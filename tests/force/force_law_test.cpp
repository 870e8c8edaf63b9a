#include "engine/force/force_law.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(ForceLaw, ContactStiffnessIsModulusTimesAreaOverThickness)
{
    // E A / h with E = 2 MPa, R = 3 mm, h = 4 mm, by hand: 2e6 * 2.8274e-5 / 4e-3.
    EXPECT_NEAR(contactStiffness(2e6, 3e-3, 4e-3), 14137.17, 0.01) << "as many digits as were computed by hand";
}

TEST(ForceLaw, SeriesIsSofterThanEitherSpring)
{
    // 1000 N/m in series with 1/250 m/N: 200 N/m.
    EXPECT_DOUBLE_EQ(feltStiffness(ForceLaw::series, 1000, 1.0 / 250), 200);
    EXPECT_DOUBLE_EQ(feltStiffness(ForceLaw::series, 1000, 0), 1000) << "a rigid plate leaves the contact";
}

TEST(ForceLaw, ThePapersLawDoesNotFeelThePlate)
{
    EXPECT_DOUBLE_EQ(feltStiffness(ForceLaw::paper, 1000, 1.0 / 250), 1000);
}

TEST(ForceLaw, NamesFindTheirLaw)
{
    for (ForceLaw law : {ForceLaw::series, ForceLaw::paper}) EXPECT_EQ(valueNamed<ForceLaw>(name(law)), law);
    EXPECT_FALSE(valueNamed<ForceLaw>("magic").has_value());
}

} // namespace
} // namespace palp
