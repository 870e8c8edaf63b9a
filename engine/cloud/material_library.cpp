#include "engine/cloud/material_library.h"

#include <algorithm>
#include <array>

namespace palp {
namespace {

constexpr std::string_view kPhantoms = "Dawood, phantom-material-database: uniaxial compression of silicone mixtures";
constexpr std::string_view kCcBy     = "CC BY 4.0";
constexpr std::string_view kProbes =
    "our fit to some 900 published robotic probes of liver and meat, ball tip, 2 to 3 mm";
constexpr std::string_view kHolds = "our fit to such probes, and to 128 holds of 10 s on cuts of meat";
constexpr std::string_view kOwn   = "figures of this program, under its licence; the measurements are not included";

/// Ecoflex of a number, with a share of thinner; silicone keeps its volume.
constexpr KnownMaterial ecoflex(std::string_view name, double kiloPascal, double error)
{
    return {name, 1e3 * kiloPascal, 1e3 * error, 0.49, 0, {}, kPhantoms, kCcBy};
}

constexpr std::array kMaterials{
    ecoflex("ecoflex-0050", 152.7, 4.8),
    ecoflex("ecoflex-0050-thinner-12.5", 111.1, 6.44),
    ecoflex("ecoflex-0050-thinner-25", 89.49, 2.33),
    ecoflex("ecoflex-0030", 97.26, 4.16),
    ecoflex("ecoflex-0030-thinner-12.5", 73.18, 1.17),
    ecoflex("ecoflex-0030-thinner-25", 65.68, 2.83),
    ecoflex("ecoflex-0010", 54.21, 2.38),
    ecoflex("ecoflex-0010-thinner-12.5", 37.3, 1.28),
    ecoflex("ecoflex-0010-thinner-25", 27.39, 0.79),
    ecoflex("ecoflex-0010-thinner-37.5", 19.37, 0.83),
    ecoflex("ecoflex-0010-thinner-50", 15.52, 0.4),
    ecoflex("ecoflex-0010-thinner-62.5", 12.17, 0.52),
    ecoflex("ecoflex-0010-thinner-75", 8.81, 0.12),
    ecoflex("ecoflex-0010-thinner-87.5", 7.92, 0.26),
    ecoflex("ecoflex-0010-thinner-100", 5.42, 0.77),
    KnownMaterial{"liver", 0, 0, -1, 810, {}, kProbes, kOwn},
    KnownMaterial{"meat", 0, 0, -1, 810, {{{{0.26, 0.41}, {0.31, 4.3}}}, 2}, kHolds, kOwn},
};

} // namespace

std::span<const KnownMaterial> knownMaterials() noexcept
{
    return kMaterials;
}

const KnownMaterial* materialNamed(std::string_view name) noexcept
{
    const auto* const found = std::ranges::find(kMaterials, name, &KnownMaterial::name);
    return found == kMaterials.end() ? nullptr : found;
}

} // namespace palp
