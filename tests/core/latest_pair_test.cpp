#include "engine/core/latest_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <thread>

namespace palp {
namespace {

TEST(LatestPair, TheReaderKeepsOneValueBesidesTheNewest)
{
    LatestPair<int> latest;
    const int*      kept   = nullptr;
    const auto      isKept = [&](const int& value) { return &value == kept; };
    EXPECT_FALSE(latest.take(isKept));
    EXPECT_EQ(latest.newest(), nullptr);
    latest.draft() = 1;
    EXPECT_FALSE(latest.take(isKept)) << "a draft is not published";
    latest.publish();
    EXPECT_TRUE(latest.take(isKept));
    kept = latest.newest();
    ASSERT_NE(kept, nullptr);
    for (int n = 2; n <= 20; ++n) { // none of these is fit for use: the first one stays
        latest.draft() = n;
        latest.publish();
        EXPECT_TRUE(latest.take(isKept));
        EXPECT_EQ(*latest.newest(), n);
        EXPECT_EQ(*kept, 1) << "the writer never touches what the reader keeps";
    }
    kept = latest.newest();
    for (int n = 21; n <= 23; ++n) {
        latest.draft() = n;
        latest.publish();
    }
    EXPECT_EQ(*kept, 20);
    EXPECT_TRUE(latest.take(isKept));
    EXPECT_EQ(*latest.newest(), 23) << "the newest wins";
    EXPECT_EQ(*kept, 20);
    EXPECT_FALSE(latest.take(isKept)) << "taken once";
}

/// Shares of memory that the writer uses again. Values are as large as some cache lines, so that a torn one shows;
/// under ThreadSanitizer this is also the proof of the ordering, and that no share ends on the reader's thread.
TEST(LatestPair, WhatTheReaderUsesIsNeverWrittenAndFreedByTheWriterOnly)
{
    struct Slot {
        std::array<int, 64> words{};
        std::thread::id     writer{};
        std::atomic<bool>*  elsewhere = nullptr;
        ~Slot() { *elsewhere = *elsewhere || std::this_thread::get_id() != writer; }
    };
    constexpr int                           kMessages = 100'000;
    std::atomic<bool>                       elsewhere = false; // outlives what ends with the next
    LatestPair<std::shared_ptr<const Slot>> latest;
    std::size_t                             slots = 0;
    std::thread                             writer([&] {
        std::array<std::shared_ptr<Slot>, 6> ring;
        for (int n = 1; n <= kMessages; ++n) {
            auto& slot = *std::ranges::find_if(ring, [](const auto& s) { return s.use_count() <= 1; });
            if (!slot || n % 1000 == 0) { // now and then memory goes, as with a solver that is made anew
                slot            = std::make_shared<Slot>();
                slot->writer    = std::this_thread::get_id();
                slot->elsewhere = &elsewhere;
            }
            slot->words.fill(n);
            latest.draft() = slot;
            latest.publish();
        }
        slots = std::size_t(std::ranges::count_if(ring, [](const auto& s) { return s != nullptr; }));
    });
    const Slot*                             inUse = nullptr;
    int                                     last = 0, torn = 0, backwards = 0;
    const auto                              check = [&](const Slot& slot) {
        torn += !std::ranges::all_of(slot.words, [&](int v) { return v == slot.words[0]; });
    };
    while (last < kMessages) {
        if (!latest.take([&](const auto& value) { return value && value.get() == inUse; })) continue;
        const Slot* const newest = latest.newest()->get();
        if (inUse) check(*inUse); // the old one and the new one lie there side by side
        check(*newest);
        backwards += newest->words[0] <= last;
        last = newest->words[0];
        if (last % 3 != 0) inUse = newest; // every third is not fit for use
    }
    writer.join();
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(backwards, 0);
    EXPECT_LE(slots, 6U);
    EXPECT_FALSE(elsewhere) << "the reader freed memory";
}

} // namespace
} // namespace palp
