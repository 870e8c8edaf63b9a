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
    double           meshError; ///< of c on the finer mesh, which is taken off [1]
};

/// Pressed as calculix_shells.py says.
inline constexpr std::array<CalculixShell, 35> kCalculixShells{{
    {"sphere", 0.001, 61.997, 3.6e-04},     {"sphere", 0.002, 216.63, 6.9e-04},
    {"sphere", 0.003, 451.4, 9.5e-04},      {"ellipsoid", 0.001, 38.496, 6.9e-04},
    {"ellipsoid", 0.002, 140.41, 1.2e-03},  {"ellipsoid", 0.003, 301.1, 1.9e-03},
    {"shoulder", 0.001, 58.075, 1.1e-03},   {"shoulder", 0.002, 200.95, 2.1e-03},
    {"side", 0.001, 66.749, 6.0e-04},       {"side", 0.002, 232.75, 1.0e-03},
    {"cigar", 0.001, 36.586, 1.3e-03},      {"cigar", 0.002, 141.24, 4.1e-03},
    {"slope", 0.001, 36.723, 1.3e-03},      {"wart_under", 0.001, 141.72, 6.1e-04},
    {"wart_under", 0.002, 433.67, 1.3e-03}, {"wart_beside", 0.001, 95.252, 4.9e-04},
    {"soft_spot", 0.001, 37.803, 5.4e-04},  {"tube", 0.001, 27.166, 1.3e-03},
    {"waist", 0.001, 36.002, 8.7e-04},      {"ridge", 0.001, 68.527, 1.7e-03},
    {"ridge", 0.002, 235.57, 1.9e-03},      {"sheet", 0.001, 12.551, 2.5e-03},
    {"drum", 0.002, 10.42, 2.6e-03},        {"drum_wart", 0.002, 12.578, 2.9e-03},
    {"lobe", 0.002, 1.6812, 4.5e-03},       {"lobe", 0.003, 5.6365, 4.4e-03},
    {"band", 0.0015, 3.6894, 3.8e-03},      {"arch", 0.0015, 18.241, 7.9e-04},
    {"low_arch", 0.0015, 5.6502, 2.1e-03},  {"vault", 0.0015, 40.781, 6.2e-04},
    {"saddle", 0.0015, 28.524, 6.9e-04},    {"bridge", 0.0015, 53.765, 3.5e-04},
    {"disc", 0.002, 17.242, 3.4e-03},       {"shallow_dish", 0.002, 20.438, 3.3e-03},
    {"dish", 0.002, 24.853, 3.2e-03},
}};

} // namespace palp
