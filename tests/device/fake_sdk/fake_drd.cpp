// A stand-in of Force Dimension's library: the functions that the driver takes, by their names.
#include <cmath>

#include "tests/device/fake_sdk/fake_sdk.h"

using palp::FakeSdk;

namespace {

FakeSdk& sdk()
{
    static FakeSdk own;
    return own;
}

int result()
{
    ++sdk().calls;
    return sdk().error != 0 || !sdk().isPresent ? -1 : 0;
}

int read(double* x, double* y, double* z, const std::atomic<double> (&from)[3])
{
    if (result() < 0) return -1;
    *x = sdk().isOutOfNumbers ? std::nan("") : from[0].load();
    *y = from[1];
    *z = from[2];
    return sdk().isSame ? 1 : 0;
}

} // namespace

extern "C" {
FakeSdk* fakeSdk()
{
    return &sdk();
}
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision)
{
    *major = 3, *minor = 17, *release = 5, *revision = 0;
}
int dhdGetDeviceCount()
{
    return sdk().isPresent ? 1 : 0;
}
int dhdOpenID(char index)
{
    if (sdk().error != 0 || index != 0) return -1;
    sdk().isRobot = false;
    ++sdk().opened;
    return 4;
}
int dhdClose(char id)
{
    if (id != 4 || sdk().isRobot) return -1;
    ++sdk().closed;
    return 0;
}
int drdOpenID(char index)
{
    if (sdk().error != 0 || index != 0 || !sdk().knowsDrd) return -1;
    sdk().isRobot = true;
    ++sdk().opened;
    return 4;
}
int drdClose(char id)
{
    if (id != 4 || !sdk().isRobot) return -1;
    ++sdk().closed;
    return 0;
}
int dhdGetSystemType(char)
{
    return sdk().type;
}
const char* dhdGetSystemName(char)
{
    return "omega.3";
}
int dhdGetSerialNumber(unsigned short* serial, char)
{
    *serial = 1234;
    return 0;
}
int dhdGetPosition(double* x, double* y, double* z, char)
{
    return read(x, y, z, sdk().position);
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char)
{
    return read(x, y, z, sdk().velocity);
}
int dhdGetOrientationFrame(double frame[3][3], char)
{
    const double quarter[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}; // about their z, which points up
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) frame[row][column] = quarter[row][column];
    return result();
}
unsigned dhdGetButtonMask(char)
{
    return 1;
}
int dhdEnableForce(unsigned char on, char)
{
    sdk().isForceOn = on != 0;
    sdk().status    = 0;
    sdk().enabled += on != 0 ? 1 : 0;
    return result();
}
int dhdSetBrakes(int on, char)
{
    sdk().areBrakesOn = on != 0;
    return result();
}
#ifndef PALPATE_FAKE_OLD
int dhdSetGravityCompensation(int on, char)
{
    sdk().isBalanced = on != 0;
    return -1; // as of a Falcon
}
#endif
int dhdSetForceAndTorqueAndGripperForce(double x, double y, double z, double, double, double, double, char)
{
    if (result() < 0) return -1;
    sdk().force[0] = x;
    sdk().force[1] = y;
    sdk().force[2] = z;
    return 2; // saturated: no error
}
#ifndef PALPATE_FAKE_OLD
int dhdSetMaxForce(double, char)
{
    return result();
}
#endif
int dhdGetStatus(int* status, char)
{
    for (int n = 0; n < 17; ++n) status[n] = 0;
    status[0] = sdk().hasPower ? 1 : 0;
    status[2] = 1;
    if (!sdk().isReady) sdk().isForceOn = false; // a reset ends the force
    status[5]  = sdk().isForceOn ? 1 : 0;
    status[6]  = sdk().areBrakesOn ? 1 : 0;
    status[9]  = sdk().isBroken ? 1 : 0;
    status[1]  = sdk().isPresent ? 1 : 0;
    status[3]  = sdk().isReady ? 0 : 1;
    status[14] = sdk().status;
    return 0;
}
int dhdStop(char)
{
    for (auto& axis : sdk().force) axis = 0;
    sdk().isForceOn = false;
    return 0;
}
const char* dhdErrorGetLastStr()
{
    return "the error of a test";
}
bool drdIsInitialized(char)
{
    return sdk().isRobot && sdk().isReady;
}
int drdAutoInit(char)
{
    if (!sdk().isRobot) return -1;
    ++sdk().calibrated;
    sdk().isReady = true;
    return result();
}
int drdStop(bool, char)
{
    return sdk().isRobot ? result() : -1;
}
}
