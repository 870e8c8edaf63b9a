#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace palp {

/// Makes room for so many values in all, twice as much as there was at least: one reserve() for each of many small
/// parts of a file would copy all of the earlier ones every time.
template <class Value>
void makeRoomFor(std::vector<Value>& values, std::size_t count)
{
    if (count > values.capacity()) values.reserve(std::max(count, 2 * values.capacity()));
}

} // namespace palp
