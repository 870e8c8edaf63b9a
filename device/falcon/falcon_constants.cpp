#include "device/falcon/falcon_constants.h"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ostream>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"

namespace palp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "palpate falcon calibration 1";
constexpr std::size_t kMost   = 4096; ///< [bytes] of a file; one has some 200

constexpr const char* kRemedy = "; run palpate calibrate anew, or remove the file";

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

FalconConstants parse(const std::string& text, const std::string& where, const std::string& serial)
{
    const JsonObject file = JsonObject::parse(text, where);
    file.allowOnly({"format", "serial", "counts_per_torque", "arm_kg", "date"});
    if (file.text("format") != kFormat) file.refuse("format", '"' + std::string(kFormat) + '"');
    if (file.text("serial") != serial) file.refuse("serial", "\"" + serial + "\", the number of the Falcon");
    FalconConstants found;
    found.serial = serial;
    found.countsPerTorque =
        bounded(file, "counts_per_torque", FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque);
    found.armMass = bounded(file, "arm_kg", 0, kMostArm);
    found.date    = file.text("date");
    if (!isDate(found.date)) file.refuse("date", "a date such as 2026-11-22");
    return found;
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

std::optional<FalconConstants> readFalconConstants(const std::string& serial)
{
    const fs::path  file = falconConstantsFile(serial);
    std::error_code failed;
    if (file.empty() || !fs::exists(file, failed)) return {};
    try {
        if (!fs::is_regular_file(file, failed)) throw Error(file.string() + ": it is no file"); // a pipe would wait
        return parse(readWhole(file, kMost, "the calibration of a Falcon"), file.string(), serial);
    } catch (const Error& error) {
        throw Error(std::string("the Falcon's calibration is damaged: ") + error.what() + kRemedy);
    }
}

fs::path writeFalconConstants(const FalconConstants& found)
{
    const fs::path file = falconConstantsFile(found.serial);
    if (file.empty()) throw Error("the calibration cannot be stored: set HOME or XDG_CONFIG_HOME");
    std::array<char, 512> text{};
    const int             size =
        std::snprintf(text.data(), text.size(),
                      "{\n  \"format\": \"%s\",\n  \"serial\": \"%s\",\n  \"counts_per_torque\": %.6g,\n"
                      "  \"arm_kg\": %.6g,\n  \"date\": \"%s\"\n}\n",
                      kFormat, found.serial.c_str(), found.countsPerTorque, found.armMass, found.date.c_str());
    if (size < 0 || std::size_t(size) >= text.size())
        throw Error("the calibration cannot be stored: its texts are too long");
    static_cast<void>(parse(text.data(), file.string(), found.serial)); // what cannot be read is not written
    makeFolder(file.parent_path());
    writeFileWhole(file, [&](std::ostream& out) { out << text.data(); });
    return file;
}

std::string describeConstants(const std::string& serial)
{
    try {
        const auto found = readFalconConstants(serial);
        if (!found) return "none; palpate calibrate makes its newtons true and lets it carry its arm";
        return counts(found->countsPerTorque) + " counts per N m, an arm of " + counts(1000 * found->armMass) +
               " g, found on " + found->date;
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
    } else if (!countsByHand) {
        tuning.note =
            "this Falcon has not been calibrated: its forces may be half of the right ones or twice, and nothing "
            "carries its arm; run palpate calibrate";
    }
    if (countsByHand) tuning.countsPerTorque = *countsByHand;
    return tuning;
}

} // namespace palp
