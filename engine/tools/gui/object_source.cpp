#include "engine/tools/gui/object_source.h"

#include <utility>

#include "engine/core/contract.h"

namespace palp {

void ObjectSource::request(const SceneValues& values)
{
    for (const auto& [key, value] : values) requestedValues_[key] = value;
}

std::function<OpenedObject()> ObjectSource::opener(const std::string& what, const SceneValues& values) const
{
    if (std::error_code hidden; !std::filesystem::is_directory(what, hidden)) // reading says why
        return [what, values, &open = settings_.open] {
            Scene scene = open(what, values);
            auto  stage = std::make_unique<Stage>(scene);
            return OpenedObject{what, std::move(scene), std::move(stage)};
        };
    std::optional<Scene> now; // its object may be used again
    if (stage_ && !stage_->painting().changed()) now = stage_->scene();
    return [what, now, toolKeys = settings_.toolKeys, solver = stage_ ? stage_->scene().solver : "auto"] {
        RecordedSession session = readSession(what);
        if (session.records.empty()) throw Error(what + ": it has no ticks, so there is nothing to replay");
        Scene scene  = palp::sceneOf(session, toolKeys);
        scene.solver = solver;
        auto stage   = now && haveSameCloud(scene, *now) ? nullptr : std::make_unique<Stage>(scene);
        return OpenedObject{what, std::move(scene), std::move(stage), std::move(session)};
    };
}

void ObjectSource::adopt(OpenedObject opened)
{
    if (opened.stage)
        stage_ = std::move(opened.stage);
    else
        stage_->change(opened.scene);
    what_     = std::move(opened.what);
    recorded_ = std::move(opened.recorded);
}

SceneValues ObjectSource::valuesWith(SceneValues others) const
{
    others.insert(values_.begin(), values_.end());
    return others;
}

Scene ObjectSource::sceneWith(const SceneValues& values) const
{
    if (!recorded_) return settings_.open(what_, values);
    Scene scene =
        parseScene(recorded_->scene, what_, recorded_->folder, {.flags = values, .toolKeys = settings_.toolKeys});
    if (!values.contains("solver")) scene.solver = stage_->scene().solver;
    return scene;
}

std::string ObjectSource::fileName() const
{
    return fileNameOf(what_);
}

std::string ObjectSource::stem() const
{
    return std::filesystem::path(what_).stem().string();
}

std::string fileNameOf(const std::string& what)
{
    return std::filesystem::path(what).filename().string();
}

} // namespace palp
