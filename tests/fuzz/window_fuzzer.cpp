#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <utility>

#include "engine/tools/gui/window_memory.h"
#include "tests/fuzz/fuzz_expect.h"
#include "tests/support/temporary_folder.h"

namespace {

/// Stands for the user's folder.
class Folder {
public:
    Folder()
    {
        std::filesystem::create_directories(folder_ / "palpate");
        ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
    }

    void put(std::string_view text) const { static_cast<void>(folder_.write("palpate/window.json", text)); }

private:
    palp::TemporaryFolder folder_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const Folder kFolder;
    kFolder.put({reinterpret_cast<const char*>(data), size});
    const auto [window, files] =
        palp::fuzzRead([] { return std::pair(palp::rememberedSize(), palp::rememberedFiles()); });
    palp::fuzzExpect(window.x >= 320 && window.x <= 16384 && window.y >= 320 && window.y <= 16384 && files.size() <= 8);
    return 0;
}
