#include "engine/tools/gui/paint_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/cloud/ply_repaint.h"
#include "engine/core/contract.h"
#include "engine/tools/gui/numbered_file.h"

namespace palp {
namespace {

/// Reads again what the object's file says beside the stiffness; empty where it does not have the object's points any
/// more.
std::optional<LoadedCloud> asOpened(const Stage& stage)
{
    try {
        LoadedCloud again = loadCloud(stage.scene());
        if (std::ranges::equal(again.cloud.positions(), stage.object().positions())) return again;
    } catch (const Error&) { // it is gone
    }
    return {};
}

} // namespace

void PaintTool::startAnew()
{
    lastDab_.reset();
    kept_ = Kept::saved;
    forgetWarning();
}

void PaintTool::change()
{
    kept_ = Kept::unsaved;
    forgetWarning();
}

void PaintTool::stroke(Stage& stage, const BrushChoice& brush, const glm::dvec3& place)
{
    std::vector<glm::dvec3> path{place};
    if (lastDab_) path.insert(path.begin(), *lastDab_);
    const std::vector<glm::dvec3> dabs = dabsAlong(path, brush.radius, stage.painted());
    stage.paint([&](StiffnessPainting& painting) {
        if (!lastDab_) painting.beginStroke();
        for (const glm::dvec3& at : dabs) {
            const Brush dab{at, brush.radius, brush.strength};
            if (brush.smooths)
                painting.smooth(dab);
            else
                painting.paint(dab, brush.value);
        }
    });
    lastDab_ = place;
    change();
}

void PaintTool::endStroke(Stage& stage)
{
    if (!std::exchange(lastDab_, std::nullopt)) return;
    stage.paint([](StiffnessPainting& painting) { painting.endStroke(); });
}

bool PaintTool::undo(Stage& stage)
{
    if (notices_.busy() || !stage.painting().canUndo()) return false;
    change();
    stage.paint([](StiffnessPainting& painting) { painting.undo(); });
    return true;
}

bool PaintTool::redo(Stage& stage)
{
    if (notices_.busy() || !stage.painting().canRedo()) return false;
    change();
    stage.paint([](StiffnessPainting& painting) { painting.redo(); });
    return true;
}

bool PaintTool::save(const Stage& stage, const std::filesystem::path& folder)
{
    if (!stage.painting().changed()) {
        notices_.say(kept_ == Kept::saved ? "nothing is painted; B takes the brush"
                                          : "nothing is to be saved: all strokes are undone, or painted what was there "
                                            "before; Tab shows the brush's stiffness");
        return true;
    }
    try {
        const std::string           cloud = stage.scene().cloud;
        const std::filesystem::path source(cloud);
        const bool isPly = !cloud.starts_with("sample:") && formatToRead(source).format == CloudFormat::ply &&
                           stage.report().scatteredPoints == 0;
        const std::string stem     = cloud.starts_with("sample:") ? cloud.substr(7) : source.stem().string();
        const auto        target   = unusedPath((folder / (stem + "-painted")).string(), ".ply");
        std::string       property = "stiffness";
        const auto        file     = asOpened(stage);
        if (isPly && file) {
            property = repaintPly(source, stage.scene().reading, stage.painted().cloud(), target).property;
        } else if (file) {
            writeCloud(target, stage.painted().cloud(), FieldsBeside(*file).all(), {.faces = file->faces});
        } else {
            writeCloud(target, stage.painted().cloud());
            notices_.complain(cloud + " has changed or gone: the painted file has its points, and no faces or other "
                                      "properties");
        }
        kept_ = Kept::saved;
        notices_.say("saved " + target.string() + ", property " + property);
        return true;
    } catch (const Error& error) {
        notices_.complain(error.what());
        return false;
    }
}

bool PaintTool::unsaved(const Stage& stage) const
{
    return stage.painting().changed() && kept_ != Kept::saved;
}

bool PaintTool::mayDiscard(const Stage& stage, const std::string& request)
{
    if (!unsaved(stage)) return true;
    const bool warned = warnedOf_ == request;
    warnedOf_         = warned ? "" : request; // the action that discards it may fail
    if (warned) return true;
    notices_.complain("what is painted is not saved: Ctrl+S saves it; asking again for " + request + " discards it");
    return false;
}

std::vector<ViewSegment> brushOutline(const Hit& hit, double radius)
{
    constexpr int kSides = 48;
    const Frame   frame  = Frame::about(hit.outward);
    const auto    at     = [&](int n) {
        const double angle = 2 * std::numbers::pi * n / kSides;
        return hit.point + radius * (std::cos(angle) * frame.east + std::sin(angle) * frame.north);
    };
    std::vector<ViewSegment> rim;
    for (int n = 0; n < kSides; ++n) rim.push_back({at(n), at(n + 1)});
    return rim;
}

} // namespace palp
