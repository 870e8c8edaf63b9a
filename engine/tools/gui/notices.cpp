#include "engine/tools/gui/notices.h"

namespace palp {

void Notices::say(const std::string& message)
{
    message_ = message;
    ++changes_;
}

void Notices::complain(const std::string& fault)
{
    constexpr std::size_t kMost = 5;
    if (!faults_.empty() && faults_.back() == fault) return;
    if (complained_) complained_(fault);
    faults_.push_back(fault);
    if (faults_.size() > kMost) faults_.erase(faults_.begin());
    ++changes_;
}

void Notices::setActivity(const std::string& activity)
{
    activity_ = activity;
    ++changes_;
}

} // namespace palp
