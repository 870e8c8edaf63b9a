#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/pipeline/deform.h"
#include "engine/pipeline/homogeneous_sites.h"
#include "engine/session/servo.h"

namespace palp {

/// The answer to a touch: the result of the slow half of a session.
struct DeformationAnswer {
    /// For the servo, where the solver wrote it; null: nothing could be solved there. It stays as it is as long as
    /// somebody has a share in it, also beyond the life of the deformation. The servo's thread takes no share.
    std::shared_ptr<PatchUpdate> update;
    std::optional<Patch>         patch;      ///< for an observer; there whenever `update` is
    std::string                  why;        ///< a failure, also one that a second try mended; may be empty
    std::string                  takeover{}; ///< who solves plates now, and why; empty: who did before
    /// Where there is no update although the last one lasts: that one, which does so no longer. Else null.
    std::shared_ptr<PatchUpdate> ends{};
    bool                         isSolved = true; ///< false: the last answer holds here too, and took no time
};

/// Turns a touch into an answer. It may take long, and throw. `lead` is the time [s] from the touch to the middle of
/// that in which the answer will be in use, see aheadOf().
using PatchSolver = std::function<DeformationAnswer(const Touch&, double lead)>;

/// The slow half of a session: solves the patch and the table of compliances for where a touch will be.
/// \thread one at a time, together with its plate solver
class Deformation {
public:
    /// Opens the plate solver of the scene and solves the homogeneous patch window, some tenths of a second.
    /// \param object  outlives this
    /// \throws Error as PlateSolver and footprintLattice() do
    Deformation(const SoftObject& object, const Scene& scene);

    /// Solves for where the touch will be a lead later. If that is off the object, or the points determine no
    /// surface there, it solves for the touch itself; if that fails too there is no update, and the answer says why.
    ///
    /// Of an object that the window spans, the last answer holds for what is touched within half the reach of its
    /// table, which has its answers there. What is drawn, and the law of large deflections, are those of the place that
    /// it was solved for, a radius of the fingertip away and more. Further off, a window about the object's middle is
    /// pressed elsewhere, see movePatch(), for the touch itself where it is not as good for the place ahead. Where it
    /// is for neither, the touch has a window of its own.
    ///
    /// In free space it solves for where the hand will land, see landingOf(), so that a tap finds a table that is made
    /// for its place. Where the surface is too far away, or has no answer there, there is no update and no reason.
    ///
    /// Then the servo goes on with its last table for a quarter of a second of contact: k_c of the contact in series
    /// with the last known compliance, flagged as stale. Before the first table firstLaw() answers, as long. After that
    /// the force fades, and that is meant. What fails is most often a wrong unit or a window that is too small, and
    /// then thickness, footprint and stiffness are as wrong: the hand would go on feeling something that is off by
    /// powers of ten, and recordings would hold forces that no plate gave. So a session says in words why it has no
    /// force.
    /// \param lead  [s] see PatchSolver
    [[nodiscard]] DeformationAnswer solve(const Touch& touch, double lead);

    /// Returns solve() of this object, which must outlive it.
    [[nodiscard]] PatchSolver solver()
    {
        return [this](const Touch& touch, double lead) { return solve(touch, lead); };
    }

    /// Goes on with other stiffnesses of the same points. The table's lattice stays that of the first object: it
    /// depends on the mean of the rigidity alone, and through that on how far a foundation lets a dent spread.
    /// \param object  repainted() or as it was; outlives this
    void repaint(const SoftObject& object);

    /// Returns what answers until the first table: of the object as it was first or at the last renewFirstLaw().
    [[nodiscard]] const HomogeneousLaw* firstLaw() const noexcept { return &firstLaw_; }

    /// Makes that law anew, of the object as it is painted now: a quarter of a second for a million points.
    /// \pre no session runs, because a servo reads the old one
    void renewFirstLaw() { firstLaw_ = homogeneousLaw(*object_, lattice_, settings_); }

    [[nodiscard]] const PlateSolver& plateSolver() const noexcept { return solver_; }

private:
    [[nodiscard]] DeformationAnswer                solveSomewhere(const Touch& touch, double lead);
    [[nodiscard]] DeformationAnswer                solveAhead(const Touch& touch, double lead);
    [[nodiscard]] DeformationAnswer                solveAt(const Contact& contact, const Touch& touch);
    [[nodiscard]] std::optional<DeformationAnswer> solveInWindows(const Contact& contact, const Touch& touch);
    [[nodiscard]] std::optional<DeformationAnswer> moved(const Patch& from, const Contact& contact, const Touch& touch);
    [[nodiscard]] const Patch*                     middleFor(const Contact& contact);
    [[nodiscard]] bool                             isKeptFor(const Contact& contact) const;
    [[nodiscard]] DeformationAnswer                keptFor(const Touch& touch);
    [[nodiscard]] std::shared_ptr<PatchUpdate>     ended(const Touch& touch);
    [[nodiscard]] DeformationAnswer answerOf(Patch patch, const Touch& touch, const std::shared_ptr<PatchUpdate>& slot);
    [[nodiscard]] const std::shared_ptr<PatchUpdate>& freeSlot();

    const SoftObject*    object_; ///< never null
    ComplianceLaw        law_;
    PatchSettings        settings_;
    PlateSolver          solver_;
    int                  told_ = 0; ///< the solver's takeovers that answers have told
    FootprintLattice     lattice_;
    HomogeneousLaw       firstLaw_;
    std::optional<Frame> frame_; ///< of the last patch, carried to the next
    struct Kept {
        PatchUpdate update;
        Patch       patch;
        bool        isOfObject = true; ///< as it is painted now
    };
    std::optional<Kept> kept_; ///< the last answer, where the window spans the object
    /// The middle of an object that the window spans, with a window for each side from which it was touched.
    struct Middle {
        glm::dvec3                          place{};   ///< [m]
        glm::dvec3                          normal{};  ///< [1]
        std::array<std::optional<Patch>, 2> windows{}; ///< from where the normal points, and from behind; not
                                                       ///< deformed(): there is none
    };
    std::optional<Middle> middle_;
    /// Memory for answers. One that nobody else has a share in is free: in a session there are four at most, and one.
    std::vector<std::shared_ptr<PatchUpdate>> slots_;
};

} // namespace palp
