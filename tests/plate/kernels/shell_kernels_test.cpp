#include <array>
#include <optional>
#include <vector>

#include "engine/plate/multigrid/detail/host_call.h"
#include "engine/plate/multigrid/detail/shell_host.h"
#include "engine/plate/multigrid/detail/shell_processor.h"
#include "tests/plate/kernels/plate_shader_test.h"
#include "tests/plate/shells.h"

// Each shader of shells against the host's kernel of the same pass, load by load.

namespace palp {
namespace {

constexpr Rounding kShellRounding{200, "some 80 products and sums, of which a driver may fuse or reorder any"};

class ShellKernelsTest : public PlateShaderTest {
protected:
    void SetUp() override
    {
        PlateShaderTest::SetUp();
        if (onHost()) GTEST_SKIP() << "the host has kernels of its own";
        if (!ShellKernels::suit(context())) GTEST_SKIP() << context().processor().name << " has no doubles";
        using enum Edge;
        const PlateGrid grid{37, 22, kSize / 37, kSize / 22};
        Shell           shell    = cutAslant(shellOf(grid, disc(10), ridges(), 12));
        shell.bending.edges      = {clamped, supported, guided, free};
        shell.stressEdges        = {free, supported, guided, clamped};
        shell.bending.foundation = 1e7;
        makeLevels(shell, *host_.kernels, levels_);
        coarse_.factorise(levels_.back(), *host_.kernels);
        kernels_.emplace(context());
    }

    [[nodiscard]] const ShellKernels::All& k() const { return kernels_->all(); }
    [[nodiscard]] const ShellLevel&        fine() const { return levels_.front(); }
    [[nodiscard]] const ShellLevel&        coarse() const { return levels_[1]; }

    /// Fields of three loads, 0 in empty places.
    template <class Real>
    [[nodiscard]] static std::vector<Real> rough(const ShellLayout& l, int seed)
    {
        std::vector<Real> fields(kLoads * numbersOf(l));
        const auto        values = roughValues<Real>(fields.size(), seed);
        for (int load = 0; load < kLoads; ++load)
            for (int i = 0; i <= l.cellsX; ++i)
                for (int j = 0; j <= l.cellsZ; ++j)
                    for (int field = 0; field < 2; ++field) {
                        const std::size_t at = std::size_t(load) * numbersOf(l) + std::size_t(placeIn(l, i, j, field));
                        fields[at]           = values[at];
                    }
        return fields;
    }

    /// Fields without what the host leaves in empty places, which no kernel's sum has a share of.
    template <class Real>
    [[nodiscard]] static std::vector<Real> onNodes(const ShellLayout& l, const std::vector<Real>& fields)
    {
        std::vector<Real> rest = rough<Real>(l, 1);
        for (std::size_t n = 0; n < rest.size(); ++n) rest[n] = rest[n] == 0 ? 0 : fields[n];
        return rest;
    }

    /// Calls a kernel of the host for each load, with fields of that load.
    template <class Call>
    static void eachLoad(const Call& call)
    {
        for (std::size_t load = 0; load < std::size_t(kLoads); ++load) call(load);
    }

    [[nodiscard]] static compute::Groups over(const compute::Kernel& kernel, const ShellLayout& l)
    {
        return kernel.groupsOver(std::uint32_t(2 * l.span), std::uint32_t(l.cellsX + 1), kLoads);
    }

    /// Expects the same bits, or on other processors what rounding allows of numbers of order one.
    template <class Real>
    static void expectSame(const std::vector<Real>& found, const std::vector<Real>& expected, double size)
    {
        EXPECT_TRUE(agree(found, expected, std::vector<double>(found.size(), size), kShellRounding));
        double most = 0;
        for (const Real value : expected) most = std::max(most, std::abs(double(value)));
        EXPECT_GT(most, 1e-3) << "then nothing is shown";
    }

    const HostVariant&          host_ = hostVariant();
    std::vector<ShellLevel>     levels_;
    ShellCoarseSolver           coarse_;
    std::optional<ShellKernels> kernels_;
};

TEST_F(ShellKernelsTest, ResidualAndProduct)
{
    const ShellLayout& l = fine().layout;
    {
        const auto         x = rough<float>(l, 1), b = rough<float>(l, 2);
        std::vector<float> r(x.size()), expected(x.size());
        eachLoad([&](std::size_t n) {
            const std::size_t at = n * numbersOf(l);
            callHost(host_.kernels->shellResidual, ShellPush{.layout = l},
                     {fine().entries.data(), &b[at], &x[at], &expected[at]});
        });
        dispatchOnce(k().residual, {in(fine().entries), in(x), inOut(r), in(b)}, shared::ShellPassPush{l, {}, 0, 0},
                     over(k().residual, l));
        expectSame(r, onNodes(l, expected), 1e3);
    }
    const auto          p = rough<double>(l, 3);
    std::vector<double> q(p.size()), expected(p.size());
    eachLoad([&](std::size_t n) {
        const std::size_t at = n * numbersOf(l);
        callHost(host_.kernels->shellApply, ShellPush{.layout = l}, {fine().exact.data(), &p[at], &expected[at]});
    });
    dispatchOnce(k().apply, {in(fine().exact), in(p), inOut(q)}, shared::ShellPassPush{l, {}, 0, 0},
                 over(k().apply, l));
    expectSame(q, onNodes(l, expected), 1e3);
}

/// What the host sums over loads that lie side by side, against sums of what its kernels write.
TEST_F(ShellKernelsTest, SumsOfEightLoads)
{
    const ShellLayout& l       = fine().layout;
    const std::size_t  numbers = kLoadsTogether * numbersOf(l);
    const auto         several = [&](int seed) {
        const auto         values = roughValues<float>(numbers, seed);
        std::vector<float> fields(numbers);
        for (int i = 0; i <= l.cellsX; ++i)
            for (int j = 0; j <= l.cellsZ; ++j)
                for (int field = 0; field < 2; ++field)
                    for (std::size_t n = 0; n < kLoadsTogether; ++n) {
                        const std::size_t at = std::size_t(placeIn(l, i, j, field)) * kLoadsTogether + n;
                        fields[at]           = values[at];
                    }
        return fields;
    };
    using Sums      = std::array<double, kLoadsTogether>;
    const auto dots = [&](const std::vector<float>& a, const std::vector<float>& b) {
        std::pair<Sums, Sums> all{}; // and what they are rounded by
        for (std::size_t n = 0; n < numbers; ++n) {
            all.first[n % kLoadsTogether] += double(a[n]) * double(b[n]);
            all.second[n % kLoadsTogether] += std::abs(double(a[n]) * double(b[n]));
        }
        return all;
    };
    const auto         x = several(7), b = several(8);
    std::vector<float> product(numbers), missing(numbers);
    Sums               ofProduct{}, ofMissing{}, steepness{};
    callHost(host_.together->shellApply, ShellPush{.layout = l},
             {fine().exact.data(), x.data(), product.data(), ofProduct.data()});
    callHost(host_.together->shellMissing, ShellPush{.layout = l},
             {fine().exact.data(), b.data(), x.data(), missing.data(), ofMissing.data()});
    callHost(host_.together->shellSteepness, ShellPush{.layout = l},
             {fine().entries.data(), x.data(), steepness.data()});
    const auto [xKx, xKxSize] = dots(x, product);
    const auto [bx, bxSize]   = dots(b, x);
    const auto [rx, rxSize]   = dots(missing, x);
    for (std::size_t n = 0; n < kLoadsTogether; ++n) {
        EXPECT_NEAR(ofProduct[n], xKx[n], 1e-12 * xKxSize[n]) << "the same sums in doubles, in another order";
        EXPECT_NEAR(ofMissing[n], bx[n] + rx[n], 1e-12 * (bxSize[n] + rxSize[n]));
        EXPECT_NEAR(steepness[n], xKx[n], 1e-5 * xKxSize[n]) << "some 80 products and sums in floats";
        EXPECT_GT(std::abs(xKx[n]), 1e-3 * xKxSize[n]) << "then nothing is shown";
    }
}

TEST_F(ShellKernelsTest, HalfSweeps)
{
    const ShellLayout& l = fine().layout;
    const auto         b = rough<float>(l, 4);
    for (const int colour : {0, 1}) {
        auto               before = rough<float>(l, 5), expected = before;
        std::vector<float> after(before.size()), first(before.size()), expectedFirst(before.size());
        eachLoad([&](std::size_t n) {
            const std::size_t at = n * numbersOf(l);
            callHost(host_.kernels->shellSmooth, ShellPush{.layout = l, .colour = colour, .halfSweeps = 1},
                     {fine().entries.data(), &b[at], &expected[at], nullptr});
            callHost(host_.kernels->shellSmooth,
                     ShellPush{.layout = l, .colour = colour, .halfSweeps = 1, .fromZero = true},
                     {fine().entries.data(), &b[at], &expectedFirst[at], nullptr});
        });
        const shared::ShellPassPush push{l, {}, colour, 0};
        dispatchOnce(k().relax, {in(fine().entries), in(b), in(before), inOut(after)}, push, over(k().relax, l));
        dispatchOnce(k().relaxFirst, {in(fine().entries), in(b), inOut(first)}, push, over(k().relaxFirst, l));
        expectSame(after, onNodes(l, expected), 1e3);
        expectSame(first, onNodes(l, expectedFirst), 1e3);
    }
}

TEST_F(ShellKernelsTest, Transfers)
{
    const ShellLayout &f = fine().layout, &c = coarse().layout;
    const auto&        t = fine().tables;
    const auto         r = rough<float>(f, 6), e = rough<float>(c, 7);
    const auto         to = rough<float>(f, 8);
    std::vector<float> restricted(e.size()), expectedCoarse(e.size()), put(r.size()), expectedPut(r.size());
    auto               added = to, expectedSum = to;
    eachLoad([&](std::size_t n) {
        const std::size_t atF = n * numbersOf(f), atC = n * numbersOf(c);
        const ShellPush   push{.layout = f, .coarse = c};
        callHost(host_.kernels->shellRestrict, push,
                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), &r[atF], &expectedCoarse[atC]});
        callHost(host_.kernels->shellProlong, push,
                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), &e[atC], &expectedSum[atF]});
        callHost(host_.kernels->shellProlong, push,
                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), &e[atC], &expectedPut[atF]});
    });
    dispatchOnce(k().restrict, {in(t[0]), in(t[1]), in(t[2]), in(t[3]), in(r), inOut(restricted)},
                 shared::ShellPassPush{f, c, 0, 0}, over(k().restrict, c));
    dispatchOnce(k().prolong, {in(t[0]), in(t[1]), in(t[2]), in(t[3]), in(e), inOut(added)},
                 shared::ShellPassPush{f, c, 0, 0}, over(k().prolong, f));
    put = to;
    dispatchOnce(k().prolong, {in(t[0]), in(t[1]), in(t[2]), in(t[3]), in(e), inOut(put)},
                 shared::ShellPassPush{f, c, 0, 1}, over(k().prolong, f));
    expectSame(restricted, expectedCoarse, 10);
    expectSame(added, expectedSum, 10);
    expectSame(put, expectedPut, 10);
}

/// A small level in one dispatch each way does what all its passes do.
TEST_F(ShellKernelsTest, ALevelInOneDispatch)
{
    const ShellLayout &f = fine().layout, &c = coarse().layout;
    const auto&        t       = fine().tables;
    const auto&        entries = fine().entries;
    const auto         b = rough<float>(f, 11), e = rough<float>(c, 12), guess = rough<float>(f, 13);
    auto               up = guess, expectedUp = guess;
    std::vector<float> x(b.size()), expectedX(b.size()), left(b.size()), turned(b.size()), below(e.size()),
        expectedBelow(e.size());
    eachLoad([&](std::size_t n) {
        const std::size_t atF = n * numbersOf(f), atC = n * numbersOf(c);
        const ShellPush   push{.layout = f, .coarse = c};
        callHost(host_.kernels->shellSmooth, ShellPush{.layout = f, .halfSweeps = 4, .fromZero = true},
                 {entries.data(), &b[atF], &expectedX[atF], nullptr});
        std::vector<float> rest(numbersOf(f));
        callHost(host_.kernels->shellResidual, ShellPush{.layout = f},
                 {entries.data(), &b[atF], &expectedX[atF], rest.data()});
        callHost(host_.kernels->shellRestrict, push,
                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), rest.data(), &expectedBelow[atC]});
        callHost(host_.kernels->shellProlong, push,
                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), &e[atC], &expectedUp[atF]});
        callHost(host_.kernels->shellSmooth, ShellPush{.layout = f, .colour = 1, .halfSweeps = 4},
                 {entries.data(), &b[atF], &expectedUp[atF], nullptr});
    });
    const shared::ShellPassPush push{f, c, 0, 0};
    dispatchOnce(k().down,
                 {in(entries), in(b), in(t[0]), in(t[1]), in(t[2]), in(t[3]), inOut(x), inOut(left), inOut(below)},
                 push, {1, 1, kLoads});
    dispatchOnce(k().up, {in(entries), in(b), in(t[0]), in(t[1]), in(t[2]), in(t[3]), inOut(up), inOut(turned), in(e)},
                 push, {1, 1, kLoads});
    expectSame(x, onNodes(f, expectedX), 1e3);
    expectSame(below, expectedBelow, 1e3);
    expectSame(up, onNodes(f, expectedUp), 1e3);
}

TEST_F(ShellKernelsTest, CoarsestLevel)
{
    const ShellLayout& l = levels_.back().layout;
    const auto         b = rough<float>(l, 9);
    std::vector<float> x(b.size()), expected(b.size());
    eachLoad([&](std::size_t n) { coarse_.solve(*host_.kernels, &b[n * numbersOf(l)], &expected[n * numbersOf(l)]); });
    std::vector<std::int32_t> places(coarse_.places().begin(), coarse_.places().end());
    std::vector<double>       factors(coarse_.factors().begin(), coarse_.factors().end());
    dispatchOnce(k().coarse, {in(factors), in(places), in(b), inOut(x)},
                 shared::ShellBandPush{std::uint32_t(places.size()), std::uint32_t(coarse_.halfBand()),
                                       std::uint32_t(numbersOf(l))},
                 {1, 1, kLoads});
    expectSame(x, expected, 1e3);

    std::vector<double>         inverse(places.size() * places.size());
    const auto                  unknowns = std::uint32_t(places.size());
    const shared::ShellBandPush push{unknowns, std::uint32_t(coarse_.halfBand()), std::uint32_t(numbersOf(l))};
    dispatchOnce(k().invert, {in(factors), out(inverse)}, push, {1, 1, unknowns});
    std::vector<float> product(b.size());
    dispatchOnce(k().byInverse, {in(inverse), in(places), in(b), inOut(product)}, push, {unknowns, 1, kLoads});
    double size = 0;
    for (const float value : expected) size = std::max(size, std::abs(double(value)));
    for (std::size_t n = 0; n < product.size(); ++n)
        ASSERT_NEAR(product[n], expected[n], 1e-6 * size) << "rounded to floats, " << n;
    double most = 0;
    for (const double entry : inverse) most = std::max(most, std::abs(entry));
    for (std::uint32_t u = 0; u < unknowns; ++u)
        for (std::uint32_t v = 0; v < u; ++v)
            ASSERT_NEAR(inverse[u * unknowns + v], inverse[v * unknowns + u], 1e-9 * most) << u << ", " << v;
}

TEST_F(ShellKernelsTest, GradientsOfEachLoad)
{
    const ShellLayout& l       = fine().layout;
    const std::size_t  numbers = numbersOf(l);
    const auto x = rough<double>(l, 10), r = rough<double>(l, 11), p = rough<double>(l, 12), q = rough<double>(l, 13),
               b                    = rough<double>(l, 14);
    const auto                    z = rough<float>(l, 15);
    const std::vector<double>     lengths{0.7, 0, -1.3}, turns{0.4, 1, 0, 1, 0.5, 0};
    auto                          xNow = x, rNow = r, xExpected = x, rExpected = r, pNow = p, pExpected = p;
    std::vector<float>            rounded(r.size()), roundedExpected;
    std::vector<double>           sums(2 * kLoads), sumsExpected(2 * kLoads), workExpected(2 * kLoads);
    const shared::ShellVectorPush push{std::uint32_t(numbers), kLoads, 0}, second{std::uint32_t(numbers), kLoads, 1};
    eachLoad([&](std::size_t n) {
        const std::size_t at = n * numbers;
        const VectorSize  size{std::ptrdiff_t(numbers)};
        callHost(host_.kernels->shellAdvance, size,
                 {&xExpected[at], &rExpected[at], &p[at], &q[at], &b[at], &lengths[n], &workExpected[2 * n]});
        if (turns[2 * n + 1] != 0) callHost(host_.kernels->shellTurn, size, {&z[at], &pExpected[at], &turns[2 * n]});
        callHost(host_.kernels->shellDots, size, {&p[at], &q[at], &sumsExpected[n]});
        callHost(host_.kernels->shellDotsOfCycle, size, {&r[at], &z[at], &sumsExpected[kLoads + n]});
    });
    for (const double value : rExpected) roundedExpected.push_back(float(value));

    dispatchOnce(k().advance, {inOut(xNow), inOut(rNow), in(p), in(q), out(rounded), in(lengths)}, push,
                 k().advance.groupsOver(push.numbers, 1, kLoads));
    dispatchOnce(k().turn, {in(z), inOut(pNow), in(turns)}, push, k().turn.groupsOver(push.numbers, 1, kLoads));
    dispatchOnce(k().dots, {in(p), in(q), inOut(sums)}, push, {1, 1, kLoads});
    dispatchOnce(k().dotsOfCycle, {in(r), in(z), inOut(sums)}, second, {1, 1, kLoads});
    expectSame(xNow, xExpected, 10);
    expectSame(rNow, rExpected, 10);
    expectSame(rounded, roundedExpected, 10);
    expectSame(pNow, pExpected, 10);
    expectSame(sums, sumsExpected, 1e4);

    // The sums of a step are those of whole vectors.
    std::vector<double> works(2 * kLoads);
    dispatchOnce(k().dots, {in(b), in(xNow), inOut(works)}, push, {1, 1, kLoads});
    dispatchOnce(k().dots, {in(rNow), in(xNow), inOut(works)}, second, {1, 1, kLoads});
    std::vector<double> byLoad;
    for (const std::size_t of : {0, 1})
        for (std::size_t n = 0; n < std::size_t(kLoads); ++n) byLoad.push_back(workExpected[2 * n + of]);
    expectSame(works, byLoad, 1e4);

    auto       sum = z, sumExpected = z;
    const auto more = rough<float>(l, 16);
    for (std::size_t n = 0; n < sum.size(); ++n) sumExpected[n] += more[n];
    dispatchOnce(k().add, {in(more), inOut(sum)}, push, k().add.groupsOver(push.numbers, 1, kLoads));
    expectSame(sum, sumExpected, 10);
}

} // namespace
} // namespace palp
