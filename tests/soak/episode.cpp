#include "tests/soak/episode.h"

#include <cmath>
#include <sstream>

#include "engine/core/latest_pair.h"
#include "engine/session/clutch.h"
#include "tests/soak/faulty_clock.h"
#include "tests/soak/faulty_device.h"
#include "tests/soak/faulty_recording.h"
#include "tests/soak/invariants.h"
#include "tests/soak/passage.h"
#include "tests/soak/soak_hand.h"

namespace palp::soak {
namespace {

using Updates = LatestPair<FaultySolver::Update>;

/// A third of the sessions go well, others fail ten times a second to once in three minutes.
double anyRate(Chance& chance)
{
    return chance.is(1.0 / 3) ? 0 : chance.scaleFrom(5e-6, 1e-2);
}

/// The operator waits for a while and resets the governor's fault by the first button.
class Operator {
public:
    void watch(const Servo& servo, FaultyDevice& device)
    {
        waited_ = servo.governor().fault() == GovernorFault::none ? 0 : waited_ + 1;
        if (waited_ % kPatience == kPatience - 1) device.press(2 * ForceHalf::kPressTicks);
    }

private:
    static constexpr int kPatience = 300; // ticks

    int waited_ = 0;
};

/// Returns the least that bounds the force.
double mostForce(const Scene& scene, const HapticDeviceInfo& info)
{
    return info.maximumForce > 0 ? std::min(scene.maxForce, info.maximumForce) : scene.maxForce;
}

} // namespace

EpisodeReport runEpisode(const Scene& scene, const SoftObject& object, Deformation& deformation, FaultySolver& solver,
                         std::uint64_t seed)
{
    Chance        chance(seed);
    EpisodeReport report;
    const auto    ticks = std::uint64_t(chance.scaleFrom(2000, 100'000));
    std::string   name;
    SessionHand   hand = anyHand(scene, object, double(ticks) * 1e-3, chance, name);
    FaultyDevice  device(*hand.device, anyRate(chance), chance.bits());
    FaultyClock   clock(anyRate(chance), chance.bits());
    const double  solverRate = 20 * anyRate(chance);
    const auto    every      = std::uint64_t(chance.scaleFrom(10, 200)); // ticks
    solver.begin(solverRate, 1.0 / 256); // most answers are older ones: ticks are what is attacked here
    std::optional<FaultyRecording> recording;
    if (chance.is(1.0 / 16)) recording.emplace(scene, std::uint64_t(chance.scaleFrom(64e3, 30e6)));

    Servo              servo(object, scene, hand.frame.inScene(hand.device->info()), deformation.firstLaw());
    Clutch             clutch(hand.frame.clutch);
    Updates            updates;
    Operator           helper;
    Invariants         invariants(mostForce(scene, hand.device->info()), glm::length(hand.device->info().weight));
    Passage            passage(object);
    std::ostringstream what;
    what << name << ", " << ticks << " ticks, an answer each " << every << ", troubles of the solver " << solverRate;
    report.what = what.str();
    report.hand = name.ends_with("wild") ? "wild" : name;

    for (std::uint64_t n = 0; n < ticks && !report.wrong; ++n) {
        const double dt = clock.step();
        if (n % every == 0 && servo.touch().sequence > 0)
            if (auto answer = solver.answer(servo.touch(), 1.5e-3 * double(every))) {
                invariants.handsOver(answer->table);
                updates.draft() = std::move(answer);
                updates.publish();
            }
        updates.take([&](const auto& update) { return update && &update->table == servo.tableInUse(); });
        const auto* const newest = updates.newest();

        Hand held     = hand.frame.handOf(clutch.step(device.read(clock.device(), clock.skipped()), false));
        held.clutched = clutch.isHeld();
        const TickRecord    record = servo.tick({clock.time(), dt}, held, newest ? newest->get() : nullptr);
        const GovernedForce given  = hand.frame.toDevice(servo.governor().force());
        hand.device->render(given);
        helper.watch(servo, device);
        if (recording) recording->push(record);

        report.wrong = invariants.check(record, given, dt, servo.governor().settings());
        if (!report.wrong) report.wrong = passage.check(record);
        if (!report.wrong) report.wrong = invariants.checkTable(servo.tableInUse(), n % 32 == 0);
        ++report.ticks;
    }
    hand.device->close();
    if (recording) {
        const auto wrong = recording->finish();
        if (!report.wrong) report.wrong = wrong;
    }
    report.pressing = invariants.pressing();
    report.judged   = passage.judged();
    report.troubles = device.troubles() + clock.troubles() + (recording ? 1 : 0);
    return report;
}

} // namespace palp::soak
