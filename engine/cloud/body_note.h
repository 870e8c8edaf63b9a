#pragma once
#include <memory>
#include <mutex>

namespace palp {

class BodyShell;

/// The coarse shell of an object as a whole, see bodyShellOf(). It depends on the stiffness, the material and what is
/// held, so each object has its own.
/// \thread any, under the mutex
struct BodyNote {
    std::mutex                       mutex;
    bool                             isMade = false;
    std::shared_ptr<const BodyShell> shell; ///< null: not made, or there is none
};

} // namespace palp
