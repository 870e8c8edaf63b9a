#include "engine/session/stepped_session.h"

#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/velocity_filter.h"
#include "engine/core/real_time.h"
#include "engine/session/clutch.h"
#include "engine/session/detail/deformation_loop.h"

namespace palp {
namespace {

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isGood(const Hand& hand)
{
    const glm::dquat& q = hand.orientation;
    return isFinite(hand.position) && isFinite(hand.velocity) && std::isfinite(q.w) && isFinite({q.x, q.y, q.z});
}

/// Takes a host's device as one that pushes on a hand. Where its force is not known it is taken for the largest that a
/// scene may have, so that what else is known of it counts, and nothing that is not is credited.
HapticDeviceInfo withUnknowns(HapticDeviceInfo device)
{
    if (!(device.maximumForce > 0)) device.maximumForce = GovernorSettings::kMostForce;
    return device;
}

/// Gives the tool its place in place of the hand's, which differ by what the hand went while the clutch was held.
void holdByClutch(Hand& hand, Clutch& clutch) noexcept
{
    HapticState state;
    state.position = hand.position;
    state.velocity = hand.velocity;
    state.buttons  = hand.buttons;
    state.clutched = hand.clutched;
    state.homed    = hand.homed;
    state.fault    = hand.device;
    state          = clutch.step(state, false);
    hand.position  = state.position;
    hand.velocity  = state.velocity;
    hand.buttons   = state.buttons;
    hand.clutched  = clutch.isHeld();
}

} // namespace

struct SteppedSession::Impl {
    SoftObject                               object;
    const std::shared_ptr<const LoadedCloud> own; ///< null: the scene says where the points are
    Scene                                    scene;
    HapticDeviceInfo                         device;
    Deformation                              deformation;
    std::mutex                               told; ///< of `takeover`
    std::string                              takeover;
    Servo                                    servo;
    DeformationLoop                          loop;
    std::optional<Recording>                 recording;
    TickRecord                               last{};
    Hand                                     hand{}; ///< the last one whose place was known
    Clutch                                   clutch;
    VelocityFilter                           moved{15e-3}; ///< [s] as drivers of devices take it
    double                                   time = 0;     ///< [s] of the last tick
    SleepWatch                               sleep;
    bool                                     begun = false;
    bool              zeroed = false; ///< a bad tick gave no force, until the governor gives none either
    std::uint64_t     steps  = 0;
    std::atomic<bool> over   = false;
    std::thread       thread;

    Impl(SoftObject touched, const Scene& given, const HapticDeviceInfo& hold,
         std::shared_ptr<const LoadedCloud> points)
        : object(std::move(touched)), own(std::move(points)), scene(given), device(withUnknowns(hold)),
          deformation(object, scene), takeover(deformation.plateSolver().takeoverSince(0)),
          servo(object, scene, device, deformation.firstLaw()),
          loop([this](const Touch& touch, double lead) { return solved(touch, lead); }, scene.deformationRate),
          clutch(clutchBit(scene))
    {
        thread = std::thread([this] { loop.run(over); });
    }

    ~Impl()
    {
        over = true;
        thread.join();
    }

    /// Solves on the deformation's thread, and keeps who took over.
    DeformationAnswer solved(const Touch& touch, double lead)
    {
        DeformationAnswer answer = deformation.solve(touch, lead);
        if (answer.takeover.empty()) return answer;
        const std::lock_guard lock(told);
        takeover = answer.takeover;
        return answer;
    }
};

SteppedSession::SteppedSession(SoftObject object, const Scene& scene, const HapticDeviceInfo& device,
                               std::shared_ptr<const LoadedCloud> own)
    : impl_(std::make_unique<Impl>(std::move(object), scene, device, std::move(own)))
{
}

SteppedSession::~SteppedSession() = default;

const TickRecord& SteppedSession::step(double time, const Hand& given) noexcept
{
    constexpr double kNominal = 1e-3; // [s] of the first tick, and of one whose time is not good
    Impl&            s        = *impl_;
    const bool       rises    = std::isfinite(time) && (!s.begun || time > s.time);
    const bool       good = rises && isGood(given), hasPlace = good && given.hasPlace();
    const double     dt = (s.begun && rises ? time - s.time : kNominal) + s.sleep.slept();
    if (rises) s.time = time;
    s.begun = true;
    ++s.steps;
    Hand hand = good ? given : s.hand;
    if (hasPlace) {
        if (ForceGovernor::isJump(glm::length(given.position - s.hand.position), dt)) s.moved.restart();
        s.hand = given;
        s.moved.add(s.time, given.position);
        if (given.velocity == glm::dvec3(0)) hand.velocity = s.moved.velocity(); // many a host has none
    } else if (!good) {
        hand.device = DeviceFault::kinematics;
    }
    hand.answerTime = s.time;
    hand.sequence   = s.steps;
    holdByClutch(hand, s.clutch); // also where its place is not known
    s.last   = s.servo.tick({s.time, dt}, hand, s.loop.newest(s.servo.tableInUse()));
    s.zeroed = !good || (s.zeroed && s.last.force != glm::dvec3(0));
    if (s.zeroed) s.last.force = {};
    s.loop.touch.draft() = s.servo.touch();
    s.loop.touch.publish();
    if (s.recording) s.recording->push(s.last);
    return s.last;
}

bool SteppedSession::takePatch() noexcept
{
    return impl_->loop.patch.take();
}

const Patch* SteppedSession::patch() const noexcept
{
    const ShownPatch* const shown = impl_->loop.patch.held();
    return shown && shown->patch ? &*shown->patch : nullptr;
}

std::string SteppedSession::takeover() const
{
    const std::lock_guard lock(impl_->told);
    return impl_->takeover;
}

void SteppedSession::record(const std::filesystem::path& folder, const std::string& program)
{
    if (impl_->recording)
        throw Error(folder.string() +
                    ": expected a session that is not recorded, found one that is; end that recording "
                    "first");
    const bool  nameless = impl_->scene.cloud.empty();
    SessionInfo info{.scene    = impl_->scene,
                     .versions = {{"palpate", program}},
                     .solver   = impl_->deformation.plateSolver().name(),
                     .command  = program,
                     .cloud    = fingerprint(impl_->object.cloud()),
                     .hand     = impl_->device};
    if (nameless) { // a caller's points: the scene gets a file of them
        info.scene.cloud     = (folder / "cloud.ply").string();
        info.scene.scatter   = Scatter::off;
        info.scene.stiffness = "own"; // also where a material would say another one
    }
    impl_->recording.emplace(folder, info);
    if (!nameless) return;
    try {
        const std::optional<FieldsBeside> beside =
            impl_->own ? std::optional<FieldsBeside>(std::in_place, *impl_->own) : std::nullopt;
        writeCloud(info.scene.cloud, impl_->object.cloud(), beside ? beside->all() : std::span<const NamedField>(),
                   {.faces = impl_->object.faces()});
    } catch (...) {
        impl_->recording.reset();
        throw;
    }
}

RecordingReport SteppedSession::stopRecording()
{
    RecordingReport report;
    if (impl_->recording) report = impl_->recording->finish();
    impl_->recording.reset();
    return report;
}

const SoftObject& SteppedSession::object() const noexcept
{
    return impl_->object;
}

const Scene& SteppedSession::scene() const noexcept
{
    return impl_->scene;
}

} // namespace palp
