#include "engine/tools/render/surface_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/tools/plot/colour_map.h"
#include "engine/tools/render/picture_change.h"
#include "engine/tools/render/view_shapes.h"
#include "engine/tools/render/vulkan_surface.h"

namespace palp {
namespace {

std::uint32_t packed(Rgb8 colour)
{
    return std::uint32_t(colour.red) | std::uint32_t(colour.green) << 8 | std::uint32_t(colour.blue) << 16 |
           0xFF000000U;
}

glm::vec3 light(Rgb8 colour)
{
    return glm::vec3(colour.red, colour.green, colour.blue) / 255.0F;
}

/// Colours of values, each looked up in a table: a live picture asks for thousands.
class Paintbox {
public:
    explicit Paintbox(const ViewColours& colours) : axis_(colours.range, colours.scale, colours.unit, 2)
    {
        for (int n = 0; n < kShades; ++n)
            shades_[std::size_t(n)] = packed(surfaceColour(n / (kShades - 1.0), colours.map));
    }
    [[nodiscard]] std::uint32_t of(double value) const
    {
        if (!drawable(value, axis_.scale())) return packed(kUndefinedColour);
        const double position = std::clamp(axis_.position(value), 0.0, 1.0);
        return shades_[std::size_t(std::lround(position * (kShades - 1)))];
    }

private:
    static constexpr int               kShades = 512;
    Axis                               axis_;
    std::array<std::uint32_t, kShades> shades_{};
};

/// \param alpha  0 to 1 [1]
std::uint32_t withAlpha(std::uint32_t colour, double alpha)
{
    return (colour & 0x00FFFFFFU) | std::uint32_t(std::lround(255 * std::clamp(alpha, 0.0, 1.0))) << 24;
}

void fillSplats(std::vector<shared::ViewSplat>& splats, const ViewScene& scene, const Camera& camera, Detail detail)
{
    const glm::dvec3&       origin = camera.target;
    std::optional<Paintbox> paint;
    splats.resize(scene.positions.size());
    if (!scene.values.empty()) paint.emplace(scene.colours);
    for (std::size_t n = 0; n < splats.size(); ++n) {
        const std::uint32_t colour = paint ? paint->of(scene.values[n]) : packed(kPlainColour);
        const glm::vec3     position(scene.positions[n] - origin), normal(scene.normals[n]);
        const float         side = !scene.oneSided.empty() && scene.oneSided[n] ? -1.0F : 1.0F;
        if (detail == Detail::fine)
            splats[n] = {position, side * float(scene.radii[n]), normal,
                         withAlpha(colour, scene.cores[n] / scene.radii[n])};
        else
            splats[n] = {position, side * float(scene.cores[n]), normal,
                         withAlpha(colour, scene.hollows.empty() ? 0.5 : 0.5 + shared::kHollow * scene.hollows[n])};
    }
    const glm::vec3 toEye(camera.toEye); // dots face it
    for (const ViewDot& dot : scene.dots)
        splats.push_back(
            {glm::vec3(dot.position - origin), float(dot.radius), toEye, withAlpha(packed(dot.colour), 0.5)});
}

std::vector<shared::ViewCorner> cornersOf(const std::vector<ShapeCorner>& shapes, const glm::dvec3& origin)
{
    std::vector<shared::ViewCorner> corners;
    for (const ShapeCorner& corner : shapes)
        corners.push_back({glm::vec3(corner.position - origin), packed(corner.colour), glm::vec3(corner.normal), 0});
    return corners;
}

/// Returns how far the drawn points reach from the target [m].
double reachOf(const ViewScene& scene, const std::vector<shared::ViewCorner>& shapes, const glm::dvec3& target)
{
    double reach = 1e-9;
    for (std::size_t n = 0; n < scene.positions.size(); ++n)
        reach = std::max(reach, glm::distance(scene.positions[n], target) + scene.radii[n]);
    for (const shared::ViewCorner& corner : shapes) reach = std::max(reach, double(glm::length(corner.position)));
    // In steps, because a change of the frame draws all of the picture; with room, because single precision must not
    // cut off the last point [1].
    constexpr double kRoom = 1.001, kStep = 1.25;
    return kRoom * std::pow(kStep, std::ceil(std::log(reach) / std::log(kStep)));
}

shared::ViewFrame frameOf(const ViewScene& scene, const Camera& camera, const PictureSize& size, double reach)
{
    constexpr float      kCueGain = 5.0F, kShine = 0.10F, kHidden = 0.45F;
    const CameraMatrices matrices = matricesOf(camera, camera.target, reach, double(size.width) / size.height);
    const bool           dark     = scene.ground == Ground::dark;
    shared::ViewFrame    frame;
    frame.viewFromWorld = glm::mat4(matrices.viewFromWorld);
    frame.clipFromView  = glm::mat4(matrices.clipFromView);
    frame.groundAbove   = light(dark ? Rgb8{38, 41, 46} : Rgb8{255, 255, 255});
    frame.groundBelow   = light(dark ? Rgb8{20, 22, 25} : Rgb8{226, 229, 233});
    frame.width         = float(size.width * size.finer);
    frame.height        = float(size.height * size.finer);
    frame.widthAtOne    = float(matrices.halfAtOne.x);
    frame.heightAtOne   = float(matrices.halfAtOne.y);
    frame.cueRadius     = float(scene.cueRadius);
    frame.cueGain       = scene.cueRadius > 0 ? kCueGain : 0;
    frame.even          = float(scene.evenLight);
    frame.shine         = kShine * (1 - frame.even);
    frame.hiddenShare   = kHidden;
    frame.orthographic  = camera.projection == Projection::orthographic;
    return frame;
}

/// Returns a bound of the sides of the squares in which a fast picture draws discs, see view_point.vert [px].
double largestSquare(const ViewScene& scene, const Camera& camera, const shared::ViewFrame& frame)
{
    constexpr double kMost   = 4; // of a disc's radius, seen aslant from near by [1]
    const bool       flat    = camera.projection == Projection::orthographic;
    const double     nearest = double(frame.clipFromView[3][2]) / double(frame.clipFromView[2][2]); // that is drawn [m]
    double           largest = 0;                                                                   // at depth 1 m [m]
    for (std::size_t n = 0; n < scene.positions.size(); ++n) {
        const double depth = flat ? 1 : glm::dot(camera.toEye, camera.eye() - scene.positions[n]);
        if (flat || depth >= nearest) largest = std::max(largest, scene.cores[n] / depth);
    }
    return kMost * largest * 0.5 * double(frame.width) / double(frame.widthAtOne);
}

/// Means over squares of `finer` pixels.
Image averaged(std::span<const std::uint8_t> pixels, const PictureSize& size, VkFormat format)
{
    const bool        blueFirst = format == VK_FORMAT_B8G8R8A8_UNORM;
    Image             image(size.width, size.height);
    const std::size_t row = std::size_t(4) * std::size_t(size.width) * std::size_t(size.finer);
    const unsigned    all = unsigned(size.finer * size.finer);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            std::array<unsigned, 3> sum{};
            for (int j = 0; j < size.finer; ++j)
                for (int i = 0; i < size.finer; ++i)
                    for (std::size_t k = 0; k < 3; ++k)
                        sum[k] +=
                            pixels[std::size_t(y * size.finer + j) * row + std::size_t(x * size.finer + i) * 4 + k];
            const auto mean = [&](std::size_t k) { return std::uint8_t((sum[k] + all / 2) / all); };
            image.at(x, y)  = {mean(blueFirst ? 2 : 0), mean(1), mean(blueFirst ? 0 : 2)};
        }
    return image;
}

void check(const ViewScene& scene, const PictureSize& size, const Overlay* overlay)
{
    const std::size_t points = scene.positions.size();
    PALP_EXPECT(size.width > 0 && size.height > 0 && size.finer > 0, "a picture has at least one pixel");
    PALP_EXPECT(scene.normals.size() == points && scene.radii.size() == points && scene.cores.size() == points &&
                    (scene.values.empty() || scene.values.size() == points) &&
                    (scene.hollows.empty() || scene.hollows.size() == points) &&
                    (scene.oneSided.empty() || scene.oneSided.size() == points),
                "every point has a normal, two radii and, if there are any, a value, a hollow and its sides");
    PALP_EXPECT(!overlay || (overlay->width == size.width * size.finer && overlay->height == size.height * size.finer),
                "an overlay has the size of the picture");
}

/// A scene as the passes take it, and the one before. The memory is kept from picture to picture.
class Drawable {
public:
    /// \param largestPoint  that the processor draws [px]; where discs are larger, also a fast picture is a fine one
    void make(const ViewScene& scene, const Camera& camera, const PictureSize& size, const Overlay* overlay,
              double largestPoint)
    {
        check(scene, size, overlay);
        std::swap(now_, before_);
        const std::vector<ShapeCorner> shapes = shapesOf(scene);
        now_.shapes                           = cornersOf(shapes, camera.target);
        now_.input.shining                    = std::size_t(std::ranges::count_if(shapes, &ShapeCorner::shinesThrough));
        now_.faces.clear();
        for (const Triangle& face : scene.faces) now_.faces.insert(now_.faces.end(), face.begin(), face.end());
        now_.input.frame  = frameOf(scene, camera, size, reachOf(scene, now_.shapes, camera.target));
        const bool cut    = scene.faces.empty() && largestSquare(scene, camera, now_.input.frame) > largestPoint;
        now_.input.detail = cut ? Detail::fine : size.detail;
        now_.input.dots   = scene.dots.size();
        fillSplats(now_.splats, scene, camera, now_.input.detail);
        now_.input.splats = now_.splats;
        now_.input.shapes = now_.shapes;
        now_.input.faces  = now_.faces;
        compare(overlay);
    }
    [[nodiscard]] const SurfaceInput& input() const { return now_.input; }

    /// The picture that was made has not been drawn.
    void forget() { drawn_ = false; }

private:
    struct Slot {
        std::vector<shared::ViewSplat>  splats;
        std::vector<shared::ViewCorner> shapes;
        std::vector<std::uint32_t>      faces;
        SurfaceInput                    input; ///< of the above
    };

    void compare(const Overlay* overlay)
    {
        static const Overlay nothing{};
        const Overlay&       texts = overlay ? *overlay : nothing;
        SurfaceInput&        input = now_.input;
        input.overlay              = overlay;
        input.changed              = drawn_ ? changedPart(before_.input, input) : std::nullopt;
        const bool      sameSize   = texts_.width == texts.width && texts_.height == texts.height;
        const PixelRect written    = sameSize ? changedPart(texts_, texts) : PixelRect{};
        input.sameOverlay          = drawn_ && sameSize && written.empty();
        if (!sameSize)
            input.changed.reset();
        else if (input.changed)
            input.changed = unionOf(*input.changed, written);
        if (!input.sameOverlay) texts_ = texts;
        drawn_ = true;
    }

    Slot    now_, before_;
    Overlay texts_; ///< of the picture made last
    bool    drawn_ = false;
};

} // namespace

struct SurfaceRenderer::Impl {
    explicit Impl(const compute::ContextSettings& settings) : context(settings) {}
    compute::Context             context;
    std::optional<VulkanWindow>  window;
    std::optional<VulkanSurface> surface;
    Drawable                     drawable; ///< keeps its memory from picture to picture

    void make(const ViewScene& scene, const Camera& camera, const PictureSize& size, const Overlay* overlay)
    {
        const auto& processor = static_cast<const compute::VulkanContext&>(context.handles());
        drawable.make(scene, camera, size, overlay, double(processor.native.pointSizeRange[1]));
    }
};

SurfaceRenderer::SurfaceRenderer(compute::ContextSettings settings)
{
    settings.purpose = compute::Purpose::draw;
    impl_            = std::make_unique<Impl>(settings);
    impl_->surface.emplace(impl_->context);
}

SurfaceRenderer::SurfaceRenderer(compute::ContextSettings settings, const WindowLink& window)
{
    settings.purpose          = compute::Purpose::show;
    settings.windowExtensions = window.extensions;
    impl_                     = std::make_unique<Impl>(settings);
    auto&      context        = static_cast<compute::VulkanContext&>(impl_->context.handles());
    const auto surface        = window.makeSurface(context.instance->get());
    impl_->window.emplace(context, reinterpret_cast<VkSurfaceKHR>(surface));
    impl_->surface.emplace(impl_->context, impl_->window->format());
}

SurfaceRenderer::~SurfaceRenderer()                                     = default;
SurfaceRenderer::SurfaceRenderer(SurfaceRenderer&&) noexcept            = default;
SurfaceRenderer& SurfaceRenderer::operator=(SurfaceRenderer&&) noexcept = default;

Image SurfaceRenderer::draw(const ViewScene& scene, const Camera& camera, const PictureSize& size,
                            const Overlay* overlay)
{
    if (impl_->window) present();
    impl_->make(scene, camera, size, overlay);
    return averaged(impl_->surface->draw(impl_->drawable.input()), size, impl_->surface->format());
}

bool SurfaceRenderer::show(const ViewScene& scene, const Camera& camera, const PictureSize& size,
                           const Overlay* overlay)
{
    PALP_EXPECT(impl_->window, "a renderer shows pictures in the window that it was made with");
    PALP_EXPECT(size.finer == 1, "a window's pixels are not averaged");
    impl_->make(scene, camera, size, overlay); // while the one before is being drawn
    present();
    if (!impl_->window->next({std::uint32_t(size.width), std::uint32_t(size.height)})) {
        impl_->drawable.forget();
        return false;
    }
    impl_->surface->start(impl_->drawable.input(), *impl_->window);
    return true;
}

void SurfaceRenderer::present()
{
    if (impl_->surface->finish()) impl_->window->show();
}

void SurfaceRenderer::takePanels()
{
    if (impl_->window && !impl_->surface->hasPanels()) present();
    impl_->surface->takePanels();
}

const compute::Processor& SurfaceRenderer::processor() const noexcept
{
    return impl_->context.processor();
}

const std::string& SurfaceRenderer::note() const noexcept
{
    return impl_->context.note();
}

std::vector<std::string> SurfaceRenderer::takeMessages()
{
    return impl_->context.takeMessages();
}

} // namespace palp
