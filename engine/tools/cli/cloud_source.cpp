#include "engine/tools/cli/cloud_source.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

constexpr std::string_view kSamplePrefix = "sample:";

StiffnessKind kindOf(const std::string& unit)
{
    for (StiffnessKind kind : {StiffnessKind::modulus, StiffnessKind::rigidity})
        if (unitOf(kind) == unit) return kind;
    throw Error("--stiffness-unit: unknown unit \"" + unit + "\"; known units: Pa (modulus), N_m (flexural rigidity)");
}

/// "2e4,2e6" or "20kPa,2MPa".
StiffnessRange rangeOf(const std::string& text, bool logarithmic, StiffnessKind kind)
{
    const std::size_t comma     = text.find(',');
    const Dimension   dimension = kind == StiffnessKind::modulus ? Dimension::pressure : Dimension::rigidity;
    if (comma == std::string::npos)
        throw Error("--range: expected FROM,TO, such as 20kPa,2MPa, found \"" + text + "\"");
    const StiffnessRange range{parseQuantity(text.substr(0, comma), dimension, "--range"),
                               parseQuantity(text.substr(comma + 1), dimension, "--range"),
                               logarithmic ? RangeScale::logarithmic : RangeScale::linear};
    if (!(range.from > 0 && range.to > 0))
        throw Error("--range: expected two stiffnesses above zero, found \"" + text + "\"");
    return range;
}

nlohmann::json pointJson(const glm::dvec3& p)
{
    return {p.x, p.y, p.z};
}

/// An option and whether the user gave it.
struct Given {
    const char* option;
    bool        given;
};

void refuseGiven(std::initializer_list<Given> options, const std::string& why)
{
    for (const Given& one : options)
        if (one.given) throw Error(std::string(one.option) + ": " + why + "; leave it away");
}

/// Every option that would have no effect.
void refuseUseless(const CloudSource& s)
{
    const std::initializer_list<Given> values = {{"--stiffness-property", !s.stiffnessProperty.empty()},
                                                 {"--range", !s.range.empty()},
                                                 {"--log-range", s.logRange},
                                                 {"--uniform", !s.uniform.empty()}};
    if (s.sample()) {
        const std::string why = "expected a file, but " + s.name + " is a sample with a stiffness of its own [Pa]";
        refuseGiven(values, why);
        refuseGiven({{"--stiffness-unit", !s.stiffnessUnit.empty()},
                     {"--columns", !s.columns.empty()},
                     {"--drop-invalid", s.dropInvalid}},
                    why);
        return;
    }
    refuseGiven({{"--points", s.points.has_value()}, {"--seed", s.seed.has_value()}},
                "expected a sample, but " + s.name + " is a file");
    if (!s.law.empty()) refuseGiven(values, "--stiffness replaces the stiffness that this option is about");
    if (s.logRange && s.range.empty()) throw Error("--log-range: expected --range FROM,TO beside it, found none");
}

/// The file's own word on its stiffness stands against the user's, or its stiffness against a uniform one.
void refuseContradiction(const CloudSource& s, const LoadedCloud& loaded)
{
    if (!s.law.empty() || !loaded.report.stiffnessProperty) return;
    if (!s.uniform.empty())
        throw Error("--uniform: expected a file without stiffness, found " + loaded.report.stiffnessSource +
                    "; to replace it give --stiffness constant:value=PASCAL");
    const auto stated = loaded.report.statedKind;
    if (stated && *stated != loaded.cloud.kind())
        throw Error("--stiffness-unit: " + s.stiffnessUnit + " contradicts the file's comment, stiffness_unit " +
                    unitOf(*stated) + "; leave the option away or correct the comment in " + s.name);
}

std::uint64_t atLeast(std::int64_t least, std::int64_t value, const char* option)
{
    if (value < least)
        throw Error(std::string(option) + ": expected at least " + std::to_string(least) + ", found " +
                    std::to_string(value));
    return std::uint64_t(value);
}

/// Smallest and largest stiffness of the points.
std::pair<double, double> stiffnessBounds(const PointCloud& cloud)
{
    const auto [least, most] = std::minmax_element(cloud.stiffness().begin(), cloud.stiffness().end());
    return {*least, *most};
}

} // namespace

void CloudSource::addTo(CLI::App& command)
{
    command
        .add_option("CLOUD", name, "a .ply, .pcd, .xyz, .txt or .csv file, or sample:NAME (see palpate info --samples)")
        ->required();
    command.add_option("--unit", unit,
                       "m, mm, cm, um, km, in or ft: length unit of the file (else its comment, else m) and of plain "
                       "numbers in --at and other lengths (else m)");
    command.add_option("--stiffness-property", stiffnessProperty, "property that holds the stiffness, such as quality");
    command.add_option("--range", range, "FROM,TO: maps the property's smallest and largest value, such as 20kPa,2MPa");
    command.add_flag("--log-range", logRange, "maps by equal factors instead of equal steps");
    command.add_option("--stiffness-unit", stiffnessUnit, "Pa (Young's modulus) or N_m (flexural rigidity)");
    command.add_option("--uniform", uniform, "stiffness where the file has none, such as 300kPa (else 300kPa)");
    command.add_option("--columns", columns, "meaning of a text file's columns, such as x,y,z,-,stiffness");
    command.add_flag("--drop-invalid", dropInvalid,
                     "leaves out points with NaN or infinity instead of refusing the file");
    command.add_option("--stiffness", law,
                       "replaces the stiffness by a law NAME:key=value,... in plain numbers: Pa (N m with "
                       "--stiffness-unit N_m) and, whatever --unit says, metres:\n"
                       "  constant: value\n"
                       "  linear, hyperbolic, exponential: from, to, and axis (x, y or z; x if absent) or start, end\n"
                       "  gaussian: from, to, centre or centres, sigma\n"
                       "  disc: from, to, centre or centres, radius\n"
                       "  box: from, to, low, high\n"
                       "  checker: from, to, edge\n"
                       "such as linear:from=2e4,to=2e6,axis=x or gaussian:from=3e5,to=3e6,centre=0;0;0,sigma=0.003");
    command.add_option("--points", points, "number of points of a sample");
    command.add_option("--seed", seed, "seed of a sample (default 1)");
}

const Sample* CloudSource::sample() const
{
    return name.starts_with(kSamplePrefix) ? &sampleNamed(std::string_view(name).substr(kSamplePrefix.size()))
                                           : nullptr;
}

double CloudSource::metresPerPlainNumber() const
{
    return unit.empty() ? 1 : metresPer(unit);
}

CloudReadSettings CloudSource::readSettings() const
{
    CloudReadSettings settings;
    settings.lengthUnit        = unit;
    settings.stiffnessProperty = stiffnessProperty;
    settings.columns           = columns;
    settings.dropInvalid       = dropInvalid;
    if (!stiffnessUnit.empty()) settings.stiffnessKind = kindOf(stiffnessUnit);
    const StiffnessKind kind = settings.stiffnessKind.value_or(StiffnessKind::modulus);
    if (!range.empty()) settings.range = rangeOf(range, logRange, kind);
    if (!uniform.empty())
        settings.uniformStiffness = parseQuantity(
            uniform, kind == StiffnessKind::modulus ? Dimension::pressure : Dimension::rigidity, "--uniform");
    return settings;
}

LoadedCloud CloudSource::load() const
{
    refuseUseless(*this);
    static_cast<void>(metresPerPlainNumber()); // an unknown unit is one for samples too
    if (const Sample* own = sample()) {
        std::optional<SpatialLaw> spread;
        const Bounds              bounds = boundsOf(*own);
        if (!law.empty()) spread = parseSpatialLaw(law, bounds.low, bounds.high, SpatialLaw::Space::volume);
        const auto      wanted = atLeast(16, points.value_or(std::int64_t(own->points)), "--points");
        PointCloud      cloud  = makeSample(*own, wanted, atLeast(0, seed.value_or(1), "--seed"), spread);
        CloudFileReport report;
        report.format           = "procedural sample";
        report.points           = cloud.size();
        report.lengthUnitSource = "m, by construction";
        report.stiffnessSource  = law.empty() ? "the sample's own law [Pa]" : "--stiffness " + law + " [Pa]";
        return {std::move(cloud), std::move(report)};
    }
    const CloudReadSettings settings = readSettings();
    const StiffnessKind     kind     = settings.stiffnessKind.value_or(StiffnessKind::modulus);
    LoadedCloud             loaded   = readCloud(name, settings);
    refuseContradiction(*this, loaded);
    if (law.empty()) return loaded;

    const Bounds&       bounds = loaded.cloud.bounds();
    const SpatialLaw    spread = parseSpatialLaw(law, bounds.low, bounds.high, SpatialLaw::Space::volume);
    std::vector<double> stiffness;
    stiffness.reserve(loaded.cloud.size());
    for (const glm::dvec3& p : loaded.cloud.positions()) stiffness.push_back(spread(p));
    loaded.cloud =
        PointCloud({loaded.cloud.positions().begin(), loaded.cloud.positions().end()}, std::move(stiffness), kind);
    loaded.report.stiffnessSource = "--stiffness " + law + " [" + unitOf(kind) + "]";
    return loaded;
}

void refuseSourceAsTarget(const std::string& option, const std::string& source, const std::string& target)
{
    std::error_code none; // no such file: no danger
    if (!std::filesystem::equivalent(source, target, none) || none) return;
    throw Error(option + ": " + target + " is the cloud that is read, which would be lost; name another file");
}

std::string placeText(const glm::dvec3& place, double diagonal, double metresPerUnit)
{
    // A thousandth of the cloud, in decimals of the unit.
    const int   decimals = std::max(0, int(std::ceil(3 - std::log10(diagonal / metresPerUnit))));
    std::string text;
    for (int k = 0; k < 3; ++k) {
        char number[64];
        std::snprintf(number, sizeof number, "%.*f", std::min(decimals, 12), place[k] / metresPerUnit);
        text += std::string(k ? "," : "") + number;
    }
    return text;
}

std::vector<std::string> CloudSource::warnings(const LoadedCloud& loaded) const
{
    std::vector<std::string> result;
    if (loaded.report.lengthUnitAssumed)
        result.emplace_back("assumed metres: there is no --unit, and no comment in the file; set --unit");
    if (loaded.report.stiffnessAssumed && law.empty())
        result.push_back("no stiffness in the file: uniform " + formatQuantity(kDefaultModulus, "Pa") +
                         " assumed; set --uniform or --stiffness");
    if (law.empty()) return result;

    constexpr double kSame   = 1e-6; // relative: no hand feels a smaller difference [1]
    const Bounds&    bounds  = loaded.cloud.bounds();
    const SpatialLaw spread  = parseSpatialLaw(law, bounds.low, bounds.high, SpatialLaw::Space::volume);
    const auto [least, most] = stiffnessBounds(loaded.cloud);
    if (spread.from != spread.to && most - least <= kSame * most)
        result.push_back("the law \"" + law +
                         "\" gives every point the same stiffness: its coordinates are metres, and " +
                         "the cloud's middle is at " + placeText(bounds.centre(), bounds.diagonal()) + " m");
    return result;
}

nlohmann::json cloudJson(const CloudSource& source, const LoadedCloud& loaded)
{
    const PointCloud& cloud  = loaded.cloud;
    const auto [least, most] = stiffnessBounds(cloud);
    return {{"name", source.name},
            {"format", loaded.report.format},
            {"points", cloud.size()},
            {"dropped_points", loaded.report.droppedPoints},
            {"duplicate_positions", loaded.report.duplicatePositions},
            {"faces", loaded.faces.size()},
            {"degenerate_faces", loaded.report.degenerateFaces},
            {"dropped_faces", loaded.report.droppedFaces},
            {"properties", loaded.report.properties},
            {"length_unit_source", loaded.report.lengthUnitSource},
            {"stiffness_source", loaded.report.stiffnessSource},
            {"stiffness_unit", unitOf(cloud.kind())},
            {"stiffness_min", least},
            {"stiffness_max", most},
            {"low", pointJson(cloud.bounds().low)},
            {"high", pointJson(cloud.bounds().high)}};
}

} // namespace palp
