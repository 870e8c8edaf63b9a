#include "engine/session/scene_keys.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/cloud/cloud_format.h"
#include "engine/core/contract.h"
#include "engine/core/spatial_law.h"
#include "engine/force/governor.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/session/scene_schema.h"

// The table of scene keys, and nothing else; scene_value.cpp reads the values, scene_schema.cpp describes them.

namespace palp {
namespace {

using Json    = nlohmann::json;
using S       = Scene;
using V       = WrittenValue;
using Control = KeyControl;
using Panel   = KeyControl::Panel;
using Kind    = SceneKey::Kind;
using D       = Dimension;

constexpr auto kTouch   = SceneKey::Group::touch;
constexpr auto kSession = SceneKey::Group::session;

std::string textOrNothing(const std::string& text)
{
    return text.empty() ? "" : quotedJson(text);
}

/// Completes a key whose value is any text.
template <class Field>
SceneKey textKey(SceneKey key, Field)
{
    key.read = [](S& s, const V& v) {
        if (v.text.empty()) v.refuse();
        Field{}(s) = v.key.words.empty() ? v.text : v.word();
    };
    key.write = [](const S& s) { return textOrNothing(Field{}(s)); };
    return key;
}

void readLaw(S& scene, const V& given)
{
    if (given.text == "own") return scene.stiffness.clear();
    try { // across any region: the cloud is not there yet
        static_cast<void>(
            parseSpatialLaw(given.text, {-1, -1, -1}, {1, 1, 1}, SpatialLaw::Space::volume, LawFiles::left));
    } catch (const Error& error) {
        throw Error(given.what + ": " + error.what());
    }
    scene.stiffness = given.text;
}

void readFrom(S& scene, const V& given)
{
    const glm::dvec3 from  = parsePoint(given.text, given.what);
    const double     scale = std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)});
    if (scale == 0) given.refuse();
    scene.from =
        scale < 1e100 && scale > 1e-100 ? from : from / scale; // its length means nothing, and must not overflow
}

void readPlace(S& scene, const V& given)
{
    const glm::dvec3 place = parsePoint(given.text, given.what, given.metresPerPlainNumber);
    for (int k = 0; k < 3; ++k)
        if (!(std::abs(place[k]) <= given.key.bounds->most)) given.refuse();
    scene.place = place;
}

std::string pointJson(const std::optional<glm::dvec3>& p)
{
    return p ? Json{p->x, p->y, p->z}.dump() : "";
}

D dimensionOf(const CloudReadSettings& reading)
{
    return dimensionOf(reading.stiffnessKind.value_or(StiffnessKind::modulus));
}

/// Returns a stiffness above zero, a modulus or a rigidity by the scene's stiffness_unit.
double stiffnessOf(const S& scene, const V& given, std::string_view text)
{
    const double value = parseQuantity(text, dimensionOf(scene.reading), given.what);
    if (!(value > 0)) given.refuse();
    return value;
}

/// Reads a range such as "20kPa,2MPa".
void readRange(S& scene, const V& given)
{
    const std::size_t comma = given.text.find(',');
    if (comma == std::string::npos) given.refuse();
    const std::string_view text = given.text;
    scene.reading.range         = StiffnessRange{stiffnessOf(scene, given, text.substr(0, comma)),
                                         stiffnessOf(scene, given, text.substr(comma + 1)), RangeScale::linear};
}

/// Reads the scale of the range; comes after stiffness_range.
void readLogRange(S& scene, const V& given)
{
    if (!given.yesNo()) return;
    if (!scene.reading.range)
        throw Error(given.what + ": expected " + flagOf("stiffness_range") + " beside it, found none");
    scene.reading.range->scale = RangeScale::logarithmic;
}

void readStiffnessUnit(S& scene, const V& given)
{
    const std::string word = given.word();
    for (const StiffnessKind kind : kStiffnessKinds)
        if (word == unitOf(kind)) scene.reading.stiffnessKind = kind;
}

/// Reads auto, on, off or a distance.
void readScatter(S& scene, const V& given)
{
    scene.scatterDistance = 0;
    if (const auto word = valueNamed<Scatter>(given.text)) {
        scene.scatter = *word;
    } else {
        if (given.text.find_first_of("0123456789") == std::string::npos)
            given.refuse(); // a word, and not a slip in a length
        scene.scatter         = Scatter::on;
        scene.scatterDistance = given.number();
    }
}

std::string scatterJson(const S& scene)
{
    if (isSample(scene)) return "";
    return scene.scatterDistance > 0 ? plainNumber(scene.scatterDistance) : quotedJson(name(scene.scatter));
}

/// Reads Poisson's ratio. The plate's own bound is nu <= 0.5: its equations hold there. A scene is of a material, and
/// none is incompressible: nu of 0.5 and more is a slip (per cent, or another number in the wrong place).
void readPoisson(S& scene, const V& given)
{
    const double nu = parseQuantity(given.text, D::none, given.what);
    if (nu >= given.key.bounds->most)
        given.refuse("; no material is incompressible: take 0.49 for rubber, which is 1.3 % softer");
    scene.material.poissonRatio = given.number();
}

/// A word for all sides, or an object with a word for each.
std::string edgesSchema()
{
    Json words = Json::array();
    for (const NamedValue<Edge>& edge : namesOf(Edge{})) words.push_back(edge.name);
    Json sides = Json::object();
    for (const char* side : {"x0", "x1", "z0", "z1"}) sides[side] = {{"enum", words}};
    const Json each{{"type", "object"}, {"additionalProperties", false}, {"properties", sides}};
    return Json{{"anyOf", {Json{{"type", "string"}}, each}}}.dump();
}

std::vector<SceneKey> fileKeys()
{
    std::vector<SceneKey> keys = {
        textKey(
            {.name  = "length_unit",
             .help  = "unit of the coordinates in a cloud file [its own comment, else m]; on the command line also "
                      "of plain numbers of lengths [m]",
             .kind  = Kind::word,
             .words = {"m", "mm", "cm", "um", "km", "in", "ft"}},
            [](auto& s) -> auto& { return s.reading.lengthUnit; }),
        textKey(
            {.name = "stiffness_property",
             .help = "property of a cloud file that holds the stiffness, such as quality [stiffness or another "
                     "name that says so]",
             .form = "the name of a property of the file's points"},
            [](auto& s) -> auto& { return s.reading.stiffnessProperty; }),
        {.name  = "stiffness_unit",
         .help  = "what the stiffness of a cloud file is: Pa for Young's modulus, N_m for the flexural "
                  "rigidity, N/m for a map of what a probe felt, of which palpate fit makes an object",
         .kind  = Kind::word,
         .words = {unitOf(StiffnessKind::modulus), unitOf(StiffnessKind::rigidity), unitOf(StiffnessKind::felt)},
         .read  = readStiffnessUnit,
         .write = [](const S& s) -> std::string {
             return s.reading.stiffnessKind ? quotedJson(unitOf(*s.reading.stiffnessKind)) : "";
         }},
        {.name = "stiffness_range",
         .help = "stiffnesses of the property's smallest and largest value, for one that has no unit of its own",
         .kind = Kind::range,
         .form = "two stiffnesses above zero, FROM,TO, such as 20kPa,2MPa",
         .read = readRange,
         .write =
             [](const S& s) {
                 return s.reading.range ? Json{s.reading.range->from, s.reading.range->to}.dump() : std::string();
             }},
        {.name  = "log_range",
         .help  = "stiffness_range goes by equal factors instead of equal steps",
         .kind  = Kind::yesNo,
         .read  = readLogRange,
         .write = [](const S& s) -> std::string {
             return s.reading.range && s.reading.range->scale == RangeScale::logarithmic ? "true" : "";
         }},
        {.name   = "uniform",
         .help   = "stiffness everywhere, for a cloud file that has none [300 kPa]",
         .kind   = Kind::number,
         .form   = "a stiffness above zero, such as 300kPa",
         .schema = R"({"anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"type": "string"}]})",
         .read   = [](S& s, const V& v) { s.reading.uniformStiffness = stiffnessOf(s, v, v.text); },
         .write  = [](const S& s) -> std::string {
             return s.reading.uniformStiffness ? plainNumber(*s.reading.uniformStiffness) : "";
         }},
        textKey(
            {.name = "columns",
             .help = "meaning of the columns of a text file, such as x,y,z,-,stiffness [its header line]",
             .form = "names of columns, such as x,y,z,-,stiffness"},
            [](auto& s) -> auto& { return s.reading.columns; }),
        {.name  = "drop_invalid",
         .help  = "omits points with NaN or infinity instead of refusing the file",
         .kind  = Kind::yesNo,
         .read  = [](S& s, const V& v) { s.reading.dropInvalid = v.yesNo(); },
         .write = [](const S& s) -> std::string { return s.reading.dropInvalid ? "true" : ""; }},
        {.name      = "scatter",
         .help      = "touches a mesh through points on its faces: auto where its vertices are too far apart for the "
                      "fingertip, on, off, or a distance between them [auto]",
         .kind      = Kind::number,
         .unit      = "m",
         .form      = "auto, on, off, or a distance from 1e-6 to 1 m, such as 0.5 mm",
         .dimension = D::length,
         .bounds    = KeyBounds{1e-6, 1},
         .schema    = R"({"anyOf": [{"type": "number", "minimum": 1e-6, "maximum": 1}, {"type": "string"}]})",
         .read      = readScatter,
         .write     = scatterJson},
    };
    for (SceneKey& key : keys) key.cloud = SceneKey::For::file, key.decidesCloud = true;
    return keys;
}

std::vector<SceneKey> objectKeys()
{
    static const std::string cloudHelp =
        "what is touched: a " + extensionsFor(CloudUse::reading) + " file, or a procedural sample";
    std::vector<SceneKey> keys = {
        {.name         = "cloud",
         .help         = cloudHelp,
         .form         = "the path of a cloud file, or sample:NAME",
         .schema       = R"({"type": "string", "minLength": 1, "examples": ["sample:skin", "scan.ply"]})",
         .decidesCloud = true,
         .read         = [](S&, const V&) {}, // the scene's reader has read it before the others
         .write        = [](const S& s) { return textOrNothing(s.cloud); }},
        countKey(
            {.name = "points", .help = "number of points of a sample", .bounds = KeyBounds{16, 10'000'000}},
            [](auto& s) -> auto& { return s.points; }),
        countKey(
            {.name = "seed", .help = "seed of a sample's random points", .bounds = KeyBounds{0, 4294967295}},
            [](auto& s) -> auto& { return s.seed; }),
    };
    keys[1].write = [](const S& s) -> std::string { return s.points ? std::to_string(s.points) : ""; };
    keys[2].write = [](const S& s) -> std::string { return isSample(s) ? std::to_string(s.seed) : ""; };
    for (SceneKey* key : {&keys[1], &keys[2]}) key->cloud = SceneKey::For::sample, key->decidesCloud = true;
    for (SceneKey& key : fileKeys()) keys.push_back(std::move(key));
    keys.push_back(
        {.name         = "stiffness",
         .help         = "law of Young's modulus over the cloud, in place of the cloud's own; its places are "
                         "in m",
         .kind         = Kind::object,
         .unit         = "Pa",
         .form         = "a law such as {\"law\":\"linear\",\"from\":3e5,\"to\":3e6,\"axis\":\"x\"}, "
                         "linear:from=3e5,to=3e6,axis=x, or own",
         .schema       = std::string(kLawSchema),
         .decidesCloud = true,
         .read         = readLaw,
         .write = [](const S& s) { return s.stiffness.starts_with('{') ? s.stiffness : textOrNothing(s.stiffness); }});
    return keys;
}

std::vector<SceneKey> placeKeys()
{
    return {
        {.name  = "place",
         .help  = "where it is touched, on the cloud [where a sample has something to feel; on a file's cloud where it "
                  "comes nearest to the viewer, at its largest z, and in the middle of a flat top]",
         .group = kTouch,
         .kind  = Kind::point,
         .unit  = "m",
         .form  = "a place X,Y,Z up to 1e9 m away, such as 10mm,0,35mm",
         .bounds = KeyBounds{-1e9, 1e9}, // surveyors count from far away, and clouds have the same bound
         .read   = readPlace,
         .write  = [](const S& s) { return pointJson(s.place); }},
        {.name  = "from",
         .help  = "direction from which the hand comes [away from the middle of the cloud]",
         .group = kTouch,
         .kind  = Kind::point,
         .unit  = "1",
         .form  = "a direction X,Y,Z that is not zero",
         .read  = readFrom,
         .write = [](const S& s) { return pointJson(s.from); }},
    };
}

std::vector<std::string> materialNames()
{
    std::vector<std::string> names;
    for (const KnownMaterial& material : knownMaterials()) names.emplace_back(material.name);
    return names;
}

std::vector<SceneKey> materialKeys()
{
    const Control         thickness{Panel::material, "thickness", "mm", 1e-3, 0.1, 20, true, 2};
    const Control         poisson{Panel::material, "Poisson's ratio", "", 1, 0, 0.49, false, 2};
    const Control         foundation{Panel::material, "foundation", "MPa/m", 1e6, 0, 100, true, 2};
    std::vector<SceneKey> keys = {
        wordKey(
            {.name  = "preset",
             .help  = "sets map, neighbourhood, resampling, edges and force_law: palpate, or paper as Kumari and "
                      "Chaudhuri published it, which also sets theory to plate, large to off, foundation and "
                      "stiffening to 0 and relaxation to none; keys beside it win over it",
             .group = kTouch},
            [](auto& s) -> auto& { return s.preset; }),
        textKey(
            {.name  = "material",
             .help  = "a measured material, see palpate materials: sets stiffness, poisson, stiffening and relaxation "
                      "as far as they are known; keys beside it win over it",
             .group = kTouch,
             .kind  = Kind::word,
             .words = materialNames()},
            [](auto& s) -> auto& { return s.materialName; }),
        numberKey(
            {.name      = "thickness",
             .help      = "thickness h of the soft sheet; skin 1.5 mm, palm 4 mm",
             .group     = kTouch,
             .unit      = "m",
             .example   = "4 mm",
             .dimension = D::length,
             .bounds    = KeyBounds{1e-6, 1},
             .control   = thickness},
            [](auto& s) -> auto& { return s.material.thickness; }),
        numberKey(
            {.name    = "poisson",
             .help    = "Poisson's ratio; skin 0.45, rubber 0.49",
             .group   = kTouch,
             .unit    = "1",
             .bounds  = KeyBounds{-1, 0.5, true},
             .control = poisson},
            [](auto& s) -> auto& { return s.material.poissonRatio; }),
        numberKey(
            {.name      = "foundation",
             .help      = "pressure per deflection of what lies below the sheet; 0 for nothing",
             .group     = kTouch,
             .unit      = "Pa/m",
             .example   = "1.74 MPa/m",
             .dimension = D::foundation,
             .bounds    = KeyBounds{0, kMostFoundation},
             .control   = foundation},
            [](auto& s) -> auto& { return s.patch.foundation; }),
        {.name   = "below",
         .help   = "the tissue below the sheet where it varies: how deep it is, its modulus, and nodules in it; or "
                   "{\"foundation\": LAW}, or own for the file's property foundation [Pa/m], about the key "
                   "foundation; none for a foundation that is the same everywhere",
         .group  = kTouch,
         .kind   = Kind::object,
         .form   = kBelowForm,
         .schema = std::string(belowSchema()),
         .decidesCloud = true,
         .read         = [](S& s, const V& v) { s.below = parseBelow(v.text, v.what); },
         .write        = [](const S& s) { return belowJson(s.below); }},
        numberKey(
            {.name = "stiffening",
             .help =
                 "b by which the force stiffens with depth, K (e^(b d) - 1) / b; meat 800; 0 for a spring; omitted: "
                 "the file's property stiffening, if it has one",
             .group     = kTouch,
             .unit      = "1/m",
             .example   = "0.8 1/mm",
             .dimension = D::perLength,
             .bounds    = KeyBounds{0, kMostStiffening},
             .control   = Control{Panel::material, "stiffening", "1/m", 1, 0, 2000, false, 0, 10}},
            [](auto& s) -> auto& { return s.material.stiffening; }),
        {.name  = "relaxation",
         .help  = "shares of the force that die away under a finger that holds still, each with its time; none for a "
                  "spring",
         .group = kTouch,
         .form  = kRelaxationForm,
         .read  = [](S& s, const V& v) { s.material.relaxation = parseRelaxation(v.text, v.what); },
         .write = [](const S& s) { return quotedJson(relaxationText(s.material.relaxation)); }},
    };
    keys[3].read = readPoisson;
    return keys;
}

void readHeld(S& scene, const V& given)
{
    const bool isWord = !given.text.starts_with('{') && !given.text.starts_with('[');
    if (isWord && given.text != "own" && given.text != "none") given.refuse();
    scene.held = parseHeld(given.text, given.what);
}

/// Returns the key of the patch window: a number, or the object's.
SceneKey windowKey(const Control& control)
{
    SceneKey key = numberKey(
        {.name  = "window",
         .help  = "edge of the patch window, the square of surface that bends with the finger; or object: all of the "
                  "object bends, free at its borders and held where the key held says so; or auto, the default of "
                  "shells: 8 times the length over which a dent of this object dies away, more where it is curved "
                  "unequally both ways, and 10 or 12 times where a foundation ends the dents; where nothing ends them, "
                  "at most the width without auto, which is that of the sample or 40 mm; where the key held says what "
                  "holds a shell, 1.25 radii of its curvature, and as much at most; palpate touch says which",
         .group = kTouch,
         .unit  = "m",
         .form  = "object, auto, or a length from 1e-6 to 100 m, such as 70 mm",
         .dimension = D::length,
         .bounds    = KeyBounds{1e-6, 100},
         .schema    = R"({"anyOf": [{"type": "number", "minimum": 1e-6, "maximum": 100}, {"type": "string"}]})",
         .control   = control},
        [](auto& s) -> auto& { return s.patch.window; });
    key.read = [](S& s, const V& v) {
        s.patch.windowOf = v.text == "object" ? WindowOf::object
                           : v.text == "auto" ? WindowOf::dent
                                              : WindowOf::contact;
        if (s.patch.windowOf != WindowOf::contact) return;
        if (!v.text.empty() && std::isalpha(static_cast<unsigned char>(v.text.front()))) v.refuse();
        s.patch.window = v.number();
    };
    key.write = [](const S& s) {
        return s.patch.windowOf == WindowOf::contact ? plainNumber(s.patch.window) : quotedJson(name(s.patch.windowOf));
    };
    return key;
}

std::vector<SceneKey> patchKeys()
{
    static const std::string edgesForm = wordsOf<Edge>() + ", or a list such as x0=free,z1=supported";
    const Control            window{Panel::patch, "patch window", "mm", 1e-3, 5, 200, true, 1};
    const Control            cells{Panel::patch, "cells a side", "", 1, 16, 256, true, 0, 2};
    const Control            fingertip{Panel::patch, "fingertip", "mm", 1e-3, 0.5, 20, true, 2};
    return {
        windowKey(window),
        {.name = "held",
         .help = "where the object is held and cannot bend: in a box, in a ball, about points, or, with own, where the "
                 "file's property held is 1; of a shell on no foundation the patch window is then cut from the object "
                 "as a whole, and what lies beyond the window is felt too",
         .group        = kTouch,
         .kind         = Kind::objects,
         .form         = kHeldForm,
         .schema       = std::string(heldSchema()),
         .decidesCloud = true,
         .read         = readHeld,
         .write        = [](const S& s) { return heldJson(s.held); }},
        countKey(
            {.name  = "cells",
             .help  = "cells of the plate's grid along a side of the patch window; a window auto that is wider than 16 "
                      "lengths of dents has up to twice as many; of window object half of them lie "
                      "along the object, and there are 256 to 512",
             .group = kTouch,
             .bounds  = KeyBounds{.least = 8, .most = 1024, .multipleOf = 2},
             .control = cells},
            [](auto& s) -> auto& { return s.patch.cells; }),
        numberKey(
            {.name      = "footprint_radius",
             .help      = "radius of the fingertip's smooth load",
             .group     = kTouch,
             .unit      = "m",
             .example   = "4 mm",
             .dimension = D::length,
             .bounds    = KeyBounds{1e-6, 10},
             .control   = fingertip},
            [](auto& s) -> auto& { return s.patch.footprintRadius; }),
        wordKey(
            {.name    = "map",
             .help    = "map from the fitted sphere to the plane",
             .group   = kTouch,
             .control = Control{Panel::patch, "map"}},
            [](auto& s) -> auto& { return s.patch.map; }),
        wordKey(
            {.name  = "neighbourhood",
             .help  = "which points near the contact count: those of the touched surface, or of a ball as in the paper",
             .group = kTouch,
             .control = Control{Panel::patch, "neighbourhood"}},
            [](auto& s) -> auto& { return s.patch.neighbourhood; }),
        wordKey(
            {.name    = "resampling",
             .help    = "how the rigidity comes to the grid's nodes",
             .group   = kTouch,
             .control = Control{Panel::patch, "resampling"}},
            [](auto& s) -> auto& { return s.patch.resampling; }),
        wordKey(
            {.name = "theory",
             .help =
                 "how a thin sheet resists: plate bends as if it were flat, shell also by forces in its surface where "
                 "that is curved; a shell's edges are supported unless edges says otherwise",
             .group = kTouch},
            [](auto& s) -> auto& { return s.patch.theory; }),
        wordKey(
            {.name  = "large",
             .help  = "whether a sheet resists in another way where it is pressed further than half its thickness: on, "
                      "flat ones harden and domes give way, trusted to two thicknesses; off, the linear theory",
             .group = kTouch},
            [](auto& s) -> auto& { return s.patch.large; }),
        {.name   = "edges",
         .help   = "edges of the patch window: one name for all, or SIDE=EDGE of the sides x0, x1, z0, z1",
         .group  = kTouch,
         .kind   = Kind::object,
         .form   = edgesForm,
         .schema = edgesSchema(),
         .read   = [](S& s, const V& v) { s.patch.edges = parseEdges(v.text, v.what); },
         .write  = [](const S& s) { return quotedJson(edgesText(s.patch.edges)); }},
        wordKey(
            {.name    = "force_law",
             .help    = "how depth becomes force: series is plate and contact, paper the contact alone",
             .group   = kTouch,
             .control = Control{Panel::servo, "force law"}},
            [](auto& s) -> auto& { return s.patch.forceLaw; }),
        numberKey(
            {.name    = "tolerance",
             .help    = "error of the plate's solution, relative in the energy norm; the reference solver has none",
             .group   = kTouch,
             .unit    = "1",
             .bounds  = KeyBounds{MultigridPlateSolver::kLeastTolerance, 0.1},
             .control = Control{.panel = Panel::patch, .label = "tolerance"}},
            [](auto& s) -> auto& { return s.patch.tolerance; }),
        textKey(
            {.name   = "solver",
             .help   = "where the plate is solved: auto (the best GPU, else the host), host (native code on this "
                       "processor), lavapipe (Vulkan in software, much slower), an index or part of a name that "
                       "palpate devices shows, or reference (sparse Cholesky in doubles)",
             .group  = kTouch,
             .form   = "auto, host, lavapipe, reference, or an index or name of a GPU",
             .schema = R"({"type": "string", "minLength": 1})"},
            [](auto& s) -> auto& { return s.solver; }),
    };
}

std::vector<SceneKey> plateThreadKeys()
{
    SceneKey size = countKey(
        {.name   = "table_size",
         .help   = "footprints along a side of the table of compliances; 0 for as many as the rate "
                   "asks for, 3 at 60 Hz",
         .group  = kSession,
         .bounds = KeyBounds{0, double(ComplianceTable::kMostSide)},
         .words  = {"0", "1", "3", "5", "7"}},
        [](auto& s) -> auto& { return s.tableSize; });
    return {
        wordKey(
            {.name    = "compliance_law",
             .help    = "what the servo takes between two answers of the plate",
             .group   = kSession,
             .control = Control{Panel::servo, "compliance law"}},
            [](auto& s) -> auto& { return s.complianceLaw; }),
        std::move(size),
        numberKey(
            {.name    = "deformation_rate",
             .help    = "rate of the plate's answers",
             .group   = kSession,
             .unit    = "Hz",
             .bounds  = KeyBounds{1, 1000},
             .control = Control{Panel::servo, "plate's rate", "Hz", 1, 5, 240, true, 0, 1}},
            [](auto& s) -> auto& { return s.deformationRate; }),
    };
}

std::vector<SceneKey> servoKeys()
{
    const Control atRest{Panel::servo, "friction at rest", "", 1, 0, 2, false, 2};
    const Control sliding{Panel::servo, "friction, sliding", "", 1, 0, 2, false, 2};
    return {
        wordKey(
            {.name    = "proxy",
             .help    = "what stands for the finger",
             .group   = kSession,
             .control = Control{Panel::servo, "proxy"}},
            [](auto& s) -> auto& { return s.proxy; }),
        numberKey(
            {.name    = "static_friction",
             .help    = "friction coefficient of a finger at rest",
             .group   = kSession,
             .unit    = "1",
             .bounds  = KeyBounds{0, 10},
             .control = atRest},
            [](auto& s) -> auto& { return s.staticFriction; }),
        numberKey(
            {.name    = "dynamic_friction",
             .help    = "friction coefficient of a finger that slides, at most static_friction",
             .group   = kSession,
             .unit    = "1",
             .bounds  = KeyBounds{0, 10},
             .control = sliding},
            [](auto& s) -> auto& { return s.dynamicFriction; }),
        numberKey(
            {.name      = "max_force",
             .help      = "largest force; the governor clamps to it",
             .group     = kSession,
             .unit      = "N",
             .example   = "4 N",
             .dimension = D::force,
             .bounds    = KeyBounds{0.01, GovernorSettings::kMostForce},
             .control   = Control{Panel::servo, "most force", "N", 1, 0.1, GovernorSettings::kMostForce, false, 1}},
            [](auto& s) -> auto& { return s.maxForce; }),
        numberKey(
            {.name    = "stiffness_cap",
             .help    = "largest stiffness that is rendered at a servo period of 1 ms; a released arm swings from "
                        "2137 N/m on",
             .group   = kSession,
             .unit    = "N/m",
             .bounds  = KeyBounds{1, 2000},
             .control = Control{Panel::servo, "most stiffness", "N/m", 1, 50, 2000, true, 0, 1}},
            [](auto& s) -> auto& { return s.stiffnessCap; }),
        numberKey(
            {.name      = "start_height",
             .help      = "height of the hand above the place when the session starts",
             .group     = kSession,
             .unit      = "m",
             .example   = "10 mm",
             .dimension = D::length,
             .bounds    = KeyBounds{0, 1}},
            [](auto& s) -> auto& { return s.startHeight; }),
        numberKey(
            {.name    = "workspace_scale",
             .help    = "millimetres of the scene per millimetre of the device: 3 explores a 120 mm object with a "
                        "workspace of 40 mm; forces are not scaled, and what is rendered is at most stiffness_cap at "
                        "the device",
             .group   = kSession,
             .unit    = "1",
             .bounds  = KeyBounds{kLeastWorkspaceScale, kMostWorkspaceScale},
             .control = Control{Panel::servo, "device scale", "", 1, 0.2, 10, true, 2}},
            [](auto& s) -> auto& { return s.workspaceScale; }),
        countKey(
            {.name  = "clutch_button",
             .help  = "button of the device that is its clutch: while it is held no force flows and the tool stays, so "
                      "that the device can go back to its middle; counted from 1, 0 for none",
             .group = kSession,
             .bounds = KeyBounds{0, 16}},
            [](auto& s) -> auto& { return s.clutchButton; }),
    };
}

} // namespace

const std::vector<SceneKey>& sceneKeys()
{
    static const std::vector<SceneKey> keys = [] {
        std::vector<SceneKey> all;
        for (const auto& part :
             {objectKeys(), placeKeys(), materialKeys(), patchKeys(), plateThreadKeys(), servoKeys()})
            all.insert(all.end(), part.begin(), part.end());
        return all;
    }();
    return keys;
}

std::vector<const SceneKey*> sceneKeysWith(const std::vector<SceneKey>* toolKeys)
{
    std::vector<const SceneKey*> all;
    for (const SceneKey& key : sceneKeys()) all.push_back(&key);
    if (toolKeys)
        for (const SceneKey& key : *toolKeys) all.push_back(&key);
    return all;
}

const SceneKey& sceneKey(std::string_view name)
{
    const auto found = std::ranges::find(sceneKeys(), name, &SceneKey::name);
    PALP_EXPECT(found != sceneKeys().end(), "no scene key is called " + std::string(name));
    return *found;
}

std::optional<std::string_view> keyNamedOnce(std::string_view name) noexcept
{
    if (name == "device") return "solver";
    if (name == "hand_over") return "compliance_law";
    if (name == "sampling") return "resampling";
    return {};
}

std::string flagOf(std::string_view key)
{
    std::string flag = "--" + std::string(key);
    std::ranges::replace(flag, '_', '-');
    return flag;
}

std::string variableOf(std::string_view key)
{
    std::string variable = "PALPATE_";
    for (const char c : key) variable += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    return variable;
}

std::map<std::string, std::string, std::less<>> presetValues(Preset preset)
{
    const PatchSettings                             set = withPreset({}, preset);
    std::map<std::string, std::string, std::less<>> values{{"map", name(set.map)},
                                                           {"neighbourhood", name(set.neighbourhood)},
                                                           {"resampling", name(set.resampling)},
                                                           {"force_law", name(set.forceLaw)},
                                                           {"edges", edgesText(set.edges)}};
    if (preset == Preset::paper) { // the paper's sheet has none of these
        values["foundation"] = plainNumber(set.foundation);
        values["theory"]     = name(set.theory);
        values["large"]      = name(set.large);
        values["stiffening"] = "0";
        values["relaxation"] = "none";
    }
    return values;
}

std::map<std::string, std::string, std::less<>> materialValues(const KnownMaterial& material)
{
    std::map<std::string, std::string, std::less<>> values{{"stiffening", plainNumber(material.stiffening)},
                                                           {"relaxation", relaxationText(material.relaxation)}};
    if (material.modulus > 0) values["stiffness"] = "constant:value=" + plainNumber(material.modulus);
    if (material.poissonRatio > -1) values["poisson"] = plainNumber(material.poissonRatio);
    return values;
}

} // namespace palp
