#include <algorithm>
#include <cmath>

#include "tests/plate/kernels/plate_shader_test.h"

// Tests of conjugate gradients in few dispatches, cg_aim.comp and cg_probe.comp, against the same sums in C++.

namespace palp {
namespace {

using namespace shared;

constexpr Rounding kSumRounding{1000,
                                "up to some hundred products that a driver may fuse with their sums, and divisions"};

class CgFusedTest : public PlateShaderTest {
protected:
    void SetUp() override
    {
        PlateShaderTest::SetUp();
        if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    }

    template <class Real>
    static std::vector<Real> roughState(std::uint32_t seed)
    {
        std::vector<Real> state = roughValues<Real>(kLoads * std::size_t(kStateWords), seed);
        for (Real& word : state) word = Real(0.5) + std::abs(word);
        return state;
    }

    template <class Real>
    static std::vector<double> ownSizes(const std::vector<Real>& values)
    {
        std::vector<double> sizes = magnitudes(values);
        for (double& size : sizes) size += 1;
        return sizes;
    }
};

TEST_F(CgFusedTest, AimingAddsByWorkgroupsAndTheLastOneMakesBeta)
{
    constexpr std::uint32_t kNodes = 997;
    inEachPrecision([](auto number) {
        using Real                 = decltype(number);
        const std::vector<Real>  r = roughValues<Real>(kLoads * kNodes, 61), x = roughValues<Real>(kLoads * kNodes, 62);
        const std::vector<float> z = roughValues<float>(kLoads * kNodes, 63),
                                 f = roughValues<float>(kLoads * kNodes, 64);
        for (const std::uint32_t width : {64U, 256U})
            for (const std::uint32_t groups : {1U, 5U})
                for (const std::uint32_t begins : {0U, 1U, 2U}) {
                    SCOPED_TRACE(std::to_string(groups) + " workgroups of " + std::to_string(width));
                    const compute::Kernel aim(context(), kernels::aim<Real>(), {width, 1, 1});
                    std::vector<Real>     sums; // as host::beta() takes them: for each load of (r, z), then of (f, x)
                    for (std::size_t load = 0; load < kLoads; ++load)
                        for (const bool ofLoad : {false, true})
                            for (std::size_t group = 0; group < groups; ++group) {
                                std::vector<Real> lanes(width);
                                for (std::size_t n = 0; n < kNodes; ++n) {
                                    const std::size_t lane = n % (groups * width), at = load * kNodes + n;
                                    if (lane / width != group) continue;
                                    lanes[lane % width] += ofLoad ? Real(f[at]) * x[at] : r[at] * Real(z[at]);
                                }
                                sums.push_back(host::total(lanes.data(), width, width));
                            }
                    std::vector<Real> state = roughState<Real>(65), expected = state,
                                      partials(2 * std::size_t(kLoads) * groups);
                    host::beta({kLoads, groups, begins, 0, 0}, sums, width, expected);
                    std::vector<std::uint32_t> tickets(kLoads + 2, 0);

                    dispatchOnce(aim, {in(r), in(z), in(x), in(f), out(partials), inOut(tickets), inOut(state)},
                                 AimPush{kNodes, begins}, {groups, 1, kLoads});

                    EXPECT_TRUE(agree(state, expected, std::vector<double>(state.size(), kNodes), kSumRounding));
                    EXPECT_EQ(tickets, std::vector<std::uint32_t>(kLoads + 2, 0)) << "ready for the next dispatch";
                }
    });
}

TEST_F(CgFusedTest, ProbingIsDirectionForcesAndAStepOfTheirProduct)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : {compute::Workgroup{8, 8, 1}, compute::Workgroup{32, 4, 1}}) {
            const compute::Kernel probe(context(), kernels::probe<Real>(), shape);
            for (const Plate& plate : plates())
                for (const float tolerance : {1e-9F, 1e9F}) { // no load is finished, or all are
                    SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                    const RoughLevel         level(plate);
                    const std::vector<float> z     = roughDeflection<float>(level.g, kLoads, 71);
                    const std::vector<Real>  last  = roughDeflection<Real>(level.g, kLoads, 72);
                    const std::size_t        nodes = nodesOf(level.g), stride = std::size_t(level.g.cellsZ) + 1;
                    std::vector<Real>        state = roughState<Real>(73), p(last.size());
                    state[kStateBeta]              = 0; // of the first load: its last direction is not looked at
                    for (std::size_t n = 0; n < p.size(); ++n) {
                        const Real beta = state[n / nodes * kStateWords + std::size_t(kStateBeta)];
                        p[n]            = beta == 0 ? Real(z[n]) : Real(z[n]) + beta * last[n];
                    }
                    const std::vector<Real> q      = host::applied(level.g, level.rigidity, p);
                    const compute::Groups   groups = groupsOver(probe, level.g, kLoads);
                    const std::size_t width = std::size_t(shape.x) * shape.y, count = std::size_t(groups.x) * groups.y;
                    std::vector<Real> lanes(kLoads * count * width), sums;
                    for (std::size_t n = 0; n < p.size(); ++n) {
                        const std::size_t i = n % nodes / stride, j = n % nodes % stride;
                        const std::size_t group = i / shape.y * groups.x + j / shape.x;
                        lanes[(n / nodes * count + group) * width + i % shape.y * shape.x + j % shape.x] = p[n] * q[n];
                    }
                    for (std::size_t n = 0; n < kLoads * count; ++n)
                        sums.push_back(host::total(lanes.data() + n * width, width, width));
                    std::vector<Real> expected = state;
                    const bool        finished =
                        host::step({kLoads, std::uint32_t(count), 0, 0, tolerance}, sums, width, expected);
                    EXPECT_EQ(finished, tolerance > 1);
                    std::vector<Real>          measuredP(p.size()), measuredQ(p.size()), partials(sums.size());
                    std::vector<std::uint32_t> tickets(kLoads + 2, 0), arguments(300, 5), wanted = arguments;
                    if (finished) std::fill(wanted.begin(), wanted.end() - 3, 0U);

                    dispatchOnce(probe,
                                 {in(level.rigidity), in(z), in(last), out(measuredP), out(measuredQ), out(partials),
                                  inOut(tickets), inOut(state), inOut(arguments)},
                                 ProbePush{level.g, kLoads, 297, tolerance}, groups);

                    EXPECT_TRUE(agree(measuredP, p, ownSizes(p), kFusedRounding));
                    EXPECT_TRUE(agree(measuredQ, q, operatorSizes(level, p), kOperatorRounding));
                    EXPECT_TRUE(agree(state, expected, ownSizes(expected), kSumRounding));
                    EXPECT_EQ(arguments, wanted) << "emptied only when every load is finished";
                    EXPECT_EQ(tickets, std::vector<std::uint32_t>(kLoads + 2, 0)) << "ready for the next dispatch";
                }
        }
    });
}

TEST_F(CgFusedTest, FinishingIsTheUpdateOfTheLastStepWhereverItsNumbersAre)
{
    constexpr std::uint32_t kNodes = 997;
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        const compute::Kernel   finish(context(), kernels::finish<Real>(), {64, 1, 1});
        const std::size_t       count = std::size_t(kLoads) * kNodes;
        const std::vector<Real> p[2]  = {roughValues<Real>(count, 51), roughValues<Real>(count, 52)},
                                q     = roughValues<Real>(count, 53);
        for (const int steps : {1, 2, 3, 4}) {
            SCOPED_TRACE(std::to_string(steps) + " steps");
            const bool        odd   = steps % 2 == 1;
            std::vector<Real> state = roughState<Real>(54), x = roughValues<Real>(count, 55),
                              r           = roughValues<Real>(count, 56);
            const std::vector<Real> other = roughValues<Real>(count, 57);
            for (int load = 0; load < kLoads; ++load)
                state[std::size_t(load * kStateWords + kStateSteps)] = Real(steps);
            std::vector<Real> wantedX = x, wantedR = odd ? r : other;
            for (std::size_t n = 0; n < count; ++n) {
                const Real alpha = state[n / kNodes * kStateWords + std::size_t(kStateAlpha)];
                wantedX[n] += alpha * p[odd ? 1 : 0][n];
                wantedR[n] -= alpha * q[n];
            }
            std::vector<float> rounded(count), wantedRounded(wantedR.begin(), wantedR.end());
            std::vector<Real>  first = p[0];
            dispatchOnce(finish,
                         {in(state), inOut(first), in(p[1]), in(q), inOut(x), inOut(r), in(other), out(rounded)},
                         VectorPush{kNodes, 0, 0}, finish.groupsOver(kNodes, 1, kLoads));
            EXPECT_EQ(first, p[odd ? 1 : 0]) << "the direction after which the next list begins";
            EXPECT_TRUE(agree(x, wantedX, ownSizes(wantedX), kFusedRounding));
            EXPECT_TRUE(agree(r, wantedR, ownSizes(wantedR), kFusedRounding));
            EXPECT_TRUE(agree(rounded, wantedRounded, ownSizes(wantedRounded), kFusedRounding));
        }
    });
}

/// One load of three that is not finished keeps the dispatches of all.
TEST_F(CgFusedTest, DispatchesGoOnWhileALoadIsNotFinished)
{
    const compute::Kernel    probe(context(), kernels::probe<float>(), {8, 8, 1});
    const RoughLevel         level(plates().front());
    const std::vector<float> last = roughDeflection<float>(level.g, kLoads, 81);
    for (int unfinished = 0; unfinished < kLoads; ++unfinished) {
        std::vector<float> z = roughDeflection<float>(level.g, kLoads, 82);
        std::vector<float> state(kLoads * std::size_t(kStateWords), 0.0F), p(z.size()), q(z.size());
        for (int load = 0; load < kLoads; ++load) {
            float* const at  = state.data() + load * kStateWords;
            at[kStateRz]     = load == unfinished ? 1.0F : 1e-12F; // the gain is its square over (p, A p)
            at[kStateEnergy] = 1;
        }
        const compute::Groups      groups = groupsOver(probe, level.g, kLoads);
        std::vector<float>         partials(std::size_t(groups.x) * groups.y * kLoads);
        std::vector<std::uint32_t> tickets(kLoads + 2, 0), arguments(10, 5);
        dispatchOnce(probe,
                     {in(level.rigidity), in(z), in(last), out(p), out(q), out(partials), inOut(tickets), inOut(state),
                      inOut(arguments)},
                     ProbePush{level.g, kLoads, 10, 1e-6F}, groups);
        EXPECT_GT(state[std::size_t(unfinished * kStateWords + kStateEstimate)], 1e-6F);
        EXPECT_EQ(arguments, std::vector<std::uint32_t>(10, 5)) << "load " << unfinished;
    }
}

} // namespace
} // namespace palp
