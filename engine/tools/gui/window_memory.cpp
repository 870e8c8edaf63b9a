#include "engine/tools/gui/window_memory.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ostream>

#include <nlohmann/json.hpp>

#include "engine/core/file.h"

namespace palp {
namespace {

constexpr int kLeast = 320, kMost = 16384; ///< [px]

std::filesystem::path fileOf()
{
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    const char* const home   = std::getenv("HOME");
    if (config && *config) return std::filesystem::path(config) / "palpate" / "window.json";
    return home && *home ? std::filesystem::path(home) / ".config" / "palpate" / "window.json"
                         : std::filesystem::path();
}

} // namespace

glm::ivec2 rememberedSize()
{
    constexpr glm::ivec2 kUsual(1280, 720);
    std::ifstream        file(fileOf());
    const auto           read   = nlohmann::json::parse(file, nullptr, false);
    const auto           number = [&](const char* name) {
        return read.is_object() && read.contains(name) && read[name].is_number_integer() ? read[name].get<long>() : 0;
    };
    const long width = number("width"), height = number("height");
    if (width < kLeast || height < kLeast || width > kMost || height > kMost) return kUsual;
    return {int(width), int(height)};
}

void rememberSize(const glm::ivec2& size) noexcept
{
    try {
        const auto file = fileOf();
        if (file.empty() || size.x < kLeast || size.y < kLeast) return;
        std::filesystem::create_directories(file.parent_path());
        const std::string text = nlohmann::json{{"width", size.x}, {"height", size.y}}.dump() + "\n";
        writeFileWhole(file, [&](std::ostream& stream) { stream << text; });
    } catch (...) { // a size is not worth an error
    }
}

} // namespace palp
