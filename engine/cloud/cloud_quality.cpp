#include "engine/cloud/cloud_quality.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/cloud/neighbourhoods.h"

namespace palp {
namespace {

/// Radius of a neighbourhood [spacings of the point, or of the neighbour].
constexpr double kReach = 3;

/// Radius in which sparser neighbours are looked for [radii of the neighbourhood]: over it, a step in density is a
/// border. Survey and charts bear steps of up to 8.
constexpr double kSparser = 4;

/// With more points around it than this one does not lie beside sparser ones, but beside a far denser part [1]: of a
/// surface there are 450, of a volume 4000.
constexpr std::size_t kMostAround = 8192;

/// Neighbours that lie steeper over the tangent plane belong to another sheet [1]: the sine of 64 degrees. The faces at
/// the corner of a cube rise by 55.
constexpr double kSteep = 0.9;

/// Height over the tangent plane that noise may make [standard deviations].
constexpr double kNoisy = 3;

/// The two nearest points of one in a line are closer than this [spacings], of a random sheet those of 9 % are; and the
/// cosine between their directions is larger than this, of random ones in 40 %.
constexpr double kClose = 0.4, kStraight = 0.8;

struct Weighted {
    double value = 0, weight = 0;
};

/// Returns the least value below which at least that share of the weight lies.
/// \param sorted  not empty
double quantile(std::span<const Weighted> sorted, double share, double all)
{
    double sum = 0;
    for (const Weighted& one : sorted)
        if ((sum += one.weight) >= share * all) return one.value;
    return sorted.back().value;
}

/// Returns the value below which that share of the values lies; reorders them.
double quantile(std::vector<double>& values, double share)
{
    const auto place =
        values.begin() + std::ptrdiff_t(std::min(values.size() - 1, std::size_t(share * double(values.size()))));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

/// What is found about single points.
struct PointFacts {
    std::vector<std::uint8_t> border, inLine, stray;
    std::vector<float>        along;  ///< to the nearest point [m]
    std::vector<float>        across; ///< to the next line [m]; 0: none is near, or the point is in no line
};

/// Looks at the points of one piece of the cloud: each thread has its own.
class Looking {
public:
    /// \param points  by rank
    Looking(const SoftObject& object, std::span<const std::uint32_t> points, PointFacts& facts)
        : object_(object), survey_(object.survey()), points_(points), facts_(facts), neighbourhoods_(object.index())
    {
    }

    void operator()(const RankRun& run)
    {
        const auto radius = [&](std::uint32_t rank) { return kReach * survey_.spacing(points_[rank]); };
        neighbourhoods_.each(run, radius, [&](std::uint32_t rank, std::span<const NearCandidate> near) {
            const std::uint32_t point = points_[rank];
            lookForLine(rank, near);
            const auto isOther = [&](const NearCandidate& n) {
                return n.rank != rank && n.distance2 <= radius(rank) * radius(rank);
            };
            facts_.stray[point] = std::ranges::none_of(near, isOther);
            if (glm::dot(survey_.normal(point), survey_.normal(point)) == 0) return; // no surface, so no border either
            facts_.border[point] =
                !isSurrounded(rank, near, radius(rank)) && freeAngle() > kFree && !isBesideSparser(rank);
        });
    }

private:
    static constexpr double kFree = kFreeAngle * std::numbers::pi / 180; // [rad]

    /// Adds the directions of the neighbours, and returns whether some hundred of them surely leave no wide angle free:
    /// then the others need not be asked. Of few that costs more than it saves.
    bool isSurrounded(std::uint32_t rank, std::span<const NearCandidate> near, double radius)
    {
        constexpr std::size_t kMany = 256;
        angles_.clear();
        std::size_t ask = kMany; // angles before the next look
        for (const NearCandidate& candidate : near) {
            if (candidate.distance2 <= radius * radius) addAngle(rank, candidate);
            if (angles_.size() < ask) continue;
            if (freeAngle() <= kFree) return true;
            ask *= 2;
        }
        return false;
    }

    /// Adds the direction of a neighbour in the tangent plane, unless it belongs to another sheet.
    void addAngle(std::uint32_t rank, const NearCandidate& candidate)
    {
        if (candidate.rank == rank || !(candidate.distance2 > 0)) return;
        const std::uint32_t point = points_[rank], other = points_[candidate.rank];
        const glm::dvec3    normal = survey_.normal(point), away = candidate.away;
        const double        height = std::abs(glm::dot(normal, away));
        if (height > kSteep * std::sqrt(candidate.distance2) + kNoisy * survey_.noise(point)) return;
        if (survey_.apart(point, other)) return;
        const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 east   = glm::normalize(glm::cross(helper, normal));
        angles_.push_back(std::atan2(glm::dot(away, glm::cross(normal, east)), glm::dot(away, east)));
    }

    /// Returns the widest angle without a neighbour [rad].
    [[nodiscard]] double freeAngle()
    {
        if (angles_.empty()) return 2 * std::numbers::pi;
        std::ranges::sort(angles_);
        double widest = angles_.front() + 2 * std::numbers::pi - angles_.back();
        for (std::size_t k = 1; k < angles_.size(); ++k) widest = std::max(widest, angles_[k] - angles_[k - 1]);
        return widest;
    }

    /// Adds the points that count this one among their neighbours; returns whether they close the angle.
    bool isBesideSparser(std::uint32_t rank)
    {
        const std::span<const glm::dvec3> positions = object_.index().positionsByRank();
        const double                      own       = kReach * survey_.spacing(points_[rank]);
        if (!object_.index().gatherRanks(positions[rank], kSparser * own, kMostAround, found_)) return false;
        for (const std::uint32_t other : found_) {
            const glm::dvec3 away      = positions[other] - positions[rank];
            const double     distance2 = glm::dot(away, away), reach = kReach * survey_.spacing(points_[other]);
            if (distance2 > own * own && distance2 <= reach * reach) addAngle(rank, {other, away, distance2});
        }
        return freeAngle() <= kFree;
    }

    void lookForLine(std::uint32_t rank, std::span<const NearCandidate> near)
    {
        const std::uint32_t  point = points_[rank];
        const NearCandidate *first = nullptr, *second = nullptr;
        for (const NearCandidate& candidate : near) {
            if (candidate.rank == rank || !(candidate.distance2 > 0)) continue;
            if (!first || candidate.distance2 < first->distance2)
                second = std::exchange(first, &candidate);
            else if (!second || candidate.distance2 < second->distance2)
                second = &candidate;
        }
        if (!second) return;
        const double close  = kClose * survey_.spacing(point);
        facts_.along[point] = float(std::sqrt(first->distance2));
        facts_.inLine[point] =
            second->distance2 < close * close &&
            std::abs(glm::dot(first->away, second->away)) > kStraight * std::sqrt(first->distance2 * second->distance2);
        if (facts_.inLine[point]) facts_.across[point] = float(toNextLine(near, first->away, close));
    }

    /// Returns the distance of the nearest neighbour that does not lie along a direction [m]; 0 if there is none.
    /// \param close  a neighbour nearer to the line than this lies along it [m]
    [[nodiscard]] static double toNextLine(std::span<const NearCandidate> near, const glm::dvec3& direction,
                                           double close)
    {
        double least2 = INFINITY;
        for (const NearCandidate& candidate : near) {
            const double along   = glm::dot(candidate.away, direction);
            const double beside2 = candidate.distance2 - along * along / glm::dot(direction, direction);
            if (beside2 > close * close) least2 = std::min(least2, beside2);
        }
        return std::isfinite(least2) ? std::sqrt(least2) : 0;
    }

    const SoftObject&              object_;
    const SurfaceSurvey&           survey_;
    std::span<const std::uint32_t> points_; ///< by rank
    PointFacts&                    facts_;
    Neighbourhoods                 neighbourhoods_;
    std::vector<double>            angles_; ///< [rad] of the neighbours in the tangent plane
    std::vector<std::uint32_t>     found_;  ///< ranks
};

void measureSpacing(CloudQuality& quality, std::span<const double> spacings)
{
    std::vector<Weighted> sorted;
    sorted.reserve(spacings.size());
    for (const double s : spacings) {
        sorted.push_back({s, s * s});
        quality.area += s * s;
    }
    std::ranges::sort(sorted, {}, &Weighted::value);
    const auto at    = [&](double share) { return quantile(sorted, share, quality.area); };
    quality.spacing  = {sorted.front().value, at(0.05), at(0.5), at(0.95), sorted.back().value};
    quality.byPoints = sorted[sorted.size() / 2].value;
}

void measureNoise(CloudQuality& quality, const SurfaceSurvey& survey, std::size_t points)
{
    std::vector<double> noise(points), noisy(points);
    std::size_t         sided = 0;
    for (std::size_t i = 0; i < points; ++i) {
        noise[i] = survey.noise(i);
        noisy[i] = survey.noise(i) / survey.spacing(i);
        sided += survey.sided(i);
    }
    quality.noise   = quantile(noise, 0.5);
    quality.noise95 = quantile(noise, 0.95);
    quality.noisy   = quantile(noisy, 0.5);
    quality.noisy95 = quantile(noisy, 0.95);
    quality.sided   = double(sided) / double(points);
}

/// Returns the distance of the values that a coordinate takes, if these are few; else 0 [m].
double stepOf(std::span<const glm::dvec3> positions, int axis)
{
    constexpr std::size_t kLooked = 100'000, kFewest = 20; // points; values: two flat faces are no steps
    constexpr std::size_t kShare = 50;                     // points a value, or more
    const std::size_t     stride = positions.size() / kLooked + 1;
    std::vector<double>   along, steps;
    for (std::size_t i = 0; i < positions.size(); i += stride) along.push_back(positions[i][axis]);
    std::sort(along.begin(), along.end());
    std::size_t values = 1;
    for (std::size_t i = 1; i < along.size(); ++i) values += along[i] != along[i - 1];
    if (values < kFewest || along.size() < kShare * values) return 0;
    double last = 0; // each point has the step to the value before
    for (std::size_t i = 1; i < along.size(); ++i) {
        if (along[i] != along[i - 1]) last = along[i] - along[i - 1];
        if (last > 0) steps.push_back(last);
    }
    return quantile(steps, 0.5);
}

void measureDepthSteps(CloudQuality& quality, const SoftObject& object)
{
    constexpr double     kLeast = 0.1;  // of the spacing [1]: finer steps are no layers
    constexpr double     kAlong = 0.7;  // of the normal: it faces along the axis [1]
    constexpr double     kMany  = 0.02; // share of the points that are taken for faces [1]
    const SurfaceSurvey& survey = object.survey();
    for (int axis = 0; axis < 3; ++axis) {
        const double step = stepOf(object.positions(), axis);
        if (step < kLeast * quality.spacing.typical) continue;
        std::size_t facing = 0;
        for (std::size_t i = 0; i < object.size(); ++i)
            facing += survey.sided(i) && !survey.given(i) && std::abs(survey.normal(i)[axis]) > kAlong;
        if (double(facing) > kMany * double(object.size())) quality.depthStep = std::max(quality.depthStep, step);
    }
}

void summarise(CloudQuality& quality, const PointFacts& facts)
{
    std::vector<double> along, across;
    std::size_t         border = 0;
    for (std::size_t i = 0; i < facts.border.size(); ++i) {
        border += facts.border[i];
        quality.strays += facts.stray[i];
        if (facts.inLine[i]) along.push_back(facts.along[i]);
        if (facts.across[i] > 0) across.push_back(facts.across[i]);
    }
    const double all = double(facts.border.size());
    quality.border   = double(border) / all;
    quality.inLines  = double(along.size()) / all;
    if (!along.empty()) quality.alongLine = quantile(along, 0.5);
    if (!across.empty()) quality.betweenLines = quantile(across, 0.5);
}

/// Finds the borders that hang together, in steps of at most three spacings.
void measureBorders(CloudQuality& quality, const SoftObject& object, const PointFacts& facts)
{
    constexpr std::size_t   kFewest = 12; // points; fewer are there by chance
    std::vector<glm::dvec3> places;
    std::vector<double>     reach; // [m]
    for (std::size_t i = 0; i < facts.border.size(); ++i)
        if (facts.border[i]) {
            places.push_back(object.positions()[i]);
            reach.push_back(kReach * object.survey().spacing(i));
        }
    if (places.empty()) return;
    const NeighbourIndex       index(places);
    std::vector<std::uint8_t>  seen(places.size());
    std::vector<std::uint32_t> piece, near;
    for (std::uint32_t first = 0; first < places.size(); ++first) {
        if (std::exchange(seen[first], 1)) continue;
        piece.assign(1, first);
        glm::dvec3 low = places[first], high = low;
        for (std::size_t next = 0; next < piece.size(); ++next) {
            index.gather(places[piece[next]], reach[piece[next]], near);
            for (const std::uint32_t other : near) {
                if (std::exchange(seen[other], 1)) continue;
                piece.push_back(other);
                low  = glm::min(low, places[other]);
                high = glm::max(high, places[other]);
            }
        }
        const glm::dvec3 box = high - low;
        if (piece.size() >= kFewest) quality.borderWidths.push_back(std::max({box.x, box.y, box.z}));
    }
    std::ranges::sort(quality.borderWidths, std::greater<>());
}

} // namespace

double CloudQuality::pointsUnder(double radius) const noexcept
{
    return spacing.typical > 0 ? std::numbers::pi * radius * radius / (spacing.typical * spacing.typical) : 0;
}

CloudQuality cloudQuality(const SoftObject& object)
{
    CloudQuality         quality;
    const SurfaceSurvey& survey = object.survey();
    if (survey.spacings().empty()) return quality;
    measureSpacing(quality, survey.spacings());
    measureNoise(quality, survey, object.size());
    measureDepthSteps(quality, object);
    PointFacts facts{std::vector<std::uint8_t>(object.size()), std::vector<std::uint8_t>(object.size()),
                     std::vector<std::uint8_t>(object.size()), std::vector<float>(object.size()),
                     std::vector<float>(object.size())};
    const std::vector<std::uint32_t> points = object.index().pointsByRank();
    inCurveRuns(points.size(), [&] { return Looking(object, points, facts); });
    summarise(quality, facts);
    measureBorders(quality, object, facts);
    return quality;
}

} // namespace palp
