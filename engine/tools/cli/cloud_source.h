#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/cloud/samples.h"

namespace palp {

/// The options by which every program is given a cloud: a file, or a sample by name.
struct CloudSource {
    std::string                 name; ///< a path, or "sample:NAME"
    std::string                 unit, stiffnessProperty, stiffnessUnit, range, columns, law, uniform;
    bool                        logRange = false, dropInvalid = false;
    std::optional<std::int64_t> points; ///< of a sample; empty: its own number
    std::optional<std::int64_t> seed;   ///< of a sample; empty: 1

    /// Adds the options to a command; `this` must outlive its parsing.
    void addTo(CLI::App& command);

    /// Loads or makes the cloud. \throws Error, also if an option was given that cannot apply
    [[nodiscard]] LoadedCloud load() const;

    /// How load() reads a file. \throws Error if a value cannot be understood
    [[nodiscard]] CloudReadSettings readSettings() const;

    /// What was assumed because nobody said so, and a law that changes nothing, in sentences. Empty is good.
    [[nodiscard]] std::vector<std::string> warnings(const LoadedCloud& loaded) const;

    /// The sample, if it is one. \throws Error if no sample has the name
    [[nodiscard]] const Sample* sample() const;

    /// Metres in one unit of a plain number of a length: that of --unit. \throws Error if the unit is unknown
    [[nodiscard]] double metresPerPlainNumber() const;
};

/// A command that reads a cloud and writes another never takes the one for the other: what it read would be gone.
/// Anything else that is there is replaced, by every command, once the new file is whole.
/// \param option  that names the target
/// \throws Error if both are the same file
void refuseSourceAsTarget(const std::string& option, const std::string& source, const std::string& target);

/// "x,y,z" as --at takes it, to about a thousandth of a cloud of that diagonal [m].
[[nodiscard]] std::string placeText(const glm::dvec3& place, double diagonal, double metresPerUnit = 1);

/// What was read, for --json: points, bounds, units, where the stiffness came from.
[[nodiscard]] nlohmann::json cloudJson(const CloudSource& source, const LoadedCloud& loaded);

} // namespace palp
