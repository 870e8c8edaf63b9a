#include <string_view>
#include <vector>

#include "engine/session/recorded_session.h"
#include "tests/fuzz/fuzz_expect.h"
#include "tests/support/temporary_folder.h"

namespace {

/// A recording in which the first byte says which file is the fuzzer's; the others are whole.
class Folder {
public:
    Folder() { restore(); }

    [[nodiscard]] const std::filesystem::path& with(char file, std::string_view bytes)
    {
        restore();
        write(file == 's' ? "session.json" : file == 'm' ? "markers.jsonl" : "ticks.npy", bytes);
        return folder_.path();
    }

private:
    void restore() const
    {
        write("session.json", R"({"format": 2, "clock": "virtual", "solver": "host", "command": "palpate",
            "scene": {"cloud": "sample:sheet"}})");
        write("ticks.npy", "\x93NUMPY\x01");
        write("markers.jsonl", "");
    }
    void write(const char* name, std::string_view bytes) const { static_cast<void>(folder_.write(name, bytes)); }

    palp::TemporaryFolder folder_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static Folder folder;
    if (size == 0) return 0;
    const auto& path = folder.with(char(data[0]), {reinterpret_cast<const char*>(data) + 1, size - 1});
    palp::fuzzRefusals([&] {
        const auto description = palp::fuzzRead([&] { return palp::readDescription(path); });
        palp::fuzzExpect(description.records.empty() && description.folder == path);
    });
    palp::fuzzRefusals([&] {
        const auto ticks = palp::fuzzRead([&] { return palp::openTicks(path, false); });
        palp::fuzzExpect(ticks->rows() * 8 <= size); // a time at least, in each row
        const auto records = palp::fuzzRead([&] {
            std::vector<palp::TickRecord> read(std::size_t(ticks->rows()));
            ticks->read(read);
            return read;
        });
        palp::fuzzExpect(records.size() == ticks->rows());
    });
    return 0;
}
