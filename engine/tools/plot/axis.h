#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palp {

enum class Scale { linear, logarithmic };

/// An interval of values, in the unit of its owner.
struct ValueRange {
    double low  = 0;
    double high = 1;
};

/// Returns whether a picture can show a value on this scale: finite, of a size whose differences do not overflow, and
/// greater than zero on a logarithmic scale.
[[nodiscard]] bool drawable(double value, Scale scale) noexcept;

/// Returns the smallest and largest drawable value, or nullopt when there is none.
[[nodiscard]] std::optional<ValueRange> rangeOf(std::span<const double> values, Scale scale);

/// Returns the range itself, or, when it is (nearly) a single value, one wide enough to have an axis: a tenth of the
/// value to either side, or -1 to 1 around zero.
[[nodiscard]] ValueRange widened(ValueRange range, Scale scale);

/// A step of an axis that has a label.
struct Tick {
    double      value = 0; ///< in the unit of the axis before prefixing
    std::string label;     ///< the number in the prefixed unit
};

/// Places values along an axis from 0 to 1 and labels them: steps of 1, 2 or 5 times a power of ten (whole decades on a
/// logarithmic axis that spans enough of them), numbers in the unit with the SI prefix that suits the largest value.
class Axis {
public:
    /// \param range      in SI units; widened() first
    /// \param unit       SI unit, "" or "1" for none; a unit that takes no prefix gets a power of ten instead
    /// \param mostTicks  number of labels that fit
    Axis(ValueRange range, Scale scale, std::string_view unit, int mostTicks);

    /// Returns 0 at the low end, 1 at the high end, linear or logarithmic in between and beyond.
    /// \pre drawable(value, scale)
    [[nodiscard]] double position(double value) const;

    [[nodiscard]] ValueRange                 range() const noexcept { return range_; }
    [[nodiscard]] Scale                      scale() const noexcept { return scale_; }
    [[nodiscard]] const std::vector<Tick>&   ticks() const noexcept { return ticks_; }
    [[nodiscard]] const std::vector<double>& minorTicks() const noexcept { return minorTicks_; }

    /// Returns the unit with its prefix; empty for none.
    [[nodiscard]] const std::string& unit() const noexcept { return unit_; }
    /// Returns "deflection [mm]", or the bare quantity when there is no unit.
    [[nodiscard]] std::string title(std::string_view quantity) const;
    /// Returns the value in the unit of this axis with three significant digits: "4.20 mm".
    [[nodiscard]] std::string text(double value) const;

private:
    void chooseUnit(std::string_view unit);
    void placeLinearTicks(int mostTicks);
    void placeLogarithmicTicks(int mostTicks);
    void placeDecadeTicks(int mostTicks, int firstDecade, int lastDecade);

    ValueRange          range_;
    Scale               scale_;
    int                 exponent_ = 0; ///< a number on the axis is value / 10^exponent_
    std::string         unit_;         ///< with prefix; empty for none
    std::vector<Tick>   ticks_;
    std::vector<double> minorTicks_;
};

} // namespace palp
