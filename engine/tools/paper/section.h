#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/enum_names.h"
#include "engine/plate/plate_solver.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::report {

// The contents of a part of the report. They are values only; pages and files are written elsewhere.

/// A number, or a list of numbers along a curve.
struct Quantity {
    std::string         name; ///< "linear/paper/deflection"
    std::string         unit; ///< SI; "1" for none
    std::vector<double> values;
};

struct Table {
    std::string                           caption;
    std::vector<std::string>              headings;
    std::vector<std::vector<std::string>> rows; ///< one cell per heading
};

struct Figure {
    std::string caption;
    std::string svg; ///< self-contained
};

enum class Verdict { holds, inPart, fails };
constexpr auto namesOf(Verdict)
{
    using enum Verdict;
    return std::to_array<NamedValue<Verdict>>({{holds, "holds"}, {inPart, "holds in part"}, {fails, "does not hold"}});
}

/// One claim of the paper beside our figure.
struct Claim {
    std::string paper; ///< the paper's statement
    std::string ours;  ///< our number
    std::string how;   ///< how our number is made
    Verdict     verdict = Verdict::holds;
    std::string words;         ///< the verdict in plain words
    bool        timed = false; ///< our number was measured by a clock and differs from run to run
};

struct Section {
    char                     letter = 'a';
    std::string              title;
    std::vector<std::string> text; ///< paragraphs
    std::vector<Claim>       claims;
    std::vector<Table>       tables;
    std::vector<Figure>      figures;
    std::vector<Quantity>    numbers; ///< the same bits from run to run on one processor
    std::vector<Quantity>    timings; ///< measured by a clock

    /// Returns the values of a number.
    /// \throws Error naming it if there is none
    [[nodiscard]] const std::vector<double>& number(std::string_view name) const;
};

/// The input of every part.
struct ReportRun {
    PlateSolver&                                  solver;
    FigureRenderer&                               renderer;
    bool                                          quick = false; ///< small enough for a test, with larger errors
    std::vector<std::string>                      timed{};       ///< processors to be timed, as PlateSolver names them
    std::function<void(std::size_t, std::size_t)> onStep{};      ///< (done, total); may be empty

    void step(std::size_t done, std::size_t total) const
    {
        if (onStep) onStep(done, total);
    }
};

/// Writes a share [1] as "3.2 %", with two digits.
[[nodiscard]] std::string percent(double share);
/// Writes a number with the given number of decimals, such as "3.20".
[[nodiscard]] std::string fixed(double value, int decimals);

} // namespace palp::report
