#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "engine/chart/chart.h"

namespace palp {

/// The compliance of plate and contact under footprints on a square lattice around a centre: what the servo knows of
/// the neighbourhood until the next patch arrives.
///
///     entry (i, j) is the footprint at chart position ((i - side/2) spacing, (j - side/2) spacing), stored at
///     [i * side + j]; the chart's origin is the entry in the middle
///
/// It holds ln c and ln k_c, which change evenly where rigidity grows by factors. Entries beyond side * side are
/// ignored. Its size is fixed and it is trivially copyable, so that it passes through a three-slot hand-off as it is.
///
/// \thread pure value
struct ComplianceTable {
    static constexpr int kMostSide    = 7; ///< entries of the widest reach, 3 R: 0.2 m/s and 30 Hz, see tableSide()
    static constexpr int kMostEntries = kMostSide * kMostSide;

    /// A logarithm under one footprint, and its change as the footprint moves in this window.
    struct Entry {
        double value  = 0; ///< [1]
        double slopeX = 0; ///< [1/m]
        double slopeZ = 0; ///< [1/m]
    };
    using Entries = std::array<Entry, kMostEntries>;

    /// Compliance and contact stiffness at one place.
    struct Values {
        double lnCompliance       = 0;     ///< of c [m/N]
        double lnContactStiffness = 0;     ///< of k_c [N/m]
        bool   clamped            = false; ///< beyond the reach: the nearest place within it answers

        std::optional<double> stiffening{}; ///< b [1/m]; empty: it is the scene's
    };

    std::uint64_t sequence = 0;       ///< of the contact that it was solved for; 0: none
    double        time     = 0;       ///< [s] of that contact, on the servo's clock
    Chart         chart;              ///< its origin is the centre of the patch window
    int           side    = 1;        ///< entries along each axis, an odd number
    double        spacing = 0;        ///< of the entries [m]
    Entries       compliance{};       ///< ln c
    Entries       contactStiffness{}; ///< ln k_c, of the rigidity's geometric mean over the footprint
    bool          lasts    = false; ///< of an object that its window spans: where it reaches it is as good as the next
    bool          ended    = false; ///< it lasted until now, and what is touched now has none
    bool          stiffens = false; ///< b varies from place to place; else the next is not read
    Entries       stiffening{};     ///< b, see DepthLaw: its mean over the footprint [1/m]

    [[nodiscard]] double reach() const noexcept { return side / 2 * spacing; } ///< along each axis [m]

    /// Interpolates bicubically from values and slopes (Hermite's form): continuous with its first derivatives.
    ///
    /// The slopes are exact and free, see solveTable(); the twist (the mixed derivative) is from differences of them.
    /// A lattice as coarse as the footprint's radius then loses 0.1 % of c at a wart of contrast 100 and 0.3 to 0.4 %
    /// at steps of 10 and 100. Slopes from differences of the values (Catmull-Rom's) lose 1.3 to 1.6 % (measured, 5 x
    /// 5), and a natural spline is straight at the rim, where a wart is not.
    [[nodiscard]] Values at(const ChartPoint& place) const noexcept;

    [[nodiscard]] Values middle() const noexcept;

    /// Returns false if the shape is impossible or an entry is not finite: nothing of the table may then be felt.
    [[nodiscard]] bool usable() const noexcept;
};

static_assert(std::is_trivially_copyable_v<ComplianceTable>);

} // namespace palp
