#pragma once
#include <array>
#include <memory>
#include <vector>

#include "engine/session/deformation.h"
#include "tests/soak/chance.h"

namespace palp::soak {

/// What goes wrong between the plate's solver and the servo.
enum class SolverTrouble {
    none,
    silent,   ///< no answer
    dry,      ///< an allocation fails in the solver, and all after it
    late,     ///< the answer comes some periods later
    replaced, ///< the answer of another place
    garbage,  ///< the table holds numbers that are none, or an impossible shape
    extreme,  ///< the table is very soft or very hard
    count
};
inline constexpr std::array kSolverTroubles{"none",     "silent",  "out of memory", "late",
                                            "replaced", "garbage", "extreme"};
static_assert(kSolverTroubles.size() == std::size_t(SolverTrouble::count));

/// The deformation of a session behind faults. Most answers are those of earlier touches, in another order: a solve
/// takes a thousand times as long as a tick, and a servo must bear any table.
class FaultySolver {
public:
    using Update = std::shared_ptr<const PatchUpdate>;

    /// \param deformation  outlives this
    FaultySolver(Deformation& deformation, std::uint64_t seed) : deformation_(deformation), chance_(seed) {}

    /// Begins another session.
    /// \param rate   troubles per answer [1]
    /// \param fresh  share of the answers that are solved [1]
    void begin(double rate, double fresh) noexcept
    {
        rate_  = rate;
        fresh_ = fresh;
        late_.reset();
    }

    /// Returns what the servo is given for this touch, numbered anew; null: nothing.
    Update answer(const Touch& touch, double lead);

    [[nodiscard]] std::uint64_t troubles() const noexcept { return troubles_; }
    [[nodiscard]] std::uint64_t solved() const noexcept { return solved_; }

private:
    [[nodiscard]] Update solve(const Touch& touch, double lead, bool isDry);
    [[nodiscard]] Update numbered(const Update& update, double time);
    [[nodiscard]] Update spoiled(const Update& update);

    static constexpr std::size_t kKept = 64;

    Deformation&        deformation_;
    Chance              chance_;
    double              rate_ = 0, fresh_ = 1; ///< [1]
    std::uint64_t       sequence_ = 0, troubles_ = 0, solved_ = 0;
    std::vector<Update> kept_;      ///< earlier answers
    Update              late_;      ///< on its way
    int                 waits_ = 0; ///< periods
};

} // namespace palp::soak
