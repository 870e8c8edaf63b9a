#include "device/vendor/open_haptics.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <list>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "device/vendor/detail/hd_library.h"
#include "engine/core/contract.h"

// source: names, numbers and results as OpenHaptics' headers hdDefines.h, hdDevice.h and hdScheduler.h declare them;
// limits of the models as CHAI3D's table has them.
namespace palp {
namespace {

constexpr double         kMetre    = 1e-3;   ///< [m] of a millimetre, the library's unit
constexpr unsigned short kPriority = 0xFFFF; ///< of the callback: the scheduler's highest

/// What the library's thread calls. It is never freed: a scheduler may call late.
struct Beat {
    std::function<void()> turn;
    std::atomic<bool>     isOver{false};
    std::atomic<bool>     isBusy{false}; ///< a callback runs
};

Beat& newBeat()
{
    static std::mutex       mutex;
    static std::list<Beat>& all = *new std::list<Beat>; // outlives every thread
    const std::lock_guard   lock(mutex);
    return all.emplace_back();
}

/// The scheduler's callback. One that comes while another still runs does nothing.
unsigned beat(void* data)
{
    Beat& own = *static_cast<Beat*>(data);
    if (own.isBusy.exchange(true)) return own.isOver ? kHdDone : kHdAgain;
    if (!own.isOver) own.turn();
    own.isBusy = false;
    return own.isOver ? kHdDone : kHdAgain;
}

/// Words for an error while forces flow; null: the link is lost, or it is none.
const char* wordsOf(unsigned code) noexcept
{
    switch (code) {
    case kHdWarm:
        return "the motors are too warm; let them cool";
    case kHdTooStrong:
        return "the device refused a force that is too strong for it";
    case kHdImpulse:
        return "the device refused a force that rose too fast";
    case kHdTooFast:
        return "the device stopped because it was moved too fast";
    case kHdForceError:
        return "the device could not make the force";
    case kHdTimer:
        return "the library's scheduler did not run in time";
    default:
        return nullptr;
    }
}

/// Returns whether the link is lost by an error.
bool isEnd(unsigned code) noexcept
{
    return code == kHdLine || code == kHdFault || code == kHdLicence;
}

/// Returns how bad an error is: 0 none, 1 it changes nothing, 2 it takes the force, 3 it ends the link.
int rankOf(unsigned code) noexcept
{
    if (isEnd(code)) return 3;
    return wordsOf(code) ? 2 : code != 0 ? 1 : 0;
}

class OpenHapticsLine : public DeviceLine {
public:
    explicit OpenHapticsLine(OpenHapticsSettings settings) : settings_(std::move(settings)) {}
    ~OpenHapticsLine() override { close(); }

    void open(HapticDeviceInfo& info) override;
    void exchange(const LineOrder& order, LineSample& sample) noexcept override;
    void close() noexcept override;
    bool drive(const std::function<void()>& turn) override;

private:
    void                   describe(HapticDeviceInfo& info);
    void                   calibrate() noexcept;
    void                   readHand(LineSample& sample) noexcept;
    [[nodiscard]] unsigned worstError() noexcept;
    void                   judge(unsigned code, const LineOrder& order, LineSample& sample) noexcept;
    [[nodiscard]] bool     waitFor(double seconds, const std::function<bool()>& done) const;

    OpenHapticsSettings              settings_;
    std::unique_ptr<const HdLibrary> hd_;
    unsigned                         device_    = kHdNoDevice; ///< kHdNoDevice: closed
    unsigned long                    scheduled_ = 0;
    Beat*                            beat_      = nullptr; ///< null: no callback is scheduled
    bool                             isHomed_   = false;
    double                           looked_    = 0; ///< [s] of the last look at the calibration
    std::optional<double>            off_;           ///< [s] since when it is asked for none, after one that it refused
    const char*                      refused_ = nullptr;
};

void OpenHapticsLine::open(HapticDeviceInfo& info)
{
    try {
        hd_ = loadHd();
    } catch (const Error& error) {
        throw Error(std::string("OpenHaptics cannot be used: ") + error.what() +
                    "; install OpenHaptics and the Touch driver, or set OPENHAPTICS to the folder of libHD.so");
    }
    refused_ = nullptr;
    off_.reset();
    static_cast<void>(worstError()); // of before
    device_             = hd_->hdInitDevice(settings_.name.empty() ? nullptr : settings_.name.c_str());
    const HdError error = hd_->hdGetError();
    if (device_ == kHdNoDevice || error.code != 0) {
        const char* why = hd_->hdGetErrorString(error.code);
        if (device_ != kHdNoDevice) hd_->hdDisableDevice(device_); // it is open in spite of the error
        device_ = kHdNoDevice;
        throw Error(
            "OpenHaptics: " +
            (settings_.name.empty() ? std::string("the default device") : "the device \"" + settings_.name + "\"") +
            " cannot be opened: " + (why ? why : "unknown error") +
            (error.code == kHdLicence ? "; the library has no valid licence: install the one that came with OpenHaptics"
                                      : "; see that their setup program finds it, and try without a name"));
    }
    hd_->hdMakeCurrentDevice(device_);
    describe(info);
    constexpr std::array<double, 3> kNone{};
    hd_->hdBeginFrame(device_);
    hd_->hdSetDoublev(kHdForce, kNone.data());
    hd_->hdEndFrame(device_);
    hd_->hdEnable(kHdClamping);
    hd_->hdEnable(kHdOutput);
    isHomed_ = hd_->hdCheckCalibration() == kHdCalibrated;
    looked_  = settings_.clock();
}

void OpenHapticsLine::describe(HapticDeviceInfo& info)
{
    const char* const model  = hd_->hdGetString(kHdModel);
    const char* const serial = hd_->hdGetString(kHdSerial);
    const bool        isSim  = info.isSimulation;
    info                     = openHapticsInfo(model ? model : "");
    info.isSimulation        = isSim;
    if (model) info.model = std::string("3D Systems ") + model;
    if (serial) info.serial = serial;
    info.path   = settings_.name;
    double most = 0; // [N]
    hd_->hdGetDoublev(kHdMostForce, &most);
    if (most > 0 && most < info.maximumForce) info.maximumForce = most;
    double stiffest = 0; // [N/mm]
    hd_->hdGetDoublev(kHdMostStiffness, &stiffest);
    if (stiffest > 0 && 1e3 * stiffest < info.maximumStiffness) info.maximumStiffness = 1e3 * stiffest;
}

bool OpenHapticsLine::drive(const std::function<void()>& turn)
{
    beat_                = &newBeat();
    beat_->turn          = turn;
    scheduled_           = hd_->hdScheduleAsynchronous(beat, beat_, kPriority);
    const auto isRefusal = [](unsigned found) { return found != 0 && !wordsOf(found); }; // not of a force
    unsigned   code      = worstError();
    if (!isRefusal(code)) {
        hd_->hdStartScheduler();
        code = worstError();
    }
    if (!isRefusal(code)) return true;
    const char* why = hd_->hdGetErrorString(code);
    close();
    throw Error(std::string("OpenHaptics: its scheduler does not start: ") + (why ? why : "unknown error") +
                "; end other programs that use the device, and see its cable");
}

/// Looks from time to time whether a device that is not calibrated can be or is by now, and whether one that was still
/// is. A calibration that could only be better (kHdUpdate) is left alone while it is in use: the hand would jump.
void OpenHapticsLine::calibrate() noexcept
{
    const double now = settings_.clock();
    if (!(now - looked_ >= settings_.secondsToLook)) return;
    looked_               = now;
    const unsigned state  = hd_->hdCheckCalibration();
    const bool     isKept = isHomed_ && state == kHdUpdate;
    isHomed_              = state == kHdCalibrated || isKept;
    if (state != kHdUpdate || isKept) return;
    int styles = 0;
    hd_->hdGetIntegerv(kHdStyles, &styles);
    const auto has = [&](HdStyle style) { return (unsigned(styles) & style) != 0; };
    hd_->hdUpdateCalibration(has(kHdAuto) ? kHdAuto : has(kHdInkwell) ? kHdInkwell : kHdReset);
}

void OpenHapticsLine::readHand(LineSample& sample) noexcept
{
    // Not a number where the library writes nothing: such a sample is not believed.
    const double           nan = std::nan("");
    std::array<double, 3>  place{nan, nan, nan}, speed{nan, nan, nan}, turning{};
    std::array<double, 16> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    int                    buttons = 0;
    hd_->hdGetDoublev(kHdPosition, place.data());
    hd_->hdGetDoublev(kHdVelocity, speed.data());
    hd_->hdGetDoublev(kHdTransform, transform.data());
    hd_->hdGetDoublev(kHdTurning, turning.data());
    hd_->hdGetIntegerv(kHdButtons, &buttons);
    sample.news            = LineNews::sample;
    sample.position        = kMetre * glm::dvec3(place[0], place[1], place[2]);
    sample.velocity        = kMetre * glm::dvec3(speed[0], speed[1], speed[2]);
    sample.angularVelocity = {turning[0], turning[1], turning[2]};
    sample.buttons         = unsigned(buttons);
    sample.homed           = isHomed_;
    glm::dmat3 turn(1);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) turn[column][row] = transform[std::size_t(4 * column + row)];
    sample.orientation = glm::quat_cast(turn);
}

/// Takes all errors that the library has kept, and returns the worst; 0 if there is none. It gives one at each call,
/// and several may come between two exchanges.
unsigned OpenHapticsLine::worstError() noexcept
{
    constexpr int kMostKept = 100; // a library that never says that there are no more must not hold the exchange
    unsigned      worst     = 0;
    for (int n = 0; n < kMostKept; ++n) {
        const unsigned code = hd_->hdGetError().code;
        if (code == 0) break;
        if (rankOf(code) >= rankOf(worst)) worst = code;
    }
    return worst;
}

/// Turns an error of the library into a fault. A force that it refused is switched on again once it was asked for none
/// for a while.
void OpenHapticsLine::judge(unsigned code, const LineOrder& order, LineSample& sample) noexcept
{
    if (isEnd(code)) {
        sample.fault = DeviceFault::linkLost;
        sample.words = code == kHdLicence ? "OpenHaptics' licence is no longer valid"
                                          : "the device no longer answers; see its cable and its light";
        sample.news  = LineNews::none;
        return;
    }
    if (const char* words = wordsOf(code)) {
        refused_ = words;
        off_.reset();
    }
    if (refused_ && !order.enable &&
        settings_.clock() - *(off_ = off_.value_or(settings_.clock())) >= settings_.restToTry) {
        refused_ = nullptr;
        hd_->hdEnable(kHdOutput);
    }
    sample.fault = refused_ ? DeviceFault::ownWatchdog : DeviceFault::none;
    sample.words = refused_ ? refused_ : "";
}

void OpenHapticsLine::exchange(const LineOrder& order, LineSample& sample) noexcept
{
    if (device_ == kHdNoDevice) return;
    const auto render = [&](const glm::dvec3& force) {
        const std::array<double, 3> newtons{force.x, force.y, force.z}; // their frame is ours
        hd_->hdSetDoublev(kHdForce, newtons.data());
    };
    hd_->hdMakeCurrentDevice(device_);
    hd_->hdBeginFrame(device_);
    readHand(sample);
    render(order.force);
    hd_->hdEndFrame(device_);
    judge(worstError(), order, sample);
    calibrate();
    if (!isFinal(sample.fault)) return;
    hd_->hdBeginFrame(device_); // the device may still hear
    render({});
    hd_->hdEndFrame(device_);
}

bool OpenHapticsLine::waitFor(double seconds, const std::function<bool()>& done) const
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!done()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

void OpenHapticsLine::close() noexcept
{
    constexpr double kPatience = 0.2; // [s] for a callback that runs
    if (device_ == kHdNoDevice) return;
    if (beat_) {
        beat_->isOver = true;
        static_cast<void>(waitFor(kPatience, [this] { return !beat_->isBusy; }));
        hd_->hdStopScheduler();
        hd_->hdUnschedule(scheduled_);
        beat_ = nullptr;
    }
    constexpr std::array<double, 3> kNone{};
    hd_->hdMakeCurrentDevice(device_);
    hd_->hdBeginFrame(device_);
    hd_->hdSetDoublev(kHdForce, kNone.data());
    hd_->hdEndFrame(device_);
    hd_->hdDisable(kHdOutput);
    hd_->hdDisableDevice(device_);
    device_ = kHdNoDevice;
}

// --- the record

/// The library lists no devices: opening the default one tells whether there is one.
std::vector<DeviceListing> list(HidSystem& /*hid*/)
{
    const std::unique_ptr<DeviceLine> line = makeOpenHapticsLine();
    try {
        static_cast<void>(loadHd());
    } catch (const Error&) { // without the library there are no devices
        return {};
    }
    HapticDeviceInfo info;
    try {
        line->open(info);
    } catch (const Error& error) {
        const std::string why = error.what();
        const std::size_t end = why.find("; ");
        return {{.model = "3D Systems device",
                 .why   = why.substr(0, end),
                 .help  = end == std::string::npos ? "" : why.substr(end + 2)}};
    }
    line->close();
    return {{.model = info.model, .usable = true, .answers = true}};
}

std::unique_ptr<HapticDevice> make(const DeviceRequest& request)
{
    return std::make_unique<LineDevice>(makeOpenHapticsLine({.name = request.path}), openHapticsInfo(""));
}

DeviceSupport support()
{
    constexpr const char* kLibrary = "libHD.so of OpenHaptics";
    try {
        static_cast<void>(loadHd());
        return {true, kLibrary, ""};
    } catch (const Error&) {
        return {true, std::string(kLibrary) + " (not found; see OPENHAPTICS)", ""};
    }
}

std::vector<Finding> findings()
{
    const char* part = "openhaptics sdk";
    try {
        static_cast<void>(loadHd());
        return {{part, Verdict::ok, "its library can be loaded"}};
    } catch (const Error& error) {
        const std::string why = error.what();
        if (why.find(" lacks ") != std::string::npos) return {{part, Verdict::missing, why, "install OpenHaptics 3"}};
        return {{part, Verdict::ok, "not found; a Touch, Touch X or Omni needs it, nothing else does"}};
    }
}

} // namespace

const DeviceRecord kOpenHapticsRecord{.name     = "openhaptics",
                                      .model    = "3D Systems Touch, Touch X or Omni",
                                      .list     = list,
                                      .make     = make,
                                      .support  = support,
                                      .findings = findings};

HapticDeviceInfo openHapticsInfo(const std::string& model)
{
    const bool       isOmni = model.find("Omni") != std::string::npos;
    HapticDeviceInfo info;
    info.model            = "3D Systems device";
    info.workspaceRadius  = isOmni ? 0.10 : 0.075;
    info.maximumForce     = 3.3;
    info.maximumStiffness = isOmni ? 700 : 400;
    info.maximumDamping   = isOmni ? 5 : 4;
    info.buttons          = 2;
    info.needsHoming      = true;
    info.homing           = "put the stylus into its inkwell, and wait for its light";
    info.rotates          = true;
    return info;
}

std::unique_ptr<DeviceLine> makeOpenHapticsLine(const OpenHapticsSettings& settings)
{
    return std::make_unique<OpenHapticsLine>(settings);
}

} // namespace palp
