#pragma once
#include <atomic>

// What a test and a stand-in of a maker's library share: registers instead of an arm. The test loads the same file as
// the driver and moves the arm itself. All numbers are in the library's own frame and units.
namespace palp {

struct FakeSdk {
    std::atomic<double> position[3]{}, velocity[3]{}; ///< that the library reports
    std::atomic<double> force[3]{};                   ///< that it was told to render last
    std::atomic<bool>   isPresent{true};              ///< a device is plugged in
    std::atomic<bool>   isForceOn{false};
    std::atomic<bool>   isReady{true};         ///< reset, calibrated
    std::atomic<int>    error{0};              ///< for each call: 0 none, else the library's number of it
    std::atomic<int>    status{0};             ///< Force Dimension: why the force is off
    std::atomic<int>    type{33};              ///< Force Dimension: the library's number of it, an omega.3's
    std::atomic<bool>   hasPower{true};        ///< Force Dimension
    std::atomic<bool>   isBroken{false};       ///< Force Dimension: the device reports an error
    std::atomic<bool>   knowsDrd{true};        ///< Force Dimension: drdOpenID() opens the device
    std::atomic<bool>   isRobot{false};        ///< Force Dimension: it was opened so; drd* serve no other device
    std::atomic<bool>   areBrakesOn{true};     ///< Force Dimension
    std::atomic<bool>   isBalanced{false};     ///< Force Dimension: gravity is compensated
    std::atomic<bool>   isSame{false};         ///< Force Dimension: each read gives the sample of before
    std::atomic<bool>   isOutOfNumbers{false}; ///< positions are NaN
    std::atomic<bool>   isLost{false};         ///< OpenHaptics: its calibration is gone
    std::atomic<int>    openError{0};          ///< OpenHaptics: of opening a device
    std::atomic<int>    startError{0};         ///< OpenHaptics: of starting the scheduler
    std::atomic<int>    nextError{0};          ///< OpenHaptics: that is kept behind `error`
    std::atomic<int>    opened{0}, closed{0}, enabled{0}, calibrated{0}, calls{0};
    std::atomic<int>    callbackThreads{1}; ///< OpenHaptics: of the scheduler; two call doubled
    std::atomic<int>    lateCallbacks{0};   ///< OpenHaptics: made after it was unscheduled
    std::atomic<bool>   callsLate{false};   ///< OpenHaptics: the scheduler calls once more after it was stopped
};

} // namespace palp

extern "C" palp::FakeSdk* fakeSdk();
