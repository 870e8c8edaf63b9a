#include "engine/tools/gui/window_memory.h"

#include <cstdlib>
#include <filesystem>
#include <ostream>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_limits.h"

namespace palp {
namespace {

constexpr int         kLeast = 320, kMost = 16384; ///< [px]
constexpr std::size_t kMostFiles = 8;

std::filesystem::path fileOf()
{
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    const char* const home   = std::getenv("HOME");
    if (config && *config) return std::filesystem::path(config) / "palpate" / "window.json";
    return home && *home ? std::filesystem::path(home) / ".config" / "palpate" / "window.json"
                         : std::filesystem::path();
}

/// Returns nothing where the file is missing or damaged.
nlohmann::json remembered()
try {
    constexpr std::size_t kLargest = 1 << 20; // [bytes]
    const std::string     text     = readWhole(fileOf(), kLargest, "what windows remember", Pipes::refused);
    auto                  read     = excessOf(text) ? nlohmann::json() : nlohmann::json::parse(text, nullptr, false);
    return read.is_object() ? read : nlohmann::json::object();
} catch (const Error&) {
    return nlohmann::json::object();
}

/// Writes one more value to the file; the others stay.
void remember(const nlohmann::json& values) noexcept
{
    try {
        const auto file = fileOf();
        if (file.empty()) return;
        nlohmann::json all = remembered();
        all.update(values);
        makeFolder(file.parent_path());
        const std::string text = all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
        writeFileWhole(file, [&](std::ostream& stream) { stream << text; });
    } catch (...) { // what is remembered is not worth an error
    }
}

/// Returns the files as they were written, whether or not they are still there.
std::vector<std::string> writtenFiles()
{
    const nlohmann::json     all = remembered();
    std::vector<std::string> files;
    if (!all.contains("files") || !all["files"].is_array()) return files;
    for (const nlohmann::json& file : all["files"])
        if (file.is_string() && files.size() < kMostFiles) files.push_back(file.get<std::string>());
    return files;
}

} // namespace

glm::ivec2 rememberedSize()
{
    constexpr glm::ivec2 kUsual(1280, 720);
    const auto           read   = remembered();
    const auto           number = [&](const char* name) {
        return read.contains(name) && read[name].is_number_integer() ? read[name].get<long>() : 0;
    };
    const long width = number("width"), height = number("height");
    if (width < kLeast || height < kLeast || width > kMost || height > kMost) return kUsual;
    return {int(width), int(height)};
}

void rememberSize(const glm::ivec2& size) noexcept
{
    if (size.x >= kLeast && size.y >= kLeast) remember({{"width", size.x}, {"height", size.y}});
}

std::vector<std::string> rememberedFiles()
{
    std::vector<std::string> files = writtenFiles();
    std::erase_if(files, [](const std::string& file) {
        std::error_code ignored;
        return !std::filesystem::exists(file, ignored);
    });
    return files;
}

void rememberFile(const std::string& file) noexcept
{
    try {
        std::vector<std::string> files = writtenFiles();
        std::erase(files, file);
        files.insert(files.begin(), file);
        if (files.size() > kMostFiles) files.resize(kMostFiles);
        remember({{"files", files}});
    } catch (...) { // as above
    }
}

bool isFirstWindow()
{
    return remembered().empty();
}

} // namespace palp
