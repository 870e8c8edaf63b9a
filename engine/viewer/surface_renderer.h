#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/context.h"
#include "engine/picture/png.h"
#include "engine/viewer/camera.h"
#include "engine/viewer/view_scene.h"

namespace palp {

enum class Detail {
    fine, ///< means over discs, lit pixel by pixel
    fast  ///< discs as they are, lit one by one: for pictures that move where a driver draws in software
};

/// The size of a picture, and how finely it is drawn.
struct PictureSize {
    int    width  = 1280; ///< [px]
    int    height = 720;  ///< [px]
    int    finer  = 1;    ///< drawn so many times larger and then averaged: smooth edges for stills [1]
    Detail detail = Detail::fine;
};

/// Draws scenes without a window, on a Vulkan device of its own: a picture never delays a solve.
///
/// Points become round discs in their tangent planes that melt into a closed, lit surface; hollows are darker and humps
/// lighter, so that a slight dent shows. Shapes behind the surface shine through. On lavapipe the same scene gives the
/// same bytes every time. \thread one
class SurfaceRenderer {
public:
    /// \param settings  the purpose is drawing, whatever they say
    /// \throws gpu::DeviceError if no device can draw, gpu::UnknownDevice for a wrong name
    explicit SurfaceRenderer(gpu::ContextSettings settings = {});
    ~SurfaceRenderer();
    SurfaceRenderer(SurfaceRenderer&&) noexcept;
    SurfaceRenderer& operator=(SurfaceRenderer&&) noexcept;

    /// The scene without texts; see annotated().
    /// \pre sides from 1 px, as many normals and radii as positions, everything finite
    /// \throws Error if the device cannot draw that large, gpu::DeviceLost
    [[nodiscard]] Image draw(const ViewScene& scene, const Camera& camera, const PictureSize& size);

    [[nodiscard]] const gpu::DeviceDescription& device() const noexcept;
    [[nodiscard]] const std::string&            note() const noexcept; ///< see gpu::Context::note()
    /// Of the validation layer, since the last call.
    [[nodiscard]] std::vector<std::string> takeMessages();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
