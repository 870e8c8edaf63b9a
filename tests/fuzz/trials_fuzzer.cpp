#include <string_view>

#include "engine/tools/study/study_analysis.h"
#include "engine/tools/study/trial_table.h"
#include "tests/fuzz/fuzz_expect.h"
#include "tests/support/temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const palp::TemporaryFolder kFolder;
    const auto path = kFolder.write("trials.csv", std::string_view(reinterpret_cast<const char*>(data), size));
    palp::fuzzRefusals([&] {
        const auto before = palp::fuzzRead([&] { return palp::study::readTrials(path); });
        static_cast<void>(palp::study::analyse(before, {}));
        // A table that can be read can be continued, and nothing of it is lost.
        palp::study::TrialTable table(path);
        palp::fuzzExpect(table.rows().size() == before.size());
        palp::study::TrialRow row;
        row.participant = "p";
        row.trial       = before.size() + 1;
        row.block       = 1;
        row.task        = "t";
        row.kind        = "rating";
        row.answer      = "5";
        table.append(row);
        palp::fuzzExpect(palp::study::readTrials(path).size() == before.size() + 1);
    });
    return 0;
}
