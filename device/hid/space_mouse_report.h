#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "device/hid/hid_port.h"

namespace palp {

/// One product of 3Dconnexion that has a cap with six axes.
struct SpaceMouseModel {
    std::uint16_t vendor, product;
    const char*   name;
    unsigned      buttons; ///< bits of the button report; not every bit need have a button
};

/// The model that a listing is, or null: keyboards and mice of the same maker, and the other collections of a cap.
[[nodiscard]] const SpaceMouseModel* spaceMouseModel(const HidListing& listing) noexcept;

/// What a SpaceMouse last said of itself, in its own counts and axes: x right, y towards the user, z down.
struct SpaceMouseCounts {
    std::array<std::int16_t, 6> axes{}; ///< [counts] x, y, z, then turns about them; about 350 at full deflection
    std::uint32_t               buttons = 0;
};

/// Beyond these counts a report is taken for garbage; the widest deflections seen in public drivers stay below 600.
inline constexpr int kMostSpaceMouseCounts = 2000;

/// Takes over what an input report says, by its number and its length:
///
///     1  x y z            7 bytes   int16, low byte first
///     1  x y z rx ry rz  13 bytes   newer and wireless ones
///     2  rx ry rz         7 bytes
///     3  buttons          2 bytes or more, a bit mask, low byte first
///
/// \return whether it was one of them; if not, `counts` stays as it is
/// \source facts from spacenavd and PySpaceMouse (device tables)
bool takeSpaceMouseReport(std::span<const std::uint8_t> report, SpaceMouseCounts& counts) noexcept;

} // namespace palp
