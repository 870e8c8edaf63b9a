#include <cstdio>
#include <ostream>

#include "engine/cloud/ply_repaint.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/tools/gui/workbench.h"

// What a workbench writes and reads: pictures, recordings, painted clouds.

namespace palp {
namespace {

/// "palpate-0001.png", the first that is not there yet.
std::filesystem::path freeName(const std::string& stem, const std::string& extension)
{
    for (int n = 1; n < 10000; ++n) {
        char number[8];
        std::snprintf(number, sizeof number, "-%04d", n);
        const std::filesystem::path path = stem + number + extension;
        if (!std::filesystem::exists(path)) return path;
    }
    throw Error("there are 9999 files called " + stem + "-NNNN" + extension + " here; move some away");
}

} // namespace

void Workbench::screenshot(bool withPanels)
{
    try {
        const auto        file = freeName("palpate", ".png");
        const PictureSize size{input_.size.x, input_.size.y, withPanels ? 1 : 2, Detail::fine};
        ViewScene&        scene = stage_->view().scene();
        if (withPanels) {
            const Image image = screen_.draw(scene, state_.camera, size, textsFor(size));
            writeFileWhole(file, [&](std::ostream& stream) { stream << encodePng(image); });
        } else {
            Image image = screen_.draw(scene, state_.camera, size, nullptr);
            scene.title = std::filesystem::path(what_).stem().string();
            scene.note.clear();
            annotate(image, scene, state_.camera);
            writeFileWhole(file, [&](std::ostream& stream) { stream << encodePng(image); });
        }
        say("saved " + file.string());
    } catch (const Error& error) {
        complain(error.what());
    }
}

/// The session begins anew with a recording, or goes on without one.
void Workbench::toggleRecording()
{
    if (recording_) { // ends with its session
        say("recorded " + recordFolder_);
    } else if (!settings_.recorded || replay_ || failed_ || stage_->painting().changed()) {
        return say(stage_->painting().changed() ? "save the paint first and open it: recordings are of files"
                                                : "nothing can be recorded now");
    } else {
        recordingWanted_ = true;
    }
    restart();
}

void Workbench::startRecording()
{
    if (!std::exchange(recordingWanted_, false)) return;
    try {
        recordFolder_ = freeName("session", "").string();
        recording_    = std::make_unique<Recording>(recordFolder_, settings_.recorded(*stage_, *hand_.device),
                                                 [](const std::string&) {});
        say("recording " + recordFolder_);
    } catch (const Error& error) {
        complain(error.what());
    }
}

/// \pre no session runs
void Workbench::endRecording()
{
    if (!recording_) return;
    const RecordingReport report = recording_->finish();
    recording_.reset();
    lastRecording_ = recordFolder_;
    if (report.stopped)
        complain(*report.stopped);
    else if (report.lost > 0)
        complain(recordFolder_ + ": " + std::to_string(report.lost) + " samples were lost");
}

void Workbench::savePaint()
{
    if (!stage_->painting().changed()) return say("nothing is painted; B takes the brush");
    try {
        const std::string           cloud = stage_->scene().cloud;
        const std::filesystem::path source(cloud);
        const bool                  isPly    = source.extension() == ".ply" && !cloud.starts_with("sample:");
        const std::string           stem     = cloud.starts_with("sample:") ? cloud.substr(7) : source.stem().string();
        const auto                  target   = freeName(stem + "-painted", ".ply");
        std::string                 property = "stiffness";
        if (isPly) {
            CloudReadSettings settings;
            settings.lengthUnit = stage_->scene().lengthUnit;
            property            = repaintPly(source, settings, stage_->painted().cloud(), target).property;
        } else {
            writeCloud(target, stage_->painted().cloud(), {}, {});
        }
        paintSaved_ = true;
        say("saved " + target.string() + ", property " + property);
    } catch (const Error& error) {
        complain(error.what());
    }
}

} // namespace palp
