#include "engine/tools/plot/png.h"

#include <new>
#include <type_traits>

#include "engine/core/contract.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace palp {
namespace {

// Keeps the byte counts of the encoder, which are int, far from overflow.
constexpr std::size_t kMostPixels = std::size_t(1) << 26;

} // namespace

std::string encodePng(const Image& image)
{
    static_assert(sizeof(Rgb8) == 3 && std::is_trivially_copyable_v<Rgb8>, "pixels are handed over as packed bytes");
    PALP_EXPECT(image.width > 0 && image.height > 0, "a picture has at least one pixel");
    PALP_EXPECT(image.pixels.size() == std::size_t(image.width) * std::size_t(image.height), "one colour per pixel");
    PALP_EXPECT(image.pixels.size() <= kMostPixels, "found " + std::to_string(image.pixels.size()) + " pixels");

    std::string bytes;
    const auto  append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(size));
    };
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(), 3 * image.width) == 0)
        throw std::bad_alloc(); // the encoder fails for nothing else
    return bytes;
}

std::string base64(std::string_view bytes)
{
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto                 byte    = [&](std::size_t i) {
        return i < bytes.size() ? unsigned(static_cast<unsigned char>(bytes[i])) : 0U;
    };
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        text += kDigits[group >> 18];
        text += kDigits[group >> 12 & 63];
        text += i + 1 < bytes.size() ? kDigits[group >> 6 & 63] : '=';
        text += i + 2 < bytes.size() ? kDigits[group & 63] : '=';
    }
    return text;
}

} // namespace palp
