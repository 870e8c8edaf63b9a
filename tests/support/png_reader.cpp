#include "tests/support/png_reader.h"

#include <stdexcept>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace palp::test {

Image decodePng(std::string_view bytes)
{
    int   width = 0, height = 0, channels = 0;
    auto* data = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()), &width,
                                       &height, &channels, 3);
    if (data == nullptr || channels != 3) throw std::runtime_error("no RGB PNG");
    Image image(width, height);
    for (std::size_t n = 0; n < image.pixels.size(); ++n)
        image.pixels[n] = {data[3 * n], data[3 * n + 1], data[3 * n + 2]};
    stbi_image_free(data);
    return image;
}

} // namespace palp::test
