#pragma once
#include <array>
#include <string_view>

// Made by calculix_shells.py, which says how: CalculiX 2.20, C3D20R.

namespace palp {

/// The stiffness of a whole thin object under a fingertip.
struct CalculixShell {
    std::string_view name;
    double           thickness; ///< [m]
    double           stiffness; ///< 1/c [N/m]
    double           meshError; ///< change from elements 1.5 times as large [1]
};

/// Pressed as calculix_shells.py says.
inline constexpr std::array<CalculixShell, 11> kCalculixShells{{
    {"sphere", 0.001, 62.031, 3.2e-04},
    {"sphere", 0.002, 216.86, 4.1e-04},
    {"ellipsoid", 0.001, 38.536, 5.0e-04},
    {"ellipsoid", 0.002, 140.66, 7.8e-04},
    {"wart_under", 0.001, 141.85, 1.3e-04},
    {"wart_under", 0.002, 434.52, 5.9e-04},
    {"wart_beside", 0.001, 95.322, 3.0e-04},
    {"soft_spot", 0.001, 37.833, 1.1e-03},
    {"tube", 0.001, 27.34, 3.0e-03},
    {"waist", 0.001, 36.149, 2.1e-03},
    {"sheet", 0.001, 12.866, 1.3e-02},
}};

} // namespace palp
