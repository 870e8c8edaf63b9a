#include "engine/tools/cli/stroke.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/tools/cli/cloud_report.h"

namespace palp {
namespace {

constexpr const char* kSuch = "such as 'at=0,0,30mm radius=5mm value=2MPa'";

constexpr std::array<std::string_view, 7> kKeys = {"at", "radius", "value", "stiffening", "held", "strength", "smooth"};

using Words = std::map<std::string, std::string, std::less<>>;

/// Reads "at=1,2,3 smooth" as at: 1,2,3 and smooth: nothing.
Words wordsOf(const std::string& text, const std::string& what)
{
    Words            words;
    std::string_view rest = text;
    for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string key(word.substr(0, equals)), value(word.substr(std::min(equals + 1, word.size())));
        if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
            const auto meant = nearestName(key, kKeys);
            throw Error(what + ": unknown word \"" + std::string(word) +
                        "\"; expected at=, radius=, value=, stiffening=, held= or smooth, " +
                        "and strength=, without blanks inside" +
                        (meant ? "; did you mean " + std::string(*meant) + "?" : ""));
        }
        if ((key == "smooth") != (equals == word.size()) || (key != "smooth" && value.empty()))
            throw Error(what + ": expected " + (key == "smooth" ? "smooth without a value" : key + "=VALUE") +
                        ", found \"" + std::string(word) + "\"");
        if (!words.emplace(key, value).second) throw Error(what + ": " + key + " is given twice");
    }
    return words;
}

std::vector<glm::dvec3> pathOf(std::string_view text, const std::string& what, double metresPerPlainNumber)
{
    std::vector<glm::dvec3> path;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(';', begin), text.size());
        path.push_back(parsePoint(text.substr(begin, end - begin), what + ": at", metresPerPlainNumber));
        begin = end + 1;
    }
    return path;
}

} // namespace

double holdOf(double held) noexcept
{
    return std::exp(held);
}

double heldOf(double hold) noexcept
{
    return std::clamp(std::log(hold), 0.0, 1.0);
}

StrokeOrder parseStroke(const std::string& text, const std::string& what, double metresPerPlainNumber,
                        StiffnessKind kind)
{
    const Words words = wordsOf(text, what);
    for (const char* key : {"at", "radius"})
        if (!words.contains(key)) throw Error(what + ": expected " + key + "=, found none, " + kSuch);
    const auto effects = words.count("value") + words.count("stiffening") + words.count("held") + words.count("smooth");
    if (effects != 1)
        throw Error(what + ": expected one of value=, stiffening=, held= and smooth, found " +
                    (effects > 1 ? std::to_string(effects) + " of them" : std::string("none of them, ") + kSuch));
    StrokeOrder order;
    order.path   = pathOf(words.at("at"), what, metresPerPlainNumber);
    order.radius = parseQuantity(words.at("radius"), Dimension::length, what + ": radius", metresPerPlainNumber);
    if (!(order.radius > 0)) throw Error(what + ": expected a radius above zero, found \"" + words.at("radius") + "\"");
    if (words.contains("value")) {
        order.value = parseQuantity(words.at("value"), dimensionOf(kind), what + ": value");
        if (!(*order.value > 0))
            throw Error(what + ": expected a value above zero, found \"" + words.at("value") + "\"");
    }
    if (const auto b = words.find("stiffening"); b != words.end()) {
        order.stiffening = parseQuantity(b->second, Dimension::perLength, what + ": stiffening");
        if (!(*order.stiffening >= 0 && *order.stiffening <= kMostStiffening))
            throw Error(what + ": expected a stiffening from 0 to " + shown(kMostStiffening) + " 1/m, found \"" +
                        b->second + "\"");
    }
    if (const auto held = words.find("held"); held != words.end()) {
        order.held = parseQuantity(held->second, Dimension::none, what + ": held");
        if (!(*order.held >= 0 && *order.held <= 1))
            throw Error(what + ": expected held from 0, free, to 1, found \"" + held->second + "\"");
    }
    if (const auto strength = words.find("strength"); strength != words.end()) {
        order.strength = parseQuantity(strength->second, Dimension::none, what + ": strength");
        if (!(order.strength > 0 && order.strength <= 1))
            throw Error(what + ": expected a strength above 0 and up to 1, found \"" + strength->second + "\"");
    }
    return order;
}

StrokeReport paintStroke(const StrokeOrder& order, const std::string& what, const SoftObject& object,
                         StiffnessPainting& painting)
{
    for (const glm::dvec3& corner : order.path) {
        const Neighbour nearest = object.index().nearest(corner, 1).front();
        if (nearest.distance > order.radius)
            throw Error(what + ": expected a place on the cloud, found (" + shown(corner.x) + ", " + shown(corner.y) +
                        ", " + shown(corner.z) + ") m, " + formatQuantity(nearest.distance, "m") +
                        " from its nearest point, " +
                        placeText(object.positions()[nearest.point], object.cloud().bounds().diagonal()) +
                        " m; is the unit right?");
    }
    const std::vector<glm::dvec3> dabs = dabsAlong(order.path, order.radius, object);
    std::vector<bool>             covered(object.size());
    StrokeReport                  report{dabs.size(), 0};
    Progress                      progress("painting");
    painting.beginStroke();
    for (std::size_t k = 0; k < dabs.size(); ++k) {
        progress.at(k, dabs.size());
        const Brush brush{dabs[k], order.radius, order.strength};
        const auto  value = order.stiffening ? growthOf(*order.stiffening)
                            : order.held     ? holdOf(*order.held)
                                             : order.value;
        for (const std::uint32_t point : value ? painting.paint(brush, *value) : painting.smooth(brush)) {
            report.points += covered[point] ? 0 : 1;
            covered[point] = true;
        }
    }
    painting.endStroke();
    return report;
}

} // namespace palp
