#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "engine/compute/context.h"
#include "engine/plate/host/kernel_codes.h"
#include "tests/plate/kernels/host_passes.h"
#include "tests/support/shader_fixture.h"

namespace palp {

/// How far a processor that fuses or re-associates may be from C++, relative to the magnitudes that were added up:
/// where terms cancel, units in the last place of the result say nothing.
struct Rounding {
    double      units;   ///< of half the spacing of floating-point numbers at 1
    const char* because; ///< printed on failure
};

inline constexpr Rounding kOperatorRounding{64,
                                            "some 60 sums and products of 13 deflections, of which a driver may fuse "
                                            "or reorder any"};
inline constexpr Rounding kTransferRounding{16, "16 or 64 products in nested sums of 4 or 8, most with small weights"};
inline constexpr Rounding kFusedRounding{3, "one product and one sum, which a driver may fuse"};

inline std::string describe(const LevelPair& pair)
{
    return std::to_string(pair.fine.cellsX) + "x" + std::to_string(pair.fine.cellsZ) + " to " +
           std::to_string(pair.coarse.cellsX) + "x" + std::to_string(pair.coarse.cellsZ) + " cells";
}

inline std::string describe(compute::Workgroup shape)
{
    return "workgroups of " + std::to_string(shape.x) + "x" + std::to_string(shape.y);
}

/// A test of one of the plate's kernels.
class PlateShaderTest : public ShaderTest {
protected:
    static constexpr int kLoads = 3; ///< at once [1]

    /// Where every access is checked a kernel takes ten times as long to compile: one shape, two small plates.
    static bool isSlow() { return validation() == compute::Validation::gpuAssisted; }

    /// Workgroups over the nodes of a grid.
    static std::vector<compute::Workgroup> tiles()
    {
        if (isSlow()) return {{8, 8, 1}};
        return {{8, 8, 1}, {64, 1, 1}, {16, 4, 1}};
    }

    /// Workgroups over nodes one after the other, and of serial kernels.
    static std::vector<compute::Workgroup> lines()
    {
        if (isSlow()) return {{64, 1, 1}};
        return {{8, 1, 1}, {64, 1, 1}, {128, 1, 1}};
    }

    /// Odd sizes, every kind of edge beside every other, spacings that differ, foundations that vary and that do not.
    static std::vector<Plate> plates()
    {
        using enum Edge;
        std::vector<Plate> all{roughPlate(9, 12, {clamped, clamped, clamped, clamped}),
                               onRoughBed(roughPlate(17, 13, {supported, free, clamped, supported}, 1, 1.3))};
        if (isSlow()) return all;
        all.push_back(onRoughBed(roughPlate(33, 10, {free, clamped, free, free})));
        all.push_back(roughPlate(10, 18, {free, free, supported, clamped}, 0.7, 1));
        all.push_back(onRoughBed(roughPlate(4, 5, {supported, supported, supported, supported})));
        return all;
    }

    /// Grids and coarser ones: by about half along both axes, along one, and by less.
    static std::vector<LevelPair> pairs()
    {
        std::vector<LevelPair>   all;
        const std::vector<Plate> of = plates();
        all.emplace_back(of[0], 5, 6);
        all.emplace_back(of[1], 9, 13);
        if (isSlow()) return all;
        all.emplace_back(of[1], 9, 7);
        all.emplace_back(of[2], 17, 5);
        all.emplace_back(of[3], 10, 9);
        all.emplace_back(of[3], 7, 11);
        return all;
    }

    static compute::Groups groupsOver(const compute::Kernel& kernel, const shared::PlateLevel& g, int loads)
    {
        return kernel.groupsOver(std::uint32_t(g.cellsZ + 1), std::uint32_t(g.cellsX + 1), std::uint32_t(loads));
    }

    /// dispatchOnce(), and again from the same contents: the answers must be equal to the bit.
    static void dispatchTwice(const compute::Kernel& kernel, std::initializer_list<ShaderArray> arrays,
                              const compute::Push& push, compute::Groups groups)
    {
        const auto contents = [&] {
            std::vector<std::vector<std::byte>> all;
            for (const ShaderArray& array : arrays) all.emplace_back(array.data, array.data + array.bytes);
            return all;
        };
        const auto before = contents();
        dispatchOnce(kernel, arrays, push, groups);
        const auto  first  = contents();
        std::size_t number = 0;
        for (const ShaderArray& array : arrays) {
            if (array.role == ShaderArray::Role::inOut) std::ranges::copy(before[number], array.data);
            ++number;
        }
        dispatchOnce(kernel, arrays, push, groups);
        EXPECT_EQ(first, contents()) << kernel.code().name << ": a repeat differs";
    }

    /// Calls check(0.0F), and check(0.0) where the processor has doubles; the argument's type is what matters.
    template <class Check>
    static void inEachPrecision(const Check& check)
    {
        {
            SCOPED_TRACE("in floats");
            check(0.0F);
        }
        if (!context().processor().float64) return;
        SCOPED_TRACE("in doubles");
        check(0.0);
    }

    /// Checks that a kernel computed what C++ does: to the bit where the processor is bitExact(), else within the
    /// rounding. The sign of a zero does not count: drivers omit the addition of 0, which turns -0 into 0.
    /// \param sizes  for each number the magnitudes that were added up to it, at least its own
    template <class Real>
    static ::testing::AssertionResult agree(const std::vector<Real>& measured, const std::vector<Real>& expected,
                                            const std::vector<double>& sizes, Rounding rounding)
    {
        if (context().bitExact())
            return ShaderTest::agree(withoutSignOfZero(measured), withoutSignOfZero(expected), {0, ""});
        return isWithin(measured, expected, sizes, rounding);
    }
    using ShaderTest::agree;

    template <class Real>
    static std::vector<Real> withoutSignOfZero(std::vector<Real> values)
    {
        for (Real& value : values)
            if (value == 0) value = 0;
        return values;
    }

    template <class Real>
    static ::testing::AssertionResult isWithin(const std::vector<Real>& measured, const std::vector<Real>& expected,
                                               const std::vector<double>& sizes, Rounding rounding)
    {
        constexpr double kUnit = std::numeric_limits<Real>::epsilon() / 2;
        if (measured.size() != expected.size()) return ::testing::AssertionFailure() << "sizes differ";
        for (std::size_t n = 0; n < measured.size(); ++n) {
            const double allowed = rounding.units * kUnit * sizes[n];
            if (std::abs(double(measured[n]) - double(expected[n])) <= allowed) continue;
            return ::testing::AssertionFailure()
                   << "value " << n << ": measured " << measured[n] << ", expected " << expected[n] << ", allowed "
                   << allowed << ", because " << rounding.because;
        }
        return ::testing::AssertionSuccess();
    }

    /// For each force of A w the sum of |entry| |deflection|, and of |force| if there is one.
    template <class Real>
    static std::vector<double> operatorSizes(const RoughLevel& level, const std::vector<Real>& w)
    {
        const shared::PlateLevel& g = level.g;
        host::Row                 row{level.rigidity.data(), g.cellsZ + 1, g.shapeAt};
        std::vector<double>       sizes(w.size());
        host::forEachNode(g, w.size() / nodesOf(g), [&](int i, int j, std::size_t n, std::size_t node) {
            for (int a = std::max(0, i - 2); a <= std::min(g.cellsX, i + 2); ++a)
                for (int b = std::max(0, j - 2); b <= std::min(g.cellsZ, j + 2); ++b) {
                    row.unitI = a;
                    row.unitJ = b;
                    sizes[n] += std::abs(double(row.operatorAt(g, i, j)) *
                                         double(w[n - node + std::size_t(a * (g.cellsZ + 1) + b)]));
                }
        });
        return sizes;
    }

    template <class Real>
    static std::vector<double> magnitudes(const std::vector<Real>& values)
    {
        std::vector<double> sizes;
        for (const Real value : values) sizes.push_back(std::abs(double(value)));
        return sizes;
    }
};

} // namespace palp
