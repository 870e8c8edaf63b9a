#include "engine/tools/cli/version.h"

#include <nlohmann/json.hpp>

#include "engine/session/device_registry.h"
#include "engine/session/recorded_session.h"
#include "engine/tools/cli/commit.h"
#include "engine/tools/gui/panel_frame.h"

namespace palp {
namespace {

#ifdef PALPATE_WINDOW
constexpr bool kHasWindow = true;
#else
constexpr bool kHasWindow = false;
#endif

/// Returns by name whether the library that a kind of device needs was compiled in. Kinds that need none are omitted.
nlohmann::ordered_json hands()
{
    nlohmann::ordered_json result;
    for (const DeviceRecord* record : deviceRecords())
        if (record->support) result[std::string(record->name)] = record->support().isBuilt;
    return result;
}

} // namespace

std::string versionLine()
{
    return "palpate " PALPATE_VERSION;
}

std::string versionJson()
{
    const nlohmann::ordered_json found = {
        {"version", PALPATE_VERSION},
        {"commit", PALPATE_COMMIT},
        {"compiler", PALPATE_COMPILER},
        {"libraries", PALPATE_LIBRARIES},
        {"window", kHasWindow},
        {"panels", PanelFrame::available()},
        {"hands", hands()},
        {"sanitizers", PALPATE_SANITIZERS},
        {"formats", {{"recording", kSessionFormat}, {"library", "libpalpate.so." PALPATE_LIBRARY_MAJOR}}},
    };
    return found.dump(2);
}

} // namespace palp
