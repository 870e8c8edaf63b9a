#include "engine/tools/study/study_plan.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"
#include "engine/core/nearest_name.h"
#include "engine/force/governor.h"
#include "engine/pipeline/presets.h"
#include "engine/session/device_registry.h"
#include "engine/session/hand_path.h"
#include "engine/session/session_hand.h"
#include "engine/tools/study/hunt_scene.h"

namespace palp::study {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLargestFile    = std::size_t(1) << 20;        ///< [bytes]; real plans have a few thousand
constexpr std::size_t kMostConditions = 26, kMostTasks = 20;         ///< more would tire participants
constexpr int         kMostRepetitions = 100;                        ///< as would more of these
constexpr double      kLeastSeconds = GovernorSettings{}.engageTime; ///< of one touch [s]; then the force is fully on
constexpr double      kMostSeconds  = 3600;                          ///< of one touch [s]
constexpr std::size_t kLongestText  = 500;                           ///< [bytes] of a text that a participant reads

/// Reads a text that a terminal and a table can show.
std::string textOf(const JsonObject& object, const char* key)
{
    const std::string text = object.text(key);
    const bool        good = std::ranges::none_of(text, [](char c) { return (c >= 0 && c < 0x20) || c == 0x7f; });
    if (text.empty() || text.size() > kLongestText || !good)
        object.refuse(key, "a text of 1 to 500 bytes without line ends");
    return text;
}

/// Returns the members of a list of objects, each named by its kind and number in errors.
std::vector<JsonObject> objectsIn(const JsonObject& object, const char* key, const std::string& kind, std::size_t most)
{
    return object.objects(key, most, kind, "a list of 1 to " + std::to_string(most) + " objects");
}

using Flags = std::map<std::string, std::string, std::less<>>;

/// Returns values as in a scene file, in the spelling of flags.
void addValues(Flags& flags, const JsonObject& condition)
{
    if (!condition.has("values")) return;
    const JsonObject              values = condition.object("values");
    std::vector<std::string_view> known;
    const auto                    keys = sceneKeysWith(&huntKeys());
    for (const SceneKey* key : keys)
        if (key->name != "cloud") known.push_back(key->name); // another cloud needs another scene
    values.allowOnly(known);
    for (const SceneKey* key : keys) {
        if (!values.has(key->name)) continue;
        const Json  value = Json::parse(values.json(key->name));
        std::string text  = value.is_string() ? value.get<std::string>() : value.dump();
        if (value.is_array() && key->kind != SceneKey::Kind::objects) text = text.substr(1, text.size() - 2); // "x,y,z"
        flags[std::string(key->name)] = text;
    }
}

Condition conditionOf(const JsonObject& object, const std::filesystem::path& folder)
{
    object.allowOnly({"name", "scene", "preset", "values"});
    Condition condition{textOf(object, "name"), {}};
    Flags     flags;
    if (object.has("preset")) flags["preset"] = object.text("preset");
    addValues(flags, object);
    try {
        condition.scene = readScene(folder / textOf(object, "scene"), {.flags = flags, .toolKeys = &huntKeys()});
    } catch (const Error& error) {
        throw Error(object.where() + " (" + condition.name + "): " + error.what());
    }
    return condition;
}

std::size_t indexOf(const std::vector<Condition>& conditions, const std::string& wanted, const std::string& where)
{
    std::vector<std::string_view> names;
    for (const Condition& condition : conditions) {
        if (condition.name == wanted) return names.size();
        names.emplace_back(condition.name);
    }
    const auto meant = nearestName(wanted, names);
    throw Error(where + ": expected the name of a condition, found \"" + wanted + "\"" +
                (meant ? "; did you mean \"" + std::string(*meant) + "\"?" : ""));
}

/// Reads a list of names of conditions.
std::vector<std::size_t> conditionsIn(const Json& list, const std::vector<Condition>& conditions,
                                      const std::string& where)
{
    if (!list.is_array()) throw Error(where + ": expected a list of names of conditions, found " + list.dump());
    std::vector<std::size_t> found;
    for (const Json& one : list) {
        if (!one.is_string()) throw Error(where + ": expected the name of a condition, found " + one.dump());
        found.push_back(indexOf(conditions, one.get<std::string>(), where));
    }
    return found;
}

/// Reads "yes_for" and "no_for".
void readAnswers(Task& task, const JsonObject& object, const std::vector<Condition>& conditions)
{
    task.yes.resize(conditions.size());
    for (const auto& [key, answer] : {std::pair{"yes_for", true}, std::pair{"no_for", false}}) {
        if (!object.has(key)) continue;
        const std::string where = object.where() + ": key \"" + key + "\"";
        for (const std::size_t n : conditionsIn(Json::parse(object.json(key)), conditions, where)) {
            if (task.yes[n]) throw Error(where + ": \"" + conditions[n].name + "\" has an answer already");
            task.yes[n] = answer;
        }
    }
}

void readPairs(Task& task, const JsonObject& object, const std::vector<Condition>& conditions)
{
    const std::string where = object.where() + ": key \"pairs\"";
    const Json        list  = Json::parse(object.json("pairs"));
    if (!list.is_array() || list.empty() || list.size() > kMostConditions)
        object.refuse("pairs", "a list of 1 to 26 pairs of names of conditions");
    for (const Json& one : list) {
        const auto pair = conditionsIn(one, conditions, where);
        if (pair.size() != 2) throw Error(where + ": expected two names in each pair, found " + one.dump());
        if (pair[0] == pair[1])
            throw Error(where + ": expected two different conditions, found \"" + conditions[pair[0]].name +
                        "\" twice");
        task.pairs.push_back({pair[0], pair[1]});
    }
    if (!object.has("right")) return;
    for (const auto& [first, second] : task.pairs)
        if (std::ranges::find(task.pairs, std::array{second, first}) != task.pairs.end())
            throw Error(where + ": expected each pair in one order where \"right\" is given, found \"" +
                        conditions[first].name + "\" and \"" + conditions[second].name +
                        "\" in both, so that the right answers contradict each other; list the pair once");
    const std::string right = object.text("right");
    if (right != "first" && right != "second") object.refuse("right", "first or second, of each pair as it is listed");
    task.right = right == "second";
}

Task taskOf(const JsonObject& object, const std::vector<Condition>& conditions)
{
    Task              task;
    const std::string kind = object.text("kind");
    if (kind == name(TaskKind::rating)) {
        object.allowOnly({"name", "kind", "statement", "least", "most"});
        task.question = textOf(object, "statement");
        if (object.has("least")) task.least = textOf(object, "least");
        if (object.has("most")) task.most = textOf(object, "most");
    } else if (kind == name(TaskKind::yesNo)) {
        object.allowOnly({"name", "kind", "question", "yes_for", "no_for"});
        task.kind     = TaskKind::yesNo;
        task.question = textOf(object, "question");
        readAnswers(task, object, conditions);
    } else if (kind == name(TaskKind::twoAlternative)) {
        object.allowOnly({"name", "kind", "question", "pairs", "right"});
        task.kind     = TaskKind::twoAlternative;
        task.question = textOf(object, "question");
        readPairs(task, object, conditions);
    } else {
        object.refuse("kind", "rating, yes-no or two-alternative");
    }
    task.name = textOf(object, "name");
    return task;
}

template <class Named>
void demandNew(const std::vector<Named>& before, const Named& one, const std::string& where)
{
    for (const Named& other : before)
        if (other.name == one.name)
            throw Error(where + ": expected a name of its own, found \"" + one.name + "\" again");
}

/// Returns the hand as --hand takes it: a file is looked for from the plan's folder.
std::string handIn(const std::filesystem::path& folder, const std::string& hand)
{
    const bool isFile = !deviceNamed(hand) && !valueNamed<HandMotion>(hand);
    return isFile ? (folder / hand).string() : hand;
}

std::string canonicalText(const JsonObject& file, const StudyPlan& plan)
{
    Json all;
    for (const char* key : {"title", "seed", "seconds", "repetitions", "tasks"})
        if (file.has(key)) all[key] = Json::parse(file.json(key));
    for (const Condition& condition : plan.conditions)
        all["conditions"].push_back({{"name", condition.name}, {"scene", Json::parse(sceneJson(condition.scene))}});
    return all.dump();
}

} // namespace

StudyPlan parsePlan(std::string_view text, const std::string& name, const std::filesystem::path& folder)
{
    const JsonObject file = JsonObject::parse(text, name);
    file.allowOnly({"title", "seed", "seconds", "hand", "repetitions", "conditions", "tasks"});
    StudyPlan plan;
    plan.title = textOf(file, "title");
    if (file.has("seed")) plan.seed = std::uint64_t(file.wholeNumber("seed", 0, 2147483647));
    if (file.has("seconds")) plan.seconds = file.positiveNumber("seconds");
    if (!(plan.seconds >= kLeastSeconds && plan.seconds <= kMostSeconds))
        file.refuse("seconds", "a time from 1.5 s, which a force needs to come on, to 3600 s");
    if (file.has("hand")) {
        plan.hand = textOf(file, "hand");
        demandKnown(plan.hand, name + ": key \"hand\":", folder);
        plan.hand = handIn(folder, plan.hand);
    }
    if (file.has("repetitions")) plan.repetitions = file.wholeNumber("repetitions", 1, kMostRepetitions);
    for (const JsonObject& one : objectsIn(file, "conditions", "condition", kMostConditions)) {
        Condition condition = conditionOf(one, folder);
        demandNew(plan.conditions, condition, one.where());
        plan.conditions.push_back(std::move(condition));
    }
    for (const JsonObject& one : objectsIn(file, "tasks", "task", kMostTasks)) {
        Task task = taskOf(one, plan.conditions);
        demandNew(plan.tasks, task, one.where());
        plan.tasks.push_back(std::move(task));
    }
    plan.canonical = canonicalText(file, plan);
    return plan;
}

std::optional<std::size_t> trialsPlanned(std::string_view canonical)
{
    try {
        const JsonObject plan   = JsonObject::parse(canonical, "a study's plan");
        const int        rounds = plan.has("repetitions") ? plan.wholeNumber("repetitions", 1, kMostRepetitions) : 1;
        const auto       conditions = objectsIn(plan, "conditions", "condition", kMostConditions).size();
        std::size_t      trials     = 0;
        for (const JsonObject& task : objectsIn(plan, "tasks", "task", kMostTasks))
            trials += std::size_t(rounds) * (task.has("pairs") ? Json::parse(task.json("pairs")).size() : conditions);
        return trials;
    } catch (const Error&) {
        return {};
    }
}

StudyPlan readPlan(const std::filesystem::path& file)
{
    return parsePlan(readWhole(file, kLargestFile, "a plan of a study, of some thousand bytes"), file.string(),
                     file.parent_path());
}

} // namespace palp::study
