#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace palp {

enum class Projection { perspective, orthographic };

/// The eye of a picture. A plain value: every motion returns a new one.
///
/// Invariant: toEye and up are unit vectors that are not parallel; distance > 0.
struct Camera {
    glm::dvec3 target{};       ///< point that the camera turns about, seen at `centre` [m]
    glm::dvec3 toEye{0, 0, 1}; ///< from the target to the eye [1]
    glm::dvec3 up{0, 1, 0};    ///< stays upright in the picture as the camera turns [1]
    double     distance   = 1; ///< of the eye from the target [m]
    Projection projection = Projection::perspective;
    /// The target's place in the picture, from its middle to the right and upwards, in halves of its height [1].
    /// Not zero where something covers a part of the picture.
    glm::dvec2 centre{};

    [[nodiscard]] glm::dvec3 right() const;   ///< to the right of the picture [1]
    [[nodiscard]] glm::dvec3 upwards() const; ///< upwards in the picture [1]
    [[nodiscard]] glm::dvec3 middle() const;  ///< point in the middle of the picture, as far off as the target [m]
    [[nodiscard]] glm::dvec3 eye() const;     ///< in front of it [m]

    /// Returns half of the visible height at the target [m], which is the same for both projections.
    [[nodiscard]] double halfHeight() const;
};

/// Field of view of a perspective camera, from the lower to the upper edge [rad]: narrow, to distort shapes little.
inline constexpr double kFieldOfView = 0.52;

/// Turns about the target like a turntable: first about `up`, then about the picture's horizontal.
/// \param angles  to the right and upwards [rad]; the eye stays a little off the poles
[[nodiscard]] Camera orbited(const Camera& camera, const glm::dvec2& angles);

/// Moves eye and target in the plane of the picture, so that a point at the target moves by `share` of half the
/// picture's height, to the right and upwards [1].
[[nodiscard]] Camera panned(const Camera& camera, const glm::dvec2& share);

/// Moves the eye nearer or farther.
/// \param factor  on the distance, > 0 [1]
[[nodiscard]] Camera dollied(const Camera& camera, double factor);

/// Fits the whole of a ball into the picture, with a little room around it.
/// \param radius  > 0 [m]
/// \param aspect  width over height of the picture; of a part of it about `centre`, its smaller side over that height
///                [1]
[[nodiscard]] Camera framed(const Camera& camera, const glm::dvec3& centre, double radius, double aspect);

/// Changes to the other projection; objects at the target keep their size.
[[nodiscard]] Camera otherProjection(const Camera& camera);

/// A camera's matrices for a picture, with lengths about a chosen origin (single precision does not reach far).
struct CameraMatrices {
    glm::dmat4 viewFromWorld{1}; ///< x right, y up, z to the eye [m]
    glm::dmat4 clipFromView{1};  ///< Vulkan's: y down, depth 0 to 1
    glm::dvec2 halfAtOne{1};     ///< half of what is seen at depth 1 m, or anywhere if orthographic [m]
};

/// Returns a camera's matrices.
/// \param origin  of the lengths that will be given [m]
/// \param reach   everything lies within so far of the target [m], > 0
/// \param aspect  width over height of the picture [1]
[[nodiscard]] CameraMatrices matricesOf(const Camera& camera, const glm::dvec3& origin, double reach, double aspect);

} // namespace palp
