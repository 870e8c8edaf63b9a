#include "compute_shaders/shared/plate_push.h"

#include <bit>
#include <cstdint>
#include <vector>

#include "compute_shaders/shared/rigidity_level.h"
#include "compute_shaders/shared/tail_level.h"
#include "tests/plate/kernels/push_echo_aim.spv.h"
#include "tests/plate/kernels/push_echo_level.spv.h"
#include "tests/plate/kernels/push_echo_nested.spv.h"
#include "tests/plate/kernels/push_echo_probe.spv.h"
#include "tests/plate/kernels/push_echo_relax.spv.h"
#include "tests/plate/kernels/push_echo_rigidity.spv.h"
#include "tests/plate/kernels/push_echo_scalars.spv.h"
#include "tests/plate/kernels/push_echo_smooth.spv.h"
#include "tests/plate/kernels/push_echo_sweep.spv.h"
#include "tests/plate/kernels/push_echo_tail.spv.h"
#include "tests/plate/kernels/push_echo_transfer.spv.h"
#include "tests/plate/kernels/push_echo_up.spv.h"
#include "tests/plate/kernels/push_echo_vector.spv.h"
#include "tests/support/shader_fixture.h"

namespace palp {
namespace {

using namespace shared;

constexpr std::size_t kMostPushBytes = 128; ///< that every processor allows
static_assert(sizeof(PlateLevel) == 48);
static_assert(sizeof(LevelPush) == 48 && sizeof(LevelPush) <= kMostPushBytes);
static_assert(sizeof(RelaxPush) == 52 && sizeof(RelaxPush) <= kMostPushBytes);
static_assert(sizeof(SweepPush) == 56 && sizeof(SweepPush) <= kMostPushBytes);
static_assert(sizeof(SmoothPush) == 56 && sizeof(SmoothPush) <= kMostPushBytes);
static_assert(sizeof(TransferPush) == 96 && sizeof(TransferPush) <= kMostPushBytes);
static_assert(sizeof(UpPush) == 100 && sizeof(UpPush) <= kMostPushBytes);
static_assert(sizeof(NestedPush) == 16 && sizeof(NestedPush) <= kMostPushBytes);
static_assert(sizeof(VectorPush) == 12 && sizeof(VectorPush) <= kMostPushBytes);
static_assert(sizeof(AimPush) == 8 && sizeof(AimPush) <= kMostPushBytes);
static_assert(sizeof(ProbePush) == 60 && sizeof(ProbePush) <= kMostPushBytes);
static_assert(sizeof(ScalarsPush) == 20 && sizeof(ScalarsPush) <= kMostPushBytes);

/// Bits of the fields, in the order in which the shader echoes them.
class Words : public std::vector<std::uint32_t> {
public:
    template <class... Fields>
    explicit Words(Fields... fields)
    {
        (add(fields), ...);
    }

private:
    void add(float value) { push_back(std::bit_cast<std::uint32_t>(value)); }
    void add(std::uint32_t value) { push_back(value); }
    void add(int value) { push_back(std::uint32_t(value)); }
    void add(const PlateLevel& g)
    {
        for (const std::uint32_t word :
             Words(g.cellsX, g.cellsZ, g.hinged, g.free, g.kxx, g.kzz, g.kxz, g.exx, g.ezz, g.twist, g.bed, g.shapeAt))
            push_back(word);
    }
};

class PlatePushTest : public ShaderTest {
protected:
    template <class Constants, std::size_t N>
    static std::vector<std::uint32_t> echoed(const std::uint32_t (&spirv)[N], const Constants& push)
    {
        const compute::Kernel      echo(context(), {"push_echo", spirv, 1, int(sizeof(Constants))}, {8, 8, 1});
        std::vector<std::uint32_t> words(sizeof(Constants) / 4);
        dispatchOnce(echo, {out(words)}, push, {1, 1, 1});
        return words;
    }

    static constexpr PlateLevel kFine{33, -17, 5U, 10U, 1.5F, -2.5F, 3.25F, 4.125F, 5.5F, -6.5F, 7e-9F, 612};
    static constexpr PlateLevel kCoarse{16, 9, 11U, 6U, -0.5F, 8.5F, 0.25F, 1e30F, 2.25F, 3.5F, -4.5F, -3};
};

TEST_F(PlatePushTest, EveryFieldArrivesInItsPlace)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    const LevelPush    level{kFine};
    const RelaxPush    relax{kFine, 1U};
    const SmoothPush   smooth{kFine, 0.375F, 0.625F};
    const TransferPush transfer{kFine, kCoarse};
    const VectorPush   vector{1000U, 64U, 7U};
    const ScalarsPush  scalars{3U, 64U, 2U, 768U, 1e-6F};

    const SweepPush sweep{kFine, 1U, 7U};
    EXPECT_EQ(echoed(push_echo_sweep_spv, sweep), Words(sweep.level, sweep.first, sweep.tilesOnly));
    const UpPush    up{kFine, kCoarse, 2U};
    const AimPush   aim{1000U, 2U};
    const ProbePush probe{kFine, 3U, 768U, 1e-6F};
    EXPECT_EQ(echoed(push_echo_up_spv, up), Words(up.fine, up.coarse, up.begins));
    const NestedPush nested{1U, 3U, 5603U, 2U};
    EXPECT_EQ(echoed(push_echo_nested_spv, nested), Words(nested.first, nested.levels, nested.nodes, nested.steps));
    EXPECT_EQ(echoed(push_echo_aim_spv, aim), Words(aim.nodes, aim.begins));
    EXPECT_EQ(echoed(push_echo_probe_spv, probe),
              Words(probe.level, probe.loads, probe.argumentWords, probe.tolerance));
    EXPECT_EQ(echoed(push_echo_level_spv, level), Words(level.level));
    EXPECT_EQ(echoed(push_echo_relax_spv, relax), Words(relax.level, relax.colour));
    EXPECT_EQ(echoed(push_echo_smooth_spv, smooth), Words(smooth.level, smooth.ahead, smooth.step));
    EXPECT_EQ(echoed(push_echo_transfer_spv, transfer), Words(transfer.fine, transfer.coarse));
    EXPECT_EQ(echoed(push_echo_vector_spv, vector), Words(vector.nodes, vector.partials, vector.iteration));
    EXPECT_EQ(echoed(push_echo_scalars_spv, scalars),
              Words(scalars.loads, scalars.partials, scalars.begins, scalars.argumentWords, scalars.tolerance));
}

TEST_F(PlatePushTest, EveryFieldOfAnArrayArrivesInItsPlace)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    const TailPush               tail{1U, 3U, 5603U};
    const std::vector<TailLevel> levels{{}, {kCoarse, 11, -12, 13, 14, -15}};
    std::vector<std::uint32_t>   words((sizeof(TailPush) + sizeof(TailLevel)) / 4);
    const compute::Kernel        echoTail(context(), {"push_echo_tail", push_echo_tail_spv, 2, int(sizeof(TailPush))},
                                          {8, 8, 1});
    dispatchOnce(echoTail, {out(words), in(levels)}, tail, {1, 1, 1});
    const TailLevel& level = levels[1];
    EXPECT_EQ(words, Words(tail.first, tail.levels, tail.nodes, level.plate, level.field, level.tableX, level.tableZ,
                           level.w, level.force));
}

TEST_F(PlatePushTest, EveryFieldOfTheLevelsThatArePreparedTogetherArrives)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    const RigidityPush               push{3U, 117U};
    const std::vector<RigidityLevel> levels{{}, {kCoarse, 11, -12, 13, -14}};
    std::vector<std::uint32_t>       words((sizeof(RigidityPush) + sizeof(RigidityLevel)) / 4);
    const compute::Kernel            echoed(
                   context(), {"push_echo_rigidity", push_echo_rigidity_spv, 2, int(sizeof(RigidityPush))}, {8, 8, 1});
    dispatchOnce(echoed, {out(words), in(levels)}, push, {1, 1, 1});
    const RigidityLevel& level = levels[1];
    EXPECT_EQ(words, Words(push.levels, push.rows, level.plate, level.field, level.list, level.row, level.tileRow));
}

} // namespace
} // namespace palp
