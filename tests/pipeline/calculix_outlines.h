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

inline constexpr std::array<CalculixOutline, 22> kCalculixOutlines{{
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
    {"arch", 48.242, 9.6e-03},
    {"arch at its border", 36.812, 9.2e-03},
    {"deep arch", 30.145, 1.8e-02},
    {"curled strip", 0.30108, 9.1e-03},
    {"gutter", 4.9204, 3.2e-03},
    {"gutter at its tip", 0.69099, 1.5e-03},
    {"corrugated strip", 0.67901, 1.3e-02},
    {"corrugated flank", 8.5224, 2.2e-02},
    {"j at its tip", 0.14007, 7.2e-03},
    {"s in its middle", 7.2447, 1.1e-02},
    {"trough at its side", 0.7396, 6.9e-03},
    {"cap on a segment", 3.0758, 2.0e-02},
}};

/// How deep it gives way under even parts of a force.
struct CalculixDeepOutline {
    std::string_view name;
    double           force; ///< of the last depth [N]

    std::array<double, 10> depths; ///< on the finer mesh, whose error is that above [m]
};

inline constexpr std::array<CalculixDeepOutline, 4> kCalculixDeepOutlines{{
    {"arch",
     0.07,
     {0.0001502, 0.000317, 0.0005015, 0.0007075, 0.0009386, 0.001199, 0.00149, 0.001815, 0.00217, 0.002547}},
    {"arch at its border",
     0.05,
     {0.0001425, 0.0003037, 0.0004885, 0.0007043, 0.000961, 0.001273, 0.001657, 0.002131, 0.002699, 0.003345}},
    {"deep arch",
     0.055,
     {0.0001846, 0.0003836, 0.0005962, 0.0008248, 0.001071, 0.001337, 0.001625, 0.001936, 0.002272, 0.002635}},
    {"cap on a segment",
     0.006,
     {0.0001928, 0.0003981, 0.0006098, 0.0008304, 0.00106, 0.0013, 0.001548, 0.001806, 0.002072, 0.002346}},
}};

} // namespace palp
