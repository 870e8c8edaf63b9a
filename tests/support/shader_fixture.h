#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/compute/command_list.h"

namespace palp {

/// An array that a kernel of a test reads or writes, made by in(), out() or inOut().
struct ShaderArray {
    enum class Role { in, out, inOut };

    Role        role;
    std::byte*  data; ///< of the test's vector, which must live until the dispatch has returned
    std::size_t bytes;
};

/// Makes an array that the kernel only reads: it must come back unchanged.
template <class T>
[[nodiscard]] ShaderArray in(const std::vector<T>& values)
{
    auto* data = const_cast<T*>(values.data()); // never written
    return {ShaderArray::Role::in, reinterpret_cast<std::byte*>(data), values.size() * sizeof(T)};
}

/// Makes an array that the kernel writes completely: it starts as NaN, not as the vector's contents, and every word
/// must be overwritten.
template <class T>
[[nodiscard]] ShaderArray out(std::vector<T>& values)
{
    return {ShaderArray::Role::out, reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(T)};
}

/// Makes an array that the kernel reads and writes, all or part of it.
template <class T>
[[nodiscard]] ShaderArray inOut(std::vector<T>& values)
{
    return {ShaderArray::Role::inOut, reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(T)};
}

/// Runs a kernel once, array n at binding n, each between guard bands of NaN, and brings the arrays back.
///
/// The bytes behind an array are bound with it, because drivers drop a write beyond the binding silently. Hence
/// length() in the shader is too large, and an index below 0 is found by GPU-assisted validation only.
/// \return one sentence per fault: a guard band was written, an input changed, an output was left unwritten
[[nodiscard]] std::vector<std::string> dispatchGuarded(compute::Context& context, const compute::Kernel& kernel,
                                                       const std::vector<ShaderArray>& arrays,
                                                       const compute::Push& push, compute::Groups groups);

/// The largest difference from C++ on processors that fuse or re-associate.
struct UlpTolerance {
    int         ulps;    ///< units in the last place of the expected value
    const char* because; ///< printed on failure
};

/// Returns the processor that PALPATE_SOLVER names; lavapipe if it is not set. It is never the choice of "auto", which
/// may be the host, which runs no shader.
[[nodiscard]] std::string processorOfTests();

/// Returns whether a driver in software other than lavapipe compiles a kernel with loops around the plate's operator
/// for 10 to 90 s, as SwiftShader does, instead of a fraction of a second.
[[nodiscard]] bool compilesSlowly(const compute::Context& context);

/// Why a test of such kernels is skipped there.
inline constexpr const char* kCompilesSlowly =
    "fused passes are never chosen in software, and this driver compiles their kernels for minutes";

/// A test of one shader. The processor is opened once per process; any message of the validation layer fails the test.
///
/// Environment: PALPATE_SOLVER, see processorOfTests() and compute::chooseProcessor(); PALPATE_VALIDATION off, core,
/// synchronization or gpu.
class ShaderTest : public ::testing::Test {
protected:
    /// Returns the context of the process; it is closed after the last test.
    static compute::Context& context();

    /// Returns true if the processor is the host, which has functions for the plate's kernels only.
    static bool onHost() { return context().processor().kind == compute::ProcessorKind::host; }

    /// Returns the validation that PALPATE_VALIDATION names.
    static compute::Validation validation();

    /// Whether validation layers or a sanitizer watch a driver's calls and memory, which take ten times as long then:
    /// few plates stand for many, for what is watched is the same for each.
    static bool watched();

    /// Returns sides of grids, none a multiple of a workgroup; only small ones where every access is checked.
    static std::vector<std::uint32_t> sides();

    void SetUp() override;
    void TearDown() override;

    /// Runs dispatchGuarded() and fails the test for each fault.
    static void dispatchOnce(const compute::Kernel& kernel, std::initializer_list<ShaderArray> arrays,
                             const compute::Push& push, compute::Groups groups);

    /// Tests that a kernel computed the same as C++: to the bit where the processor is bitExact(), else within the
    /// tolerance.
    static ::testing::AssertionResult agree(const std::vector<float>& measured, const std::vector<float>& expected,
                                            UlpTolerance tolerance);
    static ::testing::AssertionResult agree(const std::vector<double>& measured, const std::vector<double>& expected,
                                            UlpTolerance tolerance);
};

} // namespace palp
