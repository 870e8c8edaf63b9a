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
    {"tube", 0.05, 0.001, 3.0967, 1.4e-04},
    {"tube", 0.05, 0.002, 13.28, 1.2e-04},
    {"tube", 0.085, 0.001, 1.3422, 1.3e-04},
    {"tube", 0.085, 0.002, 6.2424, 1.0e-04},
    {"tube", 0.03, 0.001, 4.6874, 1.5e-04},
    {"tube", 0.03, 0.002, 19.401, 1.3e-04},
    {"torus", 0, 0.001, 8.643, 1.2e-04},
    {"torus", 0, 0.002, 30.523, 9.3e-05},
    {"torus", 90, 0.001, 5.5253, 8.7e-05},
    {"torus", 90, 0.002, 21.261, 7.5e-05},
    {"torus", 180, 0.001, 8.7869, 1.5e-04},
    {"torus", 180, 0.002, 33.99, 1.1e-04},
    {"bowl", 60, 0.001, 2.0496, 5.5e-04},
    {"bowl", 60, 0.002, 7.24, 6.0e-04},
    {"bowl", 90, 0.001, 0.8745, 5.4e-04},
    {"bowl", 90, 0.002, 3.9839, 4.4e-04},
    {"sphere", 40, 0.001, 11.113, 1.1e-04},
    {"sphere", 40, 0.002, 36.631, 7.7e-05},
    {"sphere", 70, 0.001, 11.308, 1.0e-04},
    {"sphere", 70, 0.002, 37.83, 7.4e-05},
    {"waist", 0, 0.001, 4.9221, 7.4e-05},
    {"waist", 0, 0.002, 19.527, 6.9e-05},
    {"waist", 0.02, 0.001, 2.7792, 4.0e-05},
    {"waist", 0.02, 0.002, 10.685, 4.4e-05},
    {"cone", 0.03, 0.001, 5.341, 1.2e-04},
    {"cone", 0.03, 0.002, 22.224, 9.6e-05},
    {"cone", 0.045, 0.001, 5.2658, 1.2e-04},
    {"cone", 0.045, 0.002, 22.406, 9.2e-05},
    {"oblate", 40, 0.001, 6.4669, 7.6e-05},
    {"oblate", 40, 0.002, 22.66, 5.8e-05},
    {"oblate", 70, 0.001, 11.384, 1.2e-04},
    {"oblate", 70, 0.002, 38.835, 9.1e-05},
    {"prolate", 45, 0.001, 8.4872, 1.3e-04},
    {"prolate", 45, 0.002, 23.91, 1.3e-04},
    {"prolate", 80, 0.001, 6.6078, 9.6e-05},
    {"prolate", 80, 0.002, 21.857, 9.5e-05},
}};

} // namespace palp
