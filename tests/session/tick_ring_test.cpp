#include "engine/session/tick_ring.h"

#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(TickRing, GivesBackInOrderWhatWasPushedAndRefusesWhenFull)
{
    TickRing<int> ring(3);
    ASSERT_EQ(ring.capacity(), 4u);

    for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
    EXPECT_FALSE(ring.push(4)) << "full";
    ASSERT_EQ(ring.front().size(), 4u);
    EXPECT_EQ(ring.front()[0], 0);
    ring.pop(3);
    EXPECT_TRUE(ring.push(5));

    ASSERT_EQ(ring.front().size(), 1u) << "up to the end of the storage";
    EXPECT_EQ(ring.front()[0], 3);
    ring.pop(1);
    ASSERT_EQ(ring.front().size(), 1u);
    EXPECT_EQ(ring.front()[0], 5);
    ring.pop(1);
    EXPECT_TRUE(ring.front().empty());
}

TEST(TickRing, NothingIsTornLostOrSwappedBetweenTwoThreads)
{
    struct Message {
        std::uint64_t number, square, inverse;
    };
    constexpr std::uint64_t kMessages = 300'000;
    TickRing<Message>       ring(64);
    std::uint64_t           wrong = 0;

    std::thread consumer([&] {
        for (std::uint64_t next = 0; next < kMessages;) {
            const auto batch = ring.front();
            if (batch.empty()) std::this_thread::yield();
            for (const Message& m : batch) {
                wrong += m.number != next || m.square != next * next || m.inverse != ~next;
                ++next;
            }
            ring.pop(batch.size());
        }
    });
    for (std::uint64_t i = 0; i < kMessages; ++i)
        while (!ring.push({i, i * i, ~i})) std::this_thread::yield();
    consumer.join();

    EXPECT_EQ(wrong, 0u);
    EXPECT_TRUE(ring.front().empty());
}

} // namespace
} // namespace palp
