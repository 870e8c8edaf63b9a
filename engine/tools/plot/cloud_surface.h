#pragma once
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Maps the world to a picture by parallel projection.
struct CloudCamera {
    int        width  = 0;         ///< [px]
    int        height = 0;         ///< [px]
    glm::dvec3 centre{0};          ///< shown in the middle [m, world]
    glm::dvec3 right{1, 0, 0};     ///< unit, to the right of the picture
    glm::dvec3 up{0, 1, 0};        ///< unit, up in the picture
    glm::dvec3 toEye{0, 0, 1};     ///< unit, out of the picture
    double     pixelsPerMetre = 1; ///< [px/m]

    struct Pixel {
        double x = 0, y = 0; ///< y down [px]
        double depth = 0;    ///< away from the eye, 0 at the centre [px]
    };
    /// \return nullopt for a point that is not finite or far outside the picture
    [[nodiscard]] std::optional<Pixel> project(const glm::dvec3& point) const;
};

/// What the camera sees of a cloud, one record per pixel.
struct CloudSurface {
    struct Sample {
        float     coverage = 0;    ///< 0 nothing to 1 surface [1]
        float     depth    = 0;    ///< as CloudCamera::Pixel [px]
        glm::vec3 normal{0, 0, 1}; ///< unit, in axes right, up, toEye
        float     value   = 0;     ///< mean of the points around that have a value
        bool      defined = false; ///< most points around have a value
    };
    int                 width   = 0; ///< [px]
    int                 height  = 0; ///< [px]
    double              spacing = 0; ///< typical distance of neighbouring points [px]
    std::vector<Sample> samples;     ///< row by row

    [[nodiscard]] const Sample& at(int x, int y) const
    {
        return samples[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
};

/// Draws a cloud as a closed surface. Every point is a round splat as wide as a few times the spacing around it (which
/// is estimated on the screen). Discs decide what is in front; their cover is pulled back from its edges, so that an
/// object ends where its points end. Around that front a plane is fitted per pixel to the depths of the splats by
/// weighted least squares: the surface is smooth and has a normal.
///
/// Two surfaces less than some ten spacings apart in depth melt into each other at the edge of the nearer one, and
/// where sparse points lie beside denser ones that hide them, gaps may show. Memory is bounded by the picture, time by
/// the picture and the number of points.
///
/// \param values  empty, or one per point; NaN is "no value"
/// \source the idea of averaging overlapping splats: Zwicker et al. 2001, "Surface splatting"
[[nodiscard]] CloudSurface cloudSurface(std::span<const glm::dvec3> positions, std::span<const double> values,
                                        const CloudCamera& camera);

} // namespace palp
