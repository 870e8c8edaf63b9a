#pragma once
#include <chrono>
#include <future>
#include <new>
#include <utility>

#include "engine/core/contract.h"

namespace palp {

/// Does the work on another thread. If it takes longer than 50 ms, calls `wait` repeatedly until that returns false or
/// the work is done.
/// \return what the work returns
/// \throws what it throws, and Error for a machine with too little memory
template <class Work, class Wait>
auto inBackground(Work work, Wait wait)
{
    auto made = std::async(std::launch::async, [work = std::move(work)] {
        try {
            return work();
        } catch (const std::bad_alloc&) {
            throw Error("there is not enough memory for it; try fewer points");
        }
    });
    if (made.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready) return made.get();
    while (made.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        if (!wait()) break;
    return made.get();
}

} // namespace palp
