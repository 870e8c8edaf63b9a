#pragma once
#include <algorithm>
#include <cstddef>
#include <future>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace palp {

/// Begins work on another thread. Where the system starts none any more, whoever waits for the work does it.
template <class Work>
[[nodiscard]] std::future<void> beside(const Work& work)
{
    try {
        return std::async(std::launch::async, work);
    } catch (const std::system_error&) {
        return std::async(std::launch::deferred, work);
    }
}

/// Runs work(begin, end) over pieces that together are [0, count), on as many threads as the machine has cores, and
/// waits. The caller's thread takes part. What the pieces are may differ between machines, so the work on an element
/// must not depend on the others.
/// \throws  what the work throws, once every piece has ended
/// \thread  any; starts threads
template <class Work>
void inParallel(std::size_t count, std::size_t leastPiece, Work&& work)
{
    const std::size_t cores  = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t pieces = std::clamp<std::size_t>(count / std::max<std::size_t>(1, leastPiece), 1, cores);
    std::vector<std::future<void>> others;
    const auto                     edge = [&](std::size_t piece) { return count * piece / pieces; };
    for (std::size_t piece = 1; piece < pieces; ++piece)
        others.push_back(beside([&, piece] { work(edge(piece), edge(piece + 1)); }));
    work(edge(0), edge(1));
    for (std::future<void>& other : others) other.get();
}

/// Sorts values of which no two are equal, on all cores: the result does not depend on their number.
/// \thread  any; starts threads, allocates
template <class Value>
void sortInParallel(std::vector<Value>& values)
{
    constexpr std::size_t    kWorthAThread = 100'000;
    std::vector<std::size_t> ends; // of the sorted pieces
    std::mutex               mutex;
    inParallel(values.size(), kWorthAThread, [&](std::size_t begin, std::size_t end) {
        std::sort(values.begin() + std::ptrdiff_t(begin), values.begin() + std::ptrdiff_t(end));
        const std::lock_guard lock(mutex);
        ends.push_back(end);
    });
    std::sort(ends.begin(), ends.end());
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
        std::inplace_merge(values.begin(), values.begin() + std::ptrdiff_t(ends[k]),
                           values.begin() + std::ptrdiff_t(ends[k + 1]));
}

} // namespace palp
