#include "engine/session/shipped_scenes.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "engine/core/contract.h"
#include "engine/session/scene.h"

namespace palp {

namespace fs = std::filesystem;

fs::path shippedScenesFolder()
{
    std::error_code none;
    const fs::path  here = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const fs::path& folder :
         {here / "../share/palpate/scenes", here / "../../samples/scenes", fs::path("samples/scenes")})
        if (fs::is_directory(folder, none)) return folder.lexically_normal();
    throw Error("the scenes were not found beside " + here.string() +
                "; expected ../share/palpate/scenes there; name their folder by --scenes");
}

namespace {

/// Returns whether the library alone can read the file: a hunt has keys of a tool.
bool isPlainScene(const fs::path& file)
{
    try {
        static_cast<void>(readScene(file));
        return true;
    } catch (const Error&) {
        return false;
    }
}

} // namespace

std::vector<ShippedScene> scenesIn(const fs::path& folder)
{
    std::vector<ShippedScene> scenes;
    std::error_code           failure;
    for (const auto& entry : fs::directory_iterator(folder, failure)) {
        const fs::path& file = entry.path();
        if (file.extension() != ".json" || file.stem().extension() == ".schema" || !isPlainScene(file)) continue;
        std::ifstream text(file);
        std::string   line;
        std::getline(text, line);
        scenes.push_back({file, file.stem().string(), line.starts_with("// ") ? line.substr(3) : ""});
    }
    if (failure) throw Error(folder.string() + ": cannot be read: " + failure.message());
    std::ranges::sort(scenes, {}, &ShippedScene::name);
    return scenes;
}

} // namespace palp
