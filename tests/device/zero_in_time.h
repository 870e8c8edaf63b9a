#pragma once
#include <gtest/gtest.h>

namespace palp {

/// Takes after each failure how long a force went on, and says whether that is in time.
///
/// All but one, and one more in fifty, have to be below the limit, and all below twice of it: where other programs hold
/// the processors, who wakes up gets one a slice of the scheduler later. A guardian that waits too long, or not for its
/// clock, is late every time.
class ZeroInTime {
public:
    explicit ZeroInTime(double limit) : limit_(limit) {} ///< [s]

    [[nodiscard]] ::testing::AssertionResult operator()(double took)
    {
        constexpr int kOneIn = 50;
        ++count_;
        late_ += took >= limit_;
        if (took < 2 * limit_ && late_ <= 1 + count_ / kOneIn) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << "zero after " << 1e3 * took << " ms, " << late_ << " of " << count_
                                             << " after " << 1e3 * limit_ << " ms or more";
    }

private:
    double limit_;
    int    count_ = 0, late_ = 0;
};

} // namespace palp
