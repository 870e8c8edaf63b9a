#include "engine/tools/cli/hand_source.h"

#include <cmath>
#include <iostream>
#include <sstream>

#include "device/homing.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"

namespace palp {
namespace {

/// Reads a length above zero and up to a metre, more than any hand reaches [m].
double metres(const std::string& text, const std::string& option, double metresPerPlainNumber)
{
    const double value = parseQuantity(text, Dimension::length, option, metresPerPlainNumber);
    if (value > 0 && value <= 1) return value;
    throw Error(option + ": expected a length above 0 and up to 1 m, found \"" + text + "\"");
}

/// Reads "50 mm/s" or "0.05" [m/s].
double metresPerSecond(const std::string& text, const std::string& option)
{
    const double value = parseQuantity(text, Dimension::speed, option);
    if (value > 0 && value <= HandPath::kFastest) return value;
    throw Error(option + ": expected a speed above 0 and up to " + formatQuantity(HandPath::kFastest, "m/s") +
                ", found \"" + text + "\"");
}

/// Reads "150 N/m" or "150" [N/m].
SimulatedHand gripOf(const std::string& text)
{
    SimulatedHand hand;
    hand.stiffness = parseQuantity(text, Dimension::stiffness, "--arm");
    if (!(hand.stiffness > 0 && hand.stiffness <= 5000))
        throw Error("--arm: expected the stiffness of a grip, above 0 and up to 5000 N/m (150 is relaxed, 500 firm), "
                    "found \"" +
                    text + "\"");
    hand.damping = 2; // [N s/m] of a relaxed hand; published measurements have 1 to 5
    return hand;
}

/// Refuses the options of generated hands for another hand, on which they would have no effect; a press has no reach.
void demandGenerated(const HandOptions& o)
{
    const DeviceRecord* record = deviceNamed(o.hand);
    const auto          motion = valueNamed<HandMotion>(o.hand);
    const bool          moves  = record ? record->holder == DeviceHolder::scriptedHand : motion.has_value();
    const auto          demand = [&](const char* option, const std::string& text, const std::string& hands, bool has) {
        if (text.empty() || has) return;
        throw Error(std::string(option) + " belongs to the hands " + hands + ", found --hand " + shownPath(o.hand) +
                             "; omit one of the two");
    };
    demand("--speed", o.speed, generatedHands(), moves);
    demand("--press-depth", o.depth, generatedHands(), moves);
    demand("--reach", o.reach, "circle and scan", moves && motion != HandMotion::press);
}

/// \throws Error naming the option whose text is not understood
HandChoice readChoice(const HandOptions& o)
{
    HandChoice choice;
    choice.hand    = o.hand;
    choice.options = o.device;
    choice.cancel  = o.cancel;
    if (!o.speed.empty()) choice.speed = metresPerSecond(o.speed, "--speed");
    if (!o.reach.empty()) choice.radius = reachOf(o.reach, o.metresPerPlainNumber);
    if (!o.depth.empty()) choice.depth = metres(o.depth, "--press-depth", o.metresPerPlainNumber);
    if (!o.grip.empty()) choice.grip = gripOf(o.grip);
    if (!o.seconds.empty()) choice.seconds = secondsOf(o.seconds);
    return choice;
}

/// \throws Error as readChoice(), or naming the option that has no effect
HandChoice choiceOf(const HandOptions& o)
{
    HandChoice choice = readChoice(o);
    demandGood(choice);
    demandGenerated(o);
    return choice;
}

void addOption(CLI::App& command, DeviceOptionValues& values, const DeviceOption& option)
{
    const std::string flag(option.flag), help(option.help);
    if (option.kind == DeviceOption::Kind::flag) {
        command.add_flag_callback(
            flag, [&values, flag] { values[flag] = "true"; }, help);
        return;
    }
    auto* added = command.add_option_function<std::string>(
        flag, [&values, flag](const std::string& text) { values[flag] = text; }, help);
    if (option.kind != DeviceOption::Kind::number) return;
    const auto complain = [option](const std::string& text) {
        static_cast<void>(numberOf(option, text)); // throws the sentence
        return std::string();
    };
    added->check(CLI::Validator(complain, "[" + std::to_string(std::llround(option.least)) + " - " +
                                              std::to_string(std::llround(option.most)) + "]"));
}

} // namespace

std::string motionOf(const HandOptions& options)
{
    const HandChoice   choice = readChoice(options);
    std::ostringstream text;
    text << "speed " << choice.speed << " m/s, reach " << choice.radius << " m, depth ";
    if (choice.depth)
        text << *choice.depth << " m";
    else
        text << "by the thickness";
    if (choice.grip) text << ", arm " << choice.grip->stiffness << " N/m";
    return text.str();
}

double reachOf(const std::string& text, double metresPerPlainNumber)
{
    return metres(text, "--reach", metresPerPlainNumber);
}

double secondsOf(const std::string& text)
{
    constexpr double kMost   = 86400; // [s] a day
    const double     seconds = parseQuantity(text, Dimension::time, "--seconds");
    if (seconds > 0 && seconds <= kMost) return seconds;
    throw Error("--seconds: expected a time above 0 and up to 86400 s, found \"" + text + "\"");
}

std::string generatedHands()
{
    std::string hands;
    for (const auto& motion : namesOf(HandMotion{})) hands += (hands.empty() ? "" : ", ") + std::string(motion.name);
    return hands;
}

std::string deviceHands()
{
    std::string hands;
    for (const DeviceRecord* record : deviceRecords())
        if (record->holder != DeviceHolder::pointer) hands += (hands.empty() ? "" : ", ") + std::string(record->name);
    return hands;
}

void addHandOptions(CLI::App& command, HandOptions& options, std::span<const DeviceRecord* const> records)
{
    command.add_option("--speed", options.speed, "largest speed of press, circle and scan [50 mm/s]");
    command.add_option("--press-depth", options.depth,
                       "depth of the hand below the surface [40 % of the thickness, within plate theory]");
    command.add_option("--reach", options.reach, "radius of the circle, half the length of the scan [10 mm]");
    command.add_option(
        "--arm", options.grip,
        "stiffness with which the hand grips a simulated device, so that forces move it (relaxed '150 N/m', "
        "firm '500 N/m')");
    addDeviceOptions(command, options.device, records);
}

void addDeviceOptions(CLI::App& command, DeviceOptionValues& values, std::span<const DeviceRecord* const> records)
{
    for (const DeviceRecord* record : records)
        for (const DeviceOption& option : record->options)
            if (!command.get_option_no_throw(std::string(option.flag))) addOption(command, values, option);
}

void demandGood(const HandOptions& options)
{
    static_cast<void>(choiceOf(options));
    if (!deviceNamed(options.hand) && !valueNamed<HandMotion>(options.hand)) static_cast<void>(readHand(options.hand));
}

void demandFitting(const HandOptions& options)
{
    demandGenerated(options);
    demandFitting(readChoice(options));
}

SessionHand handFor(const HandOptions& options, const Scene& scene, const SoftObject& object)
{
    return openHand(choiceOf(options), scene, object);
}

void waitForHoming(HapticDevice& device, const std::atomic<bool>& stop)
{
    const auto tell = [](const std::string& sentence) { std::cerr << "palpate: " << sentence << "\n"; };
    if (waitForHoming(device, stop, tell)) tell("homed");
}

} // namespace palp
