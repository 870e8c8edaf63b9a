#pragma once
#include <string_view>

#include "engine/tools/plot/png.h"

namespace palp::test {

/// Decodes a picture.
/// \throws std::runtime_error if the bytes are no PNG of 8 bit RGB
Image decodePng(std::string_view bytes);

} // namespace palp::test
