#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// What a scene says of what holds the object: regions of space, or the file's own property.
struct SceneHeld {
    /// A box between two corners; or balls of one radius about places.
    struct Region {
        bool                    isBox = false;
        std::vector<glm::dvec3> places{};   ///< [m] the two corners of a box, or the middles of the balls
        double                  radius = 0; ///< of the balls [m]

        [[nodiscard]] bool holds(const glm::dvec3& point) const noexcept;
    };

    std::vector<Region> regions{};
    bool                isOwn = false; ///< the file's property "held"

    [[nodiscard]] bool isThere() const noexcept { return isOwn || !regions.empty(); }
};

inline constexpr std::string_view kHeldForm =
    R"(an object such as {"box":[[-0.1,-0.1,-0.01],[0.1,-0.05,0.01]]}, {"ball":[0,0,0],"radius":5e-3} or {"points":[[0,0,0],[0.01,0,0]],"radius":2e-3}, a list of these, own, or none)";

/// Reads the value of the key "held".
/// \param what  opens complaints
/// \throws Error naming the key, what was expected and found
[[nodiscard]] SceneHeld parseHeld(const std::string& text, const std::string& what);

/// Writes what parseHeld() reads; empty if there is nothing.
[[nodiscard]] std::string heldJson(const SceneHeld& held);

/// Returns the JSON Schema of the value.
[[nodiscard]] std::string_view heldSchema();

/// Returns for each point whether it is held, 0 or 1, or the file's own share.
/// \param ofFile  property "held" of the points; may be empty
/// \param what    opens complaints
/// \throws Error if no point is held, or the file has no such property
[[nodiscard]] std::vector<double> heldShares(std::span<const glm::dvec3> positions, const SceneHeld& held,
                                             std::span<const double> ofFile, const std::string& what);

} // namespace palp
