#include "engine/plate/problem_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "engine/core/file.h"
#include "engine/core/json_object.h"
#include "engine/core/npy.h"
#include "engine/core/spatial_law.h"
#include "engine/plate/load.h"

namespace palp {
namespace {

constexpr int kMostCells = 4096; // per side: one field of nodes is then 134 MB

/// The largest problem file that is read [bytes]: some 400 000 probes.
constexpr std::size_t kLargestFile = std::size_t(16) << 20;

PlateGrid gridOf(double sizeX, double sizeZ, int cellsX, int cellsZ)
{
    return {cellsX, cellsZ, sizeX / cellsX, sizeZ / cellsZ};
}

PlateGrid readGrid(const JsonObject& problem)
{
    const std::vector<double> size = problem.numbers("size", 2);
    if (!(size[0] > 0 && size[1] > 0)) problem.refuse("size", "two positive lengths [m]");
    const std::vector<int> cells = problem.wholeNumbers("cells", 2, kFewestPlateCells, kMostCells);
    return gridOf(size[0], size[1], cells[0], cells[1]);
}

PlateGrid refined(const PlateGrid& grid, int cells, const std::string& name)
{
    const auto refuse = [&](const std::string& side, double found) {
        std::ostringstream text;
        text << name << ": --cells: expected " << kFewestPlateCells << " to " << kMostCells << " cells along " << side
             << ", found " << found << " (" << cells << " along x, in proportion to the file's " << grid.cellsX << " x "
             << grid.cellsZ << ")";
        throw Error(text.str());
    };
    const double cellsZ = std::round(double(grid.cellsZ) * cells / grid.cellsX);
    if (cells < kFewestPlateCells || cells > kMostCells) refuse("x", cells);
    if (cellsZ < kFewestPlateCells || cellsZ > kMostCells) refuse("z", cellsZ);
    return gridOf(grid.sizeX(), grid.sizeZ(), cells, int(cellsZ));
}

Edge readEdge(const JsonObject& edges, std::string_view side)
{
    if (!edges.has(side)) return Edge::clamped;
    if (const auto edge = valueNamed<Edge>(edges.text(side))) return *edge;
    edges.refuse(side, wordsOf<Edge>());
}

PlateEdges readEdges(const JsonObject& problem)
{
    if (!problem.has("edges")) return {};
    const JsonObject edges = problem.object("edges");
    edges.allowOnly({"x0", "x1", "z0", "z1"});
    return {readEdge(edges, "x0"), readEdge(edges, "x1"), readEdge(edges, "z0"), readEdge(edges, "z1")};
}

/// The grids and the folder by which the laws of a file become values at nodes.
struct Setting {
    std::filesystem::path folder;    ///< where paths in the file start
    PlateGrid             fileGrid;  ///< grid of the arrays that the file names
    PlateGrid             solveGrid; ///< grid of the solution
};

/// Reads the node values that {"law": "grid", "file": ...} names, on the file's own grid.
NodeField readField(const JsonObject& law, const Setting& setting, PlateProblem& problem)
{
    law.allowOnly({"law", "file"});
    const std::filesystem::path named = law.text("file"), path = setting.folder / named;
    if (named.empty()) law.refuse("file", "the path of a .npy file");
    problem.files.push_back(path);
    const NodeField field = [&] {
        try {
            return readNpy(path);
        } catch (const Error& error) {
            std::error_code failure;
            const bool      lost = named.is_relative() && !std::filesystem::exists(path, failure);
            throw Error(law.where() + ": key \"file\": " + error.what() +
                        (lost ? "; paths start at the problem file's folder" : ""));
        }
    }();
    if (field.on(setting.fileGrid)) return field;
    std::ostringstream text;
    text << law.where() << ": " << path.string() << ": expected shape (" << setting.fileGrid.nodesX() << ", "
         << setting.fileGrid.nodesZ() << "), one value per node (cells + 1), found (" << field.nodesX() << ", "
         << field.nodesZ() << ")";
    throw Error(text.str());
}

NodeField resampled(const NodeField& given, const Setting& setting)
{
    if (setting.solveGrid == setting.fileGrid) return given;
    const double stepX = setting.solveGrid.spacingX, stepZ = setting.solveGrid.spacingZ;
    NodeField    field(setting.solveGrid);
    for (int i = 0; i < field.nodesX(); ++i)
        for (int j = 0; j < field.nodesZ(); ++j)
            field(i, j) = interpolate(setting.fileGrid, given, i * stepX, j * stepZ);
    return field;
}

/// What a map of values at the nodes stands for.
struct Quantity {
    const char* unit;
    bool        mayBeZero;
};
constexpr Quantity kRigidity{"N m", false}, kFoundation{"Pa/m", true};

/// Checks values before interpolation, which could hide a bad node.
void expectGood(const NodeField& map, const Quantity& of, const std::string& where)
{
    for (int i = 0; i < map.nodesX(); ++i)
        for (int j = 0; j < map.nodesZ(); ++j) {
            const double value = map(i, j);
            if (std::isfinite(value) && (value > 0 || (of.mayBeZero && value == 0))) continue;
            std::ostringstream text;
            text << where << ": expected "
                 << (of.mayBeZero ? "finite values that are not negative" : "positive, finite values") << ", found "
                 << value << " " << of.unit << " at node [" << i << ", " << j << "]";
            throw Error(text.str());
        }
}

/// Returns the larger distance between nodes: a smaller law or load between them is not seen.
double spacingOf(const PlateGrid& grid)
{
    return std::max(grid.spacingX, grid.spacingZ);
}

std::string metres(double length)
{
    std::ostringstream text;
    text << length << " m";
    return text.str();
}

/// Returns a warning of a law that the nodes do not show.
std::optional<std::string> lostLaw(const JsonObject& law, const SpatialLaw& rule, const NodeField& map,
                                   const PlateGrid& grid)
{
    if (rule.from == rule.to) return std::nullopt;
    if (rule.kind == SpatialLaw::Kind::checker && rule.width < spacingOf(grid))
        return law.where() + ": the checker's edge of " + metres(rule.width) + " is below the spacing of " +
               metres(spacingOf(grid)) + ", so nodes meet its fields by chance; take more cells or a longer edge";
    constexpr double kSame   = 1e-6; // [1] relative: no answer shows a smaller difference
    const auto [least, most] = std::ranges::minmax(map.values());
    if (most - least > kSame * most) return std::nullopt;
    return law.where() + ": the law \"" + law.text("law") +
           "\" gives every node the same value; is its place on the plate, which is " + metres(grid.sizeX()) + " x " +
           metres(grid.sizeZ()) + " with nodes every " + metres(spacingOf(grid)) + "?";
}

NodeField readMap(const JsonObject& law, const Quantity& of, const Setting& setting, PlateProblem& problem)
{
    if (law.text("law") == "grid") {
        const NodeField given = readField(law, setting, problem);
        expectGood(given, of, law.where());
        return resampled(given, setting);
    }
    const PlateGrid& grid = setting.solveGrid;
    const SpatialLaw rule = parseSpatialLaw(law, {}, {grid.sizeX(), 0, grid.sizeZ()}, SpatialLaw::Space::plane);
    NodeField        map(grid);
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) map(i, j) = rule({i * grid.spacingX, 0, j * grid.spacingZ});
    expectGood(map, of, law.where());
    if (auto warning = lostLaw(law, rule, map, grid)) problem.warnings.push_back(std::move(*warning));
    return map;
}

/// Reads the foundation, one number or a map, of which the largest value is the plate's unit.
void readFoundation(const JsonObject& file, const Setting& setting, PlateProblem& problem)
{
    Plate& plate = problem.plate;
    if (!file.has("foundation")) return;
    if (file.kind("foundation") != JsonObject::Kind::object) {
        plate.foundation = file.number("foundation");
        if (!(plate.foundation >= 0)) file.refuse("foundation", "a number [Pa/m] that is not negative, or a law");
        return;
    }
    NodeField map    = readMap(file.object("foundation"), kFoundation, setting, problem);
    plate.foundation = std::ranges::max(map.values());
    if (plate.foundation == 0) return;
    for (double& k : map.values()) k /= plate.foundation;
    plate.foundationShape = std::move(map);
}

std::string sizeText(const PlateGrid& grid)
{
    std::ostringstream text;
    text << "a place [x, z] on the plate, x in [0, " << grid.sizeX() << "], z in [0, " << grid.sizeZ() << "] m";
    return text.str();
}

/// Reads a place on the plate.
std::vector<double> readPlace(const JsonObject& object, std::string_view key, const PlateGrid& grid)
{
    std::vector<double> place = object.numbers(key, 2);
    if (!isOnPlate(grid, place[0], place[1])) object.refuse(key, sizeText(grid));
    return place;
}

NodeField readLoad(const JsonObject& load, const Setting& setting, PlateProblem& problem)
{
    const PlateGrid&  grid = setting.solveGrid;
    const std::string law  = load.text("law");
    if (law == "uniform") {
        load.allowOnly({"law", "pressure"});
        return uniformLoad(grid, load.number("pressure"));
    }
    if (law == "point") {
        load.allowOnly({"law", "force", "at"});
        const std::vector<double> at = readPlace(load, "at", grid);
        return pointLoad(grid, load.number("force"), at[0], at[1]);
    }
    if (law == "gaussian") {
        load.allowOnly({"law", "force", "centre", "sigma"});
        const std::vector<double> centre = readPlace(load, "centre", grid);
        return gaussianLoad(grid, load.number("force"), centre[0], centre[1], load.positiveNumber("sigma"));
    }
    if (law == "grid") return gridLoad(grid, resampled(readField(load, setting, problem), setting));
    load.refuse("law", "point, uniform, gaussian or grid");
}

/// Returns whether there is a load and a side holds every node that gets a share of it.
bool isLoadHeld(const NodeField& nodalForce, const Plate& plate)
{
    bool loaded = false;
    for (int i = 0; i < plate.grid.nodesX(); ++i)
        for (int j = 0; j < plate.grid.nodesZ(); ++j) {
            if (nodalForce(i, j) == 0) continue;
            if (!isHeld(plate, i, j)) return false;
            loaded = true;
        }
    return loaded;
}

std::vector<std::string> warningsOf(const JsonObject& load, const PlateProblem& problem)
{
    std::vector<std::string> warnings;
    if (load.text("law") == "gaussian" && load.number("sigma") < spacingOf(problem.plate.grid))
        warnings.push_back(load.where() + ": sigma of " + metres(load.number("sigma")) + " is below the spacing of " +
                           metres(spacingOf(problem.plate.grid)) +
                           ", so the load acts as a point force does; take more cells or a larger sigma");
    if (isLoadHeld(problem.nodalForce, problem.plate))
        warnings.push_back(load.where() + ": acts only where a clamped or supported edge holds the plate, and bends "
                                          "nothing");
    return warnings;
}

std::vector<Probe> readProbes(const JsonObject& problem, const PlateGrid& grid)
{
    std::vector<Probe> probes;
    if (!problem.has("probes")) return probes;
    for (const std::vector<double>& place : problem.rows("probes", 2)) {
        if (!isOnPlate(grid, place[0], place[1])) {
            std::ostringstream text;
            text << problem.where() << ": key \"probes\": entry " << probes.size() << ": expected " << sizeText(grid)
                 << ", found [" << place[0] << ", " << place[1] << "]";
            throw Error(text.str());
        }
        probes.push_back({place[0], place[1]});
    }
    return probes;
}

} // namespace

PlateProblem readProblem(const std::filesystem::path& path, std::optional<int> cells)
{
    const JsonObject file = JsonObject::parse(
        readWhole(path, kLargestFile, "a problem file, with grids in .npy files beside it"), path.string());
    file.allowOnly({"size", "cells", "poisson", "edges", "foundation", "rigidity", "load", "probes"});

    const PlateGrid fileGrid = readGrid(file);
    const Setting   setting{path.parent_path(), fileGrid, cells ? refined(fileGrid, *cells, path.string()) : fileGrid};

    PlateProblem problem;
    problem.files              = {path};
    problem.plate.grid         = setting.solveGrid;
    problem.plate.edges        = readEdges(file);
    problem.plate.poissonRatio = file.number("poisson");
    problem.plate.rigidity     = readMap(file.object("rigidity"), kRigidity, setting, problem);
    if (!isPoissonRatio(problem.plate.poissonRatio)) file.refuse("poisson", "a number above -1 and at most 0.5");
    readFoundation(file, setting, problem);
    if (const auto why = whyUnsolvable(problem.plate)) throw Error(path.string() + ": " + *why);
    problem.nodalForce = readLoad(file.object("load"), setting, problem);
    problem.probes     = readProbes(file, setting.solveGrid);
    for (std::string& warning : warningsOf(file.object("load"), problem))
        problem.warnings.push_back(std::move(warning));
    return problem;
}

} // namespace palp
