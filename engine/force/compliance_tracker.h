#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/core/enum_names.h"
#include "engine/force/compliance_table.h"
#include "engine/force/homogeneous_law.h"

namespace palp {

/// The laws by which the servo uses the tables that the deformation thread publishes.
enum class ComplianceLaw {
    table, ///< by the contact's position in the newest table; the jump between tables dies away
    hold,  ///< the middle of the newest table, until the next: a step with every patch
    blend  ///< from what is in use to the middle of the newest table, evenly over one period: no steps, but later still
};
constexpr auto namesOf(ComplianceLaw)
{
    using enum ComplianceLaw;
    return std::to_array<NamedValue<ComplianceLaw>>({{table, "table"}, {hold, "hold"}, {blend, "blend"}});
}

/// The servo's input of one tick.
struct ComplianceTick {
    glm::dvec3 contact{}; ///< [m] of the proxy, world
    double     time = 0;  ///< [s] of the servo's clock
    double     dt   = 0;  ///< [s] since the last tick
    /// Of the deformation thread; null: none yet. It is read where it lies: it stays as it is while inUse() names it.
    const ComplianceTable* newest   = nullptr;
    bool                   touching = true; ///< false: in free space. The next contact then starts without an offset
};

struct LocalCompliance {
    double compliance       = 0;     ///< c [m/N]
    double contactStiffness = 0;     ///< k_c [N/m]
    bool   clamped          = false; ///< the contact lies beyond the table's reach, or no table was there yet
    double age              = 0;     ///< [s] of the contact that the table is for; without one, of this contact
    double curvature        = 0;     ///< [1/m] of the table's chart, see Chart

    std::optional<double> stiffening{}; ///< b [1/m]; empty: it is the scene's

    bool lasts = false; ///< the table says of the contact what the next one would, see ComplianceTable::lasts

    bool guessed = false; ///< the homogeneous law answers, for want of a table
};

/// Compliance at 1 kHz from tables at 30 to 60 Hz.
///
/// The contact is projected into the table's own chart, radially onto its sphere: the same map that brought the
/// rigidity of the points there, so that a contact finds the points around it wherever it is, and off the sphere too.
/// What remains is how the rest of the surface is bent differently from the sphere, which the plate does not know
/// either. (Onto the tangent plane, 12 mm on a radius of 35 mm would be 0.2 mm short, and a contact off the sphere
/// would be shifted by that distance times the slope.)
///
/// Where a new table disagrees with the old one at the contact, the difference is carried as an offset of ln c, and of
/// ln k_c, which dies at 1 % per millisecond, or within one period if that is faster. In free space tables change
/// without: nothing is felt. b, where it varies, goes the same way. Nor does a contact carry an offset that began
/// beyond the reach of its table, or with one that was not replaced in time: that table was made for another place, and
/// what it says is no value to keep.
///
/// A contact that finds no table, or that begins beyond its reach, is answered by the homogeneous law of its place, if
/// there is one, until its first table comes; one that ended is none. Where none comes for a quarter of a second, or
/// for as long as a slow thread may take, there is no answer: what cannot be solved for so long is most often a wrong
/// unit, and that law would be as wrong.
/// \thread the servo's; no allocation, lock or throw
/// \source our own prototype, with slopes in place of twice as many footprints; README.md here has the measurements
class ComplianceTracker {
public:
    /// \param first         answers until there is a table; outlives this; null: nothing does
    /// \param longestGuess  [s] from the beginning of a contact for which it does
    explicit ComplianceTracker(ComplianceLaw law = ComplianceLaw::table, const HomogeneousLaw* first = nullptr,
                               double longestGuess = 0.25) noexcept
        : law_(law), first_(first), longestGuess_(longestGuess)
    {
    }

    /// Returns the compliance in use; empty until the first usable table. A table counts once, by its sequence number;
    /// one that is not usable() is not taken.
    [[nodiscard]] std::optional<LocalCompliance> tick(const ComplianceTick& now) noexcept;

    /// Returns what is in use at another place, with the offsets of the last tick: what its slope is taken from. A
    /// blend and a hold have none.
    [[nodiscard]] std::optional<LocalCompliance> near(const glm::dvec3& place) const noexcept;

    [[nodiscard]] double period() const noexcept { return period_; } ///< of the tables, smoothed [s]

    /// Returns the table that the next tick may still read, besides the newest; null: none.
    [[nodiscard]] const ComplianceTable* inUse() const noexcept { return table_; }

private:
    /// One of the two logarithms, or b, on its way to the hand.
    struct Carried {
        double handed = 0; // in the last tick [1] or [1/m]
        double offset = 0; // from the table's value, likewise
        double rate   = 0; // at which the offset dies, of it in a second
        double from   = 0; // where a blend began, likewise
    };

    [[nodiscard]] ComplianceTable::Values lookUp(const glm::dvec3& contact) const noexcept;
    [[nodiscard]] bool                    answers() const noexcept { return table_ || guessing_; }
    void                                  land(const ComplianceTick& now) noexcept;
    void                                  adopt(const ComplianceTick& now) noexcept;
    void                 carry(Carried& carried, double before, double after, double rate) const noexcept;
    [[nodiscard]] double hand(Carried& carried, double wanted, double time) const noexcept;

    ComplianceLaw         law_;
    const HomogeneousLaw* first_;        // may be null
    double                longestGuess_; // [s]
    /// The table in use, where the deformation thread put it; null: none yet. A copy would cost the servo's tick 2.4
    /// KB.
    const ComplianceTable* table_    = nullptr;
    bool                   touching_ = false;
    bool                   fits_     = false;    // the table in use was made for this contact, as far as is known
    bool                   guessing_ = false;    // the homogeneous law answers
    double                 landed_   = 0;        // when this contact began [s]
    bool                   flown_    = false;    // in free space since the table came
    double                 adopted_  = 0;        // when the table came [s]
    double                 period_   = 1.0 / 30; // [s] the slowest deformation thread that is planned for
    Carried                compliance_, contact_, stiffening_;
};

} // namespace palp
