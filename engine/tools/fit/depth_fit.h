#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cloud/material.h"
#include "engine/force/depth_law.h"
#include "engine/tools/fit/probe_table.h"

namespace palp::fit {

/// A number and its 95 % interval, from the covariance of the fit. The residuals of one curve hang together, so an
/// interval is rather too narrow than too wide.
struct Estimate {
    double value = 0, low = 0, high = 0;
};

/// Writes an estimate with its interval: "300 N/m (290 N/m to 310 N/m)", or "300 N/m (+- 0.012 %)" where the ends would
/// be the same digits as the value.
[[nodiscard]] std::string intervalText(const Estimate& estimate, std::string_view siUnit);

/// A law that was tried on a probe.
struct TriedLaw {
    std::string         name;         ///< "linear"
    std::vector<double> force;        ///< at the probe's rows [N]
    double              residual = 0; ///< root mean square, as a share of the range of the forces [1]
};

/// What a press tells of a material: K and b of DepthLaw, and how it relaxes if times were measured.
struct ProbeFit {
    std::string           name;
    Estimate              stiffness;  ///< K [N/m]
    Estimate              stiffening; ///< b [1/m]
    Relaxation            relaxation{};
    std::vector<Estimate> shares, times; ///< of its terms [1], [s]
    double                residual = 0;  ///< of this law, as in TriedLaw
    std::vector<double>   force;         ///< of this law at the rows [N]
    std::vector<TriedLaw> others;        ///< linear, Hertz, cubic, and with times the exponential that does not relax
};

/// Fits K, b and, where there are times, terms of relaxation: another one if it takes a tenth off the residual and is
/// worth its two parameters by Schwarz's criterion. The forces are those of RelaxingContact, as in a session.
[[nodiscard]] ProbeFit fitProbe(const Probe& probe);

/// What many presses tell together.
struct ProbesFit {
    std::vector<ProbeFit> probes;
    double                stiffening = 0; ///< the median b [1/m]
    Relaxation            relaxation{};   ///< the medians of the terms, of the most frequent number of terms

    [[nodiscard]] double medianResidual() const; ///< of the fitted law [1]
    /// Returns the same of another law, by its name.
    [[nodiscard]] double medianResidual(std::string_view law) const;
};

[[nodiscard]] ProbesFit together(std::vector<ProbeFit> probes);

} // namespace palp::fit
