#include "engine/program/cloud_source.h"

#include <algorithm>

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
    command.add_option("--unit", unit, "length unit of the file: m, mm, cm, um, km, in, ft (else its comment, else m)");
    command.add_option("--stiffness-property", stiffnessProperty, "property that holds the stiffness, such as quality");
    command.add_option("--range", range, "FROM,TO: maps the property's smallest and largest value, such as 20kPa,2MPa");
    command.add_flag("--log-range", logRange, "maps by equal factors instead of equal steps");
    command.add_option("--stiffness-unit", stiffnessUnit, "Pa (Young's modulus) or N_m (flexural rigidity)");
    command.add_option("--uniform", uniform, "stiffness where the file has none, such as 300kPa");
    command.add_option("--columns", columns, "meaning of a text file's columns, such as x,y,z,-,stiffness");
    command.add_flag("--drop-invalid", dropInvalid,
                     "leaves out points with NaN or infinity instead of refusing the file");
    command.add_option("--stiffness", law,
                       "replaces the stiffness by a law, such as linear:from=2e4,to=2e6,axis=x or "
                       "gaussian:from=3e5,to=3e6,centre=0;0;0,sigma=0.003");
    command.add_option("--points", points, "number of points of a sample");
    command.add_option("--seed", seed, "seed of a sample")->capture_default_str();
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

LoadedCloud CloudSource::load() const
{
    if (const Sample* own = sample()) {
        std::optional<SpatialLaw> spread;
        const Bounds              bounds = boundsOf(*own);
        if (!law.empty()) spread = parseSpatialLaw(law, bounds.low, bounds.high, SpatialLaw::Space::volume);
        PointCloud      cloud = makeSample(*own, points ? points : own->points, seed, spread);
        CloudFileReport report;
        report.format           = "procedural sample";
        report.points           = cloud.size();
        report.lengthUnitSource = "m, by construction";
        report.stiffnessSource  = law.empty() ? "the sample's own law [Pa]" : "--stiffness " + law + " [Pa]";
        return {std::move(cloud), std::move(report)};
    }
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
    LoadedCloud loaded = readCloud(name, settings);
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

nlohmann::json cloudJson(const CloudSource& source, const LoadedCloud& loaded)
{
    const PointCloud& cloud  = loaded.cloud;
    const auto [least, most] = stiffnessBounds(cloud);
    return {{"name", source.name},
            {"format", loaded.report.format},
            {"points", cloud.size()},
            {"dropped_points", loaded.report.droppedPoints},
            {"duplicate_positions", loaded.report.duplicatePositions},
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
