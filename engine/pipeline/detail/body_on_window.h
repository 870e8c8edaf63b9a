#pragma once
#include <memory>

#include "engine/core/grid.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// How a whole object moves where a patch window is cut from it, under 1 N at the contact.
///
/// Let u be the answer of the object and u0 that of the window with clamped sides, both to the fingertip's load p. u0
/// and the forces by which the sides hold it balance p, so for any displacement V of the sheet within the window
///
///     a(u0, V) = p(V) + R(V on the sides)          a: the bilinear form of bending and stretching
///
/// and u - u0, which nothing presses, does no work along u0. With V = s U, U the object's displacement and s a share
/// that is 1 at the sides, that leaves
///
///     c = p(u0) + d,     d = - R(U) = p(s U) - a(u0, s U)
///
/// whatever s is within: only the object's displacement at the sides counts, which a coarse mesh of it knows well even
/// where it does not know the dent.
/// \source  Betti's theorem
struct BodyOnWindow {
    /// s times the displacement along the axes of the chart and into the surface, at the nodes of the window and at one
    /// more around it, so that node (i, j) has (i + 1, j + 1) [m/N].
    NodeField x, z, w;
    double    spacing = 0; ///< of the coarse shell's nodes [m]
};

/// Presses the body that a patch's window is cut from, and finds how the window's sides move.
/// \param object  whose body it is
/// \param used    whose points are the patch's
/// \return null if no coarse node is near, or none has a place in the chart
[[nodiscard]] std::shared_ptr<const BodyOnWindow> bodyOnWindow(const Patch& patch, const SoftObject& object,
                                                               const SoftObject& used, const PatchSettings& settings);

/// Returns d of the window's answer: p(s U) - a(u0, s U) [m/N]. Of the change of the fingertip's load as it moves
/// [N/m] it is half of what d changes by [1/N], because what two loads do along each other's answers is the same.
/// \param load  of the fingertip, 1 N [N]
/// \param w     under it, by the shallow theory [m]
/// \param phi   Airy's function with it [N m]; empty: it bent as a plate
/// \pre patch.body is there
[[nodiscard]] double bodyGive(const Patch& patch, const NodeField& load, const NodeField& w, const NodeField& phi);

} // namespace palp
