#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace palp::bench {

/// Lists, as NAME=value, the variables that keep libraries to one thread: OpenMP (in CHOLMOD), OpenBLAS, lavapipe. They
/// read them when they are loaded, before main(), so the variables have to be in the environment in which a program
/// starts.
[[nodiscard]] const std::vector<std::string>& oneThreadEnvironment();

/// Returns the running program; empty where /proc does not name it.
[[nodiscard]] std::filesystem::path runningProgram();

/// Replaces this program by `program`, with the arguments of this one, in that environment. It returns if this program
/// already runs in that environment, or if `program` cannot be run: then the variables are set, and Vulkan's drivers
/// still read them.
void becomeOneThread(const std::filesystem::path& program);

} // namespace palp::bench
