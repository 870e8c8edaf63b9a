#include "engine/tools/render/annotation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compute_shaders/shared/view_layout.h"
#include "engine/core/quantity.h"
#include "engine/tools/plot/colour_map.h"
#include "engine/tools/render/text.h"

namespace palp {
namespace {

constexpr int kLeastWidth = 200, kLeastHeight = 150; ///< a smaller picture has no room for texts [px]

/// Draws on a picture in multiples of its font's size.
class Annotator {
public:
    Annotator(Image& image, Ground ground, double scale)
        : image_(image), ink_(inkOn(ground)), ground_(ground), size_(annotationSize(image.width, image.height, scale))
    {
    }

    [[nodiscard]] double size() const { return size_; }
    [[nodiscard]] Rgb8   ink() const { return ink_; }
    [[nodiscard]] double width() const { return image_.width; }
    [[nodiscard]] double height() const { return image_.height; }

    void text(glm::dvec2 at, const std::string& content, double larger = 1, Anchor anchor = Anchor::start)
    {
        drawText(image_, at, content, {larger * size_, ink_, anchor});
    }

    /// Fades the picture below a text, so that the text can be read on anything.
    void fade(glm::dvec2 corner, glm::dvec2 extent)
    {
        constexpr int kShare = 70; // [%]
        const Rgb8    veil   = ground_ == Ground::light ? Rgb8{246, 247, 248} : Rgb8{30, 32, 36};
        eachPixel(corner, extent, [&](Rgb8& pixel, glm::dvec2) {
            const auto mix = [](int a, int b) { return std::uint8_t((a * (100 - kShare) + b * kShare) / 100); };
            pixel          = {mix(pixel.red, veil.red), mix(pixel.green, veil.green), mix(pixel.blue, veil.blue)};
        });
    }

    void fill(glm::dvec2 corner, glm::dvec2 extent, Rgb8 colour)
    {
        eachPixel(corner, extent, [&](Rgb8& pixel, glm::dvec2) { pixel = colour; });
    }

    /// \param inside  of the place in the square, -1 to 1 with y up
    void icon(glm::dvec2 centre, double radius, Rgb8 colour, const std::function<bool(glm::dvec2)>& inside)
    {
        eachPixel(centre - radius, glm::dvec2(2 * radius), [&](Rgb8& pixel, glm::dvec2 at) {
            const glm::dvec2 place = (at - centre) / radius;
            if (inside({place.x, -place.y})) pixel = colour;
        });
    }

    /// \param paint  of a pixel and the place of its middle [px]
    void eachPixel(glm::dvec2 corner, glm::dvec2 extent, const std::function<void(Rgb8&, glm::dvec2)>& paint)
    {
        const int left = std::max(0, int(std::lround(corner.x))), top = std::max(0, int(std::lround(corner.y)));
        const int right  = std::min(image_.width, int(std::lround(corner.x + extent.x)));
        const int bottom = std::min(image_.height, int(std::lround(corner.y + extent.y)));
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) paint(image_.at(x, y), {x + 0.5, y + 0.5});
    }

private:
    Image& image_;
    Rgb8   ink_;
    Ground ground_;
    double size_; // of the font [px]
};

/// Returns a text as lines that are not wider than that, unless a word is.
std::vector<std::string> linesOf(const std::string& text, double most, double size)
{
    std::vector<std::string> lines;
    std::istringstream       words(text);
    for (std::string word; words >> word;) {
        if (lines.empty() || widthOfText(lines.back() + " " + word, size) > most)
            lines.push_back(word);
        else
            lines.back() += " " + word;
    }
    return lines;
}

/// \return the height that it takes up [px]
double drawTitle(Annotator& to, const ViewScene& scene)
{
    const double s = to.size();
    if (scene.title.empty() && scene.note.empty()) return 0;
    constexpr double kTitle = 1.25, kLine = 1.4; // of the font's size [1]
    const double     room  = to.width() - 2 * s;
    const bool       fits  = widthOfText(scene.note, s) <= room;
    const auto       note  = fits ? std::vector{scene.note} : linesOf(scene.note, room, s);
    double           wide  = widthOfText(scene.title, kTitle * s);
    const double     title = wide > room ? kTitle * room / wide : kTitle; // a long name of a file becomes smaller
    wide                   = std::min(wide, room);
    for (const std::string& line : note) wide = std::max(wide, widthOfText(line, s));
    const double high = scene.note.empty() ? 2.5 * s : (4.0 + kLine * double(note.size() - 1)) * s;
    to.fade({0, 0}, {wide + 2 * s, high});
    to.text({s, 1.8 * s}, scene.title, title);
    for (std::size_t n = 0; n < note.size(); ++n) to.text({s, (3.3 + kLine * double(n)) * s}, note[n]);
    return high;
}

/// \param top, foot  heights that others have taken up [px]
void drawColours(Annotator& to, const ViewColours& colours, double top, double foot)
{
    const double s = to.size(), bar = 1.1 * s, tick = 0.35 * s;
    const double above = std::max(5.5 * s, top + 2.5 * s),
                 high  = std::min(0.42 * to.height(), to.height() - foot - above - s);
    if (high < 4 * s) return;
    const Axis axis(colours.range, colours.scale, colours.unit, std::clamp(int(high / (1.6 * s)), 2, 6));
    const auto title = axis.title(colours.quantity);
    double     label = 0;
    for (const Tick& t : axis.ticks()) label = std::max(label, widthOfText(t.label, s));
    const double     wide = std::max(bar + tick + 0.4 * s + label, widthOfText(title, s));
    const glm::dvec2 corner(to.width() - wide - s, above);
    to.fade(corner - glm::dvec2(0.7 * s, 2.2 * s), {wide + 1.4 * s, high + 3.2 * s});
    to.text(corner - glm::dvec2(0, 0.8 * s), title);
    if (colours.goesOn) { // a tip, as of an arrow: deeper ones have its colour too
        const double tip = 0.6 * s;
        to.eachPixel(corner - glm::dvec2(0, tip), {bar, tip}, [&](Rgb8& pixel, glm::dvec2 at) {
            const double from = (corner.y - at.y) / tip, aside = std::abs(at.x - corner.x - bar / 2) / (bar / 2);
            if (aside < 1 - from) pixel = surfaceColour(1, colours.map);
        });
    }
    to.fill(corner - 1.0, {bar + 2, high + 2}, to.ink());
    to.eachPixel(corner, {bar, high},
                 [&](Rgb8& pixel, glm::dvec2 at) { pixel = surfaceColour(1 - (at.y - corner.y) / high, colours.map); });
    for (const Tick& t : axis.ticks()) {
        const double y = corner.y + high * (1 - axis.position(t.value));
        to.fill({corner.x + bar, y - 0.5 * s / 14}, {tick, std::max(1.0, s / 14)}, to.ink());
        to.text({corner.x + bar + tick + 0.3 * s, y + 0.36 * s}, t.label);
    }
}

struct KeyEntry {
    const char*                     text;
    Rgb8                            colour;
    std::function<bool(glm::dvec2)> inside;
};

std::vector<KeyEntry> keyOf(const ViewScene& scene)
{
    const auto arrow = [](double thickness) {
        return [thickness](glm::dvec2 p) {
            return p.y > 0 ? std::abs(p.x) < 0.55 * (1 - p.y) : std::abs(p.x) < thickness;
        };
    };
    std::vector<KeyEntry> key;
    if (scene.proxy) key.push_back({"proxy", kProxyColour, [](glm::dvec2 p) { return glm::dot(p, p) < 0.8; }});
    if (scene.hip) key.push_back({"HIP", kHipColour, [](glm::dvec2 p) { return std::abs(p.x) + std::abs(p.y) < 1; }});
    if (scene.stylus)
        key.push_back({"stylus", kStylusColour,
                       [](glm::dvec2 p) { return std::abs(p.x - p.y) < 0.5 && std::abs(p.x + p.y) < 1.3; }});
    if (scene.force) key.push_back({"force on the hand", kForceColour, arrow(0.22)});
    if (scene.normal) key.push_back({"normal", kNormalColour, arrow(0.1)});
    if (!scene.outline.empty())
        key.push_back({"patch", inkOn(scene.ground), [](glm::dvec2 p) {
                           const double side = std::max(std::abs(p.x), std::abs(p.y));
                           return side > 0.62 && side < 0.85;
                       }});
    if (!scene.brush.empty())
        key.push_back({"brush", inkOn(scene.ground), [](glm::dvec2 p) {
                           const double radius = glm::length(p);
                           return radius > 0.65 && radius < 0.88;
                       }});
    const auto hasDots = [&](Rgb8 colour) {
        return std::ranges::any_of(scene.dots, [&](const ViewDot& dot) { return dot.colour == colour; });
    };
    const auto dots = [](glm::dvec2 p) {
        return std::min(glm::length(p - glm::dvec2(-0.45, 0.3)), glm::length(p - glm::dvec2(0.4, -0.3))) < 0.35;
    };
    if (hasDots(inkOn(scene.ground))) key.push_back({"surface at rest", inkOn(scene.ground), dots});
    if (hasDots(kProjectedColour)) key.push_back({"projected points", kProjectedColour, dots});
    if (!scene.sphere.empty())
        key.push_back({"fitted sphere", kSphereColour, [](glm::dvec2 p) {
                           const double radius = glm::length(p);
                           return radius < 0.9 && (radius > 0.7 || std::abs(p.x) < 0.1 || std::abs(p.y) < 0.1);
                       }});
    const auto stroke = [](glm::dvec2 p) { return std::abs(p.y) < 0.16 && std::abs(p.x) < 0.9; };
    if (!scene.bulging.empty()) key.push_back({"bulging", kBulgingColour, stroke});
    if (!scene.hollow.empty()) key.push_back({"hollow", kHollowColour, stroke});
    return key;
}

/// \return the place that it takes up, from the lower left corner [px]
glm::dvec2 drawKey(Annotator& to, const ViewScene& scene)
{
    const double s = to.size(), line = 1.9 * s;
    const auto   widthOf = [s](const KeyEntry& entry) { return widthOfText(entry.text, s) + 3.2 * s; };
    std::vector<std::vector<KeyEntry>> rows;
    double                             wide = 0, widest = 0;
    for (KeyEntry& entry : keyOf(scene)) {
        if (rows.empty() || wide + widthOf(entry) > to.width() - s) {
            rows.emplace_back();
            wide = 0;
        }
        wide += widthOf(entry);
        widest = std::max(widest, wide);
        rows.back().push_back(std::move(entry));
    }
    const glm::dvec2 size(widest + 0.6 * s, 0.7 * s + line * double(rows.size()));
    if (rows.empty() || size.y > to.height() / 3) return {0, 0}; // colours and lengths need the rest
    to.fade({0, to.height() - size.y}, size);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        glm::dvec2 at(s, to.height() - 0.9 * s - line * double(rows.size() - 1 - row));
        for (const KeyEntry& entry : rows[row]) {
            to.icon(at + glm::dvec2(0.6 * s, -0.36 * s), 0.75 * s, entry.colour, entry.inside);
            to.text(at + glm::dvec2(1.8 * s, 0), entry.text);
            at.x += widthOf(entry);
        }
    }
    return size;
}

/// Returns the text of a round length: "20 mm".
std::string plainText(double length)
{
    std::string       text = formatQuantity(length, "m");
    const std::size_t unit = text.find(' '), point = text.find('.');
    if (point < unit) text.erase(point, unit - point);
    return text;
}

/// Returns the round length, 1, 2 or 5 times a power of ten, that is at most `most`.
double roundLength(double most)
{
    const double decade = std::pow(10.0, std::floor(std::log10(most)));
    for (const double digit : {5.0, 2.0})
        if (digit * decade <= most) return digit * decade;
    return decade;
}

/// \param taken  from the lower left corner, by others [px]
/// \return the height that all at the foot take up then [px]
double drawLength(Annotator& to, const Camera& camera, const glm::dvec2& taken)
{
    constexpr double  kShare         = 0.16; // of the width, at most [1]
    const double      s              = to.size();
    const double      pixelsPerMetre = to.height() / (2 * camera.halfHeight());
    const double      length         = roundLength(kShare * to.width() / pixelsPerMetre);
    const double      wide           = length * pixelsPerMetre;
    const std::string text           = plainText(length);
    const double      room           = std::max(wide, widthOfText(text, s));
    const double      right          = to.width() - s;
    const double      below          = right - room - 0.7 * s < taken.x ? taken.y : 0; // [px]
    const glm::dvec2  end(right, to.height() - below - s);
    to.fade({end.x - room - 0.7 * s, to.height() - below - 3.4 * s}, {room + 1.7 * s, 3.4 * s});
    to.fill({end.x - wide, end.y - 0.25 * s}, {wide, 0.25 * s}, to.ink());
    to.fill({end.x - wide, end.y - 0.6 * s}, {s / 8, 0.6 * s}, to.ink());
    to.fill({end.x - s / 8, end.y - 0.6 * s}, {s / 8, 0.6 * s}, to.ink());
    to.text({end.x - wide / 2, end.y - 0.9 * s}, text, 1, Anchor::middle);
    return std::max(taken.y, below + 3.4 * s);
}

} // namespace

double annotationSize(int width, int height, double scale)
{
    return scale * std::clamp(std::min(width, height) / scale / 46, 10.0, 40.0);
}

void annotate(Image& image, const ViewScene& scene, const Camera& camera, double scale)
{
    if (image.width < kLeastWidth * scale || image.height < kLeastHeight * scale) return;
    Annotator        to(image, scene.ground, scale);
    const double     top   = drawTitle(to, scene);
    const glm::dvec2 taken = drawKey(to, scene);
    const double     foot  = scene.positions.empty() ? taken.y : drawLength(to, camera, taken); // nothing has no length
    if (!scene.values.empty())                                                                  // beside a short title
        drawColours(to, scene.colours, top > 4.1 * to.size() ? top : 0, foot);
}

// Everything is blended by a share, so that the results on black and on white give both share and colour.
Overlay annotations(const ViewScene& scene, const Camera& camera, int width, int height, double scale)
{
    constexpr std::uint8_t kWhite = 255;
    Image                  onBlack(width, height, {0, 0, 0}), onWhite(width, height, {kWhite, kWhite, kWhite});
    annotate(onBlack, scene, camera, scale);
    annotate(onWhite, scene, camera, scale);
    Overlay           overlay{width, height, std::vector<std::uint32_t>(onBlack.pixels.size()), {}};
    const int         tile    = int(shared::kTile);
    const int         columns = (width + tile - 1) / tile;
    std::vector<bool> used(std::size_t(columns) * std::size_t((height + tile - 1) / tile));
    for (std::size_t n = 0; n < overlay.pixels.size(); ++n) {
        const Rgb8 b = onBlack.pixels[n], w = onWhite.pixels[n];
        const auto alpha  = std::uint32_t(kWhite - (w.green - b.green));
        overlay.pixels[n] = alpha << 24 | std::uint32_t(b.blue) << 16 | std::uint32_t(b.green) << 8 | b.red;
        if (alpha > 0) used[n / std::size_t(width) / tile * columns + n % std::size_t(width) / tile] = true;
    }
    for (std::size_t n = 0; n < used.size(); ++n)
        if (used[n]) overlay.tiles.push_back(std::uint32_t(n % std::size_t(columns) | n / std::size_t(columns) << 16));
    return overlay;
}

} // namespace palp
