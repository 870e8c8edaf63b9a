#include "device/falcon/falcon_constants.h"

#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ostream>

#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"

namespace palp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "palpate falcon calibration 1";
constexpr std::size_t kMost   = 4096; ///< [bytes] of a file; one has some 200

/// A file as it is written. A hold that is not known has no line.
constexpr const char* kText = R"({
  "format": "%s",
  "serial": "%s",
  "counts_per_torque": %.6g,
  "arm_kg": %.6g,
%s  "date": "%s"
}
)";

constexpr const char* kRemedy = "; run palpate calibrate anew, or remove the file";

/// A file that may be there and may be good, but that this user may not read.
struct Unreadable : Error {
    using Error::Error;
};

fs::path folderOfUser()
{
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    const char* const home   = std::getenv("HOME");
    if (config && *config) return fs::path(config) / "palpate";
    return home && *home ? fs::path(home) / ".config" / "palpate" : fs::path();
}

bool isDate(const std::string& text)
{
    constexpr const char* kShape = "0000-00-00";
    if (text.size() != 10) return false;
    for (std::size_t n = 0; n < text.size(); ++n)
        if (kShape[n] == '-' ? text[n] != '-' : text[n] < '0' || text[n] > '9') return false;
    return true;
}

/// Returns a number within bounds.
double bounded(const JsonObject& file, const char* key, double least, double most)
{
    const double value = file.number(key);
    if (value >= least && value <= most) return value;
    std::array<char, 80> bounds{};
    std::snprintf(bounds.data(), bounds.size(), "%g to %g", least, most);
    file.refuse(key, bounds.data());
}

/// Returns false if there is no such file.
/// \throws Unreadable if it cannot be read, or if it cannot be known whether it is there
bool isReadable(const fs::path& file)
{
    if (::access(file.c_str(), R_OK) == 0) return true;
    if (errno == ENOENT || errno == ENOTDIR) return false;
    throw Unreadable("the Falcon's calibration cannot be read: " + file.string() + ": " + std::strerror(errno) +
                     "; make the file and its folder readable for you, or set XDG_CONFIG_HOME to another folder");
}

std::string counts(double value)
{
    return std::to_string(std::lround(value));
}

} // namespace

fs::path falconConstantsFile(const std::string& serial)
{
    fs::path folder = folderOfUser();
    if (folder.empty()) return folder;
    std::string name = serial.empty() ? "falcon" : "falcon-";
    for (const char c : serial) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return folder / (name + ".json");
}

FalconConstants parseFalconConstants(std::string_view text, const std::string& where, const std::string& serial)
{
    const JsonObject file = JsonObject::parse(text, where);
    file.allowOnly({"format", "serial", "counts_per_torque", "arm_kg", "hold_s", "date"});
    if (file.text("format") != kFormat) file.refuse("format", '"' + std::string(kFormat) + '"');
    if (file.text("serial") != serial) file.refuse("serial", "\"" + serial + "\", the number of the Falcon");
    FalconConstants found;
    found.serial = serial;
    found.countsPerTorque =
        bounded(file, "counts_per_torque", FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque);
    found.armMass = bounded(file, "arm_kg", 0, kMostArm);
    if (file.has("hold_s")) found.hold = bounded(file, "hold_s", 0, kMostHold); // older files have none
    found.date = file.text("date");
    if (!isDate(found.date)) file.refuse("date", "a date such as 2026-11-22");
    return found;
}

std::optional<FalconConstants> readFalconConstants(const std::string& serial)
{
    const fs::path file = falconConstantsFile(serial);
    if (file.empty() || !isReadable(file)) return {};
    try {
        std::error_code failed;
        if (!fs::is_regular_file(file, failed)) throw Error(file.string() + ": it is no file"); // a pipe would wait
        return parseFalconConstants(readWhole(file, kMost, "the calibration of a Falcon", Pipes::refused),
                                    file.string(), serial);
    } catch (const Error& error) {
        throw Error(std::string("the Falcon's calibration is damaged: ") + error.what() + kRemedy);
    }
}

fs::path writeFalconConstants(const FalconConstants& found)
{
    const fs::path file = falconConstantsFile(found.serial);
    if (file.empty()) throw Error("the calibration cannot be stored: set HOME or XDG_CONFIG_HOME");
    std::array<char, 32> hold{};
    if (found.hold) std::snprintf(hold.data(), hold.size(), "  \"hold_s\": %.6g,\n", *found.hold);
    std::array<char, 512> text{};
    const int             size = std::snprintf(text.data(), text.size(), kText, kFormat, found.serial.c_str(),
                                               found.countsPerTorque, found.armMass, hold.data(), found.date.c_str());
    if (size < 0 || std::size_t(size) >= text.size())
        throw Error("the calibration cannot be stored: its texts are too long");
    static_cast<void>(
        parseFalconConstants(text.data(), file.string(), found.serial)); // what cannot be read is not written
    makeFolder(file.parent_path());
    writeFileWhole(file, [&](std::ostream& out) { out << text.data(); });
    return file;
}

std::string describeConstants(const std::string& serial)
{
    try {
        const auto found = readFalconConstants(serial);
        if (!found) return "none; palpate calibrate makes its newtons true and lets it carry its arm";
        const std::string hold = found->hold ? "a hold of " + counts(1000 * *found->hold) + " ms without packets"
                                             : "an unknown hold without packets";
        return counts(found->countsPerTorque) + " counts per N m, an arm of " + counts(1000 * found->armMass) + " g, " +
               hold + ", found on " + found->date;
    } catch (const Unreadable& error) {
        return error.what();
    } catch (const Error&) {
        return "its file is damaged; palpate calibrate writes it anew";
    }
}

FalconTuning tuningOf(const std::string& serial, std::optional<double> countsByHand)
{
    FalconTuning tuning;
    if (const auto found = readFalconConstants(serial)) {
        tuning.countsPerTorque = found->countsPerTorque;
        tuning.armMass         = found->armMass;
        if (countsByHand && counts(*countsByHand) != counts(found->countsPerTorque))
            tuning.note = "the Falcon runs with the " + counts(*countsByHand) +
                          " counts per N m given by hand, not with the " + counts(found->countsPerTorque) +
                          " of its calibration on " + found->date;
        else if (serial.empty() && !countsByHand)
            tuning.note = "this Falcon has no serial number, so that it runs with the calibration of " + found->date +
                          " of whichever Falcon without one was calibrated last";
    } else if (!countsByHand) {
        tuning.note =
            "this Falcon has not been calibrated: its forces may be half of the right ones or twice, and nothing "
            "carries its arm; run palpate calibrate";
    }
    if (countsByHand) tuning.countsPerTorque = *countsByHand;
    return tuning;
}

FalconTuning tuningToCalibrate(const std::string& serial, std::optional<double> countsByHand)
{
    try {
        return {.countsPerTorque = tuningOf(serial, countsByHand).countsPerTorque};
    } catch (const Error& error) {
        return {.countsPerTorque = countsByHand.value_or(FalconMotors::kCountsPerTorque), .note = error.what()};
    }
}

} // namespace palp
