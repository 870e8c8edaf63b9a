#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

struct Neighbour {
    std::uint32_t point    = 0; ///< index into the positions the index was built from
    double        distance = 0; ///< [m]
};

/// Searches fixed positions by radius and for the nearest points.
///
/// It is an Embree bounding volume hierarchy over blocks of 32 Morton-ordered points, each block one user primitive
/// that is filtered with vector instructions. Very many points so close together that floats do not tell them apart
/// have such an index of their own. Answers are those of a brute-force search in double precision, exactly: a
/// point is within the radius if the squared distance, in doubles, is at most the squared radius.
/// \thread  const calls from any number of threads at once
class NeighbourIndex {
public:
    /// \param positions  finite [m], at least one; copied, so the caller's array need not live on
    explicit NeighbourIndex(std::span<const glm::dvec3> positions);
    ~NeighbourIndex();
    NeighbourIndex(NeighbourIndex&&) noexcept;
    NeighbourIndex& operator=(NeighbourIndex&&) noexcept;

    /// Replaces `found` by the points within `radius` [m] of `centre` [m], distance <= radius; infinity is legal.
    /// The order is fixed for a given cloud and version of Embree, but otherwise unspecified: near points do not come
    /// first. Allocates only if the capacity of `found` does not suffice.
    void gather(const glm::dvec3& centre, double radius, std::vector<std::uint32_t>& found) const;

    /// Returns the same, for callers that can afford an allocation.
    [[nodiscard]] std::vector<std::uint32_t> gather(const glm::dvec3& centre, double radius) const;

    /// Returns the k nearest points (fewer if the cloud is smaller), nearest first; equal distances by rising index.
    [[nodiscard]] std::vector<Neighbour> nearest(const glm::dvec3& centre, std::size_t k) const;

    [[nodiscard]] std::size_t size() const noexcept;

    // What is asked about every point is asked along the curve, where neighbours follow each other: what one search
    // reads is then in the cache for the next. A point's number along it is its rank.

    [[nodiscard]] std::vector<std::uint32_t>  pointsByRank() const;             ///< which point has each rank
    [[nodiscard]] std::span<const glm::dvec3> positionsByRank() const noexcept; ///< [m]; lives as long as the index

    /// Returns the ranks at which the points of another cube begin, and the number of points: those of a cube follow
    /// each other. A stray far from all others has a cube of its own.
    /// \param side  [m] about that of the cubes, which is a power of two times that of the finest, to a factor of 1.42
    [[nodiscard]] std::vector<std::uint32_t> cubes(double side) const;

    /// Does what gather() does, with ranks in place of points, in rising order: what is read of hundreds of thousands of
    /// points then comes from memory in order too, and what is taken of some of them hangs on no tree.
    void gatherRanks(const glm::dvec3& centre, double radius, std::vector<std::uint32_t>& found) const;

    /// Does the same if there are no more than `most`; else the time does not grow with how many there are.
    /// \return  whether `found` is all of them; false also where they lie in more than a quarter as many blocks
    [[nodiscard]] bool gatherRanks(const glm::dvec3& centre, double radius, std::size_t most,
                                   std::vector<std::uint32_t>& found) const;

    /// Replaces `points` by those that have the ranks.
    void pointsOf(std::span<const std::uint32_t> ranks, std::vector<std::uint32_t>& points) const;

    /// Returns the mean distance between points of the surface, 1/sqrt(points per square metre) [m]: the median over up
    /// to 2000 points, spread evenly, of d6 sqrt(pi/6), d6 the distance to the sixth neighbour. Computed once, at
    /// construction. 0 if the cloud has fewer than seven points or most of them coincide.
    [[nodiscard]] double spacing() const noexcept;

private:
    [[nodiscard]] double medianSixthDistance() const; ///< [m]

    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
