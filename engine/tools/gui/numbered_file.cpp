#include "engine/tools/gui/numbered_file.h"

#include <cstdio>

#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {

std::filesystem::path unusedPath(const std::string& stem, const std::string& extension)
{
    for (int n = 1; n < 10000; ++n) {
        char number[16];
        std::snprintf(number, sizeof number, "-%04d", n);
        const std::filesystem::path path = stem + number + extension;
        if (!isThere(path)) return path;
    }
    throw Error("there are 9999 files called " + stem + "-NNNN" + extension + " here; move some away");
}

} // namespace palp
