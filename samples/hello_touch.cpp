// Presses an ellipsoid of points once, and prints how far it gives.
#include <cmath>
#include <cstdio>

#include "engine/cloud/samples.h"
#include "engine/contact/contact.h"
#include "engine/pipeline/deform.h"

int main()
{
    const palp::Sample&    sample = palp::sampleNamed("ellipsoid"); // readCloud() reads a file in its place
    const palp::SoftObject object(palp::makeSample(sample, 5000, 1), sample.material);

    constexpr double    kReach  = 5e-3; // [m] that the place may lie off the cloud
    const palp::Contact contact = palp::touchAt(object, sample.place, sample.from, kReach);
    const palp::Patch   patch   = palp::deform(object, contact, {.window = sample.window, .cells = 32});

    std::printf("gives %.4g m/N, feels like %.4g N/m\n", patch.compliance, patch.feltStiffness);
    return patch.deformed() && std::isfinite(patch.compliance) ? 0 : 1;
}
