#include "engine/contact/detail/surface_projector.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace palp {
namespace {

// Lengths are in scales. A wider reach leaves less noise and takes more time.
constexpr double kReach         = 3;
constexpr double kPlaneReach    = 2;   // of the principal axes: a body behind counts less there
constexpr double kFullHeight    = 0.8; // seven or more times the noise is one scale: this is at least 5.6 of noise
constexpr double kNoHeight      = 1.4;
constexpr double kSettled       = 0.02; // change of the height that needs no further round
constexpr int    kRounds        = 4;
constexpr double kLeastKurtosis = 1.9; // [1] noise has 3, a uniform layer 1.8, two sheets 1
constexpr double kFewest        = 6;   // [1] sum of weights; the fit has four unknowns

struct Frame {
    glm::dvec3 normal{}, u{}, v{}; ///< [1] unit; 0 if there is none
};

Frame principalFrame(const std::vector<glm::dvec3>& points, double radius)
{
    double          weight = 0;
    Eigen::Vector3d mean   = Eigen::Vector3d::Zero();
    Eigen::Matrix3d sum    = Eigen::Matrix3d::Zero();
    for (const glm::dvec3& p : points) {
        const double share = 1 - glm::dot(p, p) / (radius * radius);
        if (!(share > 0)) continue;
        const double w = share * share;
        weight += w;
        mean += w * Eigen::Vector3d(p.x, p.y, p.z);
        sum(0, 0) += w * p.x * p.x;
        sum(1, 0) += w * p.x * p.y;
        sum(1, 1) += w * p.y * p.y;
        sum(2, 0) += w * p.x * p.z;
        sum(2, 1) += w * p.y * p.z;
        sum(2, 2) += w * p.z * p.z;
    }
    if (!(weight > kFewest)) return {};
    mean /= weight;
    sum = sum / weight - mean * mean.transpose(); // the solver reads the lower triangle; the mean is near the place
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(sum);
    const auto axis = [&](int k) {
        return glm::dvec3(eigen.eigenvectors()(0, k), eigen.eigenvectors()(1, k), eigen.eigenvectors()(2, k));
    };
    const glm::dvec3 normal = glm::normalize(axis(0)), u = glm::normalize(axis(2) - glm::dot(axis(2), normal) * normal);
    if (!std::isfinite(u.x)) return {};
    return {normal, u, glm::cross(normal, u)};
}

} // namespace

double SurfaceProjector::reach(double scale) noexcept
{
    return kReach * scale;
}

std::optional<glm::dvec3> SurfaceProjector::wayToSurface(double scale)
{
    const double r     = reach(scale);
    const Frame  frame = principalFrame(points_, kPlaneReach * scale);
    if (frame.normal == glm::dvec3(0)) return {};
    sites_.clear();
    for (const glm::dvec3& p : points_) {
        const double a = glm::dot(frame.u, p) / r, b = glm::dot(frame.v, p) / r, q = a * a + b * b;
        if (q < 1) sites_.push_back({a, b, q, glm::dot(frame.normal, p) / r, (1 - q) * (1 - q)});
    }
    Eigen::Vector4d fit = Eigen::Vector4d::Zero();
    for (int round = 0; round < kRounds; ++round) {
        double w1 = 0, wa = 0, wb = 0, wq = 0, waa = 0, wab = 0, waq = 0, wbb = 0, wbq = 0, wqq = 0;
        double h1 = 0, ha = 0, hb = 0, hq = 0;
        for (const Site& s : sites_) {
            const double away = std::abs(s.h - fit[0] - fit[1] * s.a - fit[2] * s.b - fit[3] * s.q) * kReach;
            if (!(away < kNoHeight)) continue;
            const double x = std::min((kNoHeight - away) / (kNoHeight - kFullHeight), 1.0);
            const double w = s.fall * x * x * (3 - 2 * x), a = w * s.a, b = w * s.b, q = w * s.q;
            w1 += w;
            wa += a;
            wb += b;
            wq += q;
            waa += a * s.a;
            wab += a * s.b;
            waq += a * s.q;
            wbb += b * s.b;
            wbq += b * s.q;
            wqq += q * s.q;
            h1 += w * s.h;
            ha += a * s.h;
            hb += b * s.h;
            hq += q * s.h;
        }
        if (!(w1 > kFewest)) return {};
        Eigen::Matrix4d moments;
        moments << w1, wa, wb, wq, wa, waa, wab, waq, wb, wab, wbb, wbq, wq, waq, wbq, wqq;
        constexpr double kRidge = 1e-6; // [1] of the weight: points on a line must not blow up
        moments.diagonal().array() += kRidge * w1;
        const double before = fit[0];
        fit                 = moments.ldlt().solve(Eigen::Vector4d(h1, ha, hb, hq));
        if (round > 0 && std::abs(fit[0] - before) * kReach < kSettled) break;
    }
    double weight = 0, square = 0, fourth = 0;
    for (const Site& s : sites_) {
        const double away = s.h - fit[0] - fit[1] * s.a - fit[2] * s.b - fit[3] * s.q;
        if (!(std::abs(away) * kReach < kNoHeight)) continue;
        weight += s.fall;
        square += s.fall * away * away;
        fourth += s.fall * away * away * away * away;
    }
    if (fourth * weight < kLeastKurtosis * square * square) return {};
    return std::clamp(r * fit[0], -scale, scale) * frame.normal;
}

} // namespace palp
