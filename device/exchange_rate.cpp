#include "device/exchange_rate.h"

#include <algorithm>

namespace palp {

ExchangeRate measureExchanges(HapticDevice& device, double seconds, const std::function<double()>& wait)
{
    constexpr double kBegin = 0.05; // [s]
    ExchangeRate     rate;
    HapticState      first, last;
    double           ages = 0;
    int              seen = 0;
    for (double begin = wait(), now = begin; now < begin + seconds; now = wait()) {
        const HapticState state = device.exchange(GovernedForce(), now);
        if (isFinal(state.fault)) return {};
        if (now < begin + kBegin || state.sequence == last.sequence) continue;
        if (seen == 0) first = state;
        if (seen > 0) rate.longest = std::max(rate.longest, state.time - last.time);
        ages += state.age;
        last = state;
        ++seen;
    }
    if (seen < 2 || !(last.time > first.time)) return {};
    rate.perSecond = double(last.sequence - first.sequence) / (last.time - first.time);
    rate.age       = ages / seen;
    return rate;
}

} // namespace palp
