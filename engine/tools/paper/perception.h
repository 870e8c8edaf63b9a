#pragma once
#include <array>
#include <span>

namespace palp::report {

/// What a person would notice of stiffness, computed: a prediction, never a user study.

/// Smallest relative changes of stiffness that are noticed [1]: of a keen finger that presses on purpose, of most, and
/// of one that can go by nothing but stiffness.
/// \source the span of published ones: Tan, Durlach, Beauregard & Srinivasan 1995 (0.08 where the way is always the
///         same, 0.22 where force and work tell nothing), Jones & Hunter 1990 (0.23)
inline constexpr std::array<double, 3> kWeberFractions = {0.07, 0.15, 0.22};

/// J: the steps that can just be noticed between two stiffnesses, |ln(a/b)| / ln(1 + W) [1]. Below 1 most people do not
/// notice.
/// \param a, b   [N/m], > 0
/// \param weber  W, the smallest relative change that is noticed [1], > 0
[[nodiscard]] double noticeableSteps(double a, double b, double weber) noexcept;

/// The same of a logarithm of their ratio.
[[nodiscard]] double noticeableSteps(double lnRatio, double weber) noexcept;

/// Share of right answers of who feels both and says which is stiffer: Phi(z J) with z = Phi^-1(3/4), so that one step
/// is told right in three of four trials; 1/2 is guessing [1].
/// \source Green & Swets 1966, "Signal Detection Theory and Psychophysics": two alternatives, Gaussian noise, here of
///         the logarithm of stiffness
/// \differs the paper reports that about 90 % of its users perceived the change; this predicts, and asks nobody
[[nodiscard]] double rightAnswers(double steps) noexcept;

/// Largest minus smallest value among samples that lie at most `within` apart along a path [unit of values]; infinity
/// as `within` is the range of all. Empty: 0.
/// \param along   rising or falling, or to and fro [m]
/// \param values  as many
[[nodiscard]] double largestRange(std::span<const double> along, std::span<const double> values, double within);

} // namespace palp::report
