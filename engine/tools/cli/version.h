#pragma once
#include <string>

namespace palp {

/// Returns "palpate 0.2.0".
[[nodiscard]] std::string versionLine();

/// Returns what a report needs to know of this build: version, commit, compiler, libraries, compiled-in parts, and the
/// formats by which it talks to others.
[[nodiscard]] std::string versionJson();

} // namespace palp
