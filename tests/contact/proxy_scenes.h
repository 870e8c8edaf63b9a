#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "engine/cloud/soft_object.h"
#include "engine/contact/proxy.h"
#include "tests/cloud/point_sheets.h"

/// Motions of the proxy's tests. All lengths here are in mean spacings; the clouds have one of 1 mm.
namespace palp::proxytest {

using namespace cloudtest;

inline constexpr double        kSpacing   = 1e-3; ///< [m]
inline constexpr int           kSeeds     = 8;
inline constexpr std::uint64_t kFirstSeed = 1000;

/// An object and a proxy, spoken to in spacings.
class Touch {
public:
    /// \param normals  of the points, outward; none: not known
    explicit Touch(const Points& points, const ProxySettings& settings = {}, const glm::dvec3& shift = glm::dvec3(0),
                   const std::vector<glm::vec3>& normals = {})
        : shift_(shift)
    {
        Points positions = points; // [m]
        for (glm::dvec3& p : positions) p = kSpacing * (p + shift);
        const std::vector<double> stiffness(positions.size(), 1e6);
        PointCloud                cloud(std::move(positions), stiffness, StiffnessKind::modulus);
        object_ = std::make_unique<SoftObject>(std::move(cloud), Material{}, std::vector<Triangle>{}, normals);
        proxy_  = std::make_unique<Proxy>(*object_, settings);
    }

    void step(const glm::dvec3& hip)
    {
        const glm::dvec3 before = force(), pullBefore = pull();
        hip_ = hip;
        proxy_->step(kSpacing * (hip + shift_));
        forceStep_            = glm::length(force() - before);
        pullStep_             = glm::length(pull() - pullBefore);
        const glm::dvec3 both = at() + pull();
        EXPECT_FALSE(std::isnan(both.x + both.y + both.z)) << "the largest of some numbers would not show it";
    }

    /// Straight to a place in ticks of at most `speed`, calling `after` after each.
    template <class After>
    void move(const glm::dvec3& to, double speed, After&& after)
    {
        const glm::dvec3 from  = hip_;
        const int        ticks = std::max(1, int(std::ceil(glm::length(to - from) / speed - 1e-9)));
        for (int k = 1; k <= ticks; ++k) {
            step(from + (double(k) / ticks) * (to - from));
            after();
        }
    }
    void move(const glm::dvec3& to, double speed)
    {
        move(to, speed, [] {});
    }
    void start(const glm::dvec3& hip)
    {
        hip_ = hip;
        proxy_->reset(kSpacing * (hip + shift_));
    }

    [[nodiscard]] const ProxyState& state() const { return proxy_->state(); }
    [[nodiscard]] glm::dvec3        at() const { return state().position / kSpacing - shift_; }
    [[nodiscard]] glm::dvec3        hip() const { return hip_; }
    [[nodiscard]] bool              touching() const { return state().touching; }
    [[nodiscard]] glm::dvec3        force() const { return touching() ? state().fade * (at() - hip_) : glm::dvec3(0); }
    [[nodiscard]] glm::dvec3        pull() const { return state().pull / kSpacing; }
    [[nodiscard]] double            forceStep() const { return forceStep_; } ///< [spacings] of depth, in the last tick
    [[nodiscard]] double            pullStep() const { return pullStep_; }   ///< [spacings] of depth, in the last tick

private:
    glm::dvec3                  shift_;
    std::unique_ptr<SoftObject> object_;
    std::unique_ptr<Proxy>      proxy_;
    glm::dvec3                  hip_{};
    double                      forceStep_ = 0;
    double                      pullStep_  = 0;
};

/// What a slide showed.
struct Slide {
    int    ticks = 0, popped = 0, flipped = 0;
    double angle2 = 0, height = 0, height2 = 0; ///< sums
    double lag = 0, forceStep = 0;              ///< largest

    /// \param normal, height, lag  of the true surface below the proxy, the proxy over it, and behind where it should
    ///                             be
    void add(const Touch& touch, const glm::dvec3& normal, double heightNow, double lagNow)
    {
        const double c = glm::dot(touch.state().normal, normal);
        ++ticks;
        popped += !touch.touching() || heightNow < -1;
        flipped += c < 0;
        angle2 += std::pow(std::acos(std::clamp(c, -1.0, 1.0)), 2);
        height += heightNow;
        height2 += heightNow * heightNow;
        lag       = std::max(lag, lagNow);
        forceStep = std::max(forceStep, touch.forceStep());
    }
    void add(const Slide& b)
    {
        ticks += b.ticks;
        popped += b.popped;
        flipped += b.flipped;
        angle2 += b.angle2;
        height += b.height;
        height2 += b.height2;
        lag       = std::max(lag, b.lag);
        forceStep = std::max(forceStep, b.forceStep);
    }

    [[nodiscard]] bool   held() const { return popped == 0 && flipped == 0; }
    [[nodiscard]] double angle() const { return std::sqrt(angle2 / ticks) * 180 / std::numbers::pi; } ///< [deg] RMS
    [[nodiscard]] double bias() const { return height / ticks; }
    [[nodiscard]] double ripple() const { return std::sqrt(std::max(0.0, height2 / ticks - bias() * bias())); }
};

/// Several runs of one kind.
struct Runs {
    int    count = 0, popped = 0; ///< runs
    Slide  all;
    double worstAngle = 0, worstRipple = 0, worstBias = 0, worstLag = 0; ///< of one run

    void add(const Slide& slide)
    {
        ++count;
        popped += !slide.held();
        all.add(slide);
        worstAngle  = std::max(worstAngle, slide.angle());
        worstRipple = std::max(worstRipple, slide.ripple());
        worstBias   = std::max(worstBias, std::abs(slide.bias()));
        worstLag    = std::max(worstLag, slide.lag);
    }
};

inline void PrintTo(const Runs& runs, std::ostream* out)
{
    *out << runs.popped << " of " << runs.count << " popped; normal " << runs.all.angle() << " deg RMS (worst run "
         << runs.worstAngle << "), ripple " << runs.all.ripple() << " (" << runs.worstRipple << "), bias "
         << runs.all.bias() << ", lag " << runs.worstLag << ", force step " << runs.all.forceStep;
}

/// Leaves what was measured in the report of the tests (--gtest_output=json:FILE), whether or not they pass.
inline std::string record(const std::string& measured, const std::string& of = "measured")
{
    testing::Test::RecordProperty(of, measured);
    return of + ": " + measured;
}
inline std::string record(const Runs& runs, const std::string& of = "measured")
{
    return record(testing::PrintToString(runs), of);
}

/// Presses down at `from` to `depth` below z = 0 and slides `way` to the side, on a flat object.
inline Slide slideFlat(Touch& touch, const glm::dvec3& from, const glm::dvec3& way, double depth, double speed)
{
    Slide slide;
    touch.start({from.x, from.y, 5});
    touch.move({from.x, from.y, -depth}, 0.5);
    const auto note = [&] {
        const glm::dvec3 x = touch.at();
        slide.add(touch, {0, 0, 1}, x.z, std::hypot(x.x - touch.hip().x, x.y - touch.hip().y));
    };
    touch.move(touch.hip() + way, speed, note);
    return slide;
}

} // namespace palp::proxytest
