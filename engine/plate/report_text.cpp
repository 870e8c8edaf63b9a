#include "engine/plate/report_text.h"

#include "engine/core/quantity.h"

namespace palp {

std::string errorText(const SolveReport& report)
{
    return "its error is about " + formatNumber(report.errorEstimate.value_or(1)) + " or more, relative";
}

} // namespace palp
