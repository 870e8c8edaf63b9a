#include "engine/plate/host_kernels.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "engine/core/contract.h"

namespace palp {

namespace portable {
extern const HostKernels kTable;
}
#ifdef PALPATE_X86_VARIANTS
namespace avx2 {
extern const HostKernels kTable;
}
namespace avx512 {
extern const HostKernels kTable;
}
#endif

const std::vector<HostVariant>& hostVariants()
{
    static const std::vector<HostVariant> all = [] {
        std::vector<HostVariant> found{{"portable", &portable::kTable}};
#ifdef PALPATE_X86_VARIANTS
        if (__builtin_cpu_supports("avx2")) found.push_back({"avx2", &avx2::kTable});
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
            found.push_back({"avx512", &avx512::kTable});
#endif
        return found;
    }();
    return all;
}

const HostVariant& hostVariant()
{
    const char* const wanted = std::getenv("PALPATE_HOST_ISA");
    if (!wanted || !*wanted) return hostVariants().back();
    const auto& all   = hostVariants();
    const auto  found = std::find_if(all.begin(), all.end(), [&](const HostVariant& v) { return v.isa == wanted; });
    if (found != all.end()) return *found;
    std::string known;
    for (const HostVariant& v : all) known += (known.empty() ? "" : ", ") + std::string(v.isa);
    throw Error("PALPATE_HOST_ISA: expected one of " + known + ", found \"" + wanted + "\"");
}

} // namespace palp
