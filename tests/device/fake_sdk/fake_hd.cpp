// A stand-in of OpenHaptics' library: the functions that the driver takes, by their names, and a scheduler's thread.
#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

#include "device/vendor/detail/hd_library.h"
#include "tests/device/fake_sdk/fake_sdk.h"

using palp::FakeSdk;
using palp::HdCallback;

namespace {

FakeSdk& sdk()
{
    static FakeSdk own;
    return own;
}

struct Scheduler {
    std::mutex                mutex;
    HdCallback                callback = nullptr;
    void*                     data     = nullptr;
    std::vector<std::jthread> threads;
};

Scheduler& scheduler()
{
    static Scheduler own;
    return own;
}

} // namespace

extern "C" {
FakeSdk* fakeSdk()
{
    return &sdk();
}
unsigned hdInitDevice(const char* name)
{
    if (sdk().openError != 0) {
        sdk().error = sdk().openError.load();
        return palp::kHdNoDevice;
    }
    if (!sdk().isPresent || (name && std::strcmp(name, "left") != 0)) {
        sdk().error = 0x301;
        return palp::kHdNoDevice;
    }
    ++sdk().opened;
    return 7;
}
void hdDisableDevice(unsigned)
{
    if (sdk().callsLate && scheduler().callback) {
        scheduler().callback(scheduler().data);
        ++sdk().lateCallbacks;
    }
    scheduler().callback = nullptr;
    ++sdk().closed;
}
void hdMakeCurrentDevice(unsigned) {}
void hdBeginFrame(unsigned)
{
    ++sdk().calls;
}
void hdEndFrame(unsigned) {}
void hdEnable(unsigned what)
{
    if (what == palp::kHdOutput) sdk().isForceOn = true, ++sdk().enabled;
}
void hdDisable(unsigned what)
{
    if (what == palp::kHdOutput) sdk().isForceOn = false;
}
void hdGetDoublev(unsigned what, double* to)
{
    if (what == palp::kHdMostForce) *to = 3.3;
    if (what == palp::kHdTurning) to[0] = 0.1, to[1] = 0.2, to[2] = 0.3;
    if (what == palp::kHdTransform) {
        const double quarter[16] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1}; // about y, by columns
        std::memcpy(to, quarter, sizeof quarter);
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (what == palp::kHdPosition) to[axis] = sdk().isOutOfNumbers ? std::nan("") : sdk().position[axis].load();
        if (what == palp::kHdVelocity) to[axis] = sdk().velocity[axis];
    }
}
void hdGetIntegerv(unsigned what, int* to)
{
    *to = what == palp::kHdButtons ? 3 : what == palp::kHdStyles ? int(palp::kHdInkwell) : 0;
}
void hdSetDoublev(unsigned what, const double* from)
{
    for (int axis = 0; what == palp::kHdForce && axis < 3; ++axis) sdk().force[axis] = from[axis];
}
const char* hdGetString(unsigned what)
{
    return what == palp::kHdModel ? "Touch" : "SN-1";
}
palp::HdError hdGetError()
{
    const int code = sdk().error.exchange(0);
    if (code != 0) sdk().error = sdk().nextError.exchange(0);
    return {unsigned(code), 0, 7};
}
const char* hdGetErrorString(unsigned)
{
    return "the error of a test";
}
unsigned hdCheckCalibration()
{
    if (sdk().isLost) return palp::kHdByHand;
    return sdk().isReady ? palp::kHdCalibrated : palp::kHdUpdate;
}
void hdUpdateCalibration(unsigned style)
{
    ++sdk().calibrated;
    if (style == palp::kHdInkwell) sdk().isReady = true;
}
unsigned long hdScheduleAsynchronous(HdCallback callback, void* data, unsigned short)
{
    const std::lock_guard lock(scheduler().mutex);
    scheduler().callback = callback;
    scheduler().data     = data;
    return 9;
}
void hdStartScheduler()
{
    if (sdk().startError != 0) {
        sdk().error = sdk().startError.load();
        return;
    }
    for (int n = 0; n < sdk().callbackThreads; ++n)
        scheduler().threads.emplace_back([](const std::stop_token& stop) {
            while (!stop.stop_requested()) {
                HdCallback callback = nullptr;
                void*      data     = nullptr;
                {
                    const std::lock_guard lock(scheduler().mutex);
                    callback = scheduler().callback;
                    data     = scheduler().data;
                }
                if (callback && callback(data) == palp::kHdDone) break;
                std::this_thread::sleep_for(std::chrono::microseconds(500));
            }
        });
}
void hdStopScheduler()
{
    scheduler().threads.clear(); // joins
}
#ifndef PALPATE_FAKE_OLD
void hdUnschedule(unsigned long)
{
    const std::lock_guard lock(scheduler().mutex);
    if (!sdk().callsLate) scheduler().callback = nullptr;
}
#endif
}
