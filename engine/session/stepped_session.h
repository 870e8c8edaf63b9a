#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "engine/cloud/point_cloud_io.h"
#include "engine/session/deformation.h"
#include "engine/session/recording.h"
#include "engine/session/scene.h"

namespace palp {

/// A session whose ticks somebody else calls: a host with a haptic loop of its own (SOFA, CHAI3D, a maker's scheduler,
/// a game engine). The deformation has a thread inside.
///
///     host's loop:  step(time, hand) -> force, governed        some microseconds; no wait, no allocation, no throw
/// \thread step(): one, the host's; takePatch() and patch(): one other; construction, destruction, record() and
///         stopRecording(): while no step() runs
class SteppedSession {
public:
    /// Opens the plate solver and solves the homogeneous window, some tenths of a second, then starts the thread.
    /// \param device  what holds the hand, as far as it is known: it bounds stiffness and force
    /// \param own     what is said of points that the scene does not name, for record(); null: nothing but the object
    /// \throws Error as Deformation does
    SteppedSession(SoftObject object, const Scene& scene, const HapticDeviceInfo& device = {},
                   std::shared_ptr<const LoadedCloud> own = nullptr);
    ~SteppedSession(); ///< ends the thread and the recording
    SteppedSession(const SteppedSession&)            = delete;
    SteppedSession& operator=(const SteppedSession&) = delete;

    /// Runs one tick. A hand or a time that is not finite, or a time that does not rise, gives zero force in this tick
    /// and counts as a device that answers nonsense. A hand whose place is not known has no force either: the tool stays
    /// where a hand was last, and touches nothing before one was anywhere. A velocity of exactly zero is taken from the
    /// positions of the last 15 ms, because many a host has none. Held down for 20 ms, the first button clears the
    /// governor's fault.
    /// \param time  [s] rising, from 0 or anywhere
    /// \return the record of the tick, in which `force` is what the governor let through [N]
    const TickRecord& step(double time, const Hand& hand) noexcept;

    /// Takes the newest patch, if there is another one.
    bool takePatch() noexcept;
    /// Returns the patch that takePatch() took last; null before.
    [[nodiscard]] const Patch* patch() const noexcept;

    /// Returns who took over from another solver last, and why; may be empty, see PlateSolver::takeoverSince().
    /// \thread any
    [[nodiscard]] std::string takeover() const;

    /// Records from now on into a new folder, see Recording. If the scene names no cloud, the folder gets cloud.ply.
    /// \throws Error as Recording does
    void            record(const std::filesystem::path& folder, const std::string& program);
    RecordingReport stopRecording();

    [[nodiscard]] const SoftObject& object() const noexcept;
    [[nodiscard]] const Scene&      scene() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
