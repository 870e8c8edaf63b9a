#pragma once
#include <span>
#include <string>

#include "engine/tools/fit/depth_fit.h"
#include "engine/tools/fit/felt_fit.h"
#include "engine/tools/fit/probe_table.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::fit {

/// Writes one self-contained HTML file about presses: a table of all, and a plot for each.
/// \param probes  those of the fit, in the same order
/// \param name    of what was measured
[[nodiscard]] std::string probesPage(std::span<const Probe> probes, const ProbesFit& fit, const std::string& name);

/// Writes the same about a map: the measured and the fitted stiffness, and what is left between them.
/// \param measured  the map that was fitted
[[nodiscard]] std::string mapPage(const PointCloud& measured, const FeltFit& fit, const std::string& name,
                                  FigureRenderer& renderer);

} // namespace palp::fit
