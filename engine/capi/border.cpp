#include "engine/capi/detail/border.h"

#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <utility>

#include "engine/core/file.h"

namespace palp::capi {
namespace {

thread_local std::string lastError, lastTakeover;

/// Keeps a sentence; returns the code that goes with it.
int keep(int code, const char* opening, const char* sentence) noexcept
{
    try {
        lastError = std::string(opening) + sentence;
    } catch (...) {
        return PALPATE_NO_MEMORY;
    }
    return code;
}

int refused(const std::filesystem::filesystem_error& error) noexcept
{
    try {
        return keep(PALPATE_REFUSED, "", sentenceOf(error).c_str());
    } catch (...) {
        return PALPATE_NO_MEMORY;
    }
}

} // namespace

void forgetLastCall() noexcept
{
    lastError.clear();
    lastTakeover.clear();
}

void keepTakeover(std::string sentence) noexcept
{
    lastTakeover = std::move(sentence);
}

int failure() noexcept
{
    try {
        throw;
    } catch (const std::bad_alloc&) {
        lastError = "no memory"; // short enough to need none
        return PALPATE_NO_MEMORY;
    } catch (const Error& error) {
        return keep(PALPATE_REFUSED, "", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return refused(error);
    } catch (const std::exception& error) {
        return keep(PALPATE_BROKEN, "a mistake of the library's own: ", error.what());
    } catch (...) {
        return keep(PALPATE_BROKEN, "a mistake of the library's own", "");
    }
}

std::string shown(const glm::dvec3& v)
{
    std::ostringstream text;
    text << '(' << v.x << ", " << v.y << ", " << v.z << ')';
    return text.str();
}

void demandRoom(std::size_t found, std::size_t wanted)
{
    if (found < wanted)
        throw Error("count: expected room for " + std::to_string(wanted) + " points, found " + std::to_string(found));
}

void giveText(const std::string& from, char* to, std::size_t size)
{
    if (size <= from.size())
        throw Error("size: expected room for " + std::to_string(from.size() + 1) + " bytes, found " +
                    std::to_string(size));
    std::memcpy(&demand(to, "text"), from.c_str(), from.size() + 1);
}

} // namespace palp::capi

const char* palpate_version(void)
{
    return PALPATE_VERSION_TEXT;
}

const char* palpate_error_text(void)
{
    return palp::capi::lastError.c_str();
}

const char* palpate_takeover_text(void)
{
    return palp::capi::lastTakeover.c_str();
}
