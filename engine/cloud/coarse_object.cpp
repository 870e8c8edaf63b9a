#include "engine/cloud/coarse_object.h"

#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/parallel.h"

namespace palp {
namespace {

constexpr std::size_t kPiece = 4096; ///< least coarse points of a thread

} // namespace

/// The points by cubes, and what they have in common.
struct CoarseObject::Cubes {
    std::vector<std::uint32_t> members, begins;
    std::vector<glm::dvec3>    positions; ///< [m]
    std::vector<glm::vec3>     normals;   ///< [1] where a side is known, else 0

    Cubes(const SoftObject& dense, double side)
    {
        const std::vector<std::uint32_t> points = dense.index().pointsByRank();
        const std::vector<std::uint32_t> edges  = dense.index().cubes(side);
        members.reserve(points.size());
        for (std::size_t cube = 0; cube + 1 < edges.size(); ++cube)
            addCube(dense, std::span(points).subspan(edges[cube], edges[cube + 1] - edges[cube]));
        begins.push_back(std::uint32_t(members.size()));
    }

private:
    /// Adds a coarse point for the points of a cube that face the same way as the first, and one for those that face
    /// away.
    void addCube(const SoftObject& dense, std::span<const std::uint32_t> cube)
    {
        const SurfaceSurvey& survey = dense.survey();
        for (const bool side : {false, true}) {
            const auto begin = std::uint32_t(members.size());
            glm::dvec3 sum{}, normal{};
            for (const std::uint32_t point : cube) {
                if (survey.apart(cube.front(), point) != side) continue;
                members.push_back(point);
                sum += dense.positions()[point] - dense.positions()[cube.front()]; // small numbers: no digits are lost
                if (survey.sided(point)) normal += survey.normal(point);
            }
            if (members.size() == begin) continue;
            const double length = glm::length(normal);
            begins.push_back(begin);
            positions.push_back(dense.positions()[cube.front()] + sum / double(members.size() - begin));
            normals.push_back(length > 0 ? glm::vec3(normal / length) : glm::vec3(0));
        }
    }
};

CoarseObject::CoarseObject(const SoftObject& dense, double side) : CoarseObject(dense, side, Cubes(dense, side)) {}

CoarseObject::CoarseObject(const SoftObject& dense, double side, Cubes cubes)
    : side_(side), members_(std::make_shared<const std::vector<std::uint32_t>>(std::move(cubes.members))),
      begins_(std::make_shared<const std::vector<std::uint32_t>>(std::move(cubes.begins))),
      object_(
          SoftObject(PointCloud(std::move(cubes.positions), meansOf(dense.cloud().stiffness()), dense.cloud().kind()),
                     dense.material(), {}, cubes.normals)
              .withFoundation(meansOf(dense.foundationShape()))
              .withStiffening(meansOf(dense.stiffening(), false))
              .withHeld(meansOf(dense.held(), false)))
{
}

CoarseObject::CoarseObject(const CoarseObject& shape, const SoftObject& dense)
    : side_(shape.side_), members_(shape.members_), begins_(shape.begins_),
      object_(shape.object_.repainted(meansOf(dense.cloud().stiffness()))
                  .withMaterial(dense.material())
                  .withFoundation(meansOf(dense.foundationShape()))
                  .withStiffening(meansOf(dense.stiffening(), false))
                  .withHeld(meansOf(dense.held(), false)))
{
}

std::vector<double> CoarseObject::meansOf(std::span<const double> values, bool byLogarithm) const
{
    if (values.empty()) return {};
    std::vector<double> means(begins_->size() - 1);
    inParallel(means.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            double sum = 0;
            for (const std::uint32_t point : membersOf(k)) sum += byLogarithm ? std::log(values[point]) : values[point];
            const double mean = sum / double(membersOf(k).size());
            means[k]          = byLogarithm ? std::exp(mean) : mean;
        }
    });
    return means;
}

} // namespace palp
