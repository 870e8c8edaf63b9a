#pragma once
#include <memory>
#include <string>

namespace palp {

/// The functions of Force Dimension's library that are used, by their own names. Its last argument says which device.
/// Most return 0, or -1 for an error; see the comments for the others.
struct DrdLibrary {
    void (*dhdGetSDKVersion)(int*, int*, int*, int*);
    int (*dhdGetDeviceCount)();
    int (*drdOpenID)(char); ///< by index; returns the device's number, which the functions drd* know from then on
    int (*drdClose)(char);
    int (*dhdOpenID)(char); ///< likewise, of a device that the functions drd* do not know
    int (*dhdClose)(char);
    int (*dhdGetSystemType)(char);
    const char* (*dhdGetSystemName)(char);
    int (*dhdGetSerialNumber)(unsigned short*, char);
    int (*dhdGetPosition)(double*, double*, double*, char);       ///< [m]; 1: the same sample as before
    int (*dhdGetLinearVelocity)(double*, double*, double*, char); ///< [m/s]; likewise
    int (*dhdGetOrientationFrame)(double (*)[3], char);           ///< rows of a rotation; likewise
    unsigned (*dhdGetButtonMask)(char);
    int (*dhdEnableForce)(unsigned char, char);
    int (*dhdSetBrakes)(int, char);
    int (*dhdSetGravityCompensation)(int, char);
    /// [N] x 3, [N m] x 3, [N]; 2: the motors are saturated
    int (*dhdSetForceAndTorqueAndGripperForce)(double, double, double, double, double, double, double, char);
    int (*dhdGetStatus)(int*, char); ///< of kDrdStatus numbers
    int (*dhdStop)(char);
    const char* (*dhdErrorGetLastStr)();
    bool (*drdIsInitialized)(char);
    int (*drdAutoInit)(char);
    int (*drdStop)(bool, char);
    // Null in a library without them.
    int (*dhdSetMaxForce)(double, char);         ///< [N]; version 3.7 has none
    int (*dhdGetGripperAngleRad)(double*, char); ///< [rad]

    std::string place; ///< where it was found
};

inline constexpr int kDrdStatus = 32; ///< room for the numbers of a status; versions of the library write 16 to 17

/// Opens it: in $FORCEDIM_SDK or $FDSDK, in ~/.local/lib and /usr/local/lib, or where the system's loader looks.
/// \throws Error saying where it was looked for, or what it lacks
[[nodiscard]] std::unique_ptr<const DrdLibrary> loadDrd();

} // namespace palp
