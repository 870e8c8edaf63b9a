#include "engine/plate/host/host_kernels.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "engine/core/contract.h"

namespace palp {

namespace portable {
extern const HostKernels kTable, kTogether;
}
#ifdef PALPATE_X86_VARIANTS
namespace avx2 {
extern const HostKernels kTable, kTogether;
}
namespace avx512 {
extern const HostKernels kTable, kTogether;
}
#endif

const std::vector<HostVariant>& hostVariants()
{
    static const std::vector<HostVariant> all = [] {
        std::vector<HostVariant> found{{"portable", &portable::kTable, &portable::kTogether}};
#ifdef PALPATE_X86_VARIANTS
        if (__builtin_cpu_supports("avx2")) found.push_back({"avx2", &avx2::kTable, &avx2::kTogether});
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
            found.push_back({"avx512", &avx512::kTable, &avx512::kTogether});
#endif
        return found;
    }();
    return all;
}

const HostVariant& hostVariant()
{
    constexpr std::array<std::string_view, 3> kNames{"portable", "avx2", "avx512"}; // best last
    const auto&                               all   = hostVariants();
    const char* const                         limit = std::getenv("PALPATE_HOST_ISA");
    if (!limit || !*limit) return all.back();
    const auto most = std::find(kNames.begin(), kNames.end(), limit);
    if (most == kNames.end())
        throw Error("PALPATE_HOST_ISA: expected portable, avx2 or avx512, found \"" + std::string(limit) + "\"");
    return all[std::min(all.size() - 1, std::size_t(most - kNames.begin()))];
}

} // namespace palp
