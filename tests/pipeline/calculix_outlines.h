#pragma once
#include <array>
#include <string_view>

// Made by calculix_outlines.py, which says how: CalculiX 2.20, C3D20R and C3D15.

namespace palp {

/// The stiffness of a curved sheet of some outline under a fingertip.
struct CalculixOutline {
    std::string_view name;
    double           stiffness; ///< 1/c [N/m]
    double           meshError; ///< of c on the finer mesh, which is taken off [1]
};

inline constexpr std::array<CalculixOutline, 10> kCalculixOutlines{{
    {"u dome", 0.68283, 8.4e-03},
    {"u vault", 1.0433, 4.2e-03},
    {"l dome", 3.0811, 2.8e-03},
    {"strip dome", 23.339, 2.2e-03},
    {"ring dome", 4.9626, 4.6e-03},
    {"holes dome", 63.156, 1.6e-03},
    {"gentle lump", 19.617, 1.0e-02},
    {"steep lump", 13.83, 1.1e-02},
    {"small lump", 10.978, 9.5e-03},
    {"beside a lump", 11.372, 8.6e-03},
}};

} // namespace palp
