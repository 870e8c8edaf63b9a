#include "tests/support/shader_fixture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "tests/support/sanitized.h"

namespace palp {
namespace {

// A quiet NaN as float, and twice as double, that no arithmetic produces.
constexpr std::uint32_t kGuardWord  = 0x7ffadead;
constexpr std::size_t   kFrontBytes = 256;  // the largest offset alignment that Vulkan allows
constexpr std::size_t   kBackBytes  = 1024; // more than a row of the grids in these tests

std::string environment(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

compute::Validation wantedValidation()
{
    const std::string word = environment("PALPATE_VALIDATION");
    if (word.empty() || word == "off") return compute::Validation::off;
    if (word == "core") return compute::Validation::core;
    if (word == "synchronization") return compute::Validation::synchronization;
    if (word == "gpu") return compute::Validation::gpuAssisted;
    throw Error("PALPATE_VALIDATION is '" + word + "'; expected off, core, synchronization or gpu");
}

/// The processor of the process. GoogleTest closes it before the drivers' own statics are destroyed.
class DeviceEnvironment : public ::testing::Environment {
public:
    void TearDown() override
    {
        if (!context_) return;
        for (const std::string& message : context_->takeMessages()) ADD_FAILURE() << "validation, after: " << message;
        context_.reset();
    }
    compute::Context& context()
    {
        if (!context_) {
            compute::ContextSettings settings;
            settings.processor  = processorOfTests();
            settings.validation = wantedValidation();
            context_            = std::make_unique<compute::Context>(settings);
        }
        return *context_;
    }

private:
    std::unique_ptr<compute::Context> context_;
};

auto* const theDevice = static_cast<DeviceEnvironment*>(::testing::AddGlobalTestEnvironment(new DeviceEnvironment));

/// One array on the processor, between its guard bands.
class GuardedArray {
public:
    GuardedArray(compute::Context& context, const ShaderArray& array, std::size_t number)
        : array_(array), name_("array " + std::to_string(number)), all_(kFrontBytes + array.bytes + kBackBytes),
          up_(context, name_ + " up", all_, compute::Intent::upload),
          on_(context, name_, all_, compute::Intent::processor),
          down_(context, name_ + " down", all_, compute::Intent::readback)
    {
        std::ranges::fill(up_.as<std::uint32_t>(), kGuardWord);
        if (array.role != ShaderArray::Role::out)
            std::memcpy(static_cast<std::byte*>(up_.mapped()) + kFrontBytes, array.data, array.bytes);
    }

    void             recordUpload(compute::CommandList& list) const { list.copy(up_, on_); }
    void             recordDownload(compute::CommandList& list) const { list.copy(on_, down_); }
    compute::Binding binding() const { return {on_, kFrontBytes}; }

    /// Brings the array back and returns its faults.
    void collect(std::vector<std::string>& faults) const
    {
        down_.makeVisibleToHost();
        const std::span<const std::uint32_t> words = down_.as<const std::uint32_t>();
        const std::size_t                    front = kFrontBytes / 4, end = front + array_.bytes / 4;
        for (std::size_t n = 0; n < front; ++n)
            if (words[n] != kGuardWord)
                faults.push_back(name_ + ": word " + std::to_string(front - n) + " before its start was written");
        for (std::size_t n = end; n < words.size(); ++n)
            if (words[n] != kGuardWord)
                faults.push_back(name_ + ": word " + std::to_string(n - end) + " after its end was written");
        const std::byte* data = static_cast<const std::byte*>(down_.mapped()) + kFrontBytes;
        if (array_.role == ShaderArray::Role::in) {
            if (std::memcmp(data, array_.data, array_.bytes) != 0) faults.push_back(name_ + ": an input changed");
            return;
        }
        if (array_.role == ShaderArray::Role::out)
            if (const auto left = std::ranges::count(words.subspan(front, end - front), kGuardWord))
                faults.push_back(name_ + ": " + std::to_string(left) + " of " + std::to_string(end - front) +
                                 " words were never written");
        std::memcpy(array_.data, data, array_.bytes);
    }

private:
    ShaderArray     array_;
    std::string     name_;
    std::size_t     all_; // [byte]
    compute::Buffer up_, on_, down_;
};

/// Returns the place of a number on the line of all floating-point numbers, one step per representable number.
template <class T>
auto placeOf(T value)
{
    using Bits      = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    const auto bits = std::bit_cast<Bits>(value);
    return std::int64_t(bits < 0 ? std::numeric_limits<Bits>::min() - bits : bits);
}

template <class T>
bool fits(T measured, T expected, int ulps)
{
    if (std::memcmp(&measured, &expected, sizeof(T)) == 0) return true;
    if (ulps == 0 || !std::isfinite(measured) || !std::isfinite(expected)) return false;
    if (std::signbit(measured) != std::signbit(expected)) return measured == expected; // zeroes
    return std::abs(placeOf(measured) - placeOf(expected)) <= ulps;
}

template <class T>
::testing::AssertionResult compare(const std::vector<T>& measured, const std::vector<T>& expected, int ulps,
                                   const char* because)
{
    if (measured.size() != expected.size())
        return ::testing::AssertionFailure() << measured.size() << " values, expected " << expected.size();
    std::size_t wrong = 0, first = 0;
    for (std::size_t n = measured.size(); n-- > 0;)
        if (!fits(measured[n], expected[n], ulps)) {
            ++wrong;
            first = n;
        }
    if (!wrong) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << wrong << " of " << measured.size() << " values differ, the first at "
                                         << first << ": measured " << measured[first] << ", expected "
                                         << expected[first] << ", allowed " << ulps << " ulp, because " << because;
}

} // namespace

bool compilesSlowly(const compute::Context& context)
{
    return context.processor().kind == compute::ProcessorKind::software && !context.bitExact();
}

std::string processorOfTests()
{
    const std::string wanted = environment("PALPATE_SOLVER");
    return wanted.empty() ? std::string(compute::kLavapipeProcessor) : wanted;
}

std::vector<std::string> dispatchGuarded(compute::Context& context, const compute::Kernel& kernel,
                                         const std::vector<ShaderArray>& arrays, const compute::Push& push,
                                         compute::Groups groups)
{
    std::vector<GuardedArray>     guarded;
    std::vector<compute::Binding> bindings;
    guarded.reserve(arrays.size()); // bindings point into it
    for (const ShaderArray& array : arrays)
        bindings.push_back(guarded.emplace_back(context, array, guarded.size()).binding());

    compute::CommandList list(context);
    for (const GuardedArray& array : guarded) array.recordUpload(list);
    list.dispatch(kernel, bindings, push, groups);
    for (const GuardedArray& array : guarded) array.recordDownload(list);
    list.end();
    context.run(list);

    std::vector<std::string> faults;
    for (const GuardedArray& array : guarded) array.collect(faults);
    return faults;
}

compute::Context& ShaderTest::context()
{
    return theDevice->context();
}

compute::Validation ShaderTest::validation()
{
    return wantedValidation();
}

bool ShaderTest::watched()
{
    return validation() != compute::Validation::off || (kSanitized && !onHost());
}

std::vector<std::uint32_t> ShaderTest::sides()
{
    if (validation() == compute::Validation::gpuAssisted) return {7, 13};
    return {7, 13, 33, 65};
}

void ShaderTest::SetUp()
{
    for (const std::string& message : context().takeMessages()) ADD_FAILURE() << "validation, before: " << message;
}

void ShaderTest::TearDown()
{
    for (const std::string& message : context().takeMessages()) ADD_FAILURE() << "validation: " << message;
}

void ShaderTest::dispatchOnce(const compute::Kernel& kernel, std::initializer_list<ShaderArray> arrays,
                              const compute::Push& push, compute::Groups groups)
{
    for (const std::string& fault : dispatchGuarded(context(), kernel, arrays, push, groups))
        ADD_FAILURE() << kernel.code().name << ": " << fault;
}

::testing::AssertionResult ShaderTest::agree(const std::vector<float>& measured, const std::vector<float>& expected,
                                             UlpTolerance tolerance)
{
    if (context().bitExact()) return compare(measured, expected, 0, "this processor computes as C++ does");
    return compare(measured, expected, tolerance.ulps, tolerance.because);
}

::testing::AssertionResult ShaderTest::agree(const std::vector<double>& measured, const std::vector<double>& expected,
                                             UlpTolerance tolerance)
{
    if (context().bitExact()) return compare(measured, expected, 0, "this processor computes as C++ does");
    return compare(measured, expected, tolerance.ulps, tolerance.because);
}

} // namespace palp
