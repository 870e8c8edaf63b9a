// Tests of an arm that gravity pulls, in virtual time, through the whole engine: whether it lies in the object or is
// carried.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <glm/geometric.hpp>

#include "device/arm_device.h"
#include "device/falcon/falcon_device.h"
#include "device/falcon/ft232_emulator.h"
#include "engine/session/deformation.h"
#include "engine/session/session_hand.h"
#include "engine/session/virtual_session.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

constexpr double kReleased = 5, kEnd = 8; // [s]
constexpr double kAbove = 5e-3;           // [m] middle of the workspace above the surface

/// A person who holds the grip above the surface, touches it with 1 mm, and lets go.
SimulatedHand holdingAt(double time)
{
    if (time >= kReleased) return {};
    const double down = std::clamp((time - 4) / 0.5, 0.0, 1.0);
    return {.stiffness = 500, .damping = 2, .target = {0, -down * (kAbove + 1e-3), 0}};
}

/// A simulated arm in that hand.
class HeldArm : public HapticDevice {
public:
    explicit HeldArm(const glm::dvec3& stated) : arm_(fallingArm())
    {
        info_        = arm_.info();
        info_.weight = stated;
    }
    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }
    void                                  open() override { arm_.open(); }
    void                                  close() noexcept override { arm_.close(); }
    HapticState                           read(double now) noexcept override
    {
        arm_.holdBy(holdingAt(now));
        return arm_.read(now);
    }
    void render(const GovernedForce& force) noexcept override { arm_.render(force); }

private:
    ArmDevice        arm_;
    HapticDeviceInfo info_;
};

/// A Falcon in that hand, emulated down to its wire.
class HeldFalcon : public HapticDevice {
public:
    explicit HeldFalcon(const glm::dvec3& stated)
        : arm_(bare()), emulator_(ready(),
                                  [this](const glm::dvec3& force, double dt) {
                                      arm_.holdBy(holdingAt(now_));
                                      arm_.step(force, dt);
                                      return arm_.position();
                                  }),
          falcon_([this] { return emulator_.connect(); }, stepped())
    {
        info_        = falcon_.info();
        info_.weight = stated;
    }
    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }
    void                                  open() override { falcon_.open(); }
    void                                  close() noexcept override { falcon_.close(); }
    HapticState                           read(double now) noexcept override
    {
        now_ = now;
        return falcon_.read(now);
    }
    void render(const GovernedForce& force) noexcept override { falcon_.render(force); }

private:
    static FalconDeviceSettings stepped()
    {
        FalconDeviceSettings settings;
        settings.pace = FalconPace::stepped;
        return settings;
    }
    static SimulatedArmSettings bare()
    {
        SimulatedArmSettings arm = fallingArm();
        arm.encoderStep          = 0;
        arm.delayTicks           = 0;
        return arm;
    }
    static Ft232EmulatorSettings ready()
    {
        Ft232EmulatorSettings settings;
        settings.falcon.running = settings.falcon.homed = true;
        return settings;
    }

    double           now_ = 0; // [s]
    SimulatedArm     arm_;
    Ft232Emulator    emulator_;
    FalconDevice     falcon_;
    HapticDeviceInfo info_;
};

struct Rest {
    double depth   = 0; // [m] below the surface, at the end
    double touched = 0; // [s] when it last did; an encoder step of 48 um is 0.04 N, more than may weigh on it
};

/// The shipped palm, where the hand stays in one place.
struct Palm {
    Scene        scene = slow();
    LoadedObject loaded{loadObject(scene)};
    Deformation  deformation{loaded.object, scene};

    static Scene slow()
    {
        Scene scene           = readScene(PALPATE_SCENES "/palm_wart.json");
        scene.deformationRate = 20; // [Hz]
        return scene;
    }

    /// The grip is let go above a place.
    Rest released(HapticDevice& device, const glm::dvec3& place)
    {
        const glm::dvec3 outward(0, 0, 1);
        device.open();
        Rest rest;
        static_cast<void>(runVirtual({scene, loaded.object, deformation.solver(), device,
                                      deviceFrame(place + kAbove * outward, outward), deformation.firstLaw()},
                                     kEnd, [&](const TickRecord& record) {
                                         EXPECT_EQ(record.faults & 0xFFU, 0U);
                                         rest.depth = glm::dot(record.proxy - record.hip, outward);
                                         if (record.normal != glm::dvec3(0)) rest.touched = record.time;
                                     }));
        return rest;
    }
};

constexpr glm::dvec3 kWart{0, 0.7e-3, 0}, kSkin{25e-3, 0.7e-3, 0}; // [m]

/// Stated is what a calibration may find, one percent more or less; or nothing.
template <class Held>
void expectRestOnTheSurface(const char* which)
{
    const glm::dvec3 truth = fallingArm().weight;
    Palm             palm;
    for (const auto& [place, stated] : {std::pair{kWart, 1.01}, std::pair{kSkin, 0.99}}) {
        if (kSanitized && stated < 1) continue; // the same code again
        Held       carried(stated * truth), uncarried(glm::dvec3(0));
        const Rest with = palm.released(carried, place), without = palm.released(uncarried, place);
        std::printf("  %s, %s: rests %.2f mm deep, uncarried %.2f mm\n", which, stated > 1 ? "on the wart" : "on skin",
                    1e3 * with.depth, 1e3 * without.depth);
        EXPECT_GT(with.touched, kEnd - 0.5) << which << ": it must not rise";
        EXPECT_LE(with.depth, 0.3e-3) << which;
        EXPECT_GT(without.depth, 2e-3) << which << ": 2 N on less than 1000 N/m, or there was nothing to carry";
    }
}

TEST(Weight, AReleasedArmRestsOnTheSurface)
{
    expectRestOnTheSurface<HeldArm>("simulated arm");
}

TEST(Weight, AReleasedFalconRestsOnTheSurface)
{
    expectRestOnTheSurface<HeldFalcon>("emulated Falcon");
}

} // namespace
} // namespace palp
