#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/compute/command_list.h"

namespace palp {

/// An array that a kernel of a test reads or writes, by in(), out() or inOut().
struct ShaderArray {
    enum class Role { in, out, inOut };

    Role        role;
    std::byte*  data; ///< of the test's vector, which must live until the dispatch has returned
    std::size_t bytes;
};

/// The kernel only reads it: it must come back unchanged.
template <class T>
[[nodiscard]] ShaderArray in(const std::vector<T>& values)
{
    auto* data = const_cast<T*>(values.data()); // never written
    return {ShaderArray::Role::in, reinterpret_cast<std::byte*>(data), values.size() * sizeof(T)};
}

/// The kernel writes all of it: it starts as NaN, whatever the vector holds, and no word may be left over.
template <class T>
[[nodiscard]] ShaderArray out(std::vector<T>& values)
{
    return {ShaderArray::Role::out, reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(T)};
}

/// The kernel reads and writes, all or some of it.
template <class T>
[[nodiscard]] ShaderArray inOut(std::vector<T>& values)
{
    return {ShaderArray::Role::inOut, reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(T)};
}

/// Runs a kernel once, array n at binding n, each between guard bands of NaN, and brings the arrays back.
///
/// What lies behind an array is bound with it: drivers would drop a write beyond the binding without a word. Hence
/// length() in the shader tells too much, and an index below 0 is found by GPU-assisted validation only.
/// \return one sentence per fault: a guard band was written, an input changed, an output was left unwritten
[[nodiscard]] std::vector<std::string> dispatchGuarded(compute::Context& context, const compute::Kernel& kernel,
                                                       const std::vector<ShaderArray>& arrays,
                                                       const compute::Push& push, compute::Groups groups);

/// How far results may be from C++ on devices that fuse or re-associate.
struct UlpTolerance {
    int         ulps;    ///< units in the last place of the expected value
    const char* because; ///< printed on failure
};

/// What PALPATE_SOLVER names; lavapipe if it is not set. Never what "auto" takes by itself: that may be the host, which
/// runs no shader.
[[nodiscard]] std::string deviceOfTests();

/// A test of one shader. The device is opened once per process; any message of the validation layer fails the test.
///
/// Environment: PALPATE_SOLVER, see deviceOfTests() and compute::chooseProcessor(); PALPATE_VALIDATION off, core,
/// synchronization or gpu.
class ShaderTest : public ::testing::Test {
protected:
    /// Of the process; it is closed after the last test.
    static compute::Context& context();

    /// Whether the device is the host, which has functions for the plate's kernels only.
    static bool onHost() { return context().processor().kind == compute::kHostProcessor; }

    /// What PALPATE_VALIDATION asks for.
    static compute::Validation validation();

    /// Sides of grids, none a multiple of a workgroup; only small ones where every access is checked.
    static std::vector<std::uint32_t> sides();

    void SetUp() override;
    void TearDown() override;

    /// dispatchGuarded(), where each fault fails the test.
    static void dispatchOnce(const compute::Kernel& kernel, std::initializer_list<ShaderArray> arrays,
                             const compute::Push& push, compute::Groups groups);

    /// Whether a kernel computed what C++ does: to the bit where the device is bitExact(), else within the tolerance.
    static ::testing::AssertionResult agree(const std::vector<float>& measured, const std::vector<float>& expected,
                                            UlpTolerance tolerance);
    static ::testing::AssertionResult agree(const std::vector<double>& measured, const std::vector<double>& expected,
                                            UlpTolerance tolerance);
};

} // namespace palp
