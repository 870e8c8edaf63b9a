#pragma once
#include <cmath>
#include <memory>
#include <string>

// A stand-in of CHAI3D for the tests of samples/chai3d: the virtual functions of its device class, its table of
// specifications, and as much of its vectors and matrices. Nothing of CHAI3D is in it.
namespace chai3d {

enum cHapticDeviceModel { C_HAPTIC_DEVICE_VIRTUAL, C_HAPTIC_DEVICE_CUSTOM };

class cVector3d {
public:
    cVector3d() = default;
    cVector3d(double x, double y, double z) : v_{x, y, z} {}
    [[nodiscard]] double x() const { return v_[0]; }
    [[nodiscard]] double y() const { return v_[1]; }
    [[nodiscard]] double z() const { return v_[2]; }

private:
    double v_[3]{};
};

class cMatrix3d {
public:
    double&              operator()(int row, int column) { return m_[row][column]; }
    [[nodiscard]] double operator()(int row, int column) const { return m_[row][column]; }

private:
    double m_[3][3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

struct cHapticDeviceInfo {
    cHapticDeviceModel m_model = C_HAPTIC_DEVICE_VIRTUAL;
    std::string        m_modelName, m_manufacturerName;
    double             m_maxLinearForce = 0, m_maxLinearStiffness = 0, m_maxLinearDamping = 0, m_workspaceRadius = 0;
    bool m_sensedPosition = false, m_sensedRotation = false, m_sensedGripper = false, m_actuatedPosition = false;
    bool m_actuatedRotation = false, m_actuatedGripper = false, m_leftHand = false, m_rightHand = false;
};

class cGenericHapticDevice {
public:
    virtual ~cGenericHapticDevice() = default;
    virtual bool open() { return false; }
    virtual bool close() { return false; }
    virtual bool calibrate(bool /*again*/ = false) { return m_deviceReady; }
    virtual bool getPosition(cVector3d& /*to*/) { return m_deviceReady; }
    virtual bool getLinearVelocity(cVector3d& /*to*/) { return m_deviceReady; }
    virtual bool getRotation(cMatrix3d& /*to*/) { return m_deviceReady; }
    virtual bool getAngularVelocity(cVector3d& /*to*/) { return m_deviceReady; }
    virtual bool getGripperAngleRad(double& /*to*/) { return m_deviceReady; }
    virtual bool getForce(cVector3d& /*to*/) { return m_deviceReady; }
    virtual bool getUserSwitch(int /*which*/, bool& /*to*/) { return m_deviceReady; }
    virtual bool getUserSwitches(unsigned int& /*to*/) { return m_deviceReady; }
    virtual bool setForceAndTorqueAndGripperForce(const cVector3d&, const cVector3d&, double) { return m_deviceReady; }
    cHapticDeviceInfo getSpecifications() { return m_specifications; }

    cHapticDeviceInfo m_specifications;

protected:
    bool m_deviceReady = false;
};
using cGenericHapticDevicePtr = std::shared_ptr<cGenericHapticDevice>;

} // namespace chai3d
