#include "engine/cloud/material.h"

#include <algorithm>
#include <cmath>
#include <array>
#include <charconv>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

constexpr double kMostShares = 0.99, kLeastTime = 1e-3, kMostTime = 1e4; // [1], [s]

std::string shortest(double value)
{
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

} // namespace

Relaxation parseRelaxation(std::string_view text, std::string_view what)
{
    const auto refuse = [&](const std::string& why) {
        throw Error(std::string(what) + ": expected " + std::string(kRelaxationForm) + ", found \"" +
                    std::string(text) + "\"" + why);
    };
    Relaxation relaxation;
    if (text == "none") return relaxation;
    for (std::string_view rest = text;;) {
        const std::size_t      comma = rest.find(',');
        const std::string_view term  = rest.substr(0, comma);
        const std::size_t      at    = term.find('@');
        if (at == std::string_view::npos) refuse("");
        if (relaxation.count == Relaxation::kMostTerms) refuse(", which has more terms");
        const double share = parseQuantity(term.substr(0, at), Dimension::none, what);
        const double time  = parseQuantity(term.substr(at + 1), Dimension::time, what);
        if (!(share > 0)) refuse(", where a share is not above 0");
        if (!(time >= kLeastTime && time <= kMostTime)) refuse(", where a time is not from 1e-3 to 1e4 s");
        relaxation.terms[relaxation.count++] = {share, time};
        if (comma == std::string_view::npos) break;
        rest.remove_prefix(comma + 1);
    }
    if (relaxation.shares() > kMostShares) refuse(", whose shares are more than 0.99 together");
    return relaxation;
}

std::string relaxationText(const Relaxation& relaxation)
{
    std::string text;
    for (std::size_t n = 0; n < relaxation.count; ++n)
        text +=
            (n == 0 ? "" : ",") + shortest(relaxation.terms[n].share) + "@" + shortest(relaxation.terms[n].time) + "s";
    return text.empty() ? "none" : text;
}

namespace {
constexpr double kGrowthDepth = 1e-4; ///< [m]
}

double growthOf(double stiffening) noexcept
{
    return std::exp(stiffening * kGrowthDepth);
}

double stiffeningOf(double growth) noexcept
{
    return std::clamp(std::log(growth) / kGrowthDepth, 0.0, kMostStiffening);
}

} // namespace palp
