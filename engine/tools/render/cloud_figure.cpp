#include "engine/tools/render/cloud_figure.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/tools/plot/colour_bar.h"
#include "engine/tools/plot/svg.h"
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/cloud_skin.h"

namespace palp {
namespace {

constexpr PictureSize kSize{900, 700, 2, Detail::fine};

Camera cameraOf(std::span<const glm::dvec3> points, const CloudFigure& figure)
{
    constexpr double kFilled = 0.88; // share of the picture that the points take: their discs reach beyond [1]
    const double     aspect  = double(kSize.width) / kSize.height;
    Camera           camera;
    camera.projection = Projection::orthographic;
    camera.toEye      = -glm::normalize(figure.direction);
    camera.up         = glm::normalize(figure.up);
    double half       = 0; // of the figure's height [m]
    if (figure.window) {
        camera.target = figure.window->centre;
        half          = figure.window->halfWidth / aspect;
    } else {
        const glm::dvec3 right = camera.right(), up = camera.upwards();
        glm::dvec3       low(INFINITY), high(-INFINITY);
        for (const glm::dvec3& p : points) {
            const glm::dvec3 place(glm::dot(p, right), glm::dot(p, up), glm::dot(p, camera.toEye));
            low  = glm::min(low, place);
            high = glm::max(high, place);
        }
        const glm::dvec3 middle = 0.5 * (low + high), extent = 0.5 * (high - low);
        camera.target = middle.x * right + middle.y * up + middle.z * camera.toEye;
        half          = std::max(extent.x / aspect, extent.y) / kFilled;
    }
    camera.distance *= half / camera.halfHeight();
    return camera;
}

/// Moves back and aside, so that the title above and the colours at the right of a panel cover nothing of the object.
Camera besideTexts(Camera camera)
{
    constexpr double kTitle = 0.09, kColours = 0.15; // of the picture's height and width [1]
    const double     aspect = double(kSize.width) / kSize.height;
    camera.distance /= 1 - kColours;
    const double height = 2 * camera.halfHeight(); // [m]
    camera.target += 0.5 * kTitle * height * camera.upwards() + 0.5 * kColours * height * aspect * camera.right();
    return camera;
}

ValueRange rangeOf(std::span<const double> values, const CloudFigure& figure)
{
    if (figure.range) return *figure.range;
    return rangeOf(values, Scale::linear).value_or(ValueRange{0, 1});
}

/// The surface of a cloud, ready to be drawn.
struct CloudBody {
    CloudSkin                 skin;
    std::vector<glm::dvec3>   normals;  ///< [1] of the points where they are now
    std::vector<std::uint8_t> oneSided; ///< see ViewScene
};

/// \throws Error if it has no surface
CloudBody bodyOf(std::span<const glm::dvec3> rest, std::span<const glm::dvec3> now, const NeighbourIndex& index)
{
    CloudBody               body{CloudSkin(rest, index), {}, {}};
    std::vector<glm::dvec3> restNormals = body.skin.normals(rest);
    body.normals                        = body.skin.normals(now);
    body.oneSided                       = body.skin.turnOutwards(rest, restNormals);
    for (std::size_t n = 0; n < body.normals.size(); ++n)
        if (glm::dot(body.normals[n], restNormals[n]) < 0) body.normals[n] = -body.normals[n];
    return body;
}

/// Returns a scene without values, whose arrays are those of the arguments.
ViewScene sceneOf(const CloudBody& body, std::span<const glm::dvec3> now, const Camera& camera, double evenLight)
{
    constexpr double kCue = 0.05; // of the picture's height [1]
    ViewScene        scene;
    scene.positions = now;
    scene.normals   = body.normals;
    scene.radii     = body.skin.radii();
    scene.cores     = body.skin.cores();
    scene.oneSided  = body.oneSided;
    scene.cueRadius = kCue * 2 * camera.halfHeight();
    scene.evenLight = evenLight;
    return scene;
}

/// Draws the cloud alone.
/// \throws Error if it has no surface, compute::ProcessorError if no processor can draw
Image imageOf(std::span<const glm::dvec3> rest, std::span<const glm::dvec3> now, std::span<const double> values,
              const CloudFigure& figure, const Camera& camera, FigureRenderer& renderer)
{
    constexpr double kMark = 0.012; // of the picture's height [1]
    if (rest.empty()) throw Error("there are no points");
    const CloudBody body   = bodyOf(rest, now, NeighbourIndex(rest));
    ViewScene       scene  = sceneOf(body, now, camera, figure.evenLight);
    const double    height = 2 * camera.halfHeight(); // of the picture [m]
    scene.values           = values;
    scene.colours          = {ColourMap::viridis, Scale::linear, rangeOf(values, figure), figure.quantity, figure.unit};
    for (const glm::dvec3& place : figure.marks) scene.dots.push_back({place, kMark * height, kForceColour});
    return renderer.opened().draw(scene, camera, kSize);
}

void drawScaleBar(SvgDrawing& svg, double pixelsPerMetre, glm::dvec2 rightEnd)
{
    constexpr double kLongest = 160; // [px]
    const ValueRange range{0, kLongest / pixelsPerMetre};
    Axis             axis(range, Scale::linear, "m", 2);
    if (axis.ticks().size() < 2) axis = Axis(range, Scale::linear, "m", 3); // 4 to 5: steps of 5 leave only zero
    const Tick&      last    = axis.ticks().back();
    const glm::dvec2 leftEnd = rightEnd - glm::dvec2(last.value * pixelsPerMetre, 0);
    svg.line(leftEnd, rightEnd, {"#1a1a1a", 2.5});
    for (const glm::dvec2 end : {leftEnd, rightEnd})
        svg.line(end - glm::dvec2(0, 4), end + glm::dvec2(0, 4), {"#1a1a1a", 1.5});
    svg.text(0.5 * (leftEnd + rightEnd) - glm::dvec2(0, 8), last.label + " " + axis.unit(),
             {.anchor = Anchor::middle, .halo = true});
}

/// Looks at the contact from outside, 55 degrees off its normal, so that a dent shows its depth.
glm::dvec3 obliquely(const glm::dvec3& normal)
{
    const Frame frame = Frame::about(normal); // the window may stand on its corner
    return -glm::normalize(0.57 * frame.normal + 0.30 * frame.east - 0.76 * frame.north);
}

} // namespace

void FigureRenderer::couldNotDraw(const std::string& why)
{
    const std::string warning = "a picture could not be drawn and says so in its place: " + why;
    if (std::ranges::find(warnings_, warning) == warnings_.end()) warnings_.push_back(warning);
}

std::string cloudFigureSvg(std::span<const glm::dvec3> rest, std::span<const glm::dvec3> now,
                           std::span<const double> values, const CloudFigure& figure, FigureRenderer& renderer)
{
    PALP_EXPECT(rest.size() == now.size() && now.size() == values.size(),
                "a figure has a value and two positions for each point");
    const glm::dvec2 corner(18, 42), size(kSize.width, kSize.height); // [px]
    SvgDrawing       svg;
    svg.text({corner.x, 25}, figure.title, {.size = 15, .bold = true});
    try {
        const Camera camera = cameraOf(now, figure);
        svg.image(corner, size, imageOf(rest, now, values, figure, camera, renderer));
        drawScaleBar(svg, 0.5 * size.y / camera.halfHeight(), corner + size - glm::dvec2(14, 14));
    } catch (const Error& error) {
        renderer.couldNotDraw(error.what());
        const std::string sentence = std::string("this picture could not be drawn: ") + error.what();
        svg.text({corner.x, 48}, sentence);
        return svg.finish({2 * corner.x + textWidth(sentence, 12), 64}, figure.title);
    }
    constexpr double kBarHeight = 420; // [px]
    const Axis       axis(rangeOf(values, figure), Scale::linear, figure.unit, 9);
    drawColourBar(svg,
                  {&axis, [](double position) { return surfaceColour(position); }, figure.quantity,
                   rangeOf(values, Scale::linear)},
                  corner + glm::dvec2(size.x + 10, 0.5 * (size.y - kBarHeight)), kBarHeight);
    double     bottom   = corner.y + size.y + 12;
    const auto unvalued = std::ranges::count_if(values, [](double value) { return !std::isfinite(value); });
    if (unvalued > 0)
        svg.text({corner.x, bottom += 8}, std::to_string(unvalued) + " points without a value are grey.",
                 {.colour = "#595959"});
    return svg.finish({corner.x + size.x + 10 + kColourBarWidth, bottom + 8}, figure.title);
}

Image cloudPanels(const SoftObject& object, std::span<const CloudPanel> panels, FigureRenderer& renderer)
{
    object.survey().expectSurface();
    CloudFigure figure;
    figure.direction       = {-0.5, -0.4, -1}; // from above for objects that stand on x and z, from outside for sheets
    const Camera    camera = besideTexts(cameraOf(object.positions(), figure));
    const CloudBody body   = bodyOf(object.positions(), object.positions(), object.index());
    Image           all(kSize.width * int(panels.size()), kSize.height);
    for (std::size_t n = 0; n < panels.size(); ++n) {
        PALP_EXPECT(panels[n].values.size() == object.size(), "a panel has a value for each point");
        ViewScene scene = sceneOf(body, object.positions(), camera, kLightOfValues);
        scene.values    = panels[n].values;
        scene.colours   = panels[n].colours;
        scene.title     = panels[n].title;
        scene.note      = panels[n].note;
        Image image     = renderer.opened().draw(scene, camera, kSize);
        annotate(image, scene, camera);
        for (int y = 0; y < kSize.height; ++y)
            std::copy_n(&image.at(0, y), kSize.width, &all.at(int(n) * kSize.width, y));
    }
    return all;
}

std::string surfaceSvg(const PointCloud& cloud, std::span<const PressedPatch> patches, const SurfaceView& view,
                       FigureRenderer& renderer)
{
    std::vector<glm::dvec3> positions(cloud.positions().begin(), cloud.positions().end());
    std::vector<double>     depth(cloud.size(), 0.0);
    CloudFigure             figure;
    for (const PressedPatch& p : patches) {
        const glm::dvec3 along = view.exaggeration * p.force * p.patch->forceDirection();
        eachMoving(*p.patch, cloud.positions(), [&](std::uint32_t point, const ChartPoint&, double response) {
            depth[point] += p.force * response;
            positions[point] += response * along;
        });
        const auto [i, j] = nodeAtContact(*p.patch);
        figure.marks.push_back(p.patch->contact.point + p.patch->response(i, j) * along);
    }
    const Patch& first = *patches.front().patch;
    const bool   given = glm::length(view.direction) > 0;
    figure.title       = view.title;
    figure.evenLight   = 0; // the dent is seen by its relief
    figure.up          = given ? glm::dvec3(0, 0, 1) : first.chart.frame.normal;
    figure.direction   = given ? view.direction : obliquely(first.chart.frame.normal);
    if (view.closeUp) figure.window = FigureWindow{first.contact.point, 0.75 * bentSize(first)};
    return cloudFigureSvg(cloud.positions(), positions, depth, figure, renderer);
}

double roundExaggeration(double deepest, double size)
{
    constexpr double kVisible = 1.0 / 30; // of the object: plain to see, and still clearly a dent [1]
    if (!(deepest > 0)) return 1;
    for (double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
        if (factor * deepest > 0.6 * kVisible * size) return factor;
    return 200;
}

} // namespace palp
