#pragma once
#include <string>
#include <vector>

#include "engine/plate/plate.h"

namespace palp {

/// Remembers plates that multigrid did not solve, because others like them will hardly be solved either.
///
/// A plate is like another one if it has as many cells and the same edges, about the same spacing and foundation, at
/// least half the contrast and, where the other one's rigidity jumps, jumps as well: what is hard about a disc is its
/// rim, and a smooth map of the same contrast is solved in a few steps.
/// \thread one at a time
class HardPlates {
public:
    /// \param tolerance  that was not reached [1]
    /// \param why        for knownBecause()
    void remember(const Plate& plate, double tolerance, std::string why);

    /// Returns why a plate like this one was not solved to this tolerance, or a looser one; null: none is known.
    [[nodiscard]] const std::string* knownBecause(const Plate& plate, double tolerance) const;

private:
    struct One {
        Plate       plate;          ///< without its rigidity
        double      contrast, jump; ///< [1]
        double      tolerance;      ///< [1]
        std::string why;
    };
    std::vector<One> all_; ///< the newest last
};

/// Returns the largest over the least rigidity [1].
[[nodiscard]] double contrastOf(const Plate& plate);

/// Returns the largest ratio of rigidities of two nodes beside each other [1].
[[nodiscard]] double largestJump(const Plate& plate);

} // namespace palp
