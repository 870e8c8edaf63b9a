#include "engine/tools/gui/touch_history.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {

void TouchHistory::add(const TickRecord& record) noexcept
{
    if (ticks_ > 0 && record.time < newest_.time) clear();
    const auto step = std::int64_t(std::floor(record.time / kStep));
    if (step != step_ && step_ >= 0) {
        std::shift_left(forces_.begin(), forces_.end(), 1);
        std::shift_left(depths_.begin(), depths_.end(), 1);
        forces_.back() = force_;
        depths_.back() = depth_;
        force_ = depth_ = 0;
        count_          = std::min(kSteps, count_ + 1);
    }
    step_  = step;
    force_ = std::max(force_, float(glm::length(record.force)));
    depth_ = std::max(depth_, float(std::max(0.0, glm::dot(record.proxy - record.hip, record.normal))));
    if (ticks_ > 0) {
        const double share = std::log((record.time - newest_.time) / kShortest) / std::log(kLongest / kShortest);
        periods_[std::size_t(std::clamp(share * double(kBins), 0.0, double(kBins) - 1))] += 1;
    }
    ++ticks_;
    newest_ = record;
}

} // namespace palp
