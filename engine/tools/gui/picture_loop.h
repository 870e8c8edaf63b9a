#pragma once
#include <chrono>
#include <string>

#include "engine/tools/gui/picture_texts.h"
#include "engine/tools/gui/screen.h"
#include "engine/tools/gui/workbench_settings.h"

namespace palp {

/// Draws the window's pictures: decides when one is due and how finely it is drawn, and measures how long it takes.
/// Invariant: while nothing changes, the last picture is a fine one and no other is drawn.
/// \thread the window's
class PictureLoop {
public:
    /// \param screen  outlives this
    explicit PictureLoop(Screen& screen);

    /// Notes that something differs from what the last picture shows.
    void changed() { changedAt_ = Clock::now(); }

    /// Returns how long to wait for input before the next picture [s].
    [[nodiscard]] double patience(const glm::ivec2& size) const;
    [[nodiscard]] bool   due(const glm::ivec2& size) const;
    [[nodiscard]] bool   resized(const glm::ivec2& size) const { return size != drawnSize_; }
    [[nodiscard]] double sinceBegin() const; ///< of the last picture [s]

    /// Begins a picture; the preparations that follow count as drawing it.
    void begin(const glm::ivec2& size);
    /// Draws the picture that was begun.
    /// \param touching  counts it in the report
    void show(const ViewScene& scene, const Camera& camera, const Overlay* texts, bool touching);
    /// Shows the last picture once more.
    void rest()
    {
        screen_.present();
        rested_ = true;
    }
    /// Draws words alone, and measures no times.
    void showWords(const ViewScene& words, const Camera& camera, const glm::ivec2& size, double scale);

    /// Writes the object as a PNG file, finer than on the screen.
    /// \return the file
    /// \throws Error if it cannot be drawn or written
    std::string saveStill(ViewScene& scene, const Camera& camera, const std::string& title);
    /// Writes what the window shows, panels included, as a PNG file.
    /// \return the file
    /// \throws Error if it cannot be drawn or written
    std::string saveWindow(const ViewScene& scene, const Camera& camera, const Overlay* texts);

    [[nodiscard]] const compute::Processor& processor() const { return screen_.processor(); }
    [[nodiscard]] glm::ivec2                size() const { return {size_.width, size_.height}; } ///< of the last [px]
    [[nodiscard]] double                    frameTime() const { return frameTime_; }             ///< a mean [s]
    [[nodiscard]] WorkbenchReport&          report() { return report_; }

private:
    using Clock = std::chrono::steady_clock;

    void count(bool touching, double period);

    Screen&           screen_;
    glm::ivec2        drawnSize_{}; ///< [px]
    Clock::time_point begunAt_{}, shownAt_, changedAt_;
    PictureSize       size_;                         ///< of the picture that was begun
    double            frameTime_ = 0, drawTime_ = 0; ///< [s]
    double            fineTime_  = 0;                ///< of the last fine picture [s]; 0: there was none
    bool              rested_    = false;            ///< since the last picture
    bool              restsFine_ = false;            ///< the last picture is a fine one, of an object at rest
    WorkbenchReport   report_;
};

} // namespace palp
