#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/cloud/samples.h"

namespace palp {

/// The options by which every program is given a cloud: a file, or a sample by name.
struct CloudSource {
    std::string   name; ///< a path, or "sample:NAME"
    std::string   unit, stiffnessProperty, stiffnessUnit, range, columns, law, uniform;
    bool          logRange = false, dropInvalid = false;
    std::size_t   points = 0; ///< of a sample; 0: its own number
    std::uint64_t seed   = 1; ///< of a sample

    /// Adds the options to a command; `this` must outlive its parsing.
    void addTo(CLI::App& command);

    /// Loads or makes the cloud. \throws Error
    [[nodiscard]] LoadedCloud load() const;

    /// The sample, if it is one. \throws Error if no sample has the name
    [[nodiscard]] const Sample* sample() const;

    /// Metres in one unit of a plain number of a place: that of --unit.
    [[nodiscard]] double metresPerPlainNumber() const;
};

/// What was read, for --json: points, bounds, units, where the stiffness came from.
[[nodiscard]] nlohmann::json cloudJson(const CloudSource& source, const LoadedCloud& loaded);

} // namespace palp
