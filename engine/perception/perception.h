#pragma once
#include <array>
#include <span>

namespace palp {

// The functions below predict what a person would notice of stiffness. They are no user study.

/// Smallest relative changes of stiffness that are noticed [1]: by a keen finger that presses on purpose, by most
/// fingers, and by one that has no cue but stiffness.
/// \source the span of published values: Tan, Durlach, Beauregard & Srinivasan 1995 (0.08 where the distance is always
///         the same, 0.22 where force and work give no cue), Jones & Hunter 1990 (0.23)
inline constexpr std::array<double, 3> kWeberFractions = {0.07, 0.15, 0.22};

/// The one of a person who feels through a rigid handle, as with every device of ours: the surface's dent, which a bare
/// finger sees in its own skin, gives no cue.
/// \source Bergmann Tiest & Kappers 2009, "Cues for haptic perception of compliance": without that cue thresholds are
///         more than three times as high
inline constexpr double kRigidHandleWeber = kWeberFractions.back();

/// Returns J, the number of just noticeable steps between two stiffnesses, |ln(a/b)| / ln(1 + W) [1]. Below 1 most
/// people notice no difference.
/// \param a, b   [N/m], > 0
/// \param weber  W, the smallest relative change that is noticed [1], > 0
[[nodiscard]] double noticeableSteps(double a, double b, double weber) noexcept;

/// Returns the same from the logarithm of their ratio.
[[nodiscard]] double noticeableSteps(double lnRatio, double weber) noexcept;

/// Returns the share of right answers of a person who feels both and says which is stiffer [1]: Phi(z J) with
/// z = Phi^-1(3/4), so that one step is judged right in three of four trials; 1/2 is guessing.
/// \source Green & Swets 1966, "Signal Detection Theory and Psychophysics": two alternatives, Gaussian noise, here of
///         the logarithm of stiffness
/// \differs the paper reports that about 90 % of its users perceived the change; this is a prediction without users
[[nodiscard]] double rightAnswers(double steps) noexcept;

/// Returns the largest minus the smallest value among places at most `within` apart along a path [unit of values]; with
/// `within` infinite it is the range of all, and 0 if there are none.
/// \param along   positions, rising or falling, or to and fro [m]
/// \param values  one per position
[[nodiscard]] double largestRange(std::span<const double> along, std::span<const double> values, double within);

} // namespace palp
