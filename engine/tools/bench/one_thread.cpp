#include "engine/tools/bench/one_thread.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include "engine/core/contract.h"

namespace palp::bench {

const std::vector<std::string>& oneThreadEnvironment()
{
    static const std::vector<std::string> variables{
        "OMP_THREAD_LIMIT=1", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1",
        "LP_NUM_THREADS=0", // lavapipe then computes on the thread of its queue and has no workers
    };
    return variables;
}

std::filesystem::path runningProgram()
{
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error);
}

void becomeOneThread(const std::filesystem::path& program)
{
    bool isSet = true;
    for (const std::string& variable : oneThreadEnvironment()) {
        const std::size_t equals = variable.find('=');
        const std::string name = variable.substr(0, equals), value = variable.substr(equals + 1);
        const char*       found = std::getenv(name.c_str());
        isSet                   = isSet && found && found == value;
        setenv(name.c_str(), value.c_str(), 1);
    }
    if (program.empty() || (isSet && program == runningProgram())) return;

    std::ifstream            commandLine("/proc/self/cmdline", std::ios::binary);
    std::vector<std::string> words(1);
    for (auto c = std::istreambuf_iterator<char>(commandLine); c != std::istreambuf_iterator<char>(); ++c) {
        if (*c)
            words.back() += *c;
        else
            words.emplace_back(); // each word ends with a zero byte
    }
    words.pop_back();
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    throw Error(program.string() + ": cannot be started: " + std::strerror(errno) +
                "; with the libraries' threads nothing would be compared");
}

} // namespace palp::bench
