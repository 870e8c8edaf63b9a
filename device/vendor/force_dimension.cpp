#include "device/vendor/force_dimension.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "device/vendor/detail/drd_device.h"
#include "device/vendor/detail/drd_library.h"
#include "engine/core/contract.h"

// source: the names, types and results of the functions as Force Dimension's header dhdc.h declares them, the order of
// the calls at start and end as its clients have it; limits of the types as CHAI3D's table has them.
namespace palp {
namespace {

constexpr std::array kOptions{kForceDimensionInit};

constexpr double kMostForce = 12;    ///< [N] that the library lets through, beyond what the governor does
constexpr int    kSame      = 1;     ///< of a read: the sample is that of the last read (TIMEGUARD)
constexpr double kDeaf      = 20e-3; ///< [s] of calls that fail, after which it is told to stop: it may hold a force
constexpr double kSettle    = 0.1;   ///< [s] at zero force before the first sample

enum Status : std::size_t {
    kPower     = 0,
    kConnected = 1,
    kStarted   = 2,
    kForce     = 5,
    kBrake     = 6,
    kError     = 9,
    kForceOff  = 14
};

/// Why the device itself has switched the force off, by its status.
const char* reasonOf(int cause) noexcept
{
    switch (cause) {
    case 1:
        return "the force was switched off by the button on the device";
    case 2:
        return "the device stopped because it was moved too fast";
    case 3:
        return "the device's watchdog acted: it was sent nothing for too long";
    case 4:
        return "another program switched the force off";
    case 5:
        return "the device stopped because its USB line was interrupted";
    case 6:
        return "the dead man's switch is not held";
    default:
        return "the device switched its force off";
    }
}

/// Returns why the device makes no force, by all its status; an empty text if it can.
/// \param isOn  its motors were switched on: only then are brakes and a force that is off a reason
const char* reasonOf(const DrdStatus& status, bool isOn) noexcept
{
    if (status[kPower] == 0) return "the device has no power; see its supply";
    if (status[kError] != 0) return "the device reports an error; switch it off and on again";
    if (!isOn) return "";
    if (status[kForceOff] != 0) return reasonOf(status[kForceOff]);
    if (status[kBrake] != 0) return "the device's brakes are on";
    return status[kForce] == 0 ? "the device's force is off" : "";
}

/// Returns whether a person or another program wants the force to be off: then it is theirs to switch on again.
bool isWanted(int cause) noexcept
{
    return cause == 1 || cause == 4 || cause == 6;
}

/// Their x points to the user, y right, z up.
glm::dvec3 toOurs(const glm::dvec3& v) noexcept
{
    return {v.y, v.z, v.x};
}
glm::dvec3 toTheirs(const glm::dvec3& v) noexcept
{
    return {v.z, v.x, v.y};
}

/// Turns a rotation of their frame, by rows, into one of ours.
glm::dquat turnOf(const double (&rows)[3][3]) noexcept
{
    glm::dmat3 ours(1);
    for (int column = 0; column < 3; ++column) {
        glm::dvec3 axis{};
        axis[column]           = 1;
        const glm::dvec3 their = toTheirs(axis);
        glm::dvec3       turned{};
        for (int row = 0; row < 3; ++row)
            turned[row] = rows[row][0] * their.x + rows[row][1] * their.y + rows[row][2] * their.z;
        ours[column] = toOurs(turned);
    }
    const glm::dquat turn = glm::quat_cast(ours);
    const double     size = glm::length(turn);
    return size > 0.9 && size < 1.1 ? turn / size : glm::dquat(1, 0, 0, 0);
}

/// What is known of a type of device.
struct Row {
    int    type;
    double force, stiffness, damping, radius; ///< [N], [N/m], [N s/m], [m]
    bool   rotates, grips;
};
constexpr Row kRows[] = {{33, 12, 5000, 30, 0.075, false, false},      {34, 12, 5000, 30, 0.075, true, false},
                         {36, 12, 5000, 30, 0.075, true, false},       {35, 12, 5000, 30, 0.075, true, true},
                         {37, 12, 5000, 30, 0.075, true, true},        {63, 20, 5000, 30, 0.15, false, false},
                         {104, 12, 4000, 30, 0.075, true, true},       {105, 12, 4000, 30, 0.075, true, true},
                         {206, 12, 4000, 30, 0.075, false, false},     {108, 12, 8000, 30, 0.1125, true, true},
                         {109, 12, 8000, 30, 0.1125, true, true},      {131, 12, 8000, 30, 0.1125, true, false},
                         {132, 12, 8000, 30, 0.1125, true, false},     {203, 12, 8000, 30, 0.1125, false, false},
                         {kDrdFalcon, 8, 3000, 20, 0.04, false, false}};
constexpr Row kWeakest{-1, 8, 3000, 20, 0.04, false, false}; ///< the least of each column

bool isKnownType(int type) noexcept
{
    return std::ranges::find(kRows, type, &Row::type) != std::end(kRows);
}

class ForceDimensionLine : public DeviceLine {
public:
    explicit ForceDimensionLine(const ForceDimensionSettings& settings) : settings_(settings) {}
    ~ForceDimensionLine() override { close(); }

    void open(HapticDeviceInfo& info) override;
    void exchange(const LineOrder& order, LineSample& sample) noexcept override;
    void close() noexcept override;

private:
    bool               switchOn() noexcept;
    void               switchOff() noexcept;
    [[nodiscard]] bool render(const glm::dvec3& force) noexcept;
    [[nodiscard]] int  readHand(LineSample& sample) noexcept;
    bool               readStatus(const LineOrder& order, LineSample& sample) noexcept;
    [[noreturn]] void  refuse(const std::string& what);

    ForceDimensionSettings            settings_;
    std::unique_ptr<const DrdLibrary> drd_;
    DrdDevice                         device_;
    bool                              isHomed_ = false; ///< its motors are on only then
    std::optional<double>             failing_;         ///< [s] since when each exchange fails
    std::optional<double> off_; ///< [s] since when the device, which has switched it off, is asked for no force
};

void ForceDimensionLine::refuse(const std::string& what)
{
    const char*       why  = drd_->dhdErrorGetLastStr();
    const std::string text = why ? why : "unknown error";
    close();
    throw Error("Force Dimension: " + what + ": " + text);
}

void ForceDimensionLine::open(HapticDeviceInfo& info)
{
    try {
        drd_ = loadDrd();
    } catch (const Error& error) {
        throw Error(std::string("Force Dimension's SDK cannot be used: ") + error.what() +
                    "; install their SDK 3 and set FORCEDIM_SDK to its folder");
    }
    failing_.reset();
    off_.reset();
    if (const int count = drd_->dhdGetDeviceCount(); count <= settings_.index)
        throw Error("Force Dimension: device number " + std::to_string(settings_.index) + " was asked for, and " +
                    std::to_string(std::max(0, count)) +
                    " are plugged in; switch it on, and see that a udev rule for vendor 1451 lets you open it");
    device_ = openDrd(*drd_, settings_.index);
    if (device_.id < 0) refuse("device number " + std::to_string(settings_.index) + " cannot be opened");
    const auto        id    = char(device_.id);
    const char* const name  = drd_->dhdGetSystemName(id);
    const bool        isSim = info.isSimulation;
    const int         type  = device_.type;
    info                    = forceDimensionInfo(type);
    info.isSimulation       = isSim;
    if (!isKnownType(type))
        info.note =
            "its type, " + std::to_string(type) + " to its library, is unknown here: it is limited as the weakest";
    if (name) info.model = std::string("Force Dimension ") + name;
    info.path             = std::to_string(settings_.index);
    unsigned short serial = 0;
    if (drd_->dhdGetSerialNumber(&serial, id) >= 0) info.serial = std::to_string(serial);
    info.hasGripper = info.hasGripper && drd_->dhdGetGripperAngleRad;

    if (settings_.mayInitialise && device_.isRobot && type != kDrdFalcon && !isHomed(*drd_, device_)) {
        if (drd_->drdAutoInit(id) < 0) refuse("the arm did not find its stops");
        drd_->drdStop(true, id); // ends the movement, keeps the motors
    }
    if (drd_->dhdSetMaxForce) drd_->dhdSetMaxForce(std::min(kMostForce, info.maximumForce), id);
    isHomed_ = isHomed(*drd_, device_);
    if (isHomed_ && !switchOn()) refuse("its motors cannot be switched on");
    if (isHomed_ && !render({})) refuse("it takes no forces");
    std::this_thread::sleep_for(std::chrono::duration<double>(kSettle));
}

/// Lets go of the brakes and switches the motors on. Only for an arm that knows where it is: the compensation of
/// gravity pushes by what the encoders say.
bool ForceDimensionLine::switchOn() noexcept
{
    const auto id = char(device_.id);
    drd_->dhdSetBrakes(0, id);
    const bool isOn = drd_->dhdEnableForce(1, id) >= 0;
    drd_->dhdSetGravityCompensation(1, id); // a Falcon has none, and says so
    return isOn;
}

void ForceDimensionLine::switchOff() noexcept
{
    static_cast<void>(render({}));
    drd_->dhdSetGravityCompensation(0, char(device_.id));
    drd_->dhdEnableForce(0, char(device_.id));
}

bool ForceDimensionLine::render(const glm::dvec3& force) noexcept
{
    const glm::dvec3 f      = toTheirs(force);
    const int        result = drd_->dhdSetForceAndTorqueAndGripperForce(f.x, f.y, f.z, 0, 0, 0, 0, char(device_.id));
    return result >= 0; // 2: the motors are saturated and give less
}

/// \return 0: a new sample; 1: the same again; below 0: an error
int ForceDimensionLine::readHand(LineSample& sample) noexcept
{
    const auto id = char(device_.id);
    glm::dvec3 place{}, speed{};
    double     turn[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double     angle      = 0;
    const int  isPlaced   = drd_->dhdGetPosition(&place.x, &place.y, &place.z, id);
    if (isPlaced < 0 || isPlaced == kSame) return isPlaced;
    if (drd_->dhdGetLinearVelocity(&speed.x, &speed.y, &speed.z, id) < 0) return -1;
    if (drd_->dhdGetOrientationFrame(turn, id) < 0) return -1;
    if (drd_->dhdGetGripperAngleRad && drd_->dhdGetGripperAngleRad(&angle, id) >= 0) sample.gripperAngle = angle;
    sample.position    = toOurs(place);
    sample.velocity    = toOurs(speed);
    sample.orientation = turnOf(turn);
    sample.buttons     = drd_->dhdGetButtonMask(id);
    return 0;
}

/// Reads what the device says of itself. Its motors go on once it knows where its arm is. A force that it has switched
/// off by itself is switched on again once it was asked for none for a while; one that somebody has switched off is
/// not.
/// \return false if it says nothing
bool ForceDimensionLine::readStatus(const LineOrder& order, LineSample& sample) noexcept
{
    const auto id = char(device_.id);
    DrdStatus  status{};
    status[kPower] = status[kConnected] = 1;
    if (drd_->dhdGetStatus(status.data(), id) < 0) return false;
    if (status[kConnected] == 0) {
        sample.fault = DeviceFault::unplugged;
        sample.words = "the device was unplugged or switched off";
        return true;
    }
    const bool wasHomed = std::exchange(isHomed_, isHomed(*drd_, device_, status));
    if (isHomed_ && !wasHomed) switchOn();
    if (!isHomed_ && wasHomed) switchOff();
    sample.homed      = isHomed_;
    sample.words      = reasonOf(status, isHomed_ && wasHomed); // of before they were switched on
    sample.fault      = *sample.words ? DeviceFault::ownWatchdog : DeviceFault::none;
    const bool mayTry = sample.fault != DeviceFault::none && isHomed_ && !isWanted(status[kForceOff]) && !order.enable;
    if (!mayTry) off_.reset();
    if (mayTry && settings_.clock() - *(off_ = off_.value_or(settings_.clock())) >= settings_.restToTry) {
        off_.reset();
        switchOn();
    }
    return true;
}

void ForceDimensionLine::exchange(const LineOrder& order, LineSample& sample) noexcept
{
    if (device_.id < 0) return;
    const bool isTaken = !isHomed_ || render(order.force);
    const int  isRead  = readHand(sample);
    sample.news        = isRead == 0 ? LineNews::sample : LineNews::none;
    const bool isTold  = readStatus(order, sample);
    if (isTaken && isRead >= 0 && isTold)
        failing_.reset();
    else if (!failing_)
        failing_ = settings_.clock();
    const double past = failing_ ? settings_.clock() - *failing_ : 0;
    if (past < kDeaf || isFinal(sample.fault)) return;
    static_cast<void>(render({})); // the device may still hear
    drd_->dhdStop(char(device_.id));
    if (past < settings_.mostErrors) return;
    sample.fault = DeviceFault::linkLost;
    sample.words = "each call of Force Dimension's library fails; see its cable, and plug it in again";
}

void ForceDimensionLine::close() noexcept
{
    if (device_.id < 0) return;
    static_cast<void>(render({}));
    drd_->dhdStop(char(device_.id));
    closeDrd(*drd_, device_);
}

// --- the record

std::vector<DeviceListing> list(HidSystem& /*hid*/)
{
    std::unique_ptr<const DrdLibrary> drd;
    try {
        drd = loadDrd();
    } catch (const Error&) { // without the library there are no devices
        return {};
    }
    std::vector<DeviceListing> devices;
    for (int n = 0; n < drd->dhdGetDeviceCount(); ++n) {
        DeviceListing listing{.path = std::to_string(n)};
        if (DrdDevice device = openDrd(*drd, n); device.id >= 0) {
            const char* name = drd->dhdGetSystemName(char(device.id));
            listing.model    = std::string("Force Dimension ") + (name ? name : "device");
            listing.usable   = true;
            listing.answers  = isHomed(*drd, device);
            if (!listing.answers) { // and no rate is measured of it
                listing.why  = device.type == kDrdFalcon ? "it is not homed" : "it has not been reset";
                listing.help = device.type == kDrdFalcon
                                   ? "pull its grip all the way out, then push it all the way in"
                                   : "press its RESET button, or use " + std::string(kForceDimensionInit.flag);
            }
            closeDrd(*drd, device);
        } else {
            const char* why = drd->dhdErrorGetLastStr();
            listing.model   = "Force Dimension device";
            listing.why     = why ? why : "it cannot be opened";
            listing.help    = "add a udev rule for vendor 1451, and end other programs that use it";
        }
        devices.push_back(std::move(listing));
    }
    return devices;
}

std::unique_ptr<HapticDevice> make(const DeviceRequest& request)
{
    ForceDimensionSettings settings;
    settings.mayInitialise = !textOf(request.options, kForceDimensionInit).empty();
    if (!request.path.empty()) {
        if (request.path.size() > 2 || request.path.find_first_not_of("0123456789") != std::string::npos)
            throw Error("forcedimension: expected a device's number from 0 to 99, found \"" + request.path + "\"");
        settings.index = std::stoi(request.path);
    }
    return std::make_unique<LineDevice>(makeForceDimensionLine(settings), forceDimensionInfo(0));
}

DeviceSupport support()
{
    constexpr const char* kLibrary = "libdrd.so of Force Dimension's SDK";
    try {
        static_cast<void>(loadDrd());
        return {true, kLibrary, ""};
    } catch (const Error&) {
        return {true, std::string(kLibrary) + " (not found; see FORCEDIM_SDK)", ""};
    }
}

std::vector<Finding> findings()
{
    const char* part = "forcedimension sdk";
    try {
        const std::unique_ptr<const DrdLibrary> drd = loadDrd();
        int                                     v[4]{};
        drd->dhdGetSDKVersion(&v[0], &v[1], &v[2], &v[3]);
        return {{part, Verdict::ok,
                 "version " + std::to_string(v[0]) + "." + std::to_string(v[1]) + "." + std::to_string(v[2])}};
    } catch (const Error& error) {
        const std::string why = error.what();
        if (why.find(" lacks ") != std::string::npos) return {{part, Verdict::missing, why, "install their SDK 3"}};
        return {{part, Verdict::ok, "not found; an omega, delta, sigma or lambda needs it, nothing else does"}};
    }
}

} // namespace

const DeviceRecord kForceDimensionRecord{.name     = "forcedimension",
                                         .model    = "Force Dimension omega, delta, sigma or lambda",
                                         .options  = kOptions,
                                         .list     = list,
                                         .make     = make,
                                         .support  = support,
                                         .findings = findings};

HapticDeviceInfo forceDimensionInfo(int type)
{
    const auto       found = std::ranges::find(kRows, type, &Row::type);
    const Row&       row   = found == std::end(kRows) ? kWeakest : *found;
    HapticDeviceInfo info;
    info.model            = "Force Dimension device";
    info.workspaceRadius  = row.radius;
    info.maximumForce     = row.force;
    info.maximumStiffness = row.stiffness;
    info.maximumDamping   = row.damping;
    info.buttons          = 8;
    info.needsHoming      = true;
    info.homing =
        type == kDrdFalcon ? "" : "press its RESET button, or start again with --forcedimension-init, hands off";
    info.rotates    = row.rotates;
    info.hasGripper = row.grips;
    return info;
}

std::unique_ptr<DeviceLine> makeForceDimensionLine(const ForceDimensionSettings& settings)
{
    return std::make_unique<ForceDimensionLine>(settings);
}

} // namespace palp
