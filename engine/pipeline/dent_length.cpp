#include "engine/pipeline/dent_length.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/parallel.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/detail/curvature_sites.h"

namespace palp {
namespace {

/// Radii of curvature to a window's width that sags by kMostSag; and the most that a window has [1]. What bulges both
/// ways is felt as whole bodies are, to 10 %, in windows that wrap round: see tooDeep() of the warnings.
constexpr double kShallowRadii = 8 * kMostSag, kMostRadii = 5;

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

/// Returns the value below and above which half of all the weight lies.
double medianOf(std::vector<Weighed> values)
{
    std::ranges::sort(values, {}, &Weighed::value);
    double left = 0;
    for (const Weighed& each : values) left += each.weight / 2;
    for (const Weighed& each : values)
        if ((left -= each.weight) < 0) return each.value;
    return values.back().value;
}

/// Returns the geometric mean of some positive values and so many standard deviations more, but no more than the
/// largest and no less than the least. It hangs less on single values than a quantile does, and less on which half is
/// the larger than a median.
double meanAndDeviations(const std::vector<Weighed>& values, double deviations)
{
    double all = 0, sum = 0, squares = 0;
    for (const auto& [value, weight] : values) {
        all += weight;
        sum += weight * std::log(value);
    }
    const double mean = sum / all;
    for (const auto& [value, weight] : values) squares += weight * std::pow(std::log(value) - mean, 2);
    const auto [least, most] = std::ranges::minmax(values, {}, &Weighed::value);
    return std::clamp(std::exp(mean + deviations * std::sqrt(squares / all)), least.value, most.value);
}

/// Returns the radius of a fit about a point [m]: some spacings, a share of the object, and what makes it quiet.
double radiusAbout(const SoftObject& object, std::uint32_t point)
{
    constexpr double     kSpacings = 6, kShare = 1.0 / 16, kMost = 1.0 / 6; // of the diagonal [1]
    const SurfaceSurvey& survey   = object.survey();
    const double         diagonal = object.cloud().bounds().diagonal();
    const double         quiet    = quietFitRadius(survey.noise(point), survey.spacing(point));
    return std::max({kSpacings * object.spacing(), kShare * diagonal, std::min(quiet, kMost * diagonal)});
}

/// Returns how a shell bends at places spread evenly over the object, where its points determine it; a plate does not.
std::vector<Bend> bendsOf(const SoftObject& object, const PatchSettings& settings)
{
    if (object.survey().spacings().empty()) return {}; // too few points for a surface
    constexpr std::size_t            kPlaces = 192;
    constexpr double                 kSure   = 3; // standard errors [1]
    const std::size_t                places  = std::min(kPlaces, object.size());
    std::vector<std::optional<Bend>> found(places);
    inParallel(places, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto   point = std::uint32_t((2 * k + 1) * object.size() / (2 * places));
            const double area  = object.survey().spacing(point) * object.survey().spacing(point);
            if (settings.theory != Theory::shell) {
                found[k] = Bend{point, 0, 0, area};
                continue;
            }
            const SurfaceSurvey& survey = object.survey();
            const double         radius = radiusAbout(object, point);
            const auto           fit = faceCurvature(object, object.positions()[point], survey.normal(point), radius);
            if (!fit) continue;
            // What noise alone may have made is no curvature.
            const double error = fitError(survey.noise(point), survey.spacing(point), radius);
            const auto   sure  = [&](double curvature) { return std::abs(curvature) > kSure * error ? curvature : 0; };
            const auto [most, least] = principalOf(*fit);
            found[k]                 = Bend{point, sure(most), sure(least), area};
        }
    });
    std::vector<Bend> bends;
    for (const auto& bend : found)
        if (bend && bend->area > 0) bends.push_back(*bend);
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

/// Returns the length of a dent on the foundation, with the geometric mean of the rigidity so far around the point, and
/// at it [m].
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

/// What the dents of an object ask for, and on how much of it they end by themselves.
struct Asked {
    DentLengths lengths;   ///< where they end; its window is that of the whole object
    double      share = 0; ///< of the surface where they end [1]
};

Asked askedBy(const SoftObject& object, const PatchSettings& settings, const std::vector<Bend>& bends)
{
    // Curvature that adds less to a foundation is none; room beyond the width of the mean rigidity [1].
    constexpr double     kFlat = 1e-6, kSpare = 1.05;
    const Material&      material     = object.material();
    const double         perRoot      = std::pow(shellLengthRoot(material), -4); // [1/m^2] of a curvature of 1/m
    const double         onFoundation = settings.foundation > 0 ? kSpare * foundationWindowOf(object) : 0;
    const auto           sample       = sampleOf(object);
    std::vector<Weighed> lengths, widths;    // [m]
    double               all = 0, ended = 0; // [m^2]
    for (const Bend& bend : bends) {
        const double below        = settings.foundation / object.rigidity(bend.point); // [1/m^4]
        const auto [length, wide] = dentReach(bend.most, bend.least, material, below);
        all += bend.area;
        if (!(length < object.cloud().bounds().diagonal())) { // supports decide: as the theory and the settings allow
            widths.push_back({std::min(settings.window, kShallowRadii / std::abs(bend.most)), bend.area});
            continue;
        }
        ended += bend.area;
        lengths.push_back({length, bend.area});
        // What is flat feels the mean of the rigidity in its window, as the warnings count it.
        const bool isFlat = perRoot * bend.most * bend.most < kFlat * below;
        widths.push_back({isFlat ? onFoundation * meanLength(object, sample, bend.point, onFoundation * length / 2,
                                                             settings.foundation)
                                 : wide * length,
                          bend.area});
    }
    if (widths.empty()) return {.lengths = {.window = settings.window}};
    // Where dents end nearly all places have the room that they ask for, where none does hardly one is too steep.
    constexpr double kWide = 1.5, kNarrow = -1; // [standard deviations]
    const double     share = ended / all;
    Asked asked{.lengths = {.window = meanAndDeviations(widths, std::lerp(kNarrow, kWide, share))}, .share = share};
    if (lengths.empty()) return asked;
    const auto [least, most] = std::ranges::minmax(lengths, {}, &Weighed::value);
    asked.lengths            = {least.value, medianOf(lengths), most.value, asked.lengths.window};
    return asked;
}

/// Returns the width of a square as large as the disc about a place of which the object's surface fills four fifths
/// [m].
///
/// Of a sample of points each stands for the area around it, and areas are compared with those near the place, so that
/// it does not matter whether one face of the object was given or two.
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

/// Returns the width up to which windows about the places in the object's middle are filled [m]: beside a border none
/// is.
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

/// A window, and the rest of a sentence that begins with its width.
struct Choice {
    DentWindow  window;
    std::string why;
};

/// Returns how many cells a window has that is so many lengths of dents wide.
int cellsFor(double lengths, int cells)
{
    constexpr double kFew = 16, kPerLength = 5;  // lengths that the settings' cells are for; cells to each beyond [1]
    constexpr int    kTogether = 16, kTimes = 2; // a multiple that a multigrid can coarsen; as many cells at most
    if (!(lengths > kFew)) return cells;
    const int wanted = kTogether * int(std::ceil(kPerLength * lengths / kTogether - 1e-9));
    return std::max(cells, std::min(wanted, kTimes * cells / kTogether * kTogether));
}

/// Chooses a width where dents end by themselves, on some of the object at least.
Choice chosenBy(const Asked& by, const SoftObject& object, const PatchSettings& settings, double least)
{
    constexpr double   kAllOver = 0.9; // of the surface [1]
    const DentLengths& lengths  = by.lengths;
    const bool         allOver  = by.share >= kAllOver;
    std::string        reach    = "dents of this object, which die away over " + formatQuantity(lengths.typical, "m");
    if (!allOver)
        reach += " on " + std::to_string(std::lround(100 * by.share)) + " % of it and reach far on the rest" +
                 (settings.theory == Theory::shell ? ", see the support range of palpate touch" : "");
    const std::string asked  = reach + ", ask for " + formatQuantity(lengths.window, "m");
    const std::string anyhow = "four radii of the fingertip, because ";
    const double filled = widthOfObject(object), carried = settings.cells * settings.footprintRadius / kFewestCells;
    const double width = std::min({lengths.window, filled, carried});
    const int    cells =
        settings.theory == Theory::shell ? cellsFor(width / lengths.typical, settings.cells) : settings.cells;
    const std::string finer = cells > settings.cells ? "; with " + std::to_string(cells) + " cells for " +
                                                           std::to_string(settings.cells) + ", so that they see a dent"
                                                     : "";
    if (lengths.window < least) return {{least, settings.cells}, anyhow + reach + ", ask for less"};
    if (width < least) return {{least, settings.cells}, anyhow + "the object is hardly wider about its middle"};
    if (width == carried)
        return {{width, cells},
                "as wide as " + std::to_string(settings.cells) + " cells carry this fingertip, where " + asked +
                    "; take more cells" + finer};
    if (width == filled) return {{width, cells}, "as wide as the object is about its middle, where " + asked + finer};
    return {{width, cells},
            "as wide as " + reach + ", ask for " + (allOver ? "at nearly all places" : "on average") + finer};
}

/// Chooses a width where the window is cut from the object as a whole, which says how its edges move: it need not
/// hold a dent, and the narrower it is the more nearly level.
Choice chosenOnBody(const SoftObject& object, const PatchSettings& settings, double least)
{
    constexpr double     kRadii = 1.25, kNarrow = -1; // radii of curvature; [standard deviations]
    std::vector<Weighed> widths;                      // [m]
    for (const Bend& bend : bendsOf(object, settings))
        widths.push_back({std::min(settings.window, kRadii / std::abs(bend.most)), bend.area});
    const double wanted = widths.empty() ? settings.window : meanAndDeviations(widths, kNarrow);
    const char*  body   = ", where it is cut from a coarse shell of the whole object, which says how its edges move";
    if (wanted < least) return {{least, settings.cells}, std::string("four radii of the fingertip") + body};
    if (wanted >= settings.window)
        return {{settings.window, settings.cells}, std::string("the width without auto") + body};
    return {{wanted, settings.cells}, std::string("over which most of the surface is nearly level") + body};
}

Choice chosen(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double kSome = 0.02; // of the surface, where the fits of a tube may see two ways to bend [1]
    const double     least = 4 * settings.footprintRadius;
    if (isCutFromBody(object, settings)) return chosenOnBody(object, settings, least);
    const Asked asked = askedBy(object, settings, bendsOf(object, settings));
    if (asked.share > kSome) return chosenBy(asked, object, settings, least);
    if (settings.theory == Theory::plate)
        return {{settings.window, settings.cells},
                "the width without auto, because nothing ends the dents of a plate " +
                    std::string(settings.foundation > 0 ? "on so soft a foundation" : "without a foundation") +
                    ": this width decides what is felt; set a --window, a --foundation or, where the "
                    "surface is curved, --theory shell"};
    const std::string why = "because nothing ends the dents of what is curved one way, against each other or hardly at "
                            "all; see the support range of palpate touch";
    if (asked.lengths.window >= settings.window)
        return {{settings.window, settings.cells}, "the width without auto, " + why};
    if (asked.lengths.window < least) return {{least, settings.cells}, "four radii of the fingertip, " + why};
    return {{asked.lengths.window, settings.cells},
            "over which most of the surface sags by no more than a fourth, " + why};
}

} // namespace

double shellLengthRoot(const Material& material) noexcept
{
    const double nu = material.poissonRatio;
    return std::sqrt(material.thickness) / std::pow(12 * (1 - nu * nu), 0.25);
}

DentReach dentReach(double most, double least, const Material& material, double below) noexcept
{
    constexpr double kAlike = 1.35, kFarther = 0.66; // ratio of the curvatures; power, see DentReach [1]
    // What is curved one way ends nothing, whichever side of it the fits' noise says that it bends to the other way.
    const double ratio = most == 0 ? 0 : least / most;
    const double perRoot =
        ratio > kOneWay ? std::pow(shellLengthRoot(material), -4) : 0; // [1/m^2] of a curvature of 1/m
    const double ends = perRoot * most * least + below;                // [1/m^4]
    if (!(ends > 0)) return {std::numeric_limits<double>::infinity()};
    const double length = std::pow(ends, -0.25);
    const double unlike = ends / (perRoot * least * least + below); // of the softest wave
    const double window = kLocalWindow * std::max(1.0, std::pow(unlike / kAlike, kFarther));
    const double part   = std::clamp((ratio - kOneWay) / (kBothWays - kOneWay), 0.0, 1.0);
    const double radii  = std::lerp(kShallowRadii, kMostRadii, part);
    const double capped = std::min(window, radii / (std::abs(most) * length));
    return {length, ratio > kOneWay ? std::lerp(capped, window, below / ends) : window}; // a foundation knows no radius
}

std::optional<DentLengths> dentLengths(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double kMost = 0.5; // of the surface [1]
    const Asked      asked = askedBy(object, settings, bendsOf(object, settings));
    if (asked.share < kMost) return {};
    return asked.lengths;
}

BeyondShell beyondShell(const SoftObject& object, const PatchSettings& settings, double window)
{
    double      all = 0;
    BeyondShell beyond;
    for (const Bend& bend : bendsOf(object, settings)) {
        const double curvature = std::abs(bend.most);
        all += bend.area;
        if (curvature * window > 8 * mostSag(bend.most, bend.least)) beyond.deep += bend.area; // as a parabola sags
        if (curvature * object.material().thickness > kMostThick) beyond.thick += bend.area;
    }
    if (!(all > 0)) return {};
    return {beyond.deep / all, beyond.thick / all};
}

DentWindow dentWindow(const SoftObject& object, const PatchSettings& settings)
{
    return chosen(object, settings).window;
}

std::string whyDentWindow(const SoftObject& object, const PatchSettings& settings)
{
    if (settings.windowOf != WindowOf::dent) return {};
    const Choice choice = chosen(object, settings);
    return "auto: " + formatQuantity(choice.window.width, "m") + ", " + choice.why;
}

} // namespace palp
