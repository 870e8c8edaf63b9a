#include "engine/session/deformation.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include <glm/geometric.hpp>

#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/force/ahead.h"
#include "engine/pipeline/move_patch.h"
#include "engine/pipeline/press.h"
#include "engine/session/approach.h"

namespace palp {
namespace {

/// Makes the table that the scene asks for; otherwise the largest that its rate can use and its window has room for.
/// \param settings  those of the scene, settled for the object
FootprintLattice latticeOf(const Scene& scene, const PatchSettings& settings, const SoftObject& object,
                           PlateSolver& solver)
{
    const auto of = [&](int side) { return footprintLattice(object, settings, side, solver); };
    if (scene.complianceLaw != ComplianceLaw::table) return of(1);
    if (scene.tableSize > 0) return of(scene.tableSize);
    // In an object's window the reach that a table has over the time that it takes hardly depends on its size, and how
    // far a hand goes astray of where it was seen to go grows with the square of that time.
    constexpr int kOfObject = 5;
    const int     wanted    = settings.windowOf == WindowOf::object
                                  ? kOfObject
                                  : tableSide(scene.complianceLaw, 1 / scene.deformationRate, scene.patch.footprintRadius);
    for (int side = wanted; side > 3; side -= 2) {
        try {
            return of(side);
        } catch (const Error&) {
            continue;
        }
    }
    return of(3);
}

} // namespace

Deformation::Deformation(const SoftObject& object, const Scene& scene)
    : object_(&object), law_(scene.complianceLaw), settings_(settledFor(object, scene.patch)),
      solver_(scene.solver, 0, SoftwareBits::ofTheHost), lattice_(latticeOf(scene, settings_, object, solver_)),
      firstLaw_(homogeneousLaw(object, lattice_, settings_))
{
    if (compute::isProcessorWord(scene.solver, compute::kAutoProcessor)) {
        constexpr double kLongest = 1.0 / 60; // [s]
        PlateTrial       trial    = plateTrial(settings_.cells, int(lattice_.loads.size()), scene.patch.tolerance);
        trial.apart               = std::min(kLongest, 1 / scene.deformationRate);
        (void)solver_.keepFaster(trial);
    }
    prepareTouch(object, settings_);
}

void Deformation::repaint(const SoftObject& object)
{
    PALP_EXPECT(object.size() == object_->size(), "a painted cloud has the points that it had before");
    object_ = &object;
    middle_.reset();
    if (kept_) kept_->isOfObject = false;
}

DeformationAnswer Deformation::solve(const Touch& touch, double lead)
{
    DeformationAnswer answer = solveSomewhere(touch, lead);
    if (!answer.update && touch.touching) answer.ends = ended(touch);
    answer.takeover = solver_.takeoverSince(told_);
    told_           = solver_.counts().takeovers;
    return answer;
}

DeformationAnswer Deformation::solveSomewhere(const Touch& touch, double lead)
{
    if (!touch.touching) return solveAhead(touch, lead);
    const Contact here{touch.point, touch.outward, true, true};
    Contact       ahead = here;
    ahead.point         = aheadOf(law_, touch.point, touch.velocity, lead);
    const bool moves    = ahead.point != here.point;
    if (auto answer = solveInWindows(ahead, touch)) return std::move(*answer);
    if (moves) // it may turn back before it leaves the window
        if (auto answer = solveInWindows(here, touch)) return std::move(*answer);
    DeformationAnswer there = solveAt(ahead, touch);
    if (there.update || !moves) return there;
    DeformationAnswer own = solveAt(here, touch);
    if (own.why.empty()) own.why = there.why;
    return own;
}

/// Solves for where a hand in free space will land. Nobody is touching yet, so a failure is none: a rim may be what is
/// nearest, and never be touched.
DeformationAnswer Deformation::solveAhead(const Touch& touch, double lead)
{
    const auto landing = landingOf(*object_, {touch.point, touch.velocity}, lead);
    if (!landing) return {};
    const Contact contact{landing->place, landing->outward, true, false};
    if (auto answer = solveInWindows(contact, touch)) return std::move(*answer);
    DeformationAnswer answer = solveAt(contact, touch);
    answer.why.clear();
    return answer;
}

/// Returns memory for an answer that nobody reads. Shares end on the thread that calls this, or on one that has handed
/// them back to it: a count of one stays one.
const std::shared_ptr<PatchUpdate>& Deformation::freeSlot()
{
    const auto found = std::ranges::find_if(slots_, [](const auto& slot) { return slot.use_count() == 1; });
    return found != slots_.end() ? *found : slots_.emplace_back(std::make_shared<PatchUpdate>());
}

bool Deformation::isKeptFor(const Contact& contact) const
{
    // Of the reach, so that the other half is left while the next is solved; cosine of 60 degrees [1].
    constexpr double kPart = 0.5, kAlike = 0.5;
    if (!kept_ || !kept_->isOfObject || glm::dot(contact.outward, kept_->update.table.chart.frame.normal) < kAlike)
        return false;
    const ComplianceTable& table = kept_->update.table;
    const auto             place = table.chart.project(contact.point);
    if (!place || !(std::max(std::abs(place->x), std::abs(place->z)) < kPart * table.reach())) return false;
    const auto over = table.chart.lift(*place); // another layer of a fold is farther off than a sheet is thick
    return over && glm::length(*over - contact.point) < kept_->patch.thickness;
}

DeformationAnswer Deformation::keptFor(const Touch& touch)
{
    const std::shared_ptr<PatchUpdate>& slot = freeSlot();
    kept_->update.table.time                 = touch.time; // it is as good as a new one, also where it ends()
    *slot                                    = kept_->update;
    slot->table.sequence                     = touch.sequence;
    Patch patch                              = kept_->patch;
    patch.times                              = {};
    DeformationAnswer answer{slot, std::move(patch), {}};
    answer.isSolved = false;
    return answer;
}

/// Returns the last answer as one that lasts no longer: there is none for what is touched now. It keeps its time. Null
/// if there is none that lasts.
std::shared_ptr<PatchUpdate> Deformation::ended(const Touch& touch)
{
    if (!kept_) return nullptr;
    const std::shared_ptr<PatchUpdate>& slot = freeSlot();
    *slot                                    = kept_->update;
    slot->table.sequence                     = touch.sequence;
    slot->table.lasts                        = false;
    slot->table.ended                        = true;
    kept_.reset();
    return slot;
}

/// Makes the answer of a patch whose table is in the slot.
DeformationAnswer Deformation::answerOf(Patch patch, const Touch& touch, const std::shared_ptr<PatchUpdate>& slot)
{
    PatchUpdate& update   = *slot;
    frame_                = chartAtContact(patch).frame;
    update.table.sequence = touch.sequence;
    update.table.time     = touch.time;
    update.rigidity       = rigidityAtContact(patch);
    update.mostResponse   = mostResponse(patch);
    update.errorEstimate  = patch.report.errorEstimate.value_or(0);
    update.iterations     = patch.report.iterations.value_or(0);
    update.shape          = depthShapeOf(patch);
    update.table.lasts    = settings_.windowOf == WindowOf::object;
    update.table.ended    = false;
    if (update.table.lasts) kept_ = {update, patch, true};
    return {slot, std::move(patch), {}};
}

/// Answers by what is kept, or in a window that is there: the middle's first, so that a place feels alike whichever way
/// the hand has come. Nothing where that takes a new one.
std::optional<DeformationAnswer> Deformation::solveInWindows(const Contact& contact, const Touch& touch)
{
    if (settings_.windowOf != WindowOf::object) return {};
    if (isKeptFor(contact)) return keptFor(touch);
    const Patch* const middle = middleFor(contact);
    if (middle)
        if (auto answer = moved(*middle, contact, touch)) return answer;
    const bool hasOwn = kept_ && kept_->isOfObject && !(middle && kept_->patch.chart.origin == middle->chart.origin);
    return hasOwn ? moved(kept_->patch, contact, touch) : std::nullopt;
}

std::optional<DeformationAnswer> Deformation::moved(const Patch& from, const Contact& contact, const Touch& touch)
{
    try {
        const std::shared_ptr<PatchUpdate>& slot = freeSlot();
        auto patch = movePatch(from, *object_, contact, settings_, lattice_, solver_, frame_, slot->table);
        if (!patch) return {};
        return answerOf(std::move(*patch), touch, slot);
    } catch (const std::exception&) { // a window of its own may have an answer, or says why there is none
        return {};
    }
}

/// Returns the window about the middle of an object that it spans, for the contact's side; null: there is none that
/// suits all of the object.
const Patch* Deformation::middleFor(const Contact& contact)
{
    if (!middle_) {
        glm::dvec3 sum{};
        for (const glm::dvec3& point : object_->positions()) sum += point;
        const auto nearest = object_->index().nearest(sum / double(object_->size()), 1).front().point;
        middle_            = Middle{object_->positions()[nearest], object_->survey().normal(nearest), {}};
    }
    const bool isFront = glm::dot(middle_->normal, contact.outward) >= 0;
    auto&      window  = middle_->windows[isFront ? 0 : 1];
    if (!window) {
        window.emplace();
        try {
            Patch of = windowAbout(*object_, {middle_->place, isFront ? middle_->normal : -middle_->normal, true, true},
                                   settings_);
            if (of.deformed() && !of.normalFelt && of.flatBecause.empty()) *window = std::move(of);
        } catch (const std::exception&) { // a piece that nothing holds, say
        }
    }
    return window->deformed() ? &*window : nullptr;
}

DeformationAnswer Deformation::solveAt(const Contact& contact, const Touch& touch)
{
    try {
        const std::shared_ptr<PatchUpdate>& slot = freeSlot();
        Patch patch = deformWithTable(*object_, contact, settings_, lattice_, solver_, frame_, slot->table);
        if (!patch.deformed()) return {{}, {}, "the points around the contact determine no surface"};
        return answerOf(std::move(patch), touch, slot);
    } catch (const Error& error) { // the window is off the object, or the plate has no solution there
        return {{}, {}, error.what()};
    }
}

} // namespace palp
