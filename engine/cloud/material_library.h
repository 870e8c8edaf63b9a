#pragma once
#include <span>
#include <string_view>

#include "engine/cloud/material.h"

namespace palp {

/// A material that somebody has measured.
struct KnownMaterial {
    std::string_view name;              ///< "ecoflex-0030"
    double           modulus      = 0;  ///< E [Pa]; 0: not known, an object keeps its own
    double           modulusError = 0;  ///< standard deviation [Pa]
    double           poissonRatio = -1; ///< [1]; -1: not known
    double           stiffening   = 0;  ///< b [1/m]
    Relaxation       relaxation{};
    std::string_view source, licence;
};

/// Returns all that are known, in the order of their names' families.
[[nodiscard]] std::span<const KnownMaterial> knownMaterials() noexcept;

/// Returns the material of that name, or null.
[[nodiscard]] const KnownMaterial* materialNamed(std::string_view name) noexcept;

} // namespace palp
