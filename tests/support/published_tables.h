#pragma once
#include <array>

#include "engine/force/compliance_tracker.h"

namespace palp {

/// Memory for the tables that a test publishes: what the tracker reads is never written, as with a session's slots.
class PublishedTables {
public:
    /// Returns the place of a table's copy, which stays while the tracker has it in use.
    const ComplianceTable* place(const ComplianceTable& table, const ComplianceTracker& reader)
    {
        const ComplianceTable* const inUse = reader.inUse();
        if (inUse && inUse->sequence == table.sequence) return inUse;
        ComplianceTable& free = inUse == &tables_[0] ? tables_[1] : tables_[0];
        free                  = table;
        return &free;
    }

private:
    std::array<ComplianceTable, 2> tables_{};
};

} // namespace palp
