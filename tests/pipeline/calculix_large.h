#pragma once
#include <array>
#include <string_view>

// Made by calculix_large.py, which says how: CalculiX 2.20, C3D20R, NLGEOM.

namespace palp {

/// How deep a fingertip presses a whole thin object.
struct CalculixPress {
    std::string_view name;
    double           thickness; ///< [m]
    double           force;     ///< of the last depth; the others are even parts of it [N]
    double           meshError; ///< of the last depth: change from elements 1.5 times as large [1]

    std::array<double, 10> depths; ///< [m]
};

inline constexpr std::array<CalculixPress, 7> kCalculixPresses{{
    {"sheet",
     0.001,
     0.046,
     1.1e-03,
     {0.00034482, 0.00061558, 0.00082325, 0.00099033, 0.0011307, 0.0012523, 0.0013602, 0.0014575, 0.0015464,
      0.0016284}},
    {"sphere",
     0.001,
     0.042,
     3.0e-04,
     {7.0219e-05, 0.00014638, 0.00022974, 0.00032229, 0.00042688, 0.0005479, 0.00069247, 0.00087295, 0.0011125,
      0.0014533}},
    {"sphere",
     0.002,
     0.34,
     4.4e-04,
     {0.00016308, 0.00034064, 0.00053636, 0.00075548, 0.0010058, 0.0012995, 0.0016569, 0.0021131, 0.0027295,
      0.0035896}},
    {"ellipsoid",
     0.001,
     0.028,
     5.1e-04,
     {7.5368e-05, 0.00015717, 0.00024672, 0.00034616, 0.00045849, 0.00058828, 0.00074279, 0.00093415, 0.0011834,
      0.0015238}},
    {"wart_under",
     0.001,
     0.121,
     7.6e-04,
     {8.7624e-05, 0.0001806, 0.0002799, 0.00038703, 0.0005041, 0.0006343, 0.00078281, 0.00095909, 0.001184, 0.0015264}},
    {"wart_beside",
     0.001,
     0.07,
     8.7e-04,
     {7.5891e-05, 0.00015736, 0.0002457, 0.0003427, 0.000451, 0.00057468, 0.00072057, 0.00090137, 0.0011446,
      0.0015263}},
    {"soft_spot",
     0.001,
     0.031,
     6.1e-04,
     {8.6374e-05, 0.00018409, 0.00029616, 0.00042785, 0.00058647, 0.00078116, 0.0010196, 0.0013001, 0.0016076,
      0.0019245}},
}};

} // namespace palp
