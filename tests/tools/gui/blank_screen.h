#pragma once
#include "engine/tools/gui/screen.h"

namespace palp {

/// A screen without pixels: whoever is derived from it says what showing does.
class BlankScreen : public Screen {
public:
    void  present() override {}
    void  takePanels() override {}
    Image draw(const ViewScene&, const Camera&, const PictureSize& size, const Overlay*) override
    {
        return Image(size.width, size.height, {});
    }
    [[nodiscard]] const compute::Processor& processor() const noexcept override { return processor_; }

private:
    compute::Processor processor_{};
};

} // namespace palp
