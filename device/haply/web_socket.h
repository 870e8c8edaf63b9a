#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

// WebSocket as far as a service on this machine needs it: no extensions, no compression, no TLS.
// source: RFC 6455, "The WebSocket Protocol"
namespace palp {

/// Bytes that break the protocol.
class WebSocketError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

enum class WebSocketKind : std::uint8_t { text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

struct WebSocketMessage {
    WebSocketKind kind = WebSocketKind::text;
    std::string   payload{};
};

/// The side that sends the frames: a client masks them, a server must not.
enum class WebSocketSide : std::uint8_t { client, server };

inline constexpr std::size_t kMostWebSocketMessage = std::size_t(1) << 20U; ///< [byte] a longer one is refused
inline constexpr std::size_t kMostHttpHead         = 8192;                  ///< [byte] of request or answer

/// Encodes a message as one frame.
/// \param mask  with which a client hides its payload; a server's frames have none
[[nodiscard]] std::string webSocketFrame(WebSocketKind kind, std::string_view payload,
                                         std::optional<std::array<std::uint8_t, 4>> mask = {});

/// Reads messages from bytes in any pieces: fragments are joined, control frames may stand between them.
/// \thread one
class WebSocketReader {
public:
    /// \param from  who sends the frames
    explicit WebSocketReader(WebSocketSide from) : from_(from) {}

    void feed(std::span<const std::uint8_t> bytes);

    /// Returns the next whole message; empty if more bytes are needed.
    /// \throws WebSocketError; nothing can be read after that
    [[nodiscard]] std::optional<WebSocketMessage> next();

private:
    std::string                  bytes_;    ///< not read yet, from read_ on
    std::size_t                  read_ = 0; ///< [byte]
    std::optional<WebSocketKind> open_;     ///< of a message whose last fragment has not come
    std::string                  message_;  ///< its fragments so far
    WebSocketSide                from_;
};

/// A head of HTTP and what follows it.
struct HttpHead {
    std::string               first{};                              ///< "HTTP/1.1 101 Switching Protocols"
    std::string               fields{};                             ///< one a line
    std::size_t               size = 0;                             ///< [byte] with the empty line
    [[nodiscard]] std::string field(std::string_view wanted) const; ///< its value; empty: none
};

/// Reads a head from the start of some bytes; empty if its end has not come.
/// \throws WebSocketError if it is longer than kMostHttpHead
[[nodiscard]] std::optional<HttpHead> readHttpHead(std::string_view bytes);

/// Returns the request by which a client opens a connection.
/// \param key  16 bytes in base64
[[nodiscard]] std::string webSocketRequest(std::string_view host, std::string_view key);

/// Returns what a server answers to a key: the SHA-1 of the key and a fixed text, in base64.
[[nodiscard]] std::string webSocketAccept(std::string_view key);

[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

} // namespace palp
