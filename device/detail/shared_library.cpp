#include "device/detail/shared_library.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <dlfcn.h>

#include "engine/core/contract.h"

namespace palp {

SharedLibrary::SharedLibrary(const std::vector<std::string>& places)
{
    std::string tried;
    for (const std::string& place : places) {
        library_ = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library_) {
            place_ = place;
            return;
        }
        const char* why = dlerror();
        tried += (tried.empty() ? "" : "; ") + std::string(why ? why : place);
    }
    throw Error("looked for " + tried);
}

void* SharedLibrary::address(const char* symbol) const noexcept
{
    return dlsym(library_, symbol);
}

void SharedLibrary::demandWhole(const char* what) const
{
    if (missing_.empty()) return;
    std::string names;
    for (const std::string& name : missing_) names += (names.empty() ? "" : ", ") + name;
    throw Error(place_ + " lacks " + names + ": it is no " + what + ", or one that is too old");
}

std::vector<std::string> filesNamed(const std::string& folder, const std::string& begin)
{
    std::vector<std::string> files;
    std::error_code          failed;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
        if (entry.path().filename().string().starts_with(begin)) files.push_back(entry.path().string());
    std::ranges::sort(files);
    return files;
}

std::string environmentOf(const char* variable)
{
    const char* value = std::getenv(variable);
    return value ? value : "";
}

} // namespace palp
