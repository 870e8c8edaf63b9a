#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/tools/paper/page.h"

namespace palp::report {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const std::vector<Quantity>& quantities)
{
    Json all = Json::object();
    for (const Quantity& quantity : quantities) {
        Json values = Json::array();
        for (const double value : quantity.values)
            values.push_back(std::isfinite(value) ? Json(value) : Json(nullptr)); // JSON has no NaN and no infinity
        all[quantity.name] = {{"unit", quantity.unit},
                              {"value", quantity.values.size() == 1 ? values.front() : std::move(values)}};
    }
    return all;
}

Json jsonOf(const Claim& claim)
{
    return {{"paper", claim.paper},
            {"ours", claim.ours},
            {"how", claim.how},
            {"verdict", name(claim.verdict)},
            {"words", claim.words}};
}

std::string textOf(const Json& json)
{
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

std::string numbersJson(std::span<const Section> sections, const Origins& origins)
{
    Json all;
    all["program"] = {{"version", origins.version}, {"commit", origins.commit}};
    all["solver"]  = origins.solver;
    all["quick"]   = origins.quick;
    for (const Section& section : sections) {
        Json& part    = all["parts"][std::string(1, section.letter)];
        part["title"] = section.title;
        for (const Claim& claim : section.claims)
            if (!claim.timed) part["claims"].push_back(jsonOf(claim));
        part["numbers"] = jsonOf(section.numbers);
    }
    return textOf(all);
}

std::string timingsJson(std::span<const Section> sections, const Origins& origins)
{
    Json all;
    all["machine"] = origins.machine;
    all["solver"]  = origins.solver;
    for (const Section& section : sections) {
        if (section.timings.empty()) continue;
        Json& part = all["parts"][std::string(1, section.letter)];
        for (const Claim& claim : section.claims)
            if (claim.timed) part["claims"].push_back(jsonOf(claim));
        part["timings"] = jsonOf(section.timings);
    }
    return textOf(all);
}

} // namespace palp::report
