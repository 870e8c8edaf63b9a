#include "device/haply/web_socket.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <utility>
#include <vector>

namespace palp {
namespace {

constexpr unsigned    kFinal = 0x80, kReserved = 0x70, kOpcode = 0x0F, kMasked = 0x80, kLength = 0x7F;
constexpr unsigned    kContinuation = 0, kLeastControl = 8;
constexpr unsigned    kTwoBytes = 126, kEightBytes = 127; ///< lengths that stand for a longer field
constexpr std::size_t kMostControl = 125;                 ///< [byte]

/// Returns SHA-1 of a text, as FIPS 180-4 defines it.
std::array<std::uint8_t, 20> sha1(std::string_view text)
{
    std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const std::uint64_t       bits = std::uint64_t(bytes.size()) * 8;
    bytes.push_back(0x80);
    while (bytes.size() % 64 != 56) bytes.push_back(0);
    for (int shift = 56; shift >= 0; shift -= 8) bytes.push_back(std::uint8_t(bits >> unsigned(shift)));

    std::array<std::uint32_t, 5> h{0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
    for (std::size_t block = 0; block < bytes.size(); block += 64) {
        std::array<std::uint32_t, 80> w{};
        for (std::size_t n = 0; n < 64; ++n) w[n / 4] = w[n / 4] << 8U | bytes[block + n];
        for (std::size_t n = 16; n < 80; ++n) w[n] = std::rotl(w[n - 3] ^ w[n - 8] ^ w[n - 14] ^ w[n - 16], 1);
        auto [a, b, c, d, e] = h;
        for (std::size_t n = 0; n < 80; ++n) {
            const std::uint32_t f    = n < 20   ? ((b & c) | (~b & d)) + 0x5A827999
                                       : n < 40 ? (b ^ c ^ d) + 0x6ED9EBA1
                                       : n < 60 ? ((b & c) | (b & d) | (c & d)) + 0x8F1BBCDC
                                                : (b ^ c ^ d) + 0xCA62C1D6;
            const std::uint32_t next = std::rotl(a, 5) + f + e + w[n];
            e                        = d;
            d                        = c;
            c                        = std::rotl(b, 30);
            b                        = a;
            a                        = next;
        }
        const std::array<std::uint32_t, 5> add{a, b, c, d, e};
        for (std::size_t n = 0; n < 5; ++n) h[n] += add[n];
    }
    std::array<std::uint8_t, 20> out{};
    for (std::size_t n = 0; n < 20; ++n) out[n] = std::uint8_t(h[n / 4] >> (24 - 8 * (n % 4)));
    return out;
}

bool isSameWord(std::string_view a, std::string_view b)
{
    return std::ranges::equal(a, b,
                              [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool isKnown(unsigned opcode)
{
    return opcode <= 2 || (opcode >= kLeastControl && opcode <= 10);
}

} // namespace

std::string base64(std::span<const std::uint8_t> bytes)
{
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string    text;
    for (std::size_t n = 0; n < bytes.size(); n += 3) {
        const std::size_t have = std::min<std::size_t>(3, bytes.size() - n);
        unsigned          bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8U | (k < have ? bytes[n + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= have ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string webSocketAccept(std::string_view key)
{
    return base64(sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
}

std::string webSocketRequest(std::string_view host, std::string_view key)
{
    return "GET / HTTP/1.1\r\nHost: " + std::string(host) +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " +
           std::string(key) + "\r\n\r\n";
}

std::string webSocketFrame(WebSocketKind kind, std::string_view payload,
                           std::optional<std::array<std::uint8_t, 4>> mask)
{
    const std::size_t size = payload.size();
    const unsigned    bit  = mask ? kMasked : 0;
    std::string       frame(1, char(kFinal | unsigned(kind)));
    if (size < kTwoBytes) {
        frame += char(bit | unsigned(size));
    } else {
        const bool isShort = size <= 0xFFFF;
        frame += char(bit | (isShort ? kTwoBytes : kEightBytes));
        for (int shift = isShort ? 8 : 56; shift >= 0; shift -= 8)
            frame += char(std::uint8_t(std::uint64_t(size) >> unsigned(shift)));
    }
    if (!mask) return frame.append(payload);
    frame.append(mask->begin(), mask->end());
    for (std::size_t n = 0; n < size; ++n) frame += char(std::uint8_t(payload[n]) ^ (*mask)[n % 4]);
    return frame;
}

void WebSocketReader::feed(std::span<const std::uint8_t> bytes)
{
    bytes_.erase(0, std::exchange(read_, 0));
    bytes_.append(bytes.begin(), bytes.end());
}

std::optional<WebSocketMessage> WebSocketReader::next()
{
    for (;;) {
        const std::string_view here = std::string_view(bytes_).substr(read_);
        const auto             byte = [&](std::size_t n) { return unsigned(std::uint8_t(here[n])); };
        if (here.size() < 2) return {};
        const unsigned    opcode  = byte(0) & kOpcode;
        const bool        isFinal = (byte(0) & kFinal) != 0, isControl = opcode >= kLeastControl;
        const bool        isMasked = (byte(1) & kMasked) != 0;
        std::uint64_t     size     = byte(1) & kLength;
        const std::size_t field    = size == kTwoBytes ? 2 : size == kEightBytes ? 8 : 0;
        if ((byte(0) & kReserved) != 0 || !isKnown(opcode)) throw WebSocketError("a frame of an unknown kind");
        if (isMasked != (from_ == WebSocketSide::client))
            throw WebSocketError(isMasked ? "a masked frame from a server" : "a frame without a mask from a client");
        if (isControl && (!isFinal || size > kMostControl)) throw WebSocketError("a control frame that is too long");
        if (!isControl && (opcode == kContinuation) != open_.has_value())
            throw WebSocketError("a fragment without its message");
        if (here.size() < 2 + field) return {};
        if (field > 0) size = 0;
        for (std::size_t n = 0; n < field; ++n) size = size << 8U | byte(2 + n);
        if (size > kMostWebSocketMessage || message_.size() + size > kMostWebSocketMessage)
            throw WebSocketError("a message of more than 1 MiB");
        const std::size_t head = 2 + field + (isMasked ? 4 : 0);
        if (here.size() < head + size) return {};

        std::string payload(here.substr(head, std::size_t(size)));
        for (std::size_t n = 0; isMasked && n < payload.size(); ++n)
            payload[n] = char(std::uint8_t(payload[n]) ^ byte(head - 4 + n % 4));
        read_ += head + std::size_t(size);
        if (isControl) return WebSocketMessage{WebSocketKind(opcode), std::move(payload)};
        if (opcode != kContinuation) open_ = WebSocketKind(opcode);
        message_ += payload;
        if (isFinal) return WebSocketMessage{*std::exchange(open_, std::nullopt), std::exchange(message_, {})};
    }
}

std::string HttpHead::field(std::string_view wanted) const
{
    for (std::size_t at = 0; at < fields.size();) {
        const std::size_t      end   = std::min(fields.find("\r\n", at), fields.size());
        const std::string_view line  = std::string_view(fields).substr(at, end - at);
        const std::size_t      colon = line.find(':');
        at                           = end + 2;
        if (colon == std::string_view::npos || !isSameWord(line.substr(0, colon), wanted)) continue;
        const std::size_t from = line.find_first_not_of(" \t", colon + 1);
        if (from == std::string_view::npos) return {};
        return std::string(line.substr(from, line.find_last_not_of(" \t") + 1 - from));
    }
    return {};
}

std::optional<HttpHead> readHttpHead(std::string_view bytes)
{
    const std::size_t end = bytes.substr(0, kMostHttpHead).find("\r\n\r\n");
    if (end == std::string_view::npos) {
        if (bytes.size() >= kMostHttpHead) throw WebSocketError("a head of HTTP without an end");
        return {};
    }
    const std::string_view head = bytes.substr(0, end);
    const std::size_t      line = std::min(head.find("\r\n"), head.size());
    return HttpHead{std::string(head.substr(0, line)), std::string(head.substr(std::min(line + 2, head.size()))),
                    end + 4};
}

} // namespace palp
