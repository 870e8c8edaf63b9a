#include "engine/contact/detail/plane_fit.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {
namespace {

// Lengths are in local spacings unless noted. About 24 points count within the least radius: noise of 0.2 then leaves
// an error of 0.04 in height and of 2 degrees in the normal.
constexpr double      kLeastRadius  = 3.75;
constexpr double      kMostRadius   = 8;
constexpr std::size_t kEnoughPoints = 12;    // the radius is kEnoughReach times the distance of this one
constexpr double      kEnoughReach  = 1.9;   // [1]
constexpr std::size_t kFewestPoints = 6;     // four unknowns, and two to spare
constexpr double      kFullSupport  = 0.34;  // [1] centroid's offset over the radius; random clouds have 0.08 (sd), ...
constexpr double      kNoSupport    = 0.50;  // ... a straight border 0.29
constexpr double      kNoiseCurve   = 0.06;  // [1/spacing] K below it is shrunk away
constexpr double      kSmoothCurve  = 0.009; // [1/spacing] the same where all points are smoothed
constexpr double      kMostCurve    = 0.15;  // [1/spacing]
constexpr double      kSlopeRidge   = 0.01;  // [spacing^2] added to the variances of a and b
constexpr double      kCurveRidge   = 0.05;  // [spacing^4] added to the variance of q
constexpr double      kBetween      = 0.2;   // points in a groove nearer to one side by less belong to neither
constexpr double      kCrowded      = 2;     // [1] points this many times closer than the spacing count less
constexpr double      kFacesAway    = 0.2; // [1] cosine to the plane's normal beyond which a point is of the other side
constexpr double      kSteepest     = 1;   // [1] slope against the given plane

/// Returns the weight of a height: 1 up to kFullHeight, a smoothstep down to 0 at kNoHeight.
double heightWeight(double height) noexcept
{
    const double x = std::clamp((kNoHeight - height) / (kNoHeight - kFullHeight), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

/// Returns a unit vector across; which one does not matter, but it is always the same.
glm::dvec3 across(const glm::dvec3& n) noexcept
{
    const glm::dvec3 a = glm::abs(n);
    const glm::dvec3 axis(a.x <= a.y && a.x <= a.z, a.y < a.x && a.y <= a.z, a.z < a.x && a.z < a.y);
    return glm::normalize(glm::cross(n, axis));
}

/// Weighted first and second moments about the mean, of a, b, q and h.
struct Moments {
    double weight = 0;
    double a = 0, b = 0, q = 0, h = 0, spacing = 0, smooth = 0; // means
    double aa = 0, ab = 0, aq = 0, bb = 0, bq = 0, qq = 0, ah = 0, bh = 0, qh = 0;

    void addFirst(double w, double ai, double bi, double hi, double si, double smoothi) noexcept
    {
        weight += w;
        a += w * ai;
        b += w * bi;
        q += w * (ai * ai + bi * bi);
        h += w * hi;
        spacing += w * si;
        smooth += w * smoothi;
    }
    void toMeans() noexcept
    {
        for (double* sum : {&a, &b, &q, &h, &spacing, &smooth}) *sum /= weight;
    }
    void addSecond(double w, double ai, double bi, double hi) noexcept
    {
        w /= weight;
        const double da = ai - a, db = bi - b, dq = ai * ai + bi * bi - q, dh = hi - h;
        aa += w * da * da;
        ab += w * da * db;
        aq += w * da * dq;
        bb += w * db * db;
        bq += w * db * dq;
        qq += w * dq * dq;
        ah += w * da * dh;
        bh += w * db * dh;
        qh += w * dq * dh;
    }
};

/// Centroid of all points, those of other surfaces included: a groove is not a border.
struct Centroid {
    double weight = 0, a = 0, b = 0; // sums

    void add(double w, double ai, double bi) noexcept
    {
        weight += w;
        a += w * ai;
        b += w * bi;
    }
    [[nodiscard]] double offset() const noexcept { return std::hypot(a, b) / weight; } ///< [m]
};

/// Returns K of the quadratic fit, by eliminating beta and gamma, less what noise could have made.
double curvature(const Moments& m, double spacing) noexcept
{
    // With S the symmetric 2x2 block of (a, b):  (qq - c' S^-1 c) K = qh - c' S^-1 g,  c = (aq, bq), g = (ah, bh).
    const double determinant = m.aa * m.bb - m.ab * m.ab;
    const double ca          = (m.bb * m.aq - m.ab * m.bq) / determinant;
    const double cb          = (m.aa * m.bq - m.ab * m.aq) / determinant;
    const double k           = (m.qh - ca * m.ah - cb * m.bh) / (m.qq - ca * m.aq - cb * m.bq);
    const double shown       = k * spacing;
    const double noise       = kNoiseCurve + m.smooth * (kSmoothCurve - kNoiseCurve);
    const double kept        = shown * shown * shown / (shown * shown + noise * noise);
    return std::clamp(kept, -kMostCurve, kMostCurve) / spacing;
}

} // namespace

double SurfacePlane::height(const glm::dvec3& place) const noexcept
{
    return glm::dot(normal, place - foot);
}

PlaneFitter::PlaneFitter(NearPoints& points) : points_(points)
{
    seen_.reserve(NearPoints::kMost);
    squares_.reserve(NearPoints::kMost);
}

void PlaneFitter::collect(const Frame& frame, double radius)
{
    seen_.clear();
    owned_ = 0;
    points_.inside(frame.place, radius, frame.spacing, [&](const NearPoint& point, double d2) {
        const glm::dvec3 d = point.position - frame.place;
        const double     h = glm::dot(frame.normal, d);
        if (!(std::abs(h) < kNoHeight * frame.spacing)) return;
        if (frame.side != 0 && frame.side * point.mark.facing.along(frame.normal) < -kFacesAway) return;
        bool own = true;
        for (const SurfacePlane& other : frame.others)
            own = own && (glm::dot(other.normal, frame.normal) >= kSameSurface ||
                          std::abs(other.height(point.position)) >= std::abs(h) + kBetween * frame.spacing);
        seen_.push_back(
            {glm::dot(frame.u, d), glm::dot(frame.v, d), h, d2, point.spacing, own, double(point.mark.smoothed)});
        owned_ += own;
    });
}

/// Collects the points that count and returns the radius [m]: the least one, unless there is a hole.
double PlaneFitter::collectEnough(const Frame& frame)
{
    const double most  = kMostRadius * frame.spacing;
    double       least = kLeastRadius * frame.spacing;
    collect(frame, least);
    if (owned_ < kEnoughPoints) collect(frame, most);
    if (owned_ < kEnoughPoints) return most;

    squares_.clear();
    for (const Seen& s : seen_)
        if (s.own) squares_.push_back(s.d2);
    const auto twelfth = squares_.begin() + (kEnoughPoints - 1);
    std::nth_element(squares_.begin(), twelfth, squares_.end());
    const double radius = std::clamp(kEnoughReach * std::sqrt(*twelfth), least, most);
    if (radius > least) collect(frame, radius);
    return radius;
}

std::optional<PlaneFit> PlaneFitter::fit(const glm::dvec3& place, const glm::dvec3& normal, double spacing,
                                         std::span<const SurfacePlane> others, int side) noexcept
{
    const glm::dvec3 u = across(normal);
    const glm::dvec3 v = glm::cross(normal, u);
    const double     r = collectEnough({place, normal, u, v, spacing, others, side});
    if (owned_ < kFewestPoints) return {};

    Moments    m;
    const auto fall = [&](const Seen& s) {
        const double share = std::max(0.0, 1 - s.d2 / (r * r));
        return share * share;
    };
    const auto weightOf = [&](const Seen& s) {
        // Where points are closer than half the usual spacing here, they count by the area they stand for, or a step in
        // density would look like a border.
        const double area = std::min(1.0, kCrowded * s.spacing / spacing);
        return area * area * fall(s) * heightWeight(std::abs(s.h) / spacing);
    };
    Centroid all;
    for (const Seen& s : seen_) {
        const double w   = weightOf(s);
        const double own = std::min(s.spacing / spacing, kCrowded);
        all.add(own * own * fall(s) * heightWeight(std::abs(s.h) / spacing), s.a, s.b);
        if (s.own) m.addFirst(w, s.a, s.b, s.h, s.spacing, s.smooth);
    }
    if (!(m.weight > 0)) return {};
    m.toMeans();
    for (const Seen& s : seen_)
        if (s.own) m.addSecond(weightOf(s), s.a, s.b, s.h);
    m.aa += kSlopeRidge * spacing * spacing;
    m.bb += kSlopeRidge * spacing * spacing;
    m.qq += kCurveRidge * spacing * spacing * spacing * spacing;

    const double k           = curvature(m, spacing);
    const double determinant = m.aa * m.bb - m.ab * m.ab;
    const double ah          = m.ah - k * m.aq;
    const double bh          = m.bh - k * m.bq;
    double       beta        = (m.bb * ah - m.ab * bh) / determinant;
    double       gamma       = (m.aa * bh - m.ab * ah) / determinant;
    if (const double slope = std::hypot(beta, gamma); slope > kSteepest) {
        beta *= kSteepest / slope;
        gamma *= kSteepest / slope;
    }
    const double alpha  = m.h - beta * m.a - gamma * m.b - k * m.q;
    const double raised = alpha / std::sqrt(1 + beta * beta + gamma * gamma);

    PlaneFit fit;
    fit.plane.normal  = glm::normalize(normal - beta * u - gamma * v);
    fit.raised        = std::clamp(raised, -kStepCap * spacing, kStepCap * spacing);
    fit.plane.foot    = place + fit.raised * fit.plane.normal;
    const double off  = all.offset() / r;
    fit.plane.support = 1 - std::clamp((off - kFullSupport) / (kNoSupport - kFullSupport), 0.0, 1.0);
    fit.plane.side    = side;
    fit.spacing       = m.spacing;
    return fit;
}

} // namespace palp
