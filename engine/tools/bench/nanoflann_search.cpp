#include "engine/tools/bench/nanoflann_search.h"

#include <array>

#include <nanoflann.hpp>

namespace palp::bench {
namespace {

template <int kDimensions>
struct Floats {
    std::vector<std::array<float, kDimensions>> points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float       kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};

template <int kDimensions>
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Floats<kDimensions>>,
                                                 Floats<kDimensions>, kDimensions, std::uint32_t>;

Floats<3> floatsOf(std::span<const glm::dvec3> points)
{
    Floats<3> floats;
    for (const glm::dvec3& p : points) floats.points.push_back({float(p.x), float(p.y), float(p.z)});
    return floats;
}

class NanoflannSearch final : public RadiusSearch {
public:
    NanoflannSearch(std::span<const glm::dvec3> points, std::size_t leaf)
        : floats_(floatsOf(points)), tree_(3, floats_, nanoflann::KDTreeSingleIndexAdaptorParams(leaf))
    {
    }

    void gather(const glm::dvec3& c, double radius, std::vector<std::pair<std::uint32_t, float>>& found) const override
    {
        const float place[]{float(c.x), float(c.y), float(c.z)};
        const float radius2 = float(radius * radius); // nanoflann's distances are squared
        tree_.radiusSearch(place, radius2, found, nanoflann::SearchParams(0, 0, false));
    }

    void nearest(const glm::dvec3& c, std::span<std::uint32_t> found) const override
    {
        const float                     place[]{float(c.x), float(c.y), float(c.z)};
        thread_local std::vector<float> distance2;
        distance2.resize(found.size());
        tree_.knnSearch(place, found.size(), found.data(), distance2.data());
    }

private:
    Floats<3> floats_;
    Tree<3>   tree_;
};

} // namespace

std::unique_ptr<RadiusSearch> nanoflannSearch(std::span<const glm::dvec3> points, std::size_t leaf)
{
    return std::make_unique<NanoflannSearch>(points, leaf);
}

std::vector<std::uint32_t> nanoflannMap(const PlateGrid& grid, const ChartPoint& origin,
                                        std::span<const ChartPoint> points, std::size_t leaf)
{
    Floats<2> floats;
    for (const ChartPoint& p : points) floats.points.push_back({float(p.x), float(p.z)});
    const Tree<2>              tree(2, floats, nanoflann::KDTreeSingleIndexAdaptorParams(leaf));
    std::vector<std::uint32_t> nearest(grid.nodes());
    std::size_t                node = 0;
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) {
            const float place[]{float(origin.x + i * grid.spacingX), float(origin.z + j * grid.spacingZ)};
            float       distance2 = 0;
            tree.knnSearch(place, 1, &nearest[node++], &distance2);
        }
    return nearest;
}

} // namespace palp::bench
