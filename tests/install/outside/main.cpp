// A project that knows Palpate only by find_package: one touch of the paper's ellipsoid.
#include <cmath>
#include <cstdio>

#include "engine/cloud/samples.h"
#include "engine/pipeline/pipeline.h"

int main()
{
    const palp::Sample&    sample = palp::sampleNamed("ellipsoid");
    const palp::SoftObject object(palp::makeSample(sample, 5000, 1), sample.material);
    const palp::Contact    contact = palp::touchAt(object, sample.place, sample.from, 5e-3);
    const palp::Patch      patch   = palp::deform(object, contact, {.cells = 32});
    std::printf("compliance %.3g m/N\n", patch.compliance);
    return patch.deformed() && std::isfinite(patch.compliance) && patch.compliance > 0 ? 0 : 1;
}
