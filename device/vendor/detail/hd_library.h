#pragma once
#include <memory>
#include <string>

namespace palp {

/// An error of the library, as it returns it.
struct HdError {
    unsigned code;
    int      internal;
    unsigned device;
};

using HdCallback = unsigned (*)(void*); ///< returns kHdAgain or kHdDone

/// The functions of OpenHaptics' library that are used, by their own names.
struct HdLibrary {
    unsigned (*hdInitDevice)(const char*); ///< null: the default one
    void (*hdDisableDevice)(unsigned);
    void (*hdMakeCurrentDevice)(unsigned);
    void (*hdBeginFrame)(unsigned);
    void (*hdEndFrame)(unsigned);
    void (*hdEnable)(unsigned);
    void (*hdDisable)(unsigned);
    void (*hdGetDoublev)(unsigned, double*);
    void (*hdGetIntegerv)(unsigned, int*);
    void (*hdSetDoublev)(unsigned, const double*);
    const char* (*hdGetString)(unsigned);
    HdError (*hdGetError)();
    const char* (*hdGetErrorString)(unsigned);
    unsigned (*hdCheckCalibration)();
    void (*hdUpdateCalibration)(unsigned);
    void (*hdStartScheduler)();
    void (*hdStopScheduler)();
    unsigned long (*hdScheduleAsynchronous)(HdCallback, void*, unsigned short);
    void (*hdUnschedule)(unsigned long);

    std::string place; ///< where it was found
};

inline constexpr unsigned kHdNoDevice = 0xFFFFFFFF, kHdDone = 0, kHdAgain = 1;

// Numbers of the library's header hdDefines.h.
enum HdName : unsigned {
    kHdButtons       = 0x2000, // bit i: button i + 1
    kHdPosition      = 0x2050, // [mm]
    kHdVelocity      = 0x2051, // [mm/s]
    kHdTurning       = 0x2053, // [rad/s]
    kHdTransform     = 0x2052, // 16 numbers by columns
    kHdModel         = 0x2501,
    kHdSerial        = 0x2504,
    kHdStyles        = 0x2555, // of calibration, a sum of HdStyle
    kHdMostStiffness = 0x2602, // [N/mm]
    kHdMostForce     = 0x2603, // [N]
    kHdForce         = 0x2700, // [N]
    kHdOutput        = 0x4000,
    kHdClamping      = 0x4001,
    kHdRamping       = 0x4002,
    kHdWarm          = 0x200, // errors from here on
    kHdTooStrong     = 0x201,
    kHdImpulse       = 0x202,
    kHdTooFast       = 0x203,
    kHdForceError    = 0x204, // the last of the errors of forces
    kHdFault         = 0x300,
    kHdLine          = 0x302,
    kHdTimer         = 0x304,
    kHdLicence       = 0x600,
    kHdCalibrated    = 0x5000,
    kHdUpdate        = 0x5001,
    kHdByHand        = 0x5002
};

/// Ways of calibration, for hdUpdateCalibration().
enum HdStyle : unsigned { kHdReset = 1, kHdAuto = 2, kHdInkwell = 4 };

/// Opens it: in $OPENHAPTICS, or where the system's loader looks.
/// \throws Error saying where it was looked for, or what it lacks
[[nodiscard]] std::unique_ptr<const HdLibrary> loadHd();

} // namespace palp
