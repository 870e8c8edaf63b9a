#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <glm/vec3.hpp>

/// Points of sheets and balls. All lengths here are in mean spacings.
namespace palp::cloudtest {

inline constexpr double kHalf = 40; ///< half the side of a sheet

using Points = std::vector<glm::dvec3>;

enum class Layout { lattice, random };

/// Places of a sheet: a lattice shifted by the seed, or as many random ones.
class Sheet {
public:
    Sheet(Layout layout, std::uint64_t seed) : layout_(layout), random_(seed) {}

    /// Points at (x, y) for the rectangle; about one per square spacing.
    Points over(double x0, double x1, double y0, double y1)
    {
        std::uniform_real_distribution<> unit(0, 1);
        Points                           points;
        if (layout_ == Layout::random) {
            const int count = int(std::lround((x1 - x0) * (y1 - y0)));
            for (int i = 0; i < count; ++i) {
                const double x = x0 + (x1 - x0) * unit(random_);
                points.emplace_back(x, y0 + (y1 - y0) * unit(random_), 0);
            }
            return points;
        }
        const double dx = unit(random_), dy = unit(random_);
        for (double x = x0 + dx; x < x1; ++x)
            for (double y = y0 + dy; y < y1; ++y) points.emplace_back(x, y, 0);
        return points;
    }
    Points whole() { return over(-kHalf, kHalf, -kHalf, kHalf); }

    [[nodiscard]] std::mt19937_64& random() noexcept { return random_; }

private:
    Layout          layout_;
    std::mt19937_64 random_;
};

inline void addNoise(Points& points, double deviation, std::mt19937_64& random)
{
    std::normal_distribution<> normal(0, deviation);
    for (glm::dvec3& p : points) p.z += normal(random);
}

inline void append(Points& points, const Points& more, const glm::dvec3& shift = glm::dvec3(0))
{
    for (const glm::dvec3& p : more) points.push_back(p + shift);
}

inline void cutHole(Points& points, double radius)
{
    std::erase_if(points, [=](const glm::dvec3& p) { return std::hypot(p.x, p.y) < radius; });
}

/// Ball about (0, 0, -radius), the pole at the origin; `cap` [rad] of it. The lattice is a spiral.
inline Points ball(Layout layout, double radius, double cap, std::uint64_t seed)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> unit(0, 1);
    const double                     low    = std::cos(cap);
    const int                        count  = int(std::lround(2 * std::numbers::pi * radius * radius * (1 - low)));
    const double                     golden = std::numbers::pi * (3 - std::sqrt(5.0));
    const double                     turn   = unit(random);
    Points                           points;
    for (int i = 0; i < count; ++i) {
        const bool   lattice = layout == Layout::lattice;
        const double c       = 1 - (1 - low) * (lattice ? (i + 0.5) / count : unit(random));
        const double angle   = lattice ? turn + golden * i : 2 * std::numbers::pi * unit(random);
        const double r       = std::sqrt(std::max(0.0, 1 - c * c));
        points.push_back(radius * glm::dvec3(r * std::cos(angle), r * std::sin(angle), c - 1));
    }
    return points;
}

} // namespace palp::cloudtest
