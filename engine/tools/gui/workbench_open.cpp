#include <algorithm>
#include <future>
#include <new>
#include <utility>

#include "engine/core/contract.h"
#include "engine/tools/gui/workbench.h"

// How a workbench comes to what it shows: objects, values of a scene, recorded sessions, hands. What takes long is made
// on a thread of its own, between two sessions.

namespace palp {
namespace {

std::string nameOf(const std::string& what)
{
    return std::filesystem::path(what).filename().string();
}

/// The work, with a sentence for a machine that is too small for it.
template <class Work>
auto within(Work work)
{
    return [work = std::move(work)] {
        try {
            return work();
        } catch (const std::bad_alloc&) {
            throw Error("there is not enough memory for it; try fewer points");
        }
    };
}

} // namespace

/// What is to be shown, as another thread has made it.
struct Workbench::Opened {
    Scene                          scene;
    std::unique_ptr<Stage>         stage; ///< null: the one that there is, with the values of that scene
    std::optional<RecordedSession> recorded;
};

/// Does the work on a thread of its own; the window goes on, shows what it showed and says what it does.
/// \return what the work does \throws what it throws
template <class Work>
auto Workbench::meanwhile(const std::string& doing, Work work)
{
    constexpr auto kAtOnce = std::chrono::milliseconds(50); // what is as quick needs no words
    auto           made    = std::async(std::launch::async, within(std::move(work)));
    if (made.wait_for(kAtOnce) == std::future_status::ready) return made.get();
    doing_      = doing;
    lastChange_ = Clock::now();
    while (made.wait_for(std::chrono::seconds(0)) != std::future_status::ready && !closing_) {
        if (handSays_.take()) {
            doing_      = *handSays_.held();
            lastChange_ = Clock::now();
        }
        frame(nullptr);
    }
    doing_.clear();
    lastChange_ = Clock::now();
    return made.get();
}

/// The first object; there is nothing to show yet but words.
void Workbench::openFirst()
{
    constexpr auto kAtOnce = std::chrono::milliseconds(50);
    auto           made    = std::async(std::launch::async, within(opener(settings_.what, values_)));
    while (made.wait_for(kAtOnce) != std::future_status::ready && !closing_) showNothing(settings_.what);
    Opened opened = made.get();
    if (closing_) return;
    adopt(settings_.what, std::move(opened));
    resetCamera();
}

/// A picture of words alone.
void Workbench::showNothing(const std::string& what)
{
    input_ = poll_(0);
    if (input_.closing || (settings_.stop && *settings_.stop)) closing_ = true;
    if (input_.size.x < 1 || input_.size.y < 1) return;
    ViewScene scene;
    scene.ground        = state_.look.ground;
    scene.title         = nameOf(what);
    scene.note          = "opening it ...";
    const Overlay words = annotations(scene, state_.camera, input_.size.x, input_.size.y, input_.scale);
    static_cast<void>(screen_.show(scene, state_.camera, {input_.size.x, input_.size.y, 1, Detail::fast}, &words));
    screen_.present();
}

/// For another thread: needs nothing of this but the settings.
std::function<Workbench::Opened()> Workbench::opener(const std::string& what, const SceneValues& values) const
{
    if (!std::filesystem::is_directory(what))
        return [what, values, &open = settings_.open] {
            Scene scene = open(what, values);
            auto  stage = std::make_unique<Stage>(scene);
            return Opened{std::move(scene), std::move(stage), std::nullopt};
        };
    std::optional<Scene> now; // whose object may do
    if (stage_ && !stage_->painting().changed()) now = stage_->scene();
    return [what, now, device = stage_ ? stage_->scene().device : "auto"] {
        RecordedSession session = readSession(what);
        if (session.samples.empty()) throw Error(what + ": there are no samples in it, so there is nothing to replay");
        Scene scene  = palp::sceneOf(session);
        scene.device = device;
        auto stage   = now && sameObject(scene, *now) ? nullptr : std::make_unique<Stage>(scene);
        return Opened{std::move(scene), std::move(stage), std::move(session)};
    };
}

void Workbench::adopt(const std::string& what, Opened opened)
{
    endRecording();
    if (opened.stage)
        stage_ = std::move(opened.stage);
    else
        stage_->change(opened.scene);
    what_ = what;
    if (settings_.titled) settings_.titled(nameOf(what));
    replay_.reset();
    replayed_ = std::move(opened.recorded);
    useObject();
    if (!replayed_) return tellAssumptions();
    replay_ = std::make_unique<ReplayDevice>(replayed_->samples, replayed_->hand);
    if (!replayed_->cloud.empty() && replayed_->cloud != fingerprint(stage_->object().cloud()))
        complain("the cloud is not the one that was recorded: " + stage_->scene().cloud + " has changed");
}

/// What nobody has said of the cloud: no fault, but good to know.
void Workbench::tellAssumptions()
{
    if (!settings_.assumed) return;
    std::string all;
    for (const std::string& sentence : settings_.assumed(stage_->scene(), stage_->report())) {
        all += (all.empty() ? "" : "; ") + sentence;
        if (settings_.complained) settings_.complained(sentence);
    }
    if (!all.empty()) say(all);
}

/// What suits the object: the hand over it, the brush, the scales of colours and arrows, which stay as they are while
/// it is touched, so that deeper and stronger always looks so.
void Workbench::useObject()
{
    const Scene& scene = stage_->scene();
    pointer_.emplace(Hit{stage_->place().point, stage_->place().outward}, scene.startHeight,
                     stage_->painted().cloud().bounds());
    state_.pressDepth   = 0.4 * scene.material.thickness;
    state_.brush.radius = scene.patch.footprintRadius;
    state_.brush.value  = *std::ranges::max_element(stage_->painted().cloud().stiffness());
    deepest_            = 0.5 * scene.material.thickness; // as far as theory goes
    strongest_          = 0.5 * scene.maxForce;
    failed_             = false;
    paintSaved_         = true;
    state_.blind        = scene.hunt.has_value();
    if (state_.blind) { // what is hidden stays hidden
        state_.look.paint              = ViewPaint::plain;
        state_.look.overlays.projected = false;
        state_.tool                    = Tool::touch;
    }
}

void Workbench::change(const SceneValues& values)
{
    for (const auto& [key, value] : values) wanted_[key] = value;
    failed_ = false;
    restart();
}

/// Between two sessions: what the user has changed.
void Workbench::takeChanges()
{
    if (const std::string what = std::exchange(toOpen_, {}); !what.empty() && mayDiscard()) openOther(what);
    if (const SceneValues wanted = std::exchange(wanted_, {}); !wanted.empty()) takeValues(wanted);
}

void Workbench::openOther(const std::string& what)
{
    try {
        Opened opened = meanwhile("opening " + nameOf(what) + " ...", opener(what, {}));
        faults_.clear();
        adopt(what, std::move(opened));
        values_.clear(); // they were for another object
        resetCamera();
    } catch (const Error& error) {
        complain(error.what());
    }
}

void Workbench::takeValues(const SceneValues& wanted)
{
    SceneValues values = values_;
    for (const auto& [key, value] : wanted) values[key] = value;
    try {
        const Scene scene = sceneWith(values);
        if (sameObject(scene, stage_->scene())) {
            stage_->change(scene);
        } else if (mayDiscard()) {
            stage_ = meanwhile("reading " + nameOf(scene.cloud) + " once more ...",
                               [scene] { return std::make_unique<Stage>(scene); });
            useObject();
        } else {
            return;
        }
        if (replay_) say("the replay has ended: the scene is another one");
        replay_.reset();
        values_ = std::move(values);
        faults_.clear();
    } catch (const Error& error) {
        complain(error.what());
    }
}

/// The scene that is shown, with other values.
Scene Workbench::sceneWith(const SceneValues& values) const
{
    if (!replayed_) return settings_.open(what_, values);
    Scene scene = parseScene(replayed_->scene, what_, std::filesystem::current_path(), {values, {}});
    if (!values.contains("device")) scene.device = stage_->scene().device;
    return scene;
}

/// Whether what is painted may go: it is saved, or the user has asked twice.
bool Workbench::mayDiscard()
{
    if (!stage_->painting().changed() || paintSaved_ || std::exchange(warned_, true)) {
        warned_ = false;
        return true;
    }
    complain("what is painted is not saved: Ctrl+S saves it, asking for the same again discards it");
    return false;
}

/// The hand that the program gives; who lets go or closes meanwhile gets none.
std::optional<WorkbenchHand> Workbench::readyHand()
{
    const HandWait wait{stop_, [this](const std::string& advice) {
                            handSays_.draft() = advice;
                            handSays_.publish();
                        }};
    try {
        return meanwhile("getting the hand ready; Esc gives up", [&] { return settings_.hand(*stage_, wait); });
    } catch (const Error&) {
        if (stop_) return std::nullopt;
        throw;
    }
}

} // namespace palp
