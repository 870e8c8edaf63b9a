#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/pipeline/deform.h"
#include "engine/session/servo.h"

namespace palp {

/// The answer to a touch: the result of the slow half of a session.
struct DeformationAnswer {
    std::optional<PatchUpdate> update; ///< for the servo; empty: nothing could be solved there
    std::optional<Patch>       patch;  ///< for an observer; there whenever `update` is
    std::string                why;    ///< a failure, also one that a second try mended; may be empty
};

/// Turns a touch and the measured period of the deformation [s] into an answer. It may take long, and throw.
using PatchSolver = std::function<DeformationAnswer(const Touch&, double period)>;

/// The slow half of a session: solves the patch and the table of compliances for where a touch will be.
/// \thread one at a time, together with its plate solver
class Deformation {
public:
    /// Opens the plate solver of the scene and solves the homogeneous patch window, some tenths of a second.
    /// \param object  outlives this
    /// \throws Error as PlateSolver and footprintLattice() do
    Deformation(const SoftObject& object, const Scene& scene);

    /// Solves for where the touch will be 1.5 periods later. If that is off the object, or the points determine no
    /// surface there, it solves for the touch itself; if that fails too there is no update, and the answer says why.
    ///
    /// Then the servo goes on with its last table for a quarter of a second of contact: k_c of the contact in series with
    /// the last known compliance, flagged as stale; after that the force fades. Before the first table there is no force, and that is meant. A plate could be made up there, of the
    /// nearest point's rigidity everywhere; but what fails is most often a wrong unit or a window that is too small,
    /// and then thickness, footprint and stiffness are as wrong: the hand would feel something that is off by powers of
    /// ten, and recordings would hold forces that no plate gave. So a session says in words why it has no force.
    /// \param period  of the deformation, as measured [s]
    [[nodiscard]] DeformationAnswer solve(const Touch& touch, double period);

    /// Returns solve() of this object, which must outlive it.
    [[nodiscard]] PatchSolver solver()
    {
        return [this](const Touch& touch, double period) { return solve(touch, period); };
    }

    /// Goes on with other stiffnesses of the same points. The table's lattice stays that of the first object: it
    /// depends on the mean of the rigidity alone, and through that on how far a foundation lets a dent spread.
    /// \param object  repainted() or as it was; outlives this
    void repaint(const SoftObject& object);

    [[nodiscard]] const PlateSolver& plateSolver() const noexcept { return solver_; }

private:
    [[nodiscard]] DeformationAnswer solveAt(const glm::dvec3& place, const Touch& touch);

    const SoftObject*    object_; ///< never null
    ComplianceLaw        law_;
    PatchSettings        settings_;
    PlateSolver          solver_;
    FootprintLattice     lattice_;
    std::optional<Frame> frame_; ///< of the last patch, carried to the next
};

} // namespace palp
