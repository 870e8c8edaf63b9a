#include "engine/pipeline/dent_length.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/quantity.h"
#include "engine/pipeline/detail/curvature_sites.h"

namespace palp {
namespace {

constexpr std::size_t kPlaces = 48;

/// How the surface bends about a place.
struct Bend {
    std::uint32_t point = 0;           ///< of the object
    double        most = 0, least = 0; ///< principal curvatures, the larger by size first [1/m]
    double        area = 0;            ///< that it stands for beside the others: the point's own [m^2]
};

/// A value and how much it counts.
struct Weighed {
    double value = 0, weight = 0;
};

/// Returns the value up to which a share of all the weight lies.
double quantileOf(std::vector<Weighed> values, double share)
{
    std::ranges::sort(values, {}, &Weighed::value);
    double left = 0;
    for (const Weighed& each : values) left += share * each.weight;
    for (const Weighed& each : values)
        if ((left -= each.weight) < 0) return each.value;
    return values.back().value;
}

/// Returns how a shell bends at places spread evenly over the object, where its points determine it; a plate does not.
std::vector<Bend> bendsOf(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double  kSpacings = 6, kShare = 1.0 / 16; // radius of the fits: at least; of the diagonal [1]
    const double      radius = std::max(kSpacings * object.spacing(), kShare * object.cloud().bounds().diagonal());
    const std::size_t places = std::min(kPlaces, object.size());
    std::vector<Bend> bends;
    for (std::size_t k = 0; k < places; ++k) {
        const auto   point = std::uint32_t((2 * k + 1) * object.size() / (2 * places));
        const double area  = object.survey().spacing(point) * object.survey().spacing(point);
        if (settings.theory != Theory::shell) {
            bends.push_back({point, 0, 0, area});
            continue;
        }
        const auto found = faceCurvature(object, object.positions()[point], object.survey().normal(point), radius);
        if (!found) continue;
        const auto [most, least] = principalOf(*found);
        bends.push_back({point, most, least, area});
    }
    return bends;
}

/// Returns points spread evenly over the object.
std::vector<std::uint32_t> sampleOf(const SoftObject& object)
{
    constexpr std::size_t      kSample = 1500;
    std::vector<std::uint32_t> sample(std::min(kSample, object.size()));
    for (std::size_t k = 0; k < sample.size(); ++k)
        sample[k] = std::uint32_t((2 * k + 1) * object.size() / (2 * sample.size()));
    return sample;
}

/// Returns the length of a dent on the foundation, with the geometric mean of the rigidity so far around the point, and at it
/// [m].
double meanLength(const SoftObject& object, const std::vector<std::uint32_t>& sample, std::uint32_t point, double reach,
                  double foundation)
{
    const glm::dvec3 place = object.positions()[point];
    double           sum = std::log(object.rigidity(point)), count = 1;
    for (const std::uint32_t other : sample) {
        if (glm::distance(object.positions()[other], place) > reach) continue;
        sum += std::log(object.rigidity(other));
        ++count;
    }
    return std::pow(std::exp(sum / count) / foundation, 0.25);
}

/// Returns foundationWindow() of all of the object.
double foundationWindowOf(const SoftObject& object)
{
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t point = 0; point < object.size(); ++point) {
        const double rigidity = object.rigidity(point);
        least                 = std::min(least, rigidity);
        most                  = std::max(most, rigidity);
    }
    return foundationWindow(least, most);
}

/// What the dents of an object ask for, and of how much of it: the others reach as far as the object.
struct Ending {
    DentLengths lengths;   ///< where dents end
    double      share = 0; ///< of the surface [1]
};

Ending endingOf(const SoftObject& object, const PatchSettings& settings, const std::vector<Bend>& bends)
{
    // Curvature that adds less to a foundation is none; widths up to twice the median, because the poles of flat spheroids need
    // 1.45 and the median of 48 places is right to a tenth [1].
    constexpr double     kFlat = 1e-6, kTypical = 0.5, kFlatter = 2, kSpare = 1.05; // of the mean rigidity's width [1]
    const Material&      material     = object.material();
    const double         perRoot      = std::pow(shellLengthRoot(material), -4); // [1/m^2] of a curvature of 1/m
    const double         onFoundation = settings.foundation > 0 ? kSpare * foundationWindowOf(object) : 0;
    const auto           sample       = sampleOf(object);
    std::vector<Weighed> lengths, widths;    // [m]
    double               all = 0, ended = 0; // [m^2]
    for (const Bend& bend : bends) {
        const double below        = settings.foundation / object.rigidity(bend.point); // [1/m^4]
        const auto [length, wide] = dentReach(bend.most, bend.least, material, below);
        const bool isFlat         = perRoot * bend.most * bend.most < kFlat * below;
        all += bend.area;
        if (!(length < object.cloud().bounds().diagonal())) continue;
        ended += bend.area;
        lengths.push_back({length, bend.area});
        // What is flat feels the mean of the rigidity in its window, as the warnings count it.
        widths.push_back({isFlat ? onFoundation * meanLength(object, sample, bend.point, onFoundation * length / 2,
                                                             settings.foundation)
                                 : wide * length,
                          bend.area});
    }
    if (lengths.empty()) return {};
    const auto [least, most] = std::ranges::minmax(lengths, {}, &Weighed::value);
    const double widest      = std::ranges::max(widths, {}, &Weighed::value).value;
    return {{least.value, quantileOf(lengths, kTypical), most.value,
             std::min(widest, kFlatter * quantileOf(widths, kTypical))},
            ended / all};
}

/// Returns the width of a window that sags no more than it may at nearly all places [m].
double shallowWindow(const std::vector<Bend>& bends)
{
    constexpr double kNearly = 0.95; // rims and tips bend as sharply as the fits can tell [1]
    if (bends.empty()) return std::numeric_limits<double>::infinity();
    std::vector<Weighed> largest; // [1/m]
    for (const Bend& bend : bends) largest.push_back({std::abs(bend.most), bend.area});
    return 8 * kMostSag / quantileOf(std::move(largest), kNearly);
}

/// Returns the width of a square as large as the disc about a place of which the object's surface fills four fifths [m].
///
/// Of a sample of points each stands for the area around it, and areas are compared with those near the place, so that it
/// does not matter whether one face of the object was given or two.
/// \param sample  even over the object
double filledWidth(const SoftObject& object, const std::vector<std::uint32_t>& sample, const glm::dvec3& place)
{
    constexpr double      kFilled = 0.8; // [1]
    constexpr std::size_t kNear   = 64;  // points: the density near the place is then known to an eighth
    struct Near {
        double square, area; ///< of the distance, and around the point [m^2]
    };
    std::vector<Near> near;
    for (const std::uint32_t point : sample) {
        const glm::dvec3 d       = object.positions()[point] - place;
        const double     spacing = object.survey().spacing(point);
        near.push_back({glm::dot(d, d), spacing * spacing});
    }
    std::ranges::sort(near, {}, &Near::square);
    double area = 0, density = 0, reach = 0; // [m^2]; [1]; [m^2]
    for (std::size_t k = 0; k < near.size(); ++k) {
        area += near[k].area;
        if (k + 1 == std::min(kNear, near.size())) density = area / near[k].square;
        if (k + 1 >= kNear && area >= kFilled * density * near[k].square) reach = near[k].square;
    }
    return std::sqrt(std::numbers::pi * (reach > 0 ? reach : near.back().square));
}

/// Returns the width up to which windows about the places in the object's middle are filled [m]: beside a border none is.
double widthOfObject(const SoftObject& object)
{
    constexpr std::size_t kEnough = 32;  // places
    constexpr double      kMiddle = 0.9; // of the places less is filled at so many [1]
    const auto            sample  = sampleOf(object);
    std::vector<double>   widths;
    for (std::size_t k = 0; k < std::min(kEnough, sample.size()); ++k)
        widths.push_back(filledWidth(object, sample, object.positions()[sample[k * sample.size() / kEnough]]));
    const auto middle = widths.begin() + std::ptrdiff_t(kMiddle * double(widths.size() - 1));
    std::ranges::nth_element(widths, middle);
    return *middle;
}

/// A width, and the rest of a sentence that begins with it.
struct Choice {
    double      width = 0; ///< [m]
    std::string why;
};

/// Chooses a width where dents end by themselves.
Choice chosenBy(const DentLengths& lengths, const SoftObject& object, const PatchSettings& settings, double least)
{
    constexpr double  kCells = 1.25; // that a fingertip's radius spans at least: what is felt is then right to 2 % [1]
    const std::string reach  = "dents of this object, which die away over " + formatQuantity(lengths.typical, "m");
    const std::string asked  = reach + ", ask for " + formatQuantity(lengths.window, "m");
    const double      filled = widthOfObject(object), carried = settings.cells * settings.footprintRadius / kCells;
    const double      width = std::min({lengths.window, filled, carried});
    if (width < least) return {least, "four radii of the fingertip, because " + reach + ", ask for less"};
    if (width == carried)
        return {width, "as wide as " + std::to_string(settings.cells) + " cells carry this fingertip, where " + asked +
                           "; take more cells"};
    if (width == filled) return {width, "as wide as the object is about its middle, where " + asked};
    return {width, "as wide as " + reach + ", ask for at nearly all places"};
}

/// Chooses a width of a shell where supports decide.
Choice unendedChoice(const PatchSettings& settings, const std::vector<Bend>& bends, double least)
{
    const std::string why = "because nothing ends the dents of what is curved one way, against each other or hardly at "
                            "all; see the support "
                            "range";
    const double      shallow = std::max(shallowWindow(bends), least);
    if (shallow < settings.window) return {shallow, "as deep as the theory of shallow shells allows, " + why};
    return {settings.window, "the width without auto, " + why};
}

Choice chosen(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double kMixed =
        0.65; // of the surface, from which on dents end, and of the rest from which on none do [1]
    const auto   bends = bendsOf(object, settings);
    const double least = 4 * settings.footprintRadius;
    // A dent that dies away hardly feels what is steep, see patch_warnings.cpp, and would feel edges that are nearer.
    const auto [lengths, share] = endingOf(object, settings, bends);
    if (share >= kMixed) return chosenBy(lengths, object, settings, least);
    if (settings.theory == Theory::plate)
        return {settings.window,
                "the width without auto, because nothing ends the dents of a plate " +
                    std::string(settings.foundation > 0 ? "on so soft a foundation" : "without a foundation") +
                    ": this width decides what is felt; set a --window, a --foundation or, where the "
                    "surface is curved, --theory shell"};
    const Choice unended = unendedChoice(settings, bends, least);
    if (share <= 1 - kMixed) return unended;
    // Which half is the larger hangs on a few places, and what is felt should not: in between it goes over from one width to
    // the other.
    const Choice ended = chosenBy(lengths, object, settings, least);
    const double part  = (share - (1 - kMixed)) / (2 * kMixed - 1);
    return {std::exp(std::lerp(std::log(unended.width), std::log(ended.width), part)),
            "between " + formatQuantity(unended.width, "m") + " and " + formatQuantity(ended.width, "m") +
                ", because dents die away by themselves on " + std::to_string(std::lround(100 * share)) +
                " % of this object and reach far on the rest of it; see the support range"};
}

} // namespace

double shellLengthRoot(const Material& material) noexcept
{
    const double nu = material.poissonRatio;
    return std::sqrt(material.thickness) / std::pow(12 * (1 - nu * nu), 0.25);
}

DentReach dentReach(double most, double least, const Material& material, double below) noexcept
{
    constexpr double kAlike = 2, kFarther = 0.7; // ratio of the curvatures; power, see DentReach [1]
    // What is curved one way ends nothing, whichever side of it the fits' noise says that it bends to the other way.
    const bool   bulges  = least * most > kOneWay * most * most;
    const double perRoot = bulges ? std::pow(shellLengthRoot(material), -4) : 0; // [1/m^2] of a curvature of 1/m
    const double ends    = perRoot * most * least + below;                       // [1/m^4]
    if (!(ends > 0)) return {std::numeric_limits<double>::infinity()};
    const double unlike = ends / (perRoot * least * least + below); // of the softest wave
    return {std::pow(ends, -0.25), kLocalWindow * std::max(1.0, std::pow(unlike / kAlike, kFarther))};
}

std::optional<DentLengths> dentLengths(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double kMost  = 0.5; // of the surface [1]
    const Ending     ending = endingOf(object, settings, bendsOf(object, settings));
    if (ending.share < kMost) return {};
    return ending.lengths;
}

double dentWindow(const SoftObject& object, const PatchSettings& settings)
{
    return chosen(object, settings).width;
}

std::string whyDentWindow(const SoftObject& object, const PatchSettings& settings)
{
    if (settings.windowOf != WindowOf::dent) return {};
    const Choice choice = chosen(object, settings);
    return "auto: " + formatQuantity(choice.width, "m") + ", " + choice.why;
}

} // namespace palp
