#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "chai3d.h"

// CHAI3D's frame has x to the user, y right and z up; Palpate's has x right, y up and z to the user.
namespace palp {

[[nodiscard]] inline glm::dvec3 fromChai3d(const chai3d::cVector3d& v)
{
    return {v.y(), v.z(), v.x()};
}

[[nodiscard]] inline chai3d::cVector3d toChai3d(const glm::dvec3& v)
{
    return chai3d::cVector3d(v.z, v.x, v.y);
}

/// Turns a rotation of one frame into the same of the other; a matrix that is none gives no turn.
[[nodiscard]] inline glm::dquat fromChai3d(const chai3d::cMatrix3d& turn)
{
    constexpr int kTheirs[] = {1, 2, 0}; // which of their axes each of ours is
    glm::dmat3    ours(1);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) ours[column][row] = turn(kTheirs[row], kTheirs[column]);
    const glm::dquat out  = glm::quat_cast(ours);
    const double     size = glm::length(out);
    return size > 0.9 && size < 1.1 ? out / size : glm::dquat(1, 0, 0, 0); // false for NaN
}

inline void toChai3d(const glm::dquat& turn, chai3d::cMatrix3d& out)
{
    constexpr int    kTheirs[] = {1, 2, 0};
    const glm::dmat3 ours      = glm::mat3_cast(turn);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) out(kTheirs[row], kTheirs[column]) = ours[column][row];
}

} // namespace palp
