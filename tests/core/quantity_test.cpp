#include "engine/core/quantity.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

TEST(Quantity, UnitsScaleToSi)
{
    EXPECT_DOUBLE_EQ(parseQuantity("4mm", Dimension::length, "x"), 4e-3);
    EXPECT_DOUBLE_EQ(parseQuantity(" 1.5 N ", Dimension::force, "x"), 1.5);
    EXPECT_DOUBLE_EQ(parseQuantity("0.3MPa", Dimension::pressure, "x"), 0.3e6);
    EXPECT_DOUBLE_EQ(parseQuantity("+2e-3", Dimension::rigidity, "x"), 2e-3);
    EXPECT_DOUBLE_EQ(parseQuantity("1.74MPa/m", Dimension::foundation, "x"), 1.74e6);
    for (const auto& [text, value] :
         {std::pair("800/m", 800.0), {"800 1/m", 800.0}, {"0.8 /mm", 800.0}, {"0.8 1/mm", 800.0}})
        EXPECT_DOUBLE_EQ(parseQuantity(text, Dimension::perLength, "x"), value) << text;
    EXPECT_DOUBLE_EQ(metresPer("in"), 0.0254);
}

TEST(Quantity, EveryUnitIsThatManySiUnits)
{
    using enum Dimension;
    struct Case {
        Dimension   dimension;
        const char* unit;
        double      inSi;
    };
    for (const auto& [dimension, unit, inSi] : {Case{length, "m", 1},
                                                {length, "mm", 1e-3},
                                                {length, "cm", 1e-2},
                                                {length, "um", 1e-6},
                                                {length, "km", 1e3},
                                                {length, "in", 0.0254},
                                                {length, "ft", 0.3048},
                                                {force, "N", 1},
                                                {force, "mN", 1e-3},
                                                {force, "kN", 1e3},
                                                {pressure, "Pa", 1},
                                                {pressure, "kPa", 1e3},
                                                {pressure, "MPa", 1e6},
                                                {pressure, "GPa", 1e9},
                                                {rigidity, "N_m", 1},
                                                {rigidity, "Nm", 1},
                                                {rigidity, "N*m", 1},
                                                {rigidity, "mN_m", 1e-3},
                                                {rigidity, "mNm", 1e-3},
                                                {foundation, "Pa/m", 1},
                                                {foundation, "kPa/m", 1e3},
                                                {foundation, "MPa/m", 1e6},
                                                {foundation, "GPa/m", 1e9},
                                                {stiffness, "N/m", 1},
                                                {stiffness, "kN/m", 1e3},
                                                {stiffness, "N/mm", 1e3},
                                                {stiffness, "N/cm", 1e2},
                                                {angle, "rad", 1},
                                                {angle, "deg", 3.14159265358979 / 180},
                                                {time, "s", 1},
                                                {time, "ms", 1e-3},
                                                {speed, "m/s", 1},
                                                {speed, "mm/s", 1e-3},
                                                {speed, "cm/s", 1e-2},
                                                {mass, "kg", 1},
                                                {mass, "g", 1e-3},
                                                {perLength, "/mm", 1e3}})
        EXPECT_NEAR(parseQuantity(std::string("3 ") + unit, dimension, "x") / (3 * inSi), 1, 1e-12) << unit;
}

TEST(Quantity, WhatPeopleReadIsReadAgain)
{
    for (const double value : {35e-6, 4.2e-3, 12.0, 3.5e3})
        EXPECT_DOUBLE_EQ(parseQuantity(formatQuantity(value, "m"), Dimension::length, "x"), value);
    EXPECT_DOUBLE_EQ(parseQuantity("3 \u03bcm", Dimension::length, "x"), 3e-6) << "the Greek letter looks the same";
    EXPECT_DOUBLE_EQ(metresPer("\u00b5m"), 1e-6);
}

TEST(Quantity, WhatItsUnitMakesInfiniteIsRefused)
{
    EXPECT_GT(parseQuantity("1e308 mm", Dimension::length, "--window"), 9e304);
    for (const char* text : {"1e308 km", "-1e308km"})
        EXPECT_THROW((void)parseQuantity(text, Dimension::length, "--window"), Error) << text;
    EXPECT_THROW((void)parseQuantity("1e308", Dimension::length, "--window", 1e3), Error);
    EXPECT_THROW((void)parsePoint("0,1e308 km,0", "--place"), Error);
}

TEST(Quantity, AnythingElseIsRefusedWithTheKnownUnits)
{
    for (const char* text : {"", "mm", "nan", "inf", "1e999", "4 parsec", "4mmm", "0x10", "4,5", "+-4"})
        EXPECT_THROW((void)parseQuantity(text, Dimension::length, "--window"), Error) << text;
    try {
        (void)parseQuantity("4 parsec", Dimension::length, "--window");
        FAIL() << "an unknown unit was accepted";
    } catch (const Error& error) {
        const std::string message = error.what();
        for (const char* part : {"--window", "parsec", "mm", "km"})
            EXPECT_NE(message.find(part), std::string::npos) << message;
    }
}

TEST(Quantity, AColumnsHeadIsItsNameAndItsUnit)
{
    const auto both = [](std::string_view cell) {
        const ColumnHead head = columnHead(cell);
        return std::string(head.name) + "|" + std::string(head.unit);
    };
    EXPECT_EQ(both("depth [mm]"), "depth|mm");
    EXPECT_EQ(both(" force( mN ) "), "force|mN");
    EXPECT_EQ(both("nx [1]"), "nx|");
    EXPECT_EQ(both("x]"), "x]|") << "no bracket opens";
    EXPECT_EQ(both("x"), "x|");
    EXPECT_EQ(both("x [mm"), "x|[mm");
    EXPECT_EQ(siPerUnitOf(columnHead("x[mm]"), Dimension::length, "a.csv"), 1e-3);
    EXPECT_EQ(siPerUnitOf(columnHead("x"), Dimension::length, "a.csv"), 1);
    EXPECT_TRUE(holds(refusalOf([] { (void)siPerUnitOf(columnHead("x [s]"), Dimension::length, "a.csv"); }),
                      {"a.csv: column \"x\": unknown unit \"s\"", "m, mm"}));
    EXPECT_TRUE(holds(refusalOf([] { (void)siPerUnitOf(columnHead("x [mm"), Dimension::length, "a.csv"); }),
                      {"a.csv: column \"x\": expected a bracket that ends", "found \"[mm\""}));
}

TEST(Quantity, WhatIsFarTooLongIsRepeatedInPart)
{
    EXPECT_LT(
        refusalOf([] { (void)parseQuantity("4 " + std::string(5000, 'm'), Dimension::length, "--window"); }).size(),
        300u);
}

TEST(Quantity, ARefusalListsTheUnitsOfItsDimensionInTheirOrder)
{
    EXPECT_TRUE(holds(refusalOf([] { (void)parseQuantity("4 parsec", Dimension::force, "--load"); }),
                      {"known units: N, mN, kN"}));
    EXPECT_TRUE(holds(refusalOf([] { (void)parseQuantity("4 m", Dimension::none, "--ratio"); }),
                      {"known units: none: a plain number"}));
    EXPECT_TRUE(holds(refusalOf([] { (void)metresPer("parsec"); }), {"\"parsec\"", "units: m, mm, cm, um, km"}));
}

TEST(Quantity, BlanksAroundANumberAndItsUnitDoNotCount)
{
    EXPECT_EQ(parseQuantity("   2   N   ", Dimension::force, "x"), 2);
    EXPECT_EQ(parseQuantity("  2  ", Dimension::force, "x"), 2);
    EXPECT_THROW((void)parseQuantity("   ", Dimension::force, "x"), Error);
}

TEST(Quantity, PointComponentsMayCarryUnits)
{
    const glm::dvec3 point = parsePoint("10,0.02m,-3cm", "--place", 1e-3);
    EXPECT_DOUBLE_EQ(point.x, 10e-3);
    EXPECT_DOUBLE_EQ(point.y, 0.02);
    EXPECT_DOUBLE_EQ(point.z, -0.03);
    for (const char* text : {"1,2", "1,2,3,4", "1,,3", "a,b,c", ""})
        EXPECT_THROW((void)parsePoint(text, "--place"), Error) << text;
}

TEST(Quantity, PeopleReadThreeDigitsAndAPrefix)
{
    EXPECT_EQ(formatQuantity(0.0042, "m"), "4.20 mm");
    EXPECT_EQ(formatQuantity(1.74e6, "Pa/m"), "1.74 MPa/m");
    EXPECT_EQ(formatQuantity(0, "N"), "0 N");
    EXPECT_EQ(formatQuantity(-35e-6, "m"), "-35.0 \u00b5m");
    EXPECT_EQ(formatQuantity(999.96, "N"), "1.00 kN");
    EXPECT_EQ(formatQuantity(1e-12, "m"), "1.00 pm");
    EXPECT_EQ(formatQuantity(999e12, "Pa"), "999 TPa");
}

TEST(Quantity, WhatIsNoNumberIsCalledSo)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(formatQuantity(std::numeric_limits<double>::quiet_NaN(), "N"), "undefined");
    EXPECT_EQ(formatQuantity(kInfinity, "N"), "infinite");
    EXPECT_EQ(formatQuantity(-kInfinity, "N"), "infinite");
}

TEST(Quantity, BeyondThePrefixesTheUnitStays)
{
    EXPECT_EQ(formatQuantity(1e300, "Pa"), "1.0e+300 Pa");
    EXPECT_EQ(formatQuantity(-1e15, "N m"), "-1.0e+15 N m");
    EXPECT_EQ(formatQuantity(3.5e-13, "m"), "3.5e-13 m");
}

TEST(Quantity, APlainNumberIsInTheUnitThatTheCallerNames)
{
    EXPECT_DOUBLE_EQ(parseQuantity("3", Dimension::length, "--thickness", 1e-3), 3e-3);
    EXPECT_DOUBLE_EQ(parseQuantity("3cm", Dimension::length, "--thickness", 1e-3), 3e-2);
}

TEST(FormatNumber, HasTwoDigitsAndAnExponent)
{
    EXPECT_EQ(formatNumber(12345), "1.2e+04");
    EXPECT_EQ(formatNumber(-0.001), "-1.0e-03");
}

TEST(ShortNumber, HasNoMoreDigitsThanItNeeds)
{
    EXPECT_EQ(shortNumber(0.25), "0.25");
    EXPECT_EQ(shortNumber(3), "3");
    EXPECT_EQ(shortNumber(1e-5), "1e-05");
    EXPECT_EQ(shortNumber(1.0 / 3), "0.333333");
    EXPECT_EQ(shortNumber(1.0 / 3, 9), "0.333333333");
    EXPECT_EQ(shortNumber(0.1, 99), "0.10000000000000001") << "17 digits are all that a double has";
}

} // namespace
} // namespace palp
