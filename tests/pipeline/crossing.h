#pragma once
#include <array>
#include <functional>
#include <vector>

#include "engine/force/ahead.h"
#include "engine/force/compliance_tracker.h"
#include "engine/pipeline/compliance_table_solve.h"

namespace palp {

/// The sheet of our own prototype: flat, on a foundation, l = 6 mm, windows of 12 l with a node per mm, a footprint of
/// 4 mm. Its rigidity is a function of the place; a hand crosses it along y = 0, obliquely to the chart's axes.
class Sheet {
public:
    using Factor = std::function<double(double x, double y)>; ///< of the rigidity [1]

    static constexpr double kRadius = 4e-3, kWindow = 72e-3, kTolerance = 1e-4;
    static constexpr int    kCells = 72;

    explicit Sheet(Factor factor);

    [[nodiscard]] Plate                          plateAt(double x) const; ///< in the window about (x, 0)
    [[nodiscard]] static Plate                   homogeneous();           ///< without any feature
    [[nodiscard]] static Chart                   chartAt(double x);
    [[nodiscard]] ComplianceTable                tableAt(double x, int side) const;
    [[nodiscard]] ComplianceTable::Values        truth(double x) const; ///< from windows about the place; |x| <= kReach
    [[nodiscard]] double                         range() const;         ///< largest over smallest compliance [1]
    [[nodiscard]] static const FootprintLattice& latticeOf(int side);

    static constexpr double kReach = 24e-3; ///< [m]

private:
    Factor                               factor_;
    std::vector<ComplianceTable::Values> truth_;
};

/// sd 4 mm, in the middle.
[[nodiscard]] Sheet::Factor wart(double contrast);
/// Stiff where x > 0. ln D as the pipeline's resampling sees it where points are 1 mm apart: evened out by a Gaussian.
[[nodiscard]] Sheet::Factor step(double contrast);

/// A hand in virtual time at constant depth: the servo ticks at 1 kHz and tables arrive at some rate, one period late.
struct Crossing {
    std::function<double(double)> along{};             ///< x of the hand [m] at a time [s]
    double                        from = 0, until = 0; ///< times that are judged [s]
};
[[nodiscard]] Crossing atConstantSpeed(double speed); ///< from -24 to 24 mm
[[nodiscard]] Crossing stroking(double fastest);      ///< 14 mm to either side, a whole cycle

struct Crossed {
    double        error      = 0; ///< largest of the force, relative, where the plate is the soft spring [1]
    double        step       = 0; ///< largest change of that force in a millisecond, relative [1]
    double        objectStep = 0; ///< the same of the force that the sheet itself gives [1]
    double        felt       = 0; ///< largest error of the force in series with a contact of k_c c = 6 [1]
    std::uint64_t clamped    = 0; ///< ticks beyond the reach [1]
    double        judged     = 0; ///< share of the ticks from which the rest is [1]: 1 but for the first of them
};
/// \param rate  of the deformation thread [Hz]
[[nodiscard]] Crossed crossed(const Sheet& sheet, const Crossing& crossing, ComplianceLaw law, double rate);

} // namespace palp
