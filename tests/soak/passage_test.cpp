#include "tests/soak/passage.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace palp::soak {
namespace {

/// A sheet of 40 mm by 40, whose points are a millimetre apart and lie irregularly.
SoftObject sheet()
{
    std::mt19937_64                        bits(1);
    std::uniform_real_distribution<double> jitter(-0.3e-3, 0.3e-3);
    std::vector<glm::dvec3>                points;
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j) points.emplace_back(1e-3 * i + jitter(bits), 1e-3 * j + jitter(bits), 0);
    std::vector<double> stiffness(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), std::move(stiffness), StiffnessKind::modulus));
}

/// What a session says of a hand at a height [m].
struct Said {
    double height, x = 0;
    bool   touching = false;
};

/// Returns what is wrong with a way down or up, a tenth of a millimetre a tick; empty if nothing is.
std::string wrongOf(const std::function<std::optional<Said>(int)>& at, std::uint32_t device = 0x300)
{
    static const SoftObject kSheet = sheet();
    Passage                 passage(kSheet);
    for (int n = 0;; ++n) {
        const auto said = at(n);
        if (!said) return "";
        TickRecord record;
        record.hip    = {said->x, 0, said->height};
        record.device = device;
        record.proxy  = said->touching ? glm::dvec3(said->x, 0, 0) : record.hip;
        record.normal = {0, 0, said->touching ? 1 : 0};
        if (const auto wrong = passage.check(record)) return *wrong;
    }
}

/// A way from one height to another [m].
std::optional<Said> way(int n, double from, double to, double x = 0)
{
    constexpr int kTicks = 100;
    if (n > kTicks) return {};
    return Said{from + (to - from) * n / kTicks, x};
}

TEST(SoakPassage, AHandThatGetsThroughWithoutAContactIsSeen)
{
    for (const double from : {5e-3, -5e-3})
        EXPECT_NE(wrongOf([&](int n) { return way(n, from, -from); }).find("no contact"), std::string::npos) << from;
    // What stays in front of it, or is in contact behind it, does not get through.
    EXPECT_EQ(wrongOf([](int n) { return way(n, 5e-3, -0.5e-3); }), "");
    EXPECT_EQ(wrongOf([](int n) {
                  auto said = way(n, 5e-3, -5e-3);
                  if (said) said->touching = said->height < 0;
                  return said;
              }),
              "");
}

TEST(SoakPassage, AContactThatIsLostBehindTheSurfaceIsSeen)
{
    const auto pressUntil = [](double lost) {
        return [=](int n) {
            auto said = way(n, 5e-3, -2.5e-3);
            if (said) said->touching = said->height < 0 && said->height > lost;
            return said;
        };
    };
    EXPECT_NE(wrongOf(pressUntil(-2e-3)).find("2.0"), std::string::npos) << "in millimetres";
    EXPECT_EQ(wrongOf(pressUntil(-1)), "");
    EXPECT_EQ(wrongOf([](int n) { // it comes out again
                  auto said = n > 100 ? way(n - 100, -2e-3, 5e-3) : way(n, 5e-3, -2e-3);
                  if (said) said->touching = said->height < 0;
                  return said;
              }),
              "");
}

/// Where a hand may well be on the other side without a contact nothing is said.
TEST(SoakPassage, BordersJumpsAndDevicesThatFailAreNoPassage)
{
    EXPECT_EQ(wrongOf([](int n) { return way(n, 5e-3, -5e-3, 21e-3); }), "") << "beyond the border";
    EXPECT_EQ(wrongOf([](int n) { return way(n, 5e-3, -5e-3, 20e-3); }), "") << "at it";
    EXPECT_EQ(wrongOf([](int n) { // it jumps
                  return n < 50 ? way(n, 5e-3, 2e-3) : way(n, -2e-3, -5e-3);
              }),
              "");
    for (const std::uint32_t device : {0x301U, 0x200U, 0xb00U}) // a fault, not homed, clutched
        EXPECT_EQ(wrongOf([](int n) { return way(n, 5e-3, -5e-3); }, device), "") << device;
}

} // namespace
} // namespace palp::soak
