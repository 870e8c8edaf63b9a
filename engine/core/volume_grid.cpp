#include "engine/core/volume_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/contract.h"
#include "engine/core/detail/nifti_file.h"
#include "engine/core/detail/volume_values.h"
#include "engine/core/file.h"
#include "engine/core/npy.h"

namespace palp {
namespace {

/// Share of a step by which a place may lie beyond the outermost nodes [1]: places and grid come of different programs,
/// and rounding to floats moves a place of 1 m by 1e-7 m.
constexpr double kRim = 1e-3;

VolumeGrid parseNpyGrid(std::istream& in, std::uint64_t size, const std::string& name, const VolumeSettings& settings)
{
    if (!settings.lengthUnit.empty())
        throw Error(name + ": \"length_unit\" is for NIfTI files; state origin and spacing of a .npy file in metres");
    if (!settings.spacing)
        throw Error(name + ": expected \"spacing\" in the law, the metres between two values along each axis, found "
                           "none; a .npy file does not state it");
    std::optional<VolumeValues> values;
    readNpyVolume(in, size, name,
                  {[&](const std::array<int, 3>& shape, bool firstIsFastest) {
                       values.emplace(name, shape, firstIsFastest, settings.factor);
                   },
                   [&](std::span<const double> some) {
                       for (const double value : some) values->add(value);
                   }});
    const glm::dvec3 spacing = *settings.spacing;
    glm::dmat3       toWorld(0);
    for (int k = 0; k < 3; ++k) toWorld[k][k] = spacing[k];
    return {values->size(), values->take(), toWorld, settings.origin.value_or(glm::dvec3(0))};
}

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

} // namespace

VolumeGrid::VolumeGrid(const std::array<int, 3>& size, std::vector<float> values, const glm::dmat3& toWorld,
                       const glm::dvec3& origin)
    : size_(size), values_(std::move(values)), toWorld_(toWorld), fromWorld_(glm::inverse(toWorld)), origin_(origin),
      step_(std::min({glm::length(toWorld[0]), glm::length(toWorld[1]), glm::length(toWorld[2])}))
{
    PALP_EXPECT(std::min({size[0], size[1], size[2]}) >= 2, "a volume has two nodes along each axis or more");
    PALP_EXPECT(values_.size() == indexOf(0, 0, size[2]), "a volume has a value for each node");
}

VolumeGrid::Value VolumeGrid::at(const glm::dvec3& place) const noexcept
{
    const glm::dvec3   voxel = fromWorld_ * (place - origin_);
    std::array<int, 3> low{};
    glm::dvec3         share(0);
    for (int k = 0; k < 3; ++k) {
        const double last = size_[std::size_t(k)] - 1;
        if (!(voxel[k] >= -kRim && voxel[k] <= last + kRim)) return {}; // NaN fails every comparison
        const double inside = std::clamp(voxel[k], 0.0, last);
        low[std::size_t(k)] = std::min(int(inside), int(last) - 1);
        share[k]            = inside - low[std::size_t(k)];
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double             weight = 1;
        std::array<int, 3> node   = low;
        for (int k = 0; k < 3; ++k) {
            const bool high = (corner >> k & 1) != 0;
            weight *= high ? share[k] : 1 - share[k];
            node[std::size_t(k)] += high ? 1 : 0;
        }
        if (weight == 0) continue;
        const double value = values_[indexOf(node[0], node[1], node[2])];
        if (value == 0) return {At::unknown, 0, node};
        sum += weight * std::log(value);
    }
    return {At::inside, std::exp(sum), {}};
}

namespace {

/// Gives each gap the nearest value before it, those at the beginning the first one.
void fillGaps(std::vector<double>& values)
{
    double last = *std::ranges::find_if(values, [](double value) { return value > 0; });
    for (double& value : values) last = value = value > 0 ? value : last;
}

/// Returns the modulus that bends like layers of equal thickness.
double bendingModulus(const std::vector<double>& layers)
{
    const double thick = 1 / double(layers.size()); // [depths]
    double       sum = 0, first = 0, inertia = 0;
    for (std::size_t n = 0; n < layers.size(); ++n) {
        sum += layers[n];
        first += layers[n] * (double(n) + 0.5) * thick;
    }
    for (std::size_t n = 0; n < layers.size(); ++n) {
        const double away = (double(n) + 0.5) * thick - first / sum;
        inertia += layers[n] * thick * (away * away + thick * thick / 12);
    }
    return 12 * inertia;
}

} // namespace

VolumeGrid::Sheet VolumeGrid::sheetAlong(const glm::dvec3& place, const glm::dvec3& inward, double depth) const
{
    // A quarter of a voxel each: a contrast of 10 between voxels is then right to 1 %. Thin sheets need as many for
    // their own sake; a sheet of a thousand voxels is none.
    constexpr double    kPerVoxel = 4, kLeastLayers = 16, kMostLayers = 1000;
    const double        layers = std::clamp(std::ceil(kPerVoxel * depth / step_), kLeastLayers, kMostLayers);
    std::vector<double> values;
    double              found = 0;
    for (double n = 0.5; n < layers; ++n) {
        const Value value = at(place + n / layers * depth * inward);
        values.push_back(value.at == At::inside ? value.value : 0);
        found += value.at == At::inside;
    }
    if (found == 0) return {at(place), 0};
    fillGaps(values);
    return {{At::inside, bendingModulus(values), {}}, found / layers};
}

glm::dvec3 VolumeGrid::placeOf(double i, double j, double k) const noexcept
{
    return toWorld_ * glm::dvec3(i, j, k) + origin_;
}

std::string VolumeGrid::extent() const
{
    glm::dvec3 low = origin_, high = origin_;
    for (int corner = 1; corner < 8; ++corner) {
        const glm::dvec3 p =
            placeOf((corner & 1) * (size_[0] - 1), (corner >> 1 & 1) * (size_[1] - 1), (corner >> 2) * (size_[2] - 1));
        low  = glm::min(low, p);
        high = glm::max(high, p);
    }
    std::string text;
    for (int k = 0; k < 3; ++k)
        text += std::string(k ? ", " : "") + "xyz"[k] + " " + number(low[k]) + " to " + number(high[k]);
    return text + " m";
}

VolumeGrid parseVolume(std::istream& in, std::uint64_t size, const std::string& name, VolumeFormat format,
                       const VolumeSettings& settings)
{
    if (format == VolumeFormat::npy) return parseNpyGrid(in, size, name, settings);
    if (settings.origin || settings.spacing)
        throw Error(name + ": \"origin\" and \"spacing\" are for .npy files; a NIfTI file states its own place");
    return parseNifti(in, size, name, settings);
}

VolumeGrid readVolume(const std::filesystem::path& path, const VolumeSettings& settings)
{
    const std::string file    = path.filename().string();
    const bool        isNpy   = file.ends_with(".npy");
    const bool        isNifti = file.ends_with(".nii") || file.ends_with(".nii.gz");
    if (!isNpy && !isNifti)
        throw Error(path.string() + ": expected a volume in a file .npy, .nii or .nii.gz, found \"" + file +
                    "\"; nibabel (Python) and 3D Slicer convert others to .nii.gz");
    InputFile           in   = openRegularFile(path);
    const std::uint64_t size = sizeOfFile(path);
    return parseVolume(in, size, path.string(), isNpy ? VolumeFormat::npy : VolumeFormat::nifti, settings);
}

} // namespace palp
