#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <glm/vec3.hpp>

#include "engine/capi/palpate.h"
#include "engine/cloud/point_cloud_io.h"
#include "engine/cloud/soft_object.h"
#include "engine/core/contract.h"
#include "engine/session/scene.h"

// What every function of the C interface does with what crosses the border.

struct palpate_object {
    palp::Scene      scene;
    palp::SoftObject object;
    /// What a caller says of points of its own, to be recorded; null: the scene says where they are.
    std::shared_ptr<const palp::LoadedCloud> own{};
};

namespace palp::capi {

void              forgetLastCall() noexcept; ///< of the calling thread
[[nodiscard]] int failure() noexcept;        ///< the code of the exception in flight; its sentence is kept
void              keepTakeover(std::string sentence) noexcept; ///< for palpate_takeover_text()

/// Runs the body of a function of the interface; returns its code.
template <class Body>
int guarded(const Body& body) noexcept
{
    try {
        forgetLastCall();
        body();
        return PALPATE_OK;
    } catch (...) {
        return failure();
    }
}

/// The most points, faces or places that an array of the caller may have: indices are 32 bits wide.
inline constexpr std::size_t kMostInArray = std::numeric_limits<std::uint32_t>::max() / 2;

/// Returns what a pointer of the caller points to.
/// \throws Error if it is null
template <class T>
T& demand(T* pointer, const char* what)
{
    if (!pointer) throw Error(std::string(what) + ": expected a pointer, found NULL");
    return *pointer;
}

/// Returns a struct of the caller, of this or another version: what it lacks is 0, what it has beyond must be 0.
template <class T>
T taken(const T* given, const char* what)
{
    constexpr std::size_t kMost = 4096; // no struct here will ever be so large
    const std::size_t     size  = demand(given, what).size;
    if (size < 2 * sizeof(std::size_t) || size > kMost)
        throw Error(std::string(what) + ": expected its own size in its first field, " + std::to_string(sizeof(T)) +
                    " bytes, found " + std::to_string(size) + "; write PALPATE_INIT(" + what + ")");
    T own{};
    std::memcpy(&own, given, std::min(size, sizeof(T)));
    const auto* bytes = reinterpret_cast<const unsigned char*>(given);
    for (std::size_t n = sizeof(T); n < size; ++n)
        if (bytes[n] != 0)
            throw Error(std::string(what) + ": expected nothing beyond " + std::to_string(sizeof(T)) +
                        " bytes, which this version knows, found a value in byte " + std::to_string(n));
    own.size = sizeof(T);
    return own;
}

/// Writes a struct for the caller, as much of it as he knows.
template <class T>
void give(T* to, T own) noexcept
{
    const std::size_t size = to->size;
    own.size               = size;
    std::memcpy(to, &own, std::min(size, sizeof(T)));
}

[[nodiscard]] inline glm::dvec3 vectorOf(const double* three) noexcept
{
    return {three[0], three[1], three[2]};
}
inline void put(const glm::dvec3& v, double* three) noexcept
{
    for (int k = 0; k < 3; ++k) three[k] = v[k];
}
[[nodiscard]] inline bool isFinite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns a place or a direction for a sentence: "(0.03, nan, 0)".
[[nodiscard]] std::string shown(const glm::dvec3& v);

/// \throws Error unless there is room for as many points
void demandRoom(std::size_t found, std::size_t wanted);

/// Copies a text with its final zero.
/// \throws Error unless there is room
void giveText(const std::string& from, char* to, std::size_t size);

} // namespace palp::capi
