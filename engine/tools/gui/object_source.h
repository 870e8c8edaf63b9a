#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/session/recorded_session.h"
#include "engine/tools/gui/stage.h"
#include "engine/tools/gui/workbench_settings.h"

namespace palp {

/// An object that another thread has opened.
struct OpenedObject {
    std::string                    what; ///< as the user named it
    Scene                          scene;
    std::unique_ptr<Stage>         stage; ///< null: the present stage takes the values of that scene
    std::optional<RecordedSession> recorded{};
};

/// Knows where the object on the stage comes from, and opens others that the user asks for.
/// Invariant: values() are those that the user has set over the scene of the object on the stage.
/// \thread the window's, except for what opener() returns
class ObjectSource {
public:
    /// \param settings  outlive this
    explicit ObjectSource(const WorkbenchSettings& settings) : settings_(settings), values_(settings.values) {}

    // The user's requests; they are met between two sessions.
    void                      request(const std::filesystem::path& what) { requested_ = what.string(); }
    void                      request(const SceneValues& values);
    [[nodiscard]] std::string takeRequestedObject() { return std::exchange(requested_, {}); }
    [[nodiscard]] SceneValues takeRequestedValues() { return std::exchange(requestedValues_, {}); }

    /// Returns work for another thread: it opens a scene, a cloud or a recorded session.
    [[nodiscard]] std::function<OpenedObject()> opener(const std::string& what, const SceneValues& values) const;
    /// Puts the opened object on the stage.
    void adopt(OpenedObject opened);

    /// Returns the values that the user has set, with others over them.
    [[nodiscard]] SceneValues valuesWith(SceneValues others) const;
    /// Returns the scene on the stage with other values over it.
    /// \throws Error as the scene's reader does
    [[nodiscard]] Scene sceneWith(const SceneValues& values) const;
    void                adopt(std::unique_ptr<Stage> stage) { stage_ = std::move(stage); }
    void                setValues(SceneValues values) { values_ = std::move(values); }

    [[nodiscard]] Stage&                                stage() const { return *stage_; } ///< \pre there is one
    [[nodiscard]] bool                                  hasStage() const { return stage_ != nullptr; }
    [[nodiscard]] const std::optional<RecordedSession>& recorded() const { return recorded_; }
    /// Returns whether the object is the one that the program opened first.
    [[nodiscard]] bool        isFirst() const { return what_ == settings_.what; }
    [[nodiscard]] std::string fileName() const; ///< "palm.ply"
    [[nodiscard]] std::string stem() const;     ///< "palm"

private:
    const WorkbenchSettings&       settings_;
    std::string                    what_;
    SceneValues                    values_, requestedValues_;
    std::string                    requested_;
    std::unique_ptr<Stage>         stage_;
    std::optional<RecordedSession> recorded_;
};

/// Returns the last part of a path or of a sample's name.
[[nodiscard]] std::string fileNameOf(const std::string& what);

} // namespace palp
