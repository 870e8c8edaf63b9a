#pragma once
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

namespace palp {

/// The dimension of a number given by a user; it decides which unit suffixes are known.
enum class Dimension {
    length,
    force,
    pressure,
    rigidity,
    foundation,
    stiffness,
    angle,
    time,
    perLength,
    none,
    speed,
    mass
};

/// Returns a unit as the tables of units have it: one that is written with the micro sign, or with the Greek letter,
/// begins with u there.
[[nodiscard]] std::string unitInAscii(std::string_view unit);

/// Reads "4mm", "1.5 N", "0.3MPa", "2e-3": a finite number and a unit.
/// \param siPerPlainNumber  SI units in one of a number without a unit
/// \return the value in SI units
/// \throws Error naming `what`, the text and the units that are known
[[nodiscard]] double parseQuantity(std::string_view text, Dimension dimension, std::string_view what,
                                   double siPerPlainNumber = 1);

/// What the header of a table calls a column: "depth [mm]", "time(s)".
struct ColumnHead {
    std::string_view name, unit; ///< the unit is empty where there is none, or 1; "[mm" if its bracket never ends
};
[[nodiscard]] ColumnHead columnHead(std::string_view cell) noexcept;

/// Returns the SI units in one of a column's unit; 1 where it has none.
/// \param where  opens complaints, before the column's name
/// \throws Error as parseQuantity() does, and of a bracket that never ends
[[nodiscard]] double siPerUnitOf(const ColumnHead& head, Dimension dimension, const std::string& where);

/// Returns the metres in one unit of length: m, mm, cm, um, km, in, ft.
/// \throws Error naming the units that are known
[[nodiscard]] double metresPer(std::string_view lengthUnit);

/// Reads "x,y,z" as a point; every component may carry a unit of length.
/// \param metresPerPlainNumber  scale of components without a unit [m]
[[nodiscard]] glm::dvec3 parsePoint(std::string_view text, std::string_view what, double metresPerPlainNumber = 1);

/// Writes a number with an SI prefix and three significant digits: formatQuantity(0.0042, "m") is "4.20 mm". Beyond the
/// prefixes from p to T it is "1.0e+300 Pa", and zero is "0 m".
[[nodiscard]] std::string formatQuantity(double value, std::string_view siUnit);

/// Writes two digits of a small number without a unit, such as an error: "7.4e-05".
[[nodiscard]] std::string formatNumber(double value);

/// Writes a number without a unit with as many digits as it needs, `digits` at most: "0.25", "1e-05".
[[nodiscard]] std::string shortNumber(double value, int digits = 6);

} // namespace palp
