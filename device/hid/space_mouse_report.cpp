#include "device/hid/space_mouse_report.h"

#include <algorithm>
#include <cstdlib>

namespace palp {
namespace {

constexpr std::uint16_t kLogitech = 0x046d, kOwn = 0x256f; // the former and the present maker
constexpr std::uint16_t kGenericDesktop = 1, kMultiAxisController = 8;

constexpr SpaceMouseModel kModels[] = {
    {kLogitech, 0xc603, "SpaceMouse Plus", 32},
    {kLogitech, 0xc605, "CadMan", 32},
    {kLogitech, 0xc606, "SpaceMouse Classic", 32},
    {kLogitech, 0xc621, "SpaceBall 5000", 32},
    {kLogitech, 0xc623, "SpaceTraveler", 32},
    {kLogitech, 0xc625, "SpacePilot", 32},
    {kLogitech, 0xc626, "SpaceNavigator", 2},
    {kLogitech, 0xc627, "SpaceExplorer", 32},
    {kLogitech, 0xc628, "SpaceNavigator for Notebooks", 2},
    {kLogitech, 0xc629, "SpacePilot Pro", 32},
    {kLogitech, 0xc62b, "SpaceMouse Pro", 32},
    {kOwn, 0xc62e, "SpaceMouse Wireless (cable)", 2},
    {kOwn, 0xc62f, "SpaceMouse Wireless (receiver)", 2},
    {kOwn, 0xc631, "SpaceMouse Pro Wireless (cable)", 32},
    {kOwn, 0xc632, "SpaceMouse Pro Wireless (receiver)", 32},
    {kOwn, 0xc633, "SpaceMouse Enterprise", 32},
    {kOwn, 0xc635, "SpaceMouse Compact", 2},
    {kOwn, 0xc636, "SpaceMouse Module", 32},
    {kOwn, 0xc638, "SpaceMouse Pro Wireless (Bluetooth)", 32},
    {kOwn, 0xc63a, "SpaceMouse Wireless (Bluetooth)", 2},
    {kOwn, 0xc652, "3Dconnexion universal receiver", 32},
};

constexpr std::size_t kThreeAxes = 1 + 3 * 2, kSixAxes = 1 + 6 * 2; // [byte]

std::int16_t axis(std::span<const std::uint8_t> report, std::size_t index) noexcept
{
    return std::int16_t(report[1 + 2 * index] | report[2 + 2 * index] << 8);
}

bool takeAxes(std::span<const std::uint8_t> report, std::size_t first, std::size_t count,
              SpaceMouseCounts& counts) noexcept
{
    std::array<std::int16_t, 6> axes = counts.axes;
    for (std::size_t n = 0; n < count; ++n) {
        axes[first + n] = axis(report, n);
        if (std::abs(int(axes[first + n])) > kMostSpaceMouseCounts) return false;
    }
    counts.axes = axes;
    return true;
}

} // namespace

const SpaceMouseModel* spaceMouseModel(const HidListing& listing) noexcept
{
    // A receiver also has a keyboard and a mouse. Systems that do not know the usage report 0.
    const bool known = listing.usagePage != 0;
    if (known && (listing.usagePage != kGenericDesktop || listing.usage != kMultiAxisController)) return nullptr;
    for (const SpaceMouseModel& model : kModels)
        if (model.vendor == listing.vendor && model.product == listing.product) return &model;
    return nullptr;
}

bool takeSpaceMouseReport(std::span<const std::uint8_t> report, SpaceMouseCounts& counts) noexcept
{
    if (report.size() < 2) return false;
    switch (report[0]) {
    case 1:
        return report.size() >= kThreeAxes && takeAxes(report, 0, report.size() >= kSixAxes ? 6 : 3, counts);
    case 2:
        return report.size() >= kThreeAxes && takeAxes(report, 3, 3, counts);
    case 3: {
        counts.buttons          = 0;
        const std::size_t bytes = std::min<std::size_t>(report.size() - 1, 4);
        for (std::size_t n = 0; n < bytes; ++n) counts.buttons |= std::uint32_t(report[1 + n]) << (8 * n);
        return true;
    }
    default:
        return false; // such as the state of a battery
    }
}

} // namespace palp
