#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "engine/session/servo.h"

namespace palp::soak {

/// What holds in every tick of every session, whatever fails.
class Invariants {
public:
    /// \param most    [N] of the hand's force: the least of scene and device
    /// \param weight  [N] of the arm
    Invariants(double most, double weight) : most_(most), weight_(weight) {}

    /// Checks a tick.
    /// \param given  the force that the device was given, in its frame
    /// \param dt     [s] as the servo was told
    /// \return what is wrong, as a sentence; empty if nothing is
    [[nodiscard]] std::optional<std::string> check(const TickRecord& record, const GovernedForce& given, double dt,
                                                   const GovernorSettings& limits);

    /// Checks the table that the servo uses: it is usable and never an older one; and, if asked to, that it is the one
    /// that was handed over, unchanged, which takes as long as a tick.
    [[nodiscard]] std::optional<std::string> checkTable(const ComplianceTable* inUse, bool whole);

    /// Notes a table before it is handed over.
    void handsOver(const ComplianceTable& table);

    [[nodiscard]] std::uint64_t pressing() const noexcept { return pressing_; } ///< ticks with a force, so far

private:
    [[nodiscard]] std::optional<std::string> checkForce(const TickRecord& record, const GovernedForce& given) const;
    [[nodiscard]] std::optional<std::string> checkChange(const TickRecord& record, double rise, double fall,
                                                         const GovernorSettings& limits) const;
    [[nodiscard]] std::optional<std::string> checkZero(const TickRecord& record, double fall,
                                                       const GovernorSettings& limits);
    [[nodiscard]] std::optional<std::string> checkEnergy(const TickRecord&       record,
                                                         const GovernorSettings& limits) const;
    [[nodiscard]] static std::optional<std::string> checkFault(const TickRecord& record, double dt,
                                                               const GovernorSettings& limits);
    [[nodiscard]] std::optional<std::string>        checkSilence(const TickRecord& record) const;

    static constexpr std::size_t kNoted = 256;

    double        most_, weight_; ///< [N]
    glm::dvec3    last_{};        ///< [N]
    double        faulty_   = 0;  ///< [s] since the governor latched a fault
    int           away_     = 0;  ///< ticks since the last contact
    std::uint64_t newest_   = 0;  ///< number of the newest table in use
    std::uint64_t handed_   = 0;  ///< of the newest one that was handed over
    std::uint64_t pressing_ = 0;
    std::uint64_t sums_[kNoted]{}; ///< of tables by their number
};

} // namespace palp::soak
