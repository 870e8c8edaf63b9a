#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/cloud/soft_object.h"
#include "engine/session/tick_record.h"

namespace palp::soak {

/// Looks whether a hand gets through the surface without a contact, or loses it behind the surface, by planes of its
/// own through the points: of what a session says it believes only where the hand is, and whether it is in contact.
///
/// It judges where nobody can doubt the side: near points that lie in a plane, with others all around them. At borders,
/// in folds and where points are noisy it says nothing.
class Passage {
public:
    /// \param object  outlives this
    explicit Passage(const SoftObject& object);

    /// Looks at the next tick.
    /// \return what is wrong, as a sentence; empty if nothing is
    [[nodiscard]] std::optional<std::string> check(const TickRecord& record);

    [[nodiscard]] std::uint64_t judged() const noexcept { return judged_; } ///< ticks whose side was known, so far

private:
    /// The surface about a point.
    struct Plane {
        bool       isKnown = false, isPlain = false;
        double     spacing = 0; ///< [m] of the points around
        glm::dvec3 normal{};    ///< [1] unit, of either side
    };
    /// On which side of which point a hand is.
    struct Side {
        std::uint32_t point = 0;
        glm::dvec3    outward{}; ///< [1] unit, towards the hand
    };

    [[nodiscard]] const Plane&               planeAt(std::uint32_t point);
    [[nodiscard]] std::optional<std::string> judge(const TickRecord& record, std::uint32_t nearest);

    const SoftObject&         object_;
    std::vector<Plane>        planes_;        ///< of each point, made when it is asked for
    std::optional<Side>       side_;          ///< of a hand without contact
    std::optional<glm::dvec3> touched_;       ///< [1] outward, if the last tick was in contact
    std::optional<glm::dvec3> hip_;           ///< [m] of the last tick
    glm::dvec3                proxy_{};       ///< [m] of the last tick
    glm::dvec3                clearOf_{};     ///< [m] where the nearest point was asked for last
    double                    clearance_ = 0; ///< [m] how far from there nothing is near
    std::uint64_t             judged_    = 0;
};

} // namespace palp::soak
