#include "engine/tools/plot/axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double           kLargest   = 1e100; // beyond it, spans and their squares overflow [any unit]
constexpr double           kNarrowest = 1e-9; // span per value below which labels would differ past the ninth digit [1]
constexpr int              kPlainDecades = 6; // more than these read better as powers of ten
constexpr int              kLeastPlain = -3, kMostPlain = 4; // decades that read well without a power of ten
constexpr double           kOnTick = 1e-9; // an end of the range this close to a tick, in steps, is on it [1]
constexpr std::string_view kMinus  = "\u2212";

std::string fixed(double value, int decimals)
{
    std::array<char, 512> text{};
    const auto            end =
        std::to_chars(text.data(), text.data() + text.size(), std::abs(value), std::chars_format::fixed, decimals).ptr;
    const std::string digits(text.data(), end);
    const bool        zero = digits.find_first_of("123456789") == std::string::npos;
    return value < 0 && !zero ? std::string(kMinus) + digits : digits;
}

std::string powerOfTen(int exponent)
{
    constexpr std::array<std::string_view, 10> kRaised = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                          "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string                                text    = "10";
    if (exponent < 0) text += "\u207b";
    for (char digit : std::to_string(std::abs(exponent))) text += kRaised[std::size_t(digit - '0')];
    return text;
}

bool takesPrefix(std::string_view unit)
{
    constexpr std::array<std::string_view, 9> kUnits = {"m", "N", "Pa", "s", "J", "W", "V", "A", "Hz"};
    const std::string_view                    first  = unit.substr(0, unit.find_first_of(" /"));
    return std::find(kUnits.begin(), kUnits.end(), first) != kUnits.end();
}

double size(ValueRange range)
{
    return std::max(std::abs(range.low), std::abs(range.high));
}

int decadeOf(double positive)
{
    return int(std::floor(std::log10(positive) + 1e-12));
}

} // namespace

bool drawable(double value, Scale scale) noexcept
{
    if (!std::isfinite(value) || std::abs(value) > kLargest) return false;
    return scale == Scale::linear || value >= 1 / kLargest;
}

std::optional<ValueRange> rangeOf(std::span<const double> values, Scale scale)
{
    std::optional<ValueRange> range;
    for (double value : values) {
        if (!drawable(value, scale)) continue;
        if (!range) range = ValueRange{value, value};
        range->low  = std::min(range->low, value);
        range->high = std::max(range->high, value);
    }
    return range;
}

ValueRange widened(ValueRange range, Scale scale)
{
    PALP_EXPECT(drawable(range.low, scale) && drawable(range.high, scale) && range.low <= range.high,
                "found the range " + std::to_string(range.low) + " to " + std::to_string(range.high));
    if (range.high - range.low > kNarrowest * size(range) && range.high - range.low > 1 / kLargest) return range;
    if (scale == Scale::logarithmic) return {range.low / 1.1, range.high * 1.1};
    const double margin = size(range) > 1 / kLargest ? 0.1 * size(range) : 1;
    return {range.low - margin, range.high + margin};
}

Axis::Axis(ValueRange range, Scale scale, std::string_view unit, int mostTicks)
    : range_(widened(range, scale)), scale_(scale)
{
    PALP_EXPECT(mostTicks >= 2, "an axis has room for two labels; found " + std::to_string(mostTicks));
    chooseUnit(unit == "1" ? "" : unit);
    scale == Scale::linear ? placeLinearTicks(mostTicks) : placeLogarithmicTicks(mostTicks);
}

void Axis::chooseUnit(std::string_view unit)
{
    constexpr std::array<std::string_view, 9> kPrefixes = {"p", "n", "\u00b5", "m", "", "k", "M", "G", "T"};
    unit_                                               = unit;
    if (scale_ == Scale::logarithmic && decadeOf(range_.high) - decadeOf(range_.low) > kPlainDecades) return;
    const int decade = decadeOf(size(range_)), thousands = int(std::floor(decade / 3.0));
    if (takesPrefix(unit) && std::abs(thousands) <= 4) {
        unit_     = std::string(kPrefixes[std::size_t(thousands + 4)]).append(unit);
        exponent_ = 3 * thousands;
    } else if (decade < -2 || decade > 3) { // 0.01 to 9999 read well as they are
        unit_     = powerOfTen(3 * thousands) + (unit.empty() ? "" : " ") + std::string(unit);
        exponent_ = 3 * thousands;
    }
}

void Axis::placeLinearTicks(int mostTicks)
{
    const double perUnit = std::pow(10.0, exponent_);
    const double low = range_.low / perUnit, high = range_.high / perUnit;
    int          decade = decadeOf((high - low) / mostTicks);
    for (;; ++decade) {
        for (int digit : {1, 2, 5}) {
            const double step  = digit * std::pow(10.0, decade);
            const double first = std::ceil(low / step - kOnTick), last = std::floor(high / step + kOnTick);
            if (last - first + 1 > mostTicks) continue;
            ticks_.clear();
            for (double n = first; n <= last; ++n)
                ticks_.push_back({n * step * perUnit, fixed(n * step, std::max(0, -decade))});
            return;
        }
    }
}

void Axis::placeLogarithmicTicks(int mostTicks)
{
    const int first = int(std::ceil(std::log10(range_.low) - kOnTick)),
              last  = int(std::floor(std::log10(range_.high) + kOnTick));
    if (last - first + 1 >= 3) return placeDecadeTicks(mostTicks, first, last);
    for (int decade = first - 1; decade <= last; ++decade)
        for (int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10.0, decade);
            if (value < range_.low * (1 - kOnTick) || value > range_.high * (1 + kOnTick)) continue;
            ticks_.push_back({value, fixed(value / std::pow(10.0, exponent_), std::max(0, exponent_ - decade))});
        }
    if (ticks_.size() < 2 || int(ticks_.size()) > mostTicks)
        placeLinearTicks(mostTicks); // a short range is nearly linear
}

void Axis::placeDecadeTicks(int mostTicks, int firstDecade, int lastDecade)
{
    const bool plain = firstDecade - exponent_ >= kLeastPlain && lastDecade - exponent_ <= kMostPlain;
    const int  every = (lastDecade - firstDecade) / mostTicks + 1;
    for (int decade = firstDecade; decade <= lastDecade; decade += every) {
        const int shown = decade - exponent_;
        ticks_.push_back(
            {std::pow(10.0, decade), plain ? fixed(std::pow(10.0, shown), std::max(0, -shown)) : powerOfTen(shown)});
    }
    for (int decade = firstDecade - 1; every == 1 && decade <= lastDecade; ++decade)
        for (int digit = 2; digit < 10; ++digit) {
            const double value = digit * std::pow(10.0, decade);
            if (value > range_.low && value < range_.high) minorTicks_.push_back(value);
        }
}

double Axis::position(double value) const
{
    if (scale_ == Scale::linear) return (value - range_.low) / (range_.high - range_.low);
    return std::log(value / range_.low) / std::log(range_.high / range_.low);
}

std::string Axis::title(std::string_view quantity) const
{
    return unit_.empty() ? std::string(quantity) : std::string(quantity) + " [" + unit_ + "]";
}

std::string Axis::text(double value) const
{
    const double number = value / std::pow(10.0, exponent_);
    std::string  text;
    if (std::abs(value) <= kNarrowest * size(range_)) { // such as the rounding error of a place
        text = "0";
    } else if (const int decade = decadeOf(std::abs(number)); decade < kLeastPlain || decade > 6) {
        text = fixed(number / std::pow(10.0, decade), 2) + "\u00b7" + powerOfTen(decade);
    } else {
        text = fixed(number, std::max(0, 2 - decade));
    }
    return unit_.empty() ? text : text + " " + unit_;
}

} // namespace palp
