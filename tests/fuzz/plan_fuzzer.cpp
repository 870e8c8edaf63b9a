#include <set>
#include <string>
#include <string_view>

#include "engine/tools/study/study_plan.h"
#include "tests/fuzz/fuzz_expect.h"
#include "tests/support/temporary_folder.h"

namespace {

/// The folder of a plan, with the scene that its conditions may name.
class Folder {
public:
    Folder() { static_cast<void>(folder_.write("a.json", R"({"cloud": "sample:sheet"})")); }

    [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

private:
    palp::TemporaryFolder folder_;
};

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
    static const Folder kFolder;
    palp::fuzzRefusals([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        check(palp::fuzzRead([&] { return palp::study::parsePlan(text, "fuzz", kFolder.path()); }));
    });
    return 0;
}
