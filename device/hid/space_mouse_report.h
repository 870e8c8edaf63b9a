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
    unsigned      buttons; ///< bits of the button report; a bit need not have a button
};

/// Returns the model of a listing; null for keyboards and mice of the same maker, and for the other collections of a
/// cap.
[[nodiscard]] const SpaceMouseModel* spaceMouseModel(const HidListing& listing) noexcept;

/// The last report of a SpaceMouse, in its own counts and axes: x right, y towards the user, z down.
struct SpaceMouseCounts {
    std::array<std::int16_t, 6> axes{}; ///< [counts] x, y, z, then turns about them; about 350 at full deflection
    std::uint32_t               buttons = 0;
};

/// Counts beyond which a report is taken for garbage; the widest deflections in public drivers stay below 600.
inline constexpr int kMostSpaceMouseCounts = 2000;

/// Reads an input report, by its number and its length:
///
///     1  x y z            7 bytes   int16, low byte first
///     1  x y z rx ry rz  13 bytes   newer and wireless ones
///     2  rx ry rz         7 bytes
///     3  buttons          2 bytes or more, a bit mask, low byte first
///
/// \return whether it was one of these; if not, `counts` is unchanged
/// \source device tables of spacenavd and PySpaceMouse
bool takeSpaceMouseReport(std::span<const std::uint8_t> report, SpaceMouseCounts& counts) noexcept;

} // namespace palp
