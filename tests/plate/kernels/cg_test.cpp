#include <array>
#include <cmath>

#include "tests/plate/kernels/plate_shader_test.h"

// Tests of conjugate gradients: cg_dot.comp, cg_scalars.comp, cg_direction.comp and cg_update.comp.

namespace palp {
namespace {

using shared::kStateAlong;
using shared::kStateAlpha;
using shared::kStateBeta;
using shared::kStateEnergy;
using shared::kStateEstimate;
using shared::kStateGain;
using shared::kStateLast;
using shared::kStateRatio;
using shared::kStateRz;
using shared::kStateSlowest;
using shared::kStateSteps;
using shared::kStateWords;

constexpr Rounding kScalarRounding{16,
                                   "sums in a fixed order, two divisions good to 2.5 ulp, and a square root good to 5"};

class CgTest : public PlateShaderTest {
protected:
    static constexpr std::uint32_t kNodes = 997; ///< a prime: no multiple of any workgroup or number of sums [1]

    /// Sums that a dot product is split into: 1 for each 64 nodes, more than a workgroup, more than nodes.
    static std::vector<std::uint32_t> partialCounts() { return {15, 64, 300, 1201}; }

    /// Workgroups that reduce, as hardware, lavapipe and neither do it.
    static std::vector<compute::Workgroup> reducers()
    {
        if (isSlow()) return {{64, 1, 1}};
        return {{256, 1, 1}, {64, 1, 1}, {8, 1, 1}};
    }

    template <class Real>
    static std::vector<Real> vectors(std::uint32_t seed)
    {
        return roughValues<Real>(kLoads * kNodes, seed);
    }

    /// A state with every word set, so that each that should not change is seen.
    template <class Real>
    static std::vector<Real> roughState(std::uint32_t seed)
    {
        std::vector<Real> state = roughValues<Real>(kLoads * std::size_t(kStateWords), seed);
        for (int load = 0; load < kLoads; ++load) { // as they may be
            Real* const at   = state.data() + load * kStateWords;
            at[kStateRz]     = Real(0.5) + std::abs(at[kStateRz]);
            at[kStateEnergy] = Real(2) + at[kStateEnergy];
            at[kStateGain]   = Real(0.1) + std::abs(at[kStateGain]);
            at[kStateRatio]  = std::abs(at[kStateRatio]);
            at[kStateSteps]  = Real(3 + load);
            for (const int word : {kStateAlpha, kStateBeta, kStateLast}) at[word] = Real(0.1) + std::abs(at[word]);
            at[kStateSlowest] = at[kStateAlpha] + at[kStateLast];
            at[kStateAlong]   = Real(0.5) * at[kStateLast];
        }
        return state;
    }

    template <class Real>
    static std::vector<Real> sumsOf(const std::vector<host::Partial<Real>>& partials)
    {
        std::vector<Real> sums;
        for (const auto& partial : partials) sums.push_back(partial.sum);
        return sums;
    }

    template <class Real>
    static std::vector<double> sizesOf(const std::vector<host::Partial<Real>>& partials)
    {
        std::vector<double> sizes;
        for (const auto& partial : partials) sizes.push_back(partial.size);
        return sizes;
    }

    /// Sizes of values that are computed from numbers of about their own size.
    template <class Real>
    static std::vector<double> ownSizes(const std::vector<Real>& values)
    {
        std::vector<double> sizes = magnitudes(values);
        for (double& size : sizes) size += 1;
        return sizes;
    }
};

constexpr Rounding kDotRounding{1000, "each of up to 67 terms is a product that a driver may fuse with the sum"};

TEST_F(CgTest, DotProductsAreAddedInTheOrderOfCxx)
{
    inEachPrecision([](auto number) {
        using Real                 = decltype(number);
        const std::vector<Real>  r = vectors<Real>(41), x = vectors<Real>(42);
        const std::vector<float> z = vectors<float>(43), f = vectors<float>(44);
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel dots(context(), kernels::dots<Real>(), shape);
            for (const std::uint32_t count : partialCounts()) {
                SCOPED_TRACE(std::to_string(count) + " sums by " + describe(shape));
                std::vector<Real> partials(2 * std::size_t(kLoads) * count);

                dispatchTwice(dots, {in(r), in(z), in(x), in(f), out(partials)}, shared::VectorPush{kNodes, count, 0},
                              dots.groupsOver(count, 1, kLoads));

                std::vector<host::Partial<Real>> expected;
                for (std::size_t load = 0; load < kLoads; ++load) {
                    const std::size_t at = load * kNodes;
                    const auto        rz = host::partialSums<Real>(kNodes, count,
                                                            [&](std::size_t n) { return r[at + n] * Real(z[at + n]); });
                    const auto        fx = host::partialSums<Real>(kNodes, count,
                                                            [&](std::size_t n) { return Real(f[at + n]) * x[at + n]; });
                    expected.insert(expected.end(), rz.begin(), rz.end());
                    expected.insert(expected.end(), fx.begin(), fx.end());
                }
                EXPECT_TRUE(agree(partials, sumsOf(expected), sizesOf(expected), kDotRounding));
            }
        }
    });
}

TEST_F(CgTest, TheDotProductOfAStepIsAddedInTheOrderOfCxx)
{
    inEachPrecision([](auto number) {
        using Real                = decltype(number);
        const std::vector<Real> p = vectors<Real>(45), q = vectors<Real>(46);
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel dots(context(), kernels::stepDots<Real>(), shape);
            for (const std::uint32_t count : partialCounts()) {
                SCOPED_TRACE(std::to_string(count) + " sums by " + describe(shape));
                std::vector<Real> partials(std::size_t(kLoads) * count);

                dispatchTwice(dots, {in(p), in(q), out(partials)}, shared::VectorPush{kNodes, count, 0},
                              dots.groupsOver(count, 1, kLoads));

                std::vector<host::Partial<Real>> expected;
                for (std::size_t load = 0; load < kLoads; ++load) {
                    const std::size_t at = load * kNodes;
                    const auto        pq =
                        host::partialSums<Real>(kNodes, count, [&](std::size_t n) { return p[at + n] * q[at + n]; });
                    expected.insert(expected.end(), pq.begin(), pq.end());
                }
                EXPECT_TRUE(agree(partials, sumsOf(expected), sizesOf(expected), kDotRounding));
            }
        }
    });
}

TEST_F(CgTest, BetaAndTheEnergyAreThoseOfCxxHoweverASolveBegins)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : reducers()) {
            const compute::Kernel beta(context(), kernels::beta<Real>(), shape);
            for (const std::uint32_t count : partialCounts())
                for (const std::uint32_t begins : {0U, 1U, 2U}) {
                    SCOPED_TRACE(std::to_string(count) + " sums, begins " + std::to_string(begins) + " by " +
                                 describe(shape));
                    const shared::ScalarsPush push{kLoads, count, begins, 0, 1e-6F};
                    std::vector<Real>         partials = roughValues<Real>(2 * std::size_t(kLoads) * count, 47);
                    std::vector<Real>         state = roughState<Real>(48), expected = state;
                    expected[kStateWords + kStateRz] = state[kStateWords + kStateRz] =
                        0; // of load 1: nothing to divide by

                    dispatchTwice(beta, {in(partials), inOut(state)}, push, {1, 1, 1});

                    host::beta(push, partials, shape.x, expected);
                    EXPECT_TRUE(agree(state, expected, std::vector<double>(state.size(), count), kScalarRounding));
                    EXPECT_EQ(state[kStateWords + kStateBeta], Real(0));
                    for (int load = 0; load < kLoads; ++load) {
                        const Real* at = state.data() + load * kStateWords;
                        EXPECT_TRUE(begins == 0 || at[kStateSteps] == 0) << "counts anew";
                        EXPECT_TRUE(begins != 2 || (at[kStateBeta] == 0 && at[kStateGain] == 0 && at[kStateRatio] == 0))
                            << "anew";
                    }
                }
        }
    });
}

TEST_F(CgTest, AStepIsThatOfCxx)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : reducers()) {
            const compute::Kernel step(context(), kernels::step<Real>(), shape);
            for (const std::uint32_t count : partialCounts()) {
                SCOPED_TRACE(std::to_string(count) + " sums by " + describe(shape));
                const shared::ScalarsPush push{kLoads, count, 0, 7, 1e-6F};
                std::vector<Real>         partials = roughValues<Real>(std::size_t(kLoads) * count, 49);
                for (Real& partial : partials) partial = std::abs(partial);
                std::vector<Real>          state = roughState<Real>(50), expected = state;
                std::vector<std::uint32_t> arguments(9, 5);

                dispatchTwice(step, {in(partials), inOut(state), inOut(arguments)}, push, {1, 1, 1});

                EXPECT_FALSE(host::step(push, partials, shape.x, expected));
                EXPECT_TRUE(agree(state, expected, ownSizes(expected), kScalarRounding));
                EXPECT_EQ(arguments, std::vector<std::uint32_t>(9, 5));
            }
        }
    });
}

/// What a step makes of given dot products, one per load.
template <class Real>
struct AfterStep {
    std::vector<Real>          state;
    std::vector<std::uint32_t> arguments;
};

class CgStepTest : public CgTest {
protected:
    /// \param pq  (p, A p) of each load
    template <class Real>
    static AfterStep<Real> stepped(const std::vector<Real>& pq, std::vector<Real> state, float tolerance)
    {
        constexpr std::uint32_t   kPartials = 3;
        static compute::Workgroup shape{64, 1, 1};
        const compute::Kernel     step(context(), kernels::step<Real>(), shape);
        std::vector<Real>         partials;
        for (const Real value : pq) partials.insert(partials.end(), {value, Real(0), Real(0)});
        std::vector<std::uint32_t> arguments(100, 5); // more than a workgroup; three of them not the kernel's
        const shared::ScalarsPush  push{std::uint32_t(pq.size()), kPartials, 0, 97, tolerance};
        std::vector<Real>          expected = state;
        dispatchTwice(step, {in(partials), inOut(state), inOut(arguments)}, push, {1, 1, 1});

        std::vector<std::uint32_t> wanted(100, 5);
        if (host::step(push, partials, shape.x, expected)) std::fill(wanted.begin(), wanted.end() - 3, 0U);
        // Where a share is 1 but for its rounding, the square root of 1 - share, which is 0 or nearly so, is that of
        // rounding.
        const double        root  = std::sqrt(double(std::numeric_limits<Real>::epsilon()));
        std::vector<double> sizes = ownSizes(expected);
        for (std::size_t at = 0; at < expected.size(); at += std::size_t(shared::kStateWords)) {
            const std::size_t along = at + std::size_t(shared::kStateAlong);
            const double      last  = std::abs(double(expected[at + std::size_t(shared::kStateLast)]));
            if (std::abs(double(expected[along])) < 16 * root * last) sizes[along] += last / root;
        }
        EXPECT_TRUE(agree(state, expected, sizes, kScalarRounding));
        EXPECT_EQ(arguments, wanted);
        return {state, arguments};
    }

    /// A state with (r, z), last gain and energy for which a step of pq = 1 has gain rz^2, and a known estimate.
    template <class Real>
    static std::vector<Real> stateOf(const std::vector<Real>& rz)
    {
        std::vector<Real> state(rz.size() * std::size_t(kStateWords));
        for (std::size_t load = 0; load < rz.size(); ++load) {
            Real* const at   = state.data() + load * std::size_t(kStateWords);
            at[kStateRz]     = rz[load];
            at[kStateEnergy] = 1;
            at[kStateGain]   = 4 * rz[load] * rz[load]; // so that the ratio is 1/4, and left = gain/3
            at[kStateSteps]  = 2;
        }
        return state;
    }
};

TEST_F(CgStepTest, TheEstimateIsAGeometricTail)
{
    inEachPrecision([](auto number) {
        using Real       = decltype(number);
        const auto after = stepped<Real>({1}, stateOf<Real>({Real(0.5)}), 1e-3F);

        EXPECT_EQ(after.state[kStateAlpha], Real(0.5));
        EXPECT_EQ(after.state[kStateGain], Real(0.25));
        EXPECT_EQ(after.state[kStateRatio], Real(0.25));
        EXPECT_EQ(after.state[kStateSteps], Real(3));
        EXPECT_NEAR(double(after.state[kStateEstimate]), std::sqrt(0.25 / 3 / 1.25), 1e-6) << "rounding of floats";
    });
}

/// What is left after a gain, by the ratio that the tail is taken to have.
double tail(double gain, double ratio)
{
    return std::sqrt(gain * ratio / (1 - ratio) / (1 + gain));
}

TEST_F(CgStepTest, ALuckyRatioIsNotBelievedAtOnceAndASlowOneIsNotForgottenAtOnce)
{
    inEachPrecision([](auto number) {
        using Real               = decltype(number);
        std::vector<Real> second = stateOf<Real>({Real(0.125)}); // gain 1/64 of a last gain of 64: ratio 1/4096
        second[kStateGain]       = 64;
        second[kStateAlpha] = second[kStateSlowest] = 1;
        second[kStateBeta]                          = 100; // nothing slow is known: the bound is 0
        const auto        lucky                     = stepped<Real>({1}, second, 1e-3F);
        std::vector<Real> later                     = second;
        later[kStateRatio]                          = Real(0.5);
        const auto afterOne                         = stepped<Real>({1}, later, 1e-3F);
        EXPECT_NEAR(double(lucky.state[kStateEstimate]), tail(1.0 / 64, 0.09375), 1e-6)
            << "3/32 is the least of a second step";
        EXPECT_EQ(afterOne.state[kStateRatio], Real(0.40625)) << "13/16 of it is kept";
        EXPECT_NEAR(double(afterOne.state[kStateEstimate]), tail(1.0 / 64, 0.40625), 1e-6);
    });
}

/// Steps of conjugate gradients on a matrix of four eigenvalues, with a right side in which the slowest part is small.
TEST_F(CgStepTest, TheSlowestPartIsTheSmallestRitzValueAndBoundsTheError)
{
    constexpr double                 kEigenvalues[] = {2.0, 1.0, 0.5, 0.01};
    std::array                       r{1.0, 1.0, 1.0, 0.02}, p = r;
    host::Scalars<double>::CgSlowest slowest{};
    double                           rz = 0, lastAlpha = 0, beta = 0, truth = 0;
    for (int n = 0; n < 4; ++n) truth += r[std::size_t(n)] * r[std::size_t(n)] / kEigenvalues[n];
    for (int step = 0; step < 4; ++step) {
        double next = 0, pq = 0;
        for (const double value : r) next += value * value;
        beta = step > 0 ? next / rz : 0;
        rz   = next;
        for (std::size_t n = 0; n < 4; ++n) p[n] = r[n] + beta * p[n];
        for (std::size_t n = 0; n < 4; ++n) pq += p[n] * p[n] * kEigenvalues[n];
        const auto now = host::Scalars<double>{}.stepOf(pq, rz, beta, 0, lastAlpha, 0, 0, step, slowest);
        for (std::size_t n = 0; n < 4; ++n) r[n] -= now.alpha * kEigenvalues[n] * p[n];
        truth -= now.gain;
        const double smallest = 1 / now.slowest.most;
        EXPECT_GT(smallest, 0.999 * kEigenvalues[3]) << "a Ritz value is never below the spectrum";
        EXPECT_LE(now.slowest.most, 1.001 / kEigenvalues[3]);
        if (step == 0) {
            EXPECT_DOUBLE_EQ(now.slowest.most, now.alpha);
        }
        if (step == 3) {
            EXPECT_NEAR(smallest, kEigenvalues[3], 0.05 * kEigenvalues[3]) << "the last one is the spectrum's";
            EXPECT_NEAR(truth, 0, 1e-12);
        } else if (smallest < 2 * kEigenvalues[3]) {
            EXPECT_LT(truth, host::Scalars<double>{}.leftAtMost(now.slowest, now.alpha, beta, lastAlpha, rz));
        }
        slowest   = now.slowest;
        lastAlpha = now.alpha;
    }
}

TEST_F(CgStepTest, AGainThatIsSmallByLuckIsNotBelievedWhereASlowPartIsKnown)
{
    inEachPrecision([](auto number) {
        using Real              = decltype(number);
        std::vector<Real> state = stateOf<Real>({Real(0.125)});
        state[kStateGain]       = 64; // of which 1/64 is 1/4096
        state[kStateAlpha]      = 1;
        state[kStateBeta]       = Real(0.5);
        state[kStateSlowest]    = 4;
        state[kStateLast]       = 1;
        state[kStateAlong]      = 0;
        const auto   after      = stepped<Real>({1}, state, 1e-3F);
        const double atNode = 4 * 1.421875, rest = atNode - 1, bound = rest / (rest / atNode + 0.5) - 0.125;
        const double left = 0.40625 * bound * 0.125;
        EXPECT_NEAR(double(after.state[kStateSlowest]), 4, 1e-5) << "it is not forgotten";
        EXPECT_NEAR(double(after.state[kStateEstimate]), std::sqrt(left / (1 + 1.0 / 64)), 1e-6);
    });
}

TEST_F(CgStepTest, DispatchesAreEmptiedOnlyWhenEveryLoadIsFinished)
{
    inEachPrecision([](auto number) {
        using Real      = decltype(number);
        const Real fine = Real(1e-3), rough = Real(0.1); // estimates of 6e-4 and 6e-2
        struct Case {
            std::vector<Real> rz;
            bool              finished;
        };
        for (const Case& one : {Case{{fine, fine, fine}, true}, Case{{rough, fine, fine}, false},
                                Case{{fine, rough, fine}, false}, Case{{fine, fine, rough}, false},
                                Case{{rough, rough, rough}, false}, Case{{fine}, true}, Case{{rough}, false}}) {
            const auto after = stepped<Real>(std::vector<Real>(one.rz.size(), Real(1)), stateOf<Real>(one.rz), 1e-2F);
            EXPECT_EQ(after.arguments.front() == 0, one.finished);
        }
    });
}

TEST_F(CgStepTest, ALoadWithoutAPositiveProductTakesNoStepAndIsNotCalledFinished)
{
    inEachPrecision([](auto number) {
        using Real     = decltype(number);
        const Real nan = std::numeric_limits<Real>::quiet_NaN();
        for (const Real pq : {Real(0), Real(-1), nan}) {
            const auto after = stepped<Real>({1, pq, 1}, stateOf<Real>({Real(1e-3), Real(0.25), Real(1e-3)}), 1e-2F);

            const Real* at = after.state.data() + kStateWords;
            EXPECT_EQ(at[kStateAlpha], Real(0));
            EXPECT_EQ(at[kStateGain], Real(0));
            EXPECT_EQ(at[kStateEstimate], Real(0.5)) << "the square root of (r, z) over the energy";
            EXPECT_EQ(after.arguments.front(), 5U);
        }
    });
}

/// An estimate of 0 would call it solved.
TEST_F(CgStepTest, NotANumberIsNoEstimate)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double pq : {1.0, 0.0, nan})
        for (const double energy : {0.0, 1.0, nan}) {
            const auto now = host::Scalars<double>{}.stepOf(pq, nan, 0, energy, 0, 0, 0, 0, {});
            EXPECT_TRUE(std::isnan(now.estimate)) << pq << ", " << energy << ": " << now.estimate;
        }
}

TEST_F(CgStepTest, ALoadOfNothingIsFinished)
{
    inEachPrecision([](auto number) {
        using Real       = decltype(number);
        const auto after = stepped<Real>({0}, std::vector<Real>(std::size_t(kStateWords)), 1e-6F);

        EXPECT_EQ(after.state[kStateAlpha], Real(0));
        EXPECT_EQ(after.state[kStateEstimate], Real(0));
        EXPECT_EQ(after.arguments.front(), 0U);
    });
}

TEST_F(CgStepTest, AToleranceOfZeroNeverStops)
{
    inEachPrecision([](auto number) {
        using Real       = decltype(number);
        const auto after = stepped<Real>({0, 1}, std::vector<Real>(2 * std::size_t(kStateWords)), 0);

        EXPECT_EQ(after.arguments.front(), 5U);
    });
}

TEST_F(CgTest, TheNextDirectionIsThatOfCxxAndTheFirstNeedsNoLast)
{
    inEachPrecision([](auto number) {
        using Real                    = decltype(number);
        const std::vector<float> z    = vectors<float>(51);
        std::vector<Real>        last = vectors<Real>(52), state = roughState<Real>(53);
        state[kStateWords + kStateBeta] = 0; // of load 1, whose last direction is whatever memory held
        std::fill(last.begin() + kNodes, last.begin() + 2 * kNodes, std::numeric_limits<Real>::quiet_NaN());
        std::vector<Real>   expected(last.size());
        std::vector<double> sizes;
        for (std::size_t n = 0; n < expected.size(); ++n) {
            const Real beta = state[n / kNodes * std::size_t(kStateWords) + std::size_t(kStateBeta)];
            expected[n]     = beta == 0 ? Real(z[n]) : Real(z[n]) + beta * last[n];
            sizes.push_back(2);
        }
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel direction(context(), kernels::direction<Real>(), shape);
            std::vector<Real>     p = last;

            EXPECT_EQ(dispatchGuarded(context(), direction, {in(state), in(z), inOut(p)},
                                      shared::VectorPush{kNodes, 0, 0}, direction.groupsOver(kNodes, 1, kLoads)),
                      std::vector<std::string>{});

            EXPECT_TRUE(agree(p, expected, sizes, kFusedRounding)) << describe(shape);
        }
    });
}

TEST_F(CgTest, AnUpdateIsThatOfCxxAndIsLeftOutWhereTheSolveStoppedBefore)
{
    inEachPrecision([](auto number) {
        using Real                 = decltype(number);
        const std::vector<Real>  p = vectors<Real>(54), q = vectors<Real>(55), state = roughState<Real>(56);
        const std::uint32_t      iteration = 4; // of load 1; loads 0 and 2 have made 3 and 5 steps
        const std::vector<Real>  xBefore = vectors<Real>(57), rBefore = vectors<Real>(58);
        const std::vector<float> roundedBefore = vectors<float>(59);
        std::vector<Real>        xExpected = xBefore, rExpected = rBefore;
        for (std::size_t n = kNodes; n < 2 * kNodes; ++n) {
            const Real alpha = state[std::size_t(kStateWords + kStateAlpha)];
            xExpected[n] += alpha * p[n];
            rExpected[n] -= alpha * q[n];
        }
        for (const compute::Workgroup shape : lines()) {
            SCOPED_TRACE(describe(shape));
            const compute::Kernel update(context(), kernels::update<Real>(), shape);
            std::vector<Real>     x = xBefore, r = rBefore;
            std::vector<float>    rounded = roundedBefore;

            dispatchTwice(update, {in(state), in(p), in(q), inOut(x), inOut(r), inOut(rounded)},
                          shared::VectorPush{kNodes, 0, iteration}, update.groupsOver(kNodes, 1, kLoads));

            const std::vector<double> sizes(x.size(), 2);
            EXPECT_TRUE(agree(x, xExpected, sizes, kFusedRounding));
            EXPECT_TRUE(agree(r, rExpected, sizes, kFusedRounding));
            for (std::size_t n = 0; n < r.size(); ++n)
                EXPECT_EQ(rounded[n], n / kNodes == 1 ? float(r[n]) : roundedBefore[n]) << "load " << n / kNodes;
        }
    });
}

TEST_F(CgTest, RepeatsAreEqualToTheBit)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        const compute::Kernel   dots(context(), kernels::stepDots<Real>(), {64, 1, 1});
        const compute::Kernel   step(context(), kernels::step<Real>(), {64, 1, 1});
        const std::vector<Real> p = vectors<Real>(61), q = vectors<Real>(62);
        const auto              run = [&] {
            std::vector<Real>          partials(std::size_t(kLoads) * 64), state = roughState<Real>(63);
            std::vector<std::uint32_t> arguments(6, 5);
            dispatchOnce(dots, {in(p), in(q), out(partials)}, shared::VectorPush{kNodes, 64, 0},
                                      dots.groupsOver(64, 1, kLoads));
            dispatchOnce(step, {in(partials), inOut(state), inOut(arguments)},
                                      shared::ScalarsPush{kLoads, 64, 0, 6, 1e-6F}, {1, 1, 1});
            return state;
        };

        const std::vector<Real> first = run();
        for (int n = 0; n < 5; ++n) EXPECT_EQ(first, run());
    });
}

} // namespace
} // namespace palp
