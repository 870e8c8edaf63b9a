#pragma once
#include <array>
#include <string_view>

// Made by calculix_revolution.py, which says how: CalculiX 2.20, C3D20R.

namespace palp {

/// The stiffness of a thin body of revolution under a fingertip.
struct CalculixRevolution {
    std::string_view body;
    double           place;     ///< along its meridian, an angle [degrees] or z [m]
    double           thickness; ///< [m]
    double           stiffness; ///< 1/c [N/m]
    double           meshError; ///< of c on the finer mesh, which is taken off [1]
};

inline constexpr std::array<CalculixRevolution, 36> kCalculixRevolutions{{
    {"tube", 0.03, 0.001, 4.6923, -1.4e-03},
    {"tube", 0.03, 0.002, 19.469, -1.1e-03},
    {"tube", 0.05, 0.001, 3.0991, -8.8e-04},
    {"tube", 0.05, 0.002, 13.31, -5.5e-04},
    {"tube", 0.085, 0.001, 1.3427, -5.6e-04},
    {"tube", 0.085, 0.002, 6.2494, -3.1e-04},
    {"torus", 0, 0.001, 8.6592, -5.9e-04},
    {"torus", 0, 0.002, 30.688, -6.9e-04},
    {"torus", 90, 0.001, 5.5334, -3.8e-06},
    {"torus", 90, 0.002, 21.356, -2.3e-04},
    {"torus", 180, 0.001, 8.8013, 6.4e-04},
    {"torus", 180, 0.002, 34.179, 4.3e-04},
    {"bowl", 60, 0.001, 2.056, -1.6e-02},
    {"bowl", 60, 0.002, 7.2536, -1.2e-02},
    {"bowl", 90, 0.001, 0.87691, -9.1e-03},
    {"bowl", 90, 0.002, 3.9931, -8.8e-03},
    {"sphere", 40, 0.001, 11.138, 2.5e-04},
    {"sphere", 40, 0.002, 36.867, 1.6e-04},
    {"sphere", 70, 0.001, 11.334, 2.6e-04},
    {"sphere", 70, 0.002, 38.081, 1.9e-04},
    {"waist", 0, 0.001, 4.9277, -2.3e-04},
    {"waist", 0, 0.002, 19.593, -6.0e-05},
    {"waist", 0.02, 0.001, 2.7815, -1.4e-04},
    {"waist", 0.02, 0.002, 10.708, -8.2e-05},
    {"cone", 0.03, 0.001, 5.3502, -1.2e-03},
    {"cone", 0.03, 0.002, 22.329, -9.4e-04},
    {"cone", 0.045, 0.001, 5.2738, -7.4e-04},
    {"cone", 0.045, 0.002, 22.505, -3.8e-04},
    {"oblate", 40, 0.001, 6.4782, 2.1e-04},
    {"oblate", 40, 0.002, 22.773, 1.7e-04},
    {"oblate", 70, 0.001, 11.408, 3.0e-04},
    {"oblate", 70, 0.002, 39.099, 2.4e-04},
    {"prolate", 45, 0.001, 8.4955, 5.4e-04},
    {"prolate", 45, 0.002, 23.97, 6.5e-04},
    {"prolate", 80, 0.001, 6.6169, 3.2e-04},
    {"prolate", 80, 0.002, 21.939, 3.8e-04},
}};

} // namespace palp
