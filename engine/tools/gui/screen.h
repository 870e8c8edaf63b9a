#pragma once
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/surface_renderer.h"

namespace palp {

/// The target of a workbench's pictures. Its functions have the names and meanings of SurfaceRenderer's.
/// \thread one
class Screen {
public:
    Screen()                         = default;
    Screen(const Screen&)            = delete;
    Screen& operator=(const Screen&) = delete;
    virtual ~Screen()                = default;

    virtual bool  show(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) = 0;
    virtual void  present()                                                                 = 0;
    virtual void  takePanels()                                                              = 0;
    virtual Image draw(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) = 0;

    [[nodiscard]] virtual const compute::Processor& processor() const noexcept = 0;
};

/// The screen of a window, through a renderer that was made with the window and outlives this.
class WindowScreen final : public Screen {
public:
    explicit WindowScreen(SurfaceRenderer& renderer) : renderer_(renderer) {}

    bool show(const ViewScene& scene, const Camera& camera, const PictureSize& size, const Overlay* overlay) override
    {
        return renderer_.show(scene, camera, size, overlay);
    }
    void  present() override { renderer_.present(); }
    void  takePanels() override { renderer_.takePanels(); }
    Image draw(const ViewScene& scene, const Camera& camera, const PictureSize& size, const Overlay* overlay) override
    {
        return renderer_.draw(scene, camera, size, overlay);
    }
    [[nodiscard]] const compute::Processor& processor() const noexcept override { return renderer_.processor(); }

private:
    SurfaceRenderer& renderer_;
};

} // namespace palp
