#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// What a file of a volume does not state, or should not.
struct VolumeSettings {
    std::optional<glm::dvec3> origin{};     ///< of a .npy file: the middle of its first voxel [m]; empty: 0
    std::optional<glm::dvec3> spacing{};    ///< of a .npy file: between voxels along each axis [m], needed
    std::string               lengthUnit{}; ///< of a NIfTI file, such as "mm"; empty: as it states itself
    double                    factor = 1;   ///< on every value, > 0: 1e3 for a file in kPa
};

/// Positive values at the nodes of a regular grid in space, as an elastogram has them. Zero is "nothing was measured".
///
/// Invariant: at least two values along each axis, all finite and none negative.
/// \thread immutable, so free to share
class VolumeGrid {
public:
    /// \param values  as many as `size` says, the first axis fastest
    /// \param toWorld  from the numbers of a node to its place [m]; not singular
    VolumeGrid(const std::array<int, 3>& size, std::vector<float> values, const glm::dmat3& toWorld,
               const glm::dvec3& origin);

    enum class At {
        inside,  ///< has a value
        outside, ///< beyond the outermost nodes
        unknown  ///< a node that would count has zero
    };
    struct Value {
        At                 at    = At::outside;
        double             value = 0; ///< > 0 inside
        std::array<int, 3> node{};    ///< the first with zero, where the value is unknown
    };

    /// Returns the value at a place, linear in the logarithm between the eight nodes around it; it is exact of what
    /// grows by equal factors along a line.
    [[nodiscard]] Value at(const glm::dvec3& place) const noexcept;

    /// A sheet that is cut out of the volume.
    struct Sheet {
        Value  value;     ///< of a homogeneous sheet that bends alike; as at() has it where none of the way has a value
        double share = 0; ///< of the way that has a value [1]
    };

    /// Returns the modulus of a homogeneous sheet that bends as the layers along a way do:
    /// 12/h^3 int E(t) (t - t0)^2 dt, where t0 = int E t dt / int E dt is the neutral axis.
    ///
    /// For a plate it is exact: D = E h^3 / (12 (1 - nu^2)) is then that of the layers. Outer layers count for more
    /// than inner ones, so no mean of the values alone is right: a hard skin on half the depth of a sheet that is soft
    /// by contrast makes it bend like 1/8 of the skin, where the arithmetic mean says 1/2 and the geometric one almost
    /// 0. A place on the way without a value has that of the nearest one before it, else after it.
    /// \param inward  of unit length: against the outward normal
    /// \param depth   h, > 0 [m]
    /// \source Timoshenko & Woinowsky-Krieger 1959, "Theory of Plates and Shells", section 3, for layers of one nu
    [[nodiscard]] Sheet sheetAlong(const glm::dvec3& place, const glm::dvec3& inward, double depth) const;

    [[nodiscard]] const std::array<int, 3>& size() const noexcept { return size_; }
    [[nodiscard]] float      node(int i, int j, int k) const noexcept { return values_[indexOf(i, j, k)]; }
    [[nodiscard]] glm::dvec3 placeOf(double i, double j, double k) const noexcept; ///< [m]

    /// Returns the box that holds the grid, for messages: "x 0 to 0.1, y 0 to 0.2, z 0 to 0.05 m".
    [[nodiscard]] std::string extent() const;

private:
    [[nodiscard]] std::size_t indexOf(int i, int j, int k) const noexcept
    {
        return std::size_t(i) + std::size_t(size_[0]) * (std::size_t(j) + std::size_t(size_[1]) * std::size_t(k));
    }

    std::array<int, 3> size_;
    std::vector<float> values_;
    glm::dmat3         toWorld_, fromWorld_;
    glm::dvec3         origin_; ///< [m]
    double             step_;   ///< shortest way between two nodes [m]
};

/// Reads a volume: .npy (three dimensions), or NIfTI-1 as .nii or .nii.gz, either byte order, with its sform, else its
/// qform, else its voxels' sizes alone.
/// \throws Error naming the file, the byte, what was expected and found; a value that is NaN, infinite or negative by
///         its index; a file without a unit of length, and a setting that is not for its format
[[nodiscard]] VolumeGrid readVolume(const std::filesystem::path& path, const VolumeSettings& settings = {});

enum class VolumeFormat { npy, nifti };

/// Does the same from a stream of `size` bytes; a NIfTI file may be compressed by gzip.
[[nodiscard]] VolumeGrid parseVolume(std::istream& in, std::uint64_t size, const std::string& name, VolumeFormat format,
                                     const VolumeSettings& settings = {});

} // namespace palp
