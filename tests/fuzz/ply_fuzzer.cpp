#include "engine/cloud/ply_repaint.h"
#include "tests/fuzz/cloud_fuzzer.h"

namespace {

using namespace palp;

/// Every file that is accepted can be written again with another stiffness, which is read back; and with its own, which
/// changes nothing unless a property must be appended or widened.
void repaint(const std::string& bytes)
{
    std::istringstream original(bytes);
    const LoadedCloud  loaded = parseCloud(original, bytes.size(), "fuzz", CloudFormat::ply);
    const PointCloud&  cloud  = loaded.cloud;
    for (const double value : {0.0, 3.25}) { // an exact float; 0: what it is
        std::vector<double> stiffness(cloud.stiffness().begin(), cloud.stiffness().end());
        if (value > 0) std::fill(stiffness.begin(), stiffness.end(), value);
        const PointCloud  painted({cloud.positions().begin(), cloud.positions().end()}, stiffness, cloud.kind());
        std::stringstream copy;
        static_cast<void>(formatRepaintedPly(copy, original, bytes.size(), "fuzz", {}, painted));
        const LoadedCloud again = parseCloud(copy, copy.str().size(), "again", CloudFormat::ply);
        if (value > 0) fuzzExpectSame(painted, again.cloud);
        fuzzExpect(again.faces == loaded.faces && again.cloud.size() == cloud.size());
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    fuzzCloud(data, size, CloudFormat::ply);
    palp::fuzzRefusals([&] { repaint(std::string(reinterpret_cast<const char*>(data), size)); });
    return 0;
}
