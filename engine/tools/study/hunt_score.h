#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/chart/chart.h"
#include "engine/cloud/neighbour_index.h"
#include "engine/session/scene.h"
#include "engine/session/tick_record.h"
#include "engine/tools/study/hunt_scene.h"

namespace palp::study {

/// A place at which the hand declared a nodule, by a button.
struct Declaration {
    static constexpr int kNone = -1;

    double     time = 0;         ///< [s] since the hunt's start
    glm::dvec3 place{};          ///< [m] of the contact
    int        nodule   = kNone; ///< the found one, from 0; kNone: a false alarm
    double     distance = 0;     ///< [m] from the middle of the nearest nodule
    bool       again    = false; ///< the nodule was found before
};

/// The score of one nodule.
struct NoduleScore {
    Nodule nodule;
    bool   found    = false;
    double time     = 0; ///< of its find [s]
    double distance = 0; ///< of that declaration from its middle [m]
    double edge     = 0; ///< share of its circumference that was traced [1]
};

/// The score of a hunt.
struct HuntScore {
    std::vector<NoduleScore>             nodules;
    std::vector<Declaration>             declarations;
    std::size_t                          found = 0, falseAlarms = 0, inAir = 0, unkept = 0;
    double                               duration = 0, contact = 0; ///< [s] of the session, in contact
    double                               meanForce = 0;             ///< over the time in contact [N]
    double                               peakForce = 0;             ///< [N]
    double                               impulse   = 0; ///< of the force's magnitude over all of the time [N s]
    double                               tooHard   = 0; ///< share of the time in contact above the hunt's limit [1]
    double                               coverage  = 0; ///< share of the ground that came under the fingertip [1]
    double                               mark      = 0; ///< 2 found / (nodules + finds + false alarms) [1]
    std::vector<std::vector<glm::dvec3>> path;          ///< [m] of the contact, thinned; a piece per touch

    /// The formula of `mark`, to be shown beside it.
    /// \source Dice 1945, Sorensen 1948: here of finds and nodules
    static constexpr const char* kMarkFormula = "2 found / (nodules + found + false alarms)";
};

/// A scorer of a hunt in progress.
///
/// Any button that is held for ForceHalf::kPressTicks declares the place of the contact at which it was pressed, except
/// while the governor has stopped the force, when a button belongs to its operator. The declaration finds the nearest
/// nodule if the fingertip touches that: at a distance of at most its radius and a footprint's. An edge is traced in
/// sectors of 10 degrees, where the contact moves within max(r/4, footprint/2) of the radius r at the hunt's press
/// force or more. The ground counts as covered within a footprint's radius of a contact with that force or more.
/// \thread one; add() may allocate
class HuntScorer {
public:
    static constexpr int kSectors = 36; ///< of a nodule's circumference

    /// \param cloud  as loadCloud() returns it
    /// \throws Error if nothing is hidden in the scene
    HuntScorer(const Scene& scene, const PointCloud& cloud);

    /// Adds the record of the next tick; an earlier time than the last one begins another session of the same hunt.
    void add(const TickRecord& record);

    [[nodiscard]] HuntScore score() const;

private:
    struct Edge {
        Frame         frame;      ///< in the surface, at the middle
        std::uint64_t traced = 0; ///< bit k: sector k
        bool          known  = false;
    };

    void press(const TickRecord& record, double now);
    void declare(double time, const glm::dvec3& place);
    void trace(const TickRecord& record);
    void cover(const glm::dvec3& place);
    void draw(const TickRecord& record);

    Hunt                       hunt_;
    double                     footprint_; ///< radius [m]
    std::vector<Edge>          edges_;
    std::vector<glm::dvec3>    ground_; ///< [m]
    NeighbourIndex             index_;  ///< of the ground
    std::vector<bool>          covered_;
    std::vector<std::uint32_t> near_;
    HuntScore                  score_;
    double                     begun_ = 0, last_ = -1, tooHard_ = 0; ///< [s] of earlier sessions, of the last record
    int                        held_            = 0;                 ///< ticks of a button
    double                     pressedAt_       = 0;                 ///< [s]
    bool                       pressedTouching_ = false, touching_ = false;
    glm::dvec3                 pressedOn_{}, coveredAt_{}; ///< [m]
    bool                       coveredAny_ = false;
    std::size_t                drawn_      = 0; ///< places of the path
};

} // namespace palp::study
