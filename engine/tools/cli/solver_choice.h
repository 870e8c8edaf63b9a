#pragma once
#include <string>

#include <CLI/CLI.hpp>

#include "engine/compute/processor_error.h"
#include "engine/plate/plate_solver.h"

namespace palp {

/// The options --solver and --tolerance of commands that solve plates without a scene: the scene's keys of those names.
struct SolverChoice {
    std::string solver    = "auto";
    double      tolerance = 1e-4; ///< of the error, relative [1]

    void addTo(CLI::App& command);

    /// Opens the solver; says on standard error what "auto" found broken.
    /// \throws Error for a tolerance out of range, and as openSolver() does
    [[nodiscard]] PlateSolver open() const;
};

/// Opens the solver of a scene; says on standard error what "auto" found broken.
/// \throws compute::UnknownProcessor for a name that no solver has, compute::ProcessorError for one that cannot be used
[[nodiscard]] PlateSolver openSolver(const std::string& name);

/// Checks that a tolerance is in range.
/// \throws Error naming --tolerance and its bounds
void checkTolerance(double tolerance);

/// Says on standard error which processor "auto" took in place of a broken one, if there is a note of that.
void sayPassedOver(const std::string& name, const std::string& note);

/// Says on standard error who took over, if the sentence is not empty; see PlateSolver::takeoverSince().
void sayTakeover(const std::string& sentence);

/// Says on standard error who took over from a command's solver, or in a session that it ran, if that was not told yet.
/// \param told       solver.counts().takeovers that were told, as openSolver() does
/// \param inSession  takeoverSince(0) of that session's solver
/// \return the last sentence, told now or before, for the key "takeover" of JSON; empty: nobody took over
std::string sayTakeovers(const PlateSolver& solver, int told, const std::string& inSession = {});

/// Returns open(); where the processor is refused, the sentence adds that --solver takes the reference solver too.
template <class Open>
[[nodiscard]] auto orTheReference(const Open& open)
{
    constexpr const char* kToo = "; reference is sparse Cholesky in double precision";
    try {
        return open();
    } catch (const compute::UnknownProcessor& error) {
        throw compute::UnknownProcessor(std::string(error.what()) + kToo);
    } catch (const compute::ProcessorError& error) {
        throw compute::ProcessorError(std::string(error.what()) + kToo);
    }
}

} // namespace palp
