#include "engine/tools/fit/depth_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "engine/cloud/material.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/force/relaxing_contact.h"
#include "engine/tools/fit/least_squares.h"

namespace palp::fit {
namespace {

constexpr double kMostShares = 0.99; // [1] as parseRelaxation() takes them

double shareOfRange(double squares, const Probe& probe)
{
    const double range = probe.forceRange();
    return std::sqrt(squares / double(probe.force.size())) / (range > 0 ? range : std::abs(probe.force.front()));
}

double squaresOf(std::span<const double> force, const Probe& probe)
{
    double sum = 0;
    for (std::size_t n = 0; n < force.size(); ++n) sum += (force[n] - probe.force[n]) * (force[n] - probe.force[n]);
    return sum;
}

/// Fits F = a u(d) + c v(d), without the second where it is null.
TriedLaw combination(const std::string& name, const Probe& probe, double (*u)(double), double (*v)(double) = nullptr)
{
    const double unit = probe.deepest(); // makes depths pure numbers
    double       uu = 0, uv = 0, vv = 0, uf = 0, vf = 0;
    for (std::size_t n = 0; n < probe.depth.size(); ++n) {
        const double a = u(probe.depth[n] / unit), b = v ? v(probe.depth[n] / unit) : 0, f = probe.force[n];
        uu += a * a, uv += a * b, vv += b * b, uf += a * f, vf += b * f;
    }
    const double determinant = uu * vv - uv * uv;
    const bool   both        = determinant > 1e-12 * uu * vv;
    const double first       = both ? (vv * uf - uv * vf) / determinant : uf / uu;
    const double second      = both ? (uu * vf - uv * uf) / determinant : 0;
    TriedLaw     law{name, {}, 0};
    for (const double depth : probe.depth)
        law.force.push_back(first * u(depth / unit) + (v ? second * v(depth / unit) : 0));
    law.residual = shareOfRange(squaresOf(law.force, probe), probe);
    return law;
}

double line(double d)
{
    return d;
}
double hertz(double d)
{
    return d * std::sqrt(d);
}
double cube(double d)
{
    return d * d * d;
}

/// A law of ours with its numbers: parameters are ln K, b times the deepest depth, then g and ln tau of each term.
struct Model {
    const Probe& probe;
    std::size_t  terms;

    [[nodiscard]] DepthLaw law(std::span<const double> p) const
    {
        return {std::exp(p[0]), p[1] / probe.deepest(), std::numeric_limits<double>::infinity()};
    }
    [[nodiscard]] Relaxation relaxation(std::span<const double> p) const
    {
        Relaxation r;
        for (; r.count < terms; ++r.count) r.terms[r.count] = {p[2 + 2 * r.count], std::exp(p[3 + 2 * r.count])};
        return r;
    }
    void forces(std::span<const double> p, std::span<double> force) const
    {
        const DepthLaw elastic = law(p);
        if (terms == 0) {
            for (std::size_t n = 0; n < force.size(); ++n) force[n] = elastic.force(probe.depth[n]);
            return;
        }
        const Relaxation giving = relaxation(p);
        if (giving.shares() > kMostShares) {
            std::ranges::fill(force, std::numeric_limits<double>::quiet_NaN());
            return;
        }
        RelaxingContact contact(giving, 1.0); // at one place
        for (std::size_t n = 0; n < force.size(); ++n)
            force[n] =
                contact.step({elastic, probe.depth[n], {}, n == 0 ? 0 : probe.time[n] - probe.time[n - 1]}).force;
    }
    [[nodiscard]] LeastSquares fit(std::span<const Parameter> start) const
    {
        return leastSquares(start, probe.force.size(), [this](std::span<const double> p, std::span<double> r) {
            forces(p, r);
            for (std::size_t n = 0; n < r.size(); ++n) r[n] -= probe.force[n];
        });
    }
};

/// Returns K and b to begin with, which the shallower and the deeper half of the forces tell.
std::array<Parameter, 2> elasticStart(const Probe& probe)
{
    constexpr double kMostBend = 40; // of b times the deepest depth: the force then rises within a fortieth of it
    const double     most      = std::min(kMostBend, kMostStiffening * probe.deepest());
    double           sum = 0, squares = 0;
    for (std::size_t n = 0; n < probe.depth.size(); ++n) {
        sum += probe.depth[n] * probe.force[n];
        squares += probe.depth[n] * probe.depth[n];
    }
    const double secant = std::max(sum, 1e-9 * squares) / squares; // [N/m]
    return {Parameter{std::log(secant / 2), std::log(1e-6 * secant), std::log(1e3 * secant)},
            {std::min(1.0, most), 0, most}};
}

/// Returns the start for some terms: times spread over the measurement, or those of fewer terms and one between them.
std::vector<Parameter> startOf(const Probe& probe, std::size_t terms, const LeastSquares& fewer)
{
    const double           duration = probe.time.back() - probe.time.front();
    const double           shortest = std::max(1e-3, duration / double(probe.time.size()) / 3);
    const double           longest  = std::min(1e4, 5 * duration);
    const auto             elastic  = elasticStart(probe);
    std::vector<Parameter> start(elastic.begin(), elastic.end());
    start[0].start = fewer.parameters[0];
    start[1].start = fewer.parameters[1];
    constexpr std::array<std::array<double, 3>, 3> kTimes{{{0.2, 0, 0}, {0.03, 0.4, 0}, {0.01, 0.08, 0.7}}};
    for (std::size_t n = 0; n < terms; ++n) {
        const double time = std::clamp(kTimes[terms - 1][n] * duration, shortest, longest);
        start.push_back({0.6 / double(terms), 1e-6, kMostShares});
        start.push_back({std::log(time), std::log(shortest), std::log(longest)});
    }
    return start;
}

/// Schwarz's criterion: lower is better.
double schwarz(const LeastSquares& fit, std::size_t rows)
{
    const double n = double(rows);
    return n * std::log(std::max(fit.squares, 1e-300) / n) + double(fit.parameters.size()) * std::log(n);
}

Estimate estimate(double value, double deviation, double factor, double low, double high)
{
    return {value, std::max(low, value - factor * deviation), std::min(high, value + factor * deviation)};
}

Estimate ofLogarithm(double logarithm, double deviation, double factor)
{
    return {std::exp(logarithm), std::exp(logarithm - factor * deviation), std::exp(logarithm + factor * deviation)};
}

/// Puts the numbers of a fit into a probe's; terms by rising times.
void take(ProbeFit& result, const Model& model, const LeastSquares& fit)
{
    const double     factor = studentFactor(fit.freedom), deepest = model.probe.deepest();
    const auto&      p     = fit.parameters;
    const auto&      sd    = fit.deviations;
    constexpr double kNone = std::numeric_limits<double>::infinity();
    result.stiffness       = ofLogarithm(p[0], sd[0], factor);
    result.stiffening      = estimate(p[1] / deepest, sd[1] / deepest, factor, 0, kNone);
    std::vector<std::size_t> order;
    for (std::size_t n = 0; n < model.terms; ++n) order.push_back(n);
    std::ranges::sort(order, {}, [&](std::size_t n) { return p[3 + 2 * n]; });
    for (const std::size_t n : order) {
        result.shares.push_back(estimate(p[2 + 2 * n], sd[2 + 2 * n], factor, 0, 1));
        result.times.push_back(ofLogarithm(p[3 + 2 * n], sd[3 + 2 * n], factor));
        result.relaxation.terms[result.relaxation.count++] = {result.shares.back().value, result.times.back().value};
    }
    result.force.resize(model.probe.force.size());
    model.forces(p, result.force);
    result.residual = shareOfRange(fit.squares, model.probe);
}

double median(std::vector<double> values)
{
    PALP_EXPECT(!values.empty(), "no values");
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

} // namespace

std::string intervalText(const Estimate& estimate, std::string_view siUnit)
{
    const std::string value = formatQuantity(estimate.value, siUnit), low = formatQuantity(estimate.low, siUnit),
                      high = formatQuantity(estimate.high, siUnit);
    if (low != value || high != value) return value + " (" + low + " to " + high + ")";
    if (!std::isfinite(estimate.value)) return value;
    const double half = std::max(estimate.high - estimate.value, estimate.value - estimate.low);
    return value + " (+- " + shortNumber(half > 0 ? 100 * half / std::abs(estimate.value) : 0, 2) + " %)";
}

ProbeFit fitProbe(const Probe& probe)
{
    ProbeFit result;
    result.name   = probe.name;
    result.others = {combination("linear", probe, line), combination("Hertz", probe, hertz),
                     combination("cubic", probe, line, cube)};
    Model        best{probe, 0};
    const auto   elastic = elasticStart(probe);
    LeastSquares fit     = best.fit(elastic);
    if (!probe.time.empty()) {
        TriedLaw alone{"exponential", std::vector<double>(probe.force.size()), shareOfRange(fit.squares, probe)};
        best.forces(fit.parameters, alone.force);
        result.others.push_back(std::move(alone));
    }
    constexpr double kWorthIt = 0.81; // of the squares: a tenth off the residual [1]
    for (std::size_t terms = 1; !probe.time.empty() && terms <= Relaxation::kMostTerms; ++terms) {
        if (probe.force.size() < 4 * (2 + 2 * terms)) break; // too few rows for so many numbers
        const Model        model{probe, terms};
        const LeastSquares more = model.fit(startOf(probe, terms, fit));
        if (!(more.squares < kWorthIt * fit.squares) ||
            !(schwarz(more, probe.force.size()) < schwarz(fit, probe.force.size())))
            break;
        fit        = more;
        best.terms = terms;
    }
    take(result, best, fit);
    return result;
}

double ProbesFit::medianResidual() const
{
    std::vector<double> all;
    for (const ProbeFit& p : probes) all.push_back(p.residual);
    return median(std::move(all));
}

double ProbesFit::medianResidual(std::string_view law) const
{
    std::vector<double> all;
    for (const ProbeFit& p : probes)
        for (const TriedLaw& other : p.others)
            if (other.name == law) all.push_back(other.residual);
    return median(std::move(all));
}

ProbesFit together(std::vector<ProbeFit> probes)
{
    ProbesFit                                   all;
    std::vector<double>                         bends;
    std::array<int, Relaxation::kMostTerms + 1> counts{};
    for (const ProbeFit& p : probes) {
        bends.push_back(p.stiffening.value);
        ++counts[p.relaxation.count];
    }
    all.stiffening       = median(std::move(bends));
    all.relaxation.count = std::size_t(std::ranges::max_element(counts) - counts.begin());
    for (std::size_t n = 0; n < all.relaxation.count; ++n) {
        std::vector<double> shares, times;
        for (const ProbeFit& p : probes) {
            if (p.relaxation.count != all.relaxation.count) continue;
            shares.push_back(p.relaxation.terms[n].share);
            times.push_back(p.relaxation.terms[n].time);
        }
        all.relaxation.terms[n] = {median(std::move(shares)), median(std::move(times))};
    }
    all.probes = std::move(probes);
    return all;
}

} // namespace palp::fit
