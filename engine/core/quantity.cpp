#include "engine/core/quantity.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <span>

#include "engine/core/contract.h"
#include "engine/core/shown_text.h"

namespace palp {
namespace {

struct Unit {
    std::string_view name;
    double           inSi; ///< SI units in one of these
};

constexpr std::array kLengths     = {Unit{"m", 1},    Unit{"mm", 1e-3},   Unit{"cm", 1e-2},  Unit{"um", 1e-6},
                                     Unit{"km", 1e3}, Unit{"in", 0.0254}, Unit{"ft", 0.3048}};
constexpr std::array kForces      = {Unit{"N", 1}, Unit{"mN", 1e-3}, Unit{"kN", 1e3}};
constexpr std::array kPressures   = {Unit{"Pa", 1}, Unit{"kPa", 1e3}, Unit{"MPa", 1e6}, Unit{"GPa", 1e9}};
constexpr std::array kRigidities  = {Unit{"N_m", 1}, Unit{"Nm", 1}, Unit{"N*m", 1}, Unit{"mN_m", 1e-3},
                                     Unit{"mNm", 1e-3}};
constexpr std::array kFoundations = {Unit{"Pa/m", 1}, Unit{"kPa/m", 1e3}, Unit{"MPa/m", 1e6}, Unit{"GPa/m", 1e9}};
constexpr std::array kStiffnesses = {Unit{"N/m", 1}, Unit{"kN/m", 1e3}, Unit{"N/mm", 1e3}, Unit{"N/cm", 1e2}};
constexpr std::array kTimes       = {Unit{"s", 1}, Unit{"ms", 1e-3}};
constexpr std::array kSpeeds      = {Unit{"m/s", 1}, Unit{"mm/s", 1e-3}, Unit{"cm/s", 1e-2}};
constexpr std::array kMasses      = {Unit{"kg", 1}, Unit{"g", 1e-3}};
constexpr std::array kPerLengths  = {Unit{"1/m", 1}, Unit{"/m", 1}, Unit{"1/mm", 1e3}, Unit{"/mm", 1e3}};
constexpr std::array kAngles      = {Unit{"rad", 1}, Unit{"deg", std::numbers::pi / 180}};

std::span<const Unit> unitsOf(Dimension dimension)
{
    switch (dimension) {
    case Dimension::length:
        return kLengths;
    case Dimension::force:
        return kForces;
    case Dimension::pressure:
        return kPressures;
    case Dimension::rigidity:
        return kRigidities;
    case Dimension::foundation:
        return kFoundations;
    case Dimension::stiffness:
        return kStiffnesses;
    case Dimension::angle:
        return kAngles;
    case Dimension::time:
        return kTimes;
    case Dimension::speed:
        return kSpeeds;
    case Dimension::mass:
        return kMasses;
    case Dimension::perLength:
        return kPerLengths;
    case Dimension::none:
        return {};
    }
    return {};
}

std::string listed(std::span<const Unit> units)
{
    std::string text;
    for (const Unit& unit : units) text += (text.empty() ? "" : ", ") + std::string(unit.name);
    return text.empty() ? "none: a plain number" : text;
}

std::string_view trimmed(std::string_view text) noexcept
{
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

struct NumberAndUnit {
    double           number;
    std::string_view unit;
};

NumberAndUnit split(std::string_view text, std::string_view what)
{
    const std::string_view body  = trimmed(text);
    const char*            begin = body.data() + (body.starts_with('+') && !body.starts_with("+-") ? 1 : 0);
    double                 number{};
    const auto [end, error] = std::from_chars(begin, body.data() + body.size(), number);
    if (error != std::errc() || !std::isfinite(number))
        throw Error(std::string(what) + ": expected a finite number, found " + inQuotes(text));
    return {number, trimmed(body.substr(std::size_t(end - body.data())))};
}

} // namespace

std::string unitInAscii(std::string_view unit)
{
    for (const std::string_view micro : {"\u00b5", "\u03bc"})
        if (unit.starts_with(micro)) return "u" + std::string(unit.substr(micro.size()));
    return std::string(unit);
}

double parseQuantity(std::string_view text, Dimension dimension, std::string_view what, double siPerPlainNumber)
{
    const auto [number, unit] = split(text, what);
    const auto inSi           = [&, number = number](double one) {
        if (!std::isfinite(number * one))
            throw Error(std::string(what) + ": expected a finite number, found " + inQuotes(text));
        return number * one;
    };
    if (unit.empty()) return inSi(siPerPlainNumber);
    for (const Unit& known : unitsOf(dimension))
        if (known.name == unitInAscii(unit)) return inSi(known.inSi);
    throw Error(std::string(what) + ": unknown unit " + inQuotes(unit) + " in " + inQuotes(text) +
                "; known units: " + listed(unitsOf(dimension)));
}

ColumnHead columnHead(std::string_view cell) noexcept
{
    const std::size_t      open  = std::min(cell.find_first_of("[("), cell.size());
    const std::size_t      close = cell.find_first_of("])", open);
    const std::string_view name  = trimmed(cell.substr(0, open));
    if (close == std::string_view::npos) return {name, cell.substr(open)};
    const std::string_view unit = trimmed(cell.substr(open + 1, close - open - 1));
    return {name, unit == "1" ? std::string_view() : unit};
}

double siPerUnitOf(const ColumnHead& head, Dimension dimension, const std::string& where)
{
    if (head.unit.empty()) return 1;
    if (head.unit.starts_with('[') || head.unit.starts_with('('))
        throw Error(where + ": column \"" + std::string(head.name) +
                    "\": expected a bracket that ends behind its unit, found " + inQuotes(head.unit));
    return parseQuantity("1 " + std::string(head.unit), dimension,
                         where + ": column \"" + std::string(head.name) + "\"");
}

double metresPer(std::string_view lengthUnit)
{
    for (const Unit& known : kLengths)
        if (known.name == unitInAscii(lengthUnit)) return known.inSi;
    throw Error("unknown length unit \"" + std::string(lengthUnit) + "\"; known units: " + listed(kLengths));
}

glm::dvec3 parsePoint(std::string_view text, std::string_view what, double metresPerPlainNumber)
{
    glm::dvec3       point{};
    std::string_view rest = text;
    for (int k = 0; k < 3; ++k) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (k == 2))
            throw Error(std::string(what) + ": expected three numbers x,y,z, found " + inQuotes(text));
        point[k] = parseQuantity(rest.substr(0, comma), Dimension::length, what, metresPerPlainNumber);
        if (k < 2) rest.remove_prefix(comma + 1);
    }
    return point;
}

std::string formatQuantity(double value, std::string_view siUnit)
{
    if (!std::isfinite(value)) return std::isnan(value) ? "undefined" : "infinite";
    const int length = int(siUnit.size());
    char      text[64];
    if (value == 0) {
        std::snprintf(text, sizeof text, "0 %.*s", length, siUnit.data());
        return text;
    }
    constexpr std::array kPrefixes  = {"p", "n", "\u00b5", "m", "", "k", "M", "G", "T"};
    constexpr int        kMostSteps = 4; // of a thousand, up or down from the unit
    // Rounded to three digits first: 999.96 is 1.00 k, not 1000.
    std::snprintf(text, sizeof text, "%.2e", value);
    const double rounded  = std::strtod(text, nullptr);
    const int    exponent = std::atoi(std::strchr(text, 'e') + 1);
    const int    step     = int(std::floor(exponent / 3.0));
    if (siUnit.starts_with("1/")) // a prefix before it would read as another unit
        std::snprintf(text, sizeof text, "%.3g %.*s", rounded, length, siUnit.data());
    else if (std::abs(step) > kMostSteps)
        std::snprintf(text, sizeof text, "%.1e %.*s", value, length, siUnit.data());
    else
        std::snprintf(text, sizeof text, "%.*f %s%.*s", 2 - (exponent - 3 * step), rounded / std::pow(10.0, 3 * step),
                      kPrefixes[std::size_t(step + kMostSteps)], length, siUnit.data());
    return text;
}

std::string formatNumber(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", value);
    return text;
}

std::string shortNumber(double value, int digits)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", std::min(digits, 17), value);
    return text;
}

} // namespace palp
