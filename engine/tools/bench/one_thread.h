#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace palp::bench {

/// Lists, as NAME=value, what keeps libraries to one thread: OpenMP (in CHOLMOD), OpenBLAS, lavapipe. They read it when
/// they are loaded, before main(), so it has to be in the environment in which a program starts.
[[nodiscard]] const std::vector<std::string>& oneThreadEnvironment();

/// The program that is running; empty where /proc does not say.
[[nodiscard]] std::filesystem::path runningProgram();

/// Becomes `program`, with the arguments of this one, in that environment. Returns if it is running in it already, or
/// if it cannot be run: then the variables are set, which Vulkan's drivers still see.
void becomeOneThread(const std::filesystem::path& program);

} // namespace palp::bench
