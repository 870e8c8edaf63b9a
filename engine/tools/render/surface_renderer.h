#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/compute/context.h"
#include "engine/tools/plot/png.h"
#include "engine/tools/render/camera.h"
#include "engine/tools/render/view_scene.h"

namespace palp {

enum class Detail {
    fine, ///< means over discs, lit pixel by pixel
    fast  ///< discs as they are, lit one by one: for pictures that move where a driver draws in software
};

/// The size of a picture, and how finely it is drawn.
struct PictureSize {
    int    width  = 1280; ///< [px]
    int    height = 720;  ///< [px]
    int    finer  = 1;    ///< factor by which it is drawn larger and then averaged, for smooth edges of stills
    Detail detail = Detail::fine;
};

struct Overlay;

/// A renderer's access to the window that it shows pictures in, without a type of Vulkan.
struct WindowLink {
    std::vector<std::string>            extensions;  ///< of Vulkan, that its desktop needs
    std::function<std::uint64_t(void*)> makeSurface; ///< from Vulkan's instance to a surface of the window; may throw
};

/// Draws scenes, with or without a window, on a Vulkan processor of its own: a picture never delays a solve.
///
/// Points become round discs in their tangent planes that melt into a closed, lit surface; hollows are darker and humps
/// lighter, so that a slight dent shows. Shapes behind the surface shine through. On lavapipe the same scene gives the
/// same bytes every time.
/// \thread one
class SurfaceRenderer {
public:
    /// \param settings  of the processor; their purpose is always drawing
    /// \throws compute::ProcessorError if no processor can draw, compute::UnknownProcessor for a wrong name
    explicit SurfaceRenderer(compute::ContextSettings settings = {});
    /// Makes a renderer that shows pictures in a window too.
    /// \throws as above, and what makeSurface throws
    SurfaceRenderer(compute::ContextSettings settings, const WindowLink& window);
    ~SurfaceRenderer();
    SurfaceRenderer(SurfaceRenderer&&) noexcept;
    SurfaceRenderer& operator=(SurfaceRenderer&&) noexcept;

    /// Draws the scene, without texts unless an overlay has them; see annotate().
    /// \pre sides from 1 px, as many normals and radii as positions, everything finite
    /// \throws Error if the processor cannot draw that large, compute::ProcessorLost
    [[nodiscard]] Image draw(const ViewScene& scene, const Camera& camera, const PictureSize& size,
                             const Overlay* overlay = nullptr);

    /// Does the same in the window: begins to draw, and shows the picture that was begun before. So the host is free
    /// while a picture is drawn, and the visible picture is one picture old; present() shows the last.
    /// \pre made with a window
    /// \param size  of the window; `finer` must be 1
    /// \return false if nothing can be shown now, as in a minimised window
    bool show(const ViewScene& scene, const Camera& camera, const PictureSize& size, const Overlay* overlay = nullptr);

    /// Shows in the window the picture that show() began, once it is done; does nothing if none was begun.
    void present();

    /// Takes the result of ImGui::Render() and lays it over every picture of the size that ImGui knows, until the next
    /// call or a picture of another size.
    /// \pre there is a current ImGui context, which outlives this
    /// \throws Error in a build without Dear ImGui
    void takePanels();

    [[nodiscard]] const compute::Processor& processor() const noexcept;
    [[nodiscard]] const std::string&        note() const noexcept; ///< see compute::Context::note()
    /// Returns the validation layer's messages since the last call.
    [[nodiscard]] std::vector<std::string> takeMessages();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
