#include "engine/session/deformation.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/force/ahead.h"
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
    // An object's answer holds as far as its table reaches, and takes a hand's longer than a window's.
    const int wanted = settings.windowOf == WindowOf::object
                           ? ComplianceTable::kMostSide
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
      firstLaw_(homogeneousLaw(object, lattice_))
{
    if (compute::isProcessorWord(scene.solver, compute::kAutoProcessor))
        (void)solver_.keepFaster(plateTrial(settings_.cells, int(lattice_.loads.size()), scene.patch.tolerance));
    prepareTouch(object, settings_);
}

void Deformation::repaint(const SoftObject& object)
{
    PALP_EXPECT(object.size() == object_->size(), "a painted cloud has the points that it had before");
    object_ = &object;
    kept_.reset();
}

DeformationAnswer Deformation::solve(const Touch& touch, double lead)
{
    DeformationAnswer answer = solveSomewhere(touch, lead);
    answer.takeover          = solver_.takeoverSince(told_);
    told_                    = solver_.counts().takeovers;
    return answer;
}

DeformationAnswer Deformation::solveSomewhere(const Touch& touch, double lead)
{
    if (!touch.touching) return solveAhead(touch, lead);
    const glm::dvec3  ahead = aheadOf(law_, touch.point, touch.velocity, lead);
    DeformationAnswer there = solveAt({ahead, touch.outward, true, true}, touch);
    if (there.update || ahead == touch.point) return there;
    DeformationAnswer here = solveAt({touch.point, touch.outward, true, true}, touch);
    if (here.why.empty()) here.why = there.why;
    return here;
}

/// Solves for where a hand in free space will land. Nobody is touching yet, so a failure is none: a rim may be what is
/// nearest, and never be touched.
DeformationAnswer Deformation::solveAhead(const Touch& touch, double lead)
{
    const auto landing = landingOf(*object_, {touch.point, touch.velocity}, lead);
    if (!landing) return {};
    DeformationAnswer answer = solveAt({landing->place, landing->outward, true, false}, touch);
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
    if (!kept_ || glm::dot(contact.outward, kept_->update.table.chart.frame.normal) < kAlike) return false;
    const ComplianceTable& table = kept_->update.table;
    const auto             place = table.chart.project(contact.point);
    if (!place || !(std::max(std::abs(place->x), std::abs(place->z)) < kPart * table.reach())) return false;
    const auto over = table.chart.lift(*place); // another layer of a fold is farther off than a sheet is thick
    return over && glm::length(*over - contact.point) < kept_->patch.thickness;
}

DeformationAnswer Deformation::keptFor(const Touch& touch)
{
    const std::shared_ptr<PatchUpdate>& slot = freeSlot();
    *slot                                    = kept_->update;
    slot->table.sequence                     = touch.sequence;
    slot->table.time                         = touch.time;
    Patch patch                              = kept_->patch;
    patch.times                              = {};
    return {slot, std::move(patch), {}, {}, true};
}

DeformationAnswer Deformation::solveAt(const Contact& contact, const Touch& touch)
{
    if (isKeptFor(contact)) return keptFor(touch);
    try {
        const std::shared_ptr<PatchUpdate>& slot   = freeSlot();
        PatchUpdate&                        update = *slot;
        Patch patch = deformWithTable(*object_, contact, settings_, lattice_, solver_, frame_, update.table);
        if (!patch.deformed()) return {{}, {}, "the points around the contact determine no surface"};
        frame_                = patch.chart.frame;
        update.table.sequence = touch.sequence;
        update.table.time     = touch.time;
        update.rigidity       = rigidityAtContact(patch);
        update.mostResponse   = mostResponse(patch);
        update.errorEstimate  = patch.report.errorEstimate.value_or(0);
        update.iterations     = patch.report.iterations.value_or(0);
        update.shape          = depthShapeOf(patch);
        const bool lasts      = settings_.windowOf == WindowOf::object;
        if (lasts) kept_ = {update, patch};
        return {slot, std::move(patch), {}, {}, lasts};
    } catch (const Error& error) { // the window is off the object, or the plate has no solution there
        return {{}, {}, error.what()};
    }
}

} // namespace palp
