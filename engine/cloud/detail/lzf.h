#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace palp {

/// Unpacks data of Lehmann's LZF, which PCD files use. A control byte below 32 announces that many literal bytes and
/// one more; any other has a length in its upper three bits (7: add the next byte) and, with the byte after that, a
/// distance in its lower five: the output repeats length + 2 bytes from distance + 1 bytes before its end.
/// \param unpacked  exactly as long as the data
/// \return          what is wrong and at which byte of `packed`; empty if nothing
/// \source          Lehmann, liblzf 3.6 (2000-2010), the format as its header describes it
[[nodiscard]] std::optional<std::string> unpackLzf(std::span<const std::byte> packed, std::span<std::byte> unpacked);

} // namespace palp
