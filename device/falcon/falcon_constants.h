#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "device/falcon/falcon_motors.h"

namespace palp {

/// What palpate calibrate found of one Falcon. It lies in the user's folder, so that every command uses it:
/// $XDG_CONFIG_HOME/palpate, or ~/.config/palpate.
struct FalconConstants {
    std::string serial;              ///< of its USB bridge; empty: it has none
    double      countsPerTorque = 0; ///< [counts/(N m)] in the bounds of FalconMotors
    double      armMass         = 0; ///< [kg] of it weigh on the grip, at most kMostArm
    std::string date;                ///< "2026-11-22", when it was calibrated
    /// [s] for which its firmware holds the last force when no packet comes, at most kMostHold; empty: not known
    std::optional<double> hold{};
};

/// [kg] the largest part of an arm that is believed to weigh on the grip. Some 0.2 are known of one Falcon [I]; the
/// governor carries 4 N at most.
inline constexpr double kMostArm = 0.4;

inline constexpr double kMostHold = 1; ///< [s] the longest hold that is believed; FalconHold measures half of it

/// Returns the file of the Falcon with this serial number; empty if neither XDG_CONFIG_HOME nor HOME is set.
[[nodiscard]] std::filesystem::path falconConstantsFile(const std::string& serial);

/// Reads the text of such a file.
/// \param where  opens complaints
/// \throws Error naming the key, what was expected and found
[[nodiscard]] FalconConstants parseFalconConstants(std::string_view text, const std::string& where,
                                                   const std::string& serial);

/// Reads what was found of a Falcon. The file is believed only as a whole: any other size, key, type or range is
/// refused. So is one that this user may not read: it may hold other counts than those that would be used without it.
/// \return empty if it has not been calibrated
/// \throws Error naming the file, what is wrong, and the remedy
[[nodiscard]] std::optional<FalconConstants> readFalconConstants(const std::string& serial);

/// Writes it, whole or not at all.
/// \return the file
/// \throws Error naming the file and the reason; also if a value is out of its range
std::filesystem::path writeFalconConstants(const FalconConstants& constants);

/// Returns "4321 counts per N m, an arm of 213 g, a hold of 20 ms without packets, found on 2026-11-22", or that it has
/// not been calibrated, or that its file is damaged or cannot be read, for a list of devices.
[[nodiscard]] std::string describeConstants(const std::string& serial);

/// The values with which an open Falcon runs.
struct FalconTuning {
    double      countsPerTorque = FalconMotors::kCountsPerTorque; ///< [counts/(N m)]
    double      armMass         = 0; ///< [kg] that weighs on the grip; 0: unknown, and nothing carries it
    std::string note{};              ///< what the user should read; may be empty
};

/// Returns the values for a Falcon: those that were found of it, except counts that were given by hand.
/// \throws Error as readFalconConstants()
[[nodiscard]] FalconTuning tuningOf(const std::string& serial, std::optional<double> countsByHand);

/// Returns the values with which a Falcon begins its calibration. The counts are those of tuningOf(); the arm is not
/// carried, because it is weighed.
/// \return with a note if the file of its last calibration cannot be used: then no session ran with these counts
[[nodiscard]] FalconTuning tuningToCalibrate(const std::string& serial, std::optional<double> countsByHand);

} // namespace palp
