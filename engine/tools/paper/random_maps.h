#pragma once
#include <array>

#include "engine/core/enum_names.h"
#include "engine/core/uniform.h"
#include "engine/plate/plate.h"

namespace palp::report {

/// Kinds of random rigidity, such as scans and made-up maps contain.
enum class MapKind {
    smooth, ///< a few waves
    rough,  ///< every node independent
    discs,  ///< hard or soft inclusions with sharp rims
    blocks  ///< a coarse checker of random fields
};
constexpr auto namesOf(MapKind)
{
    using enum MapKind;
    return std::to_array<NamedValue<MapKind>>(
        {{smooth, "smooth"}, {rough, "rough"}, {discs, "sharp discs"}, {blocks, "sharp blocks"}});
}
inline constexpr std::array<MapKind, 4> kMapKinds = {MapKind::smooth, MapKind::rough, MapKind::discs, MapKind::blocks};

/// Returns a rigidity of a kind on a grid: the softest node is 1 and the stiffest is `contrast`, as far as the kind
/// reaches them [1].
[[nodiscard]] NodeField randomMap(MapKind kind, const PlateGrid& grid, double contrast, Uniform& uniform);

} // namespace palp::report
