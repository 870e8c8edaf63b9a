#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

namespace palp {

/// An error of what lies outside the program: a file, an option, a device. The message is one sentence for the user: it
/// names the subject, the place (file, line or byte), what was expected, what was found and what to try. The programs
/// print it and exit with 2. It is one line whatever the names and words in it: see shownText().
class Error : public std::runtime_error {
public:
    explicit Error(std::string_view sentence);
};

/// A broken precondition: a mistake in the calling code, never in the user's data.
class ContractViolation : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

namespace detail {
[[noreturn]] inline void contractBroken(const char* condition, const char* file, int line, const std::string& why)
{
    throw ContractViolation(std::string(file) + ":" + std::to_string(line) + ": expected " + condition + ": " + why);
}
} // namespace detail
} // namespace palp

/// Checks a precondition in every build; `why` is a string that names the values found.
#define PALP_EXPECT(condition, why)                                                                                    \
    ((condition) ? void() : ::palp::detail::contractBroken(#condition, __FILE__, __LINE__, (why)))
