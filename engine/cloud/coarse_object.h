#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/cloud/soft_object.h"

namespace palp {

/// A dense object by fewer points: one for those of each cube, on either side of a thin body, at their mean position
/// with the mean of their logarithmic stiffness, of how it grows with depth, and of the foundation below them. A touch
/// that asks for no finer detail then costs the same however dense the object is.
/// \thread immutable, so free to share
class CoarseObject {
public:
    /// \param side  of the cubes [m], > 0; taken to the nearest power of two of the index's cells, so to a factor of
    ///              1.42
    CoarseObject(const SoftObject& dense, double side);

    /// Makes that of an object of the same points with other stiffnesses or another material: positions, index and
    /// survey are shared.
    CoarseObject(const CoarseObject& shape, const SoftObject& dense);

    [[nodiscard]] const SoftObject& object() const noexcept { return object_; }
    [[nodiscard]] double            side() const noexcept { return side_; } ///< asked for [m]

    /// Returns the points of the dense object that a coarse one stands for, at least one.
    [[nodiscard]] std::span<const std::uint32_t> membersOf(std::size_t point) const noexcept
    {
        return std::span(*members_).subspan((*begins_)[point], (*begins_)[point + 1] - (*begins_)[point]);
    }

private:
    struct Cubes;

    CoarseObject(const SoftObject& dense, double side, Cubes cubes);
    /// Returns the mean of each coarse point's members, by their logarithms or as they are.
    [[nodiscard]] std::vector<double> meansOf(std::span<const double> values, bool byLogarithm = true) const;

    double                                            side_ = 0;
    std::shared_ptr<const std::vector<std::uint32_t>> members_; ///< of the first coarse point, of the second ...
    std::shared_ptr<const std::vector<std::uint32_t>> begins_;  ///< where those of each begin, and the end
    SoftObject                                        object_;
};

} // namespace palp
