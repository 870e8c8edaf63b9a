#include <set>
#include <string>
#include <string_view>

#include "engine/tools/study/study_plan.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

/// What must hold of every plan that is accepted: something is asked of somebody, names are unique, pairs are known.
void check(const palp::study::StudyPlan& plan)
{
    std::set<std::string> names;
    for (const palp::study::Condition& condition : plan.conditions)
        palp::fuzzExpect(names.insert(condition.name).second && !condition.scene.cloud.empty());
    palp::fuzzExpect(!names.empty() && !plan.tasks.empty());
    for (const palp::study::Task& task : plan.tasks)
        for (const auto& pair : task.pairs)
            palp::fuzzExpect(pair[0] < plan.conditions.size() && pair[1] < plan.conditions.size());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzRefusals([&] {
        check(palp::study::parsePlan(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz", "."));
    });
    return 0;
}
