#pragma once
#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace palp {

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
        others.push_back(std::async(std::launch::async, [&, piece] { work(edge(piece), edge(piece + 1)); }));
    work(edge(0), edge(1));
    for (std::future<void>& other : others) other.get();
}

} // namespace palp
