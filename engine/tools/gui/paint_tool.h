#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/tools/gui/notices.h"
#include "engine/tools/gui/pick.h"
#include "engine/tools/gui/stage.h"
#include "engine/tools/gui/view_state.h"

namespace palp {

/// Paints stiffness on the object on the stage, undoes strokes, and saves the paint.
/// Invariant: paint that is on the object and not in a file is never discarded without a warning.
/// \thread the window's
class PaintTool {
public:
    explicit PaintTool(Notices& notices) : notices_(notices) {}

    /// Forgets the last object.
    /// \pre its paint may be discarded
    void startAnew();

    /// Dabs from the stroke's last place to this one; the first call begins a stroke.
    /// \throws Error if the way is too long for the brush; nothing is painted then
    void               stroke(Stage& stage, const BrushChoice& brush, const glm::dvec3& place);
    void               endStroke(Stage& stage);
    [[nodiscard]] bool inStroke() const { return lastDab_.has_value(); }

    /// Return whether there was a stroke to undo or to paint again.
    bool undo(Stage& stage);
    bool redo(Stage& stage);

    /// Writes the painted cloud as a new PLY file, and shows its name or why it could not be written.
    /// \param folder  empty: the current one
    /// \return whether nothing is unsaved now
    bool               save(const Stage& stage, const std::filesystem::path& folder = {});
    [[nodiscard]] bool unsaved(const Stage& stage) const;
    /// Returns true if the paint is saved or the user has asked twice for the same; warns the first time.
    /// \param request  what the user asks for, as the warning names it
    [[nodiscard]] bool mayDiscard(const Stage& stage, const std::string& request);
    /// Forgets a warning that is not shown any more: the next request is warned of again.
    void forgetWarning() { warnedOf_.clear(); }

private:
    enum class Kept { saved, unsaved };

    void change();

    Notices&                  notices_;
    std::optional<glm::dvec3> lastDab_; ///< of the stroke that has begun [m]
    Kept                      kept_ = Kept::saved;
    std::string               warnedOf_; ///< the request that has been warned of; empty: none
};

/// Returns the brush's rim as lines on the surface.
[[nodiscard]] std::vector<ViewSegment> brushOutline(const Hit& hit, double radius);

} // namespace palp
