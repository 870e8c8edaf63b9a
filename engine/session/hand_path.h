#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/enum_names.h"
#include "engine/session/scene.h"

namespace palp {

/// The place of a scripted hand at one time.
struct HandPose {
    double        time = 0;                ///< [s]
    glm::dvec3    position{};              ///< of the HIP [m]
    std::uint32_t buttons = 0;             ///< that are down from here on, as HapticState::buttons
    glm::dquat    orientation{1, 0, 0, 0}; ///< of the grip in the scene, a unit quaternion
};

/// A scripted hand: straight lines between waypoints.
///
/// They are lines, not a cubic through the waypoints: a cubic overshoots, into the object if it must, and is faster in
/// places than the hand was; a line is never faster than fastest(), and at the time of a waypoint it gives that
/// waypoint bit for bit.
/// Invariant: at least two waypoints, all finite, times rising.
/// \thread immutable; pure
class HandPath {
public:
    /// Largest speed of a hand [m/s]: a higher one is a wrong unit; a thrown ball has 40.
    static constexpr double kFastest = 100;

    /// \param name         opens complaints
    /// \param repeatsFrom  [s] within the path: where it goes on after its end, again and again; without it the hand
    ///                     rests there
    /// \throws Error naming the first waypoint that is wrong (counted from 0)
    explicit HandPath(std::vector<HandPose> waypoints, const std::string& name = "hand",
                      std::optional<double> repeatsFrom = {});

    /// Returns the hand at a time [s]: at rest at the first waypoint before it begins, at the last after it has ended,
    /// or in its repetition.
    [[nodiscard]] glm::dvec3 position(double time) const noexcept;

    /// Returns the buttons that are down at a time [s]: those of the last waypoint up to then.
    [[nodiscard]] std::uint32_t buttons(double time) const noexcept;

    /// Returns how the grip is turned at a time [s]: on the shortest way from one waypoint to the next.
    [[nodiscard]] glm::dquat orientation(double time) const noexcept;

    /// Returns whether the hand turns its grip anywhere.
    [[nodiscard]] bool turns() const noexcept { return turns_; }

    [[nodiscard]] double begin() const noexcept { return waypoints_.front().time; }             ///< [s]
    [[nodiscard]] double duration() const noexcept { return waypoints_.back().time - begin(); } ///< [s] of one pass
    [[nodiscard]] std::optional<double>        repeatsFrom() const noexcept { return repeatsFrom_; } ///< [s]
    [[nodiscard]] double                       fastest() const noexcept { return fastest_; }         ///< [m/s]
    [[nodiscard]] const std::vector<HandPose>& waypoints() const noexcept { return waypoints_; }

private:
    [[nodiscard]] double inPath(double time) const noexcept; ///< [s]

    std::vector<HandPose> waypoints_;
    std::optional<double> repeatsFrom_; ///< [s]
    double                fastest_ = 0; ///< [m/s]
    bool                  turns_   = false;
};

/// Reads a hand from a file of rows time [s], x, y, z [m]. Further columns are skipped where a header line has them
/// too, so that the table of a recorded session is a hand, with its buttons; in text, one that is called "buttons" is
/// read: a whole number, whose bit i is set if button i is down; and so are orientation_x, _y, _z and _w, a quaternion
/// of the grip.
///
/// .npy: an array of shape (n, 4) or wider. Any other extension: text, one waypoint a line, numbers between commas,
/// semicolons, blanks or tabs; lines that start with '#' are comments; the first name of a header line begins with "t",
/// as in "time", and its names may have units of time and length, as in "time [ms]". A comment "# time x y z" that
/// names as many columns as the first row has is a header too: numpy.savetxt writes it so.
/// \throws Error naming the file and the line: NaN, infinity, time that does not rise, too few columns, a hand faster
///         than HandPath::kFastest (millimetres?)
[[nodiscard]] HandPath readHand(const std::filesystem::path& path);

/// Reads a hand from a stream of text; `name` stands in messages.
[[nodiscard]] HandPath parseHand(std::istream& in, const std::string& name);

/// Returns 16 hexadecimal digits that tell hands apart, see Fingerprint.
[[nodiscard]] std::string fingerprint(const HandPath& hand);

/// A place on an object and the side of the hand there.
struct HandPlace {
    glm::dvec3 point{};          ///< [m] on the surface
    glm::dvec3 outward{0, 0, 1}; ///< [1] unit vector to the hand
};

/// Returns where the scene is touched: the foot of placeOf() on the surface, see touchAt(), and the side Scene::from;
/// where the scene names no place, the viewer's side.
/// \throws Error if the place is farther than a quarter of the patch window from the cloud
[[nodiscard]] Contact contactOf(const Scene& scene, const SoftObject& object);

/// Returns where the scene's hand works: contactOf() without the knowledge about its side.
/// \throws Error as contactOf()
[[nodiscard]] HandPlace handPlace(const Scene& scene, const SoftObject& object);

enum class HandMotion {
    press,  ///< down and up again at one place
    circle, ///< down, then round the place
    scan    ///< down beside the place, then to and fro across it
};
constexpr auto namesOf(HandMotion)
{
    using enum HandMotion;
    return std::to_array<NamedValue<HandMotion>>({{press, "press"}, {circle, "circle"}, {scan, "scan"}});
}

/// The settings of a generated hand.
struct HandScript {
    HandMotion motion   = HandMotion::press;
    double     speed    = 0.05;  ///< the highest it has [m/s]
    double     depth    = 2e-3;  ///< below the surface [m]
    double     radius   = 10e-3; ///< of the circle; half the length of a scan [m]
    double     height   = 10e-3; ///< above the place, where it starts [m]
    double     duration = 5;     ///< [s]
};

/// Makes a hand in the plane through the place, perpendicular to its outward direction: a waypoint every millisecond
/// from time 0 on, without a jump in velocity, never faster than the script's speed. The same script gives the
/// same bits. Of more than a minute one pass is made, and
/// repeated.
///
///     press   outward height  h - (h + d)(1 - cos(pi t / T))/2,  T = pi (h + d) / (2 speed), again and again
///     circle  press's first half beside the place, then round it, the speed rising smoothly within a fifth of a second
///     scan    press's first half, then along the line as -r cos(speed t / r)
///
/// \throws Error naming what is not positive, or that the motion takes more than 10000 s
[[nodiscard]] HandPath makeHand(const HandScript& script, const HandPlace& place);

/// Makes a hand that keeps its depth over a curved object: each waypoint moves along `outward` by the height of the
/// cloud above the plane through the place, there.
///
/// The height is the weighted mean of the near points' heights, weights (1 - r^2/R^2)^2 by their distance r in the
/// plane, R three spacings of the cloud: smooth where the hand is, for any points. Where the cloud ends the last
/// height stays. The result may be faster than makeHand's by the slope of the surface.
[[nodiscard]] HandPath draped(const HandPath& hand, const HandPlace& place, const SoftObject& object);

} // namespace palp
