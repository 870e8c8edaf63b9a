// The frames of WebSocket, against the examples of its standard and against bytes that break it.
#include "device/haply/web_socket.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace palp {
namespace {

std::span<const std::uint8_t> bytesOf(std::string_view text)
{
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Reads all messages of some bytes, fed in pieces.
std::vector<WebSocketMessage> readAll(std::string_view bytes, std::size_t piece, WebSocketSide from)
{
    WebSocketReader               reader(from);
    std::vector<WebSocketMessage> messages;
    for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
        reader.feed(bytesOf(bytes.substr(0, piece)));
        while (auto message = reader.next()) messages.push_back(std::move(*message));
    }
    return messages;
}

/// Section 1.3 of RFC 6455 has this key and its answer.
TEST(WebSocket, AcceptsTheKeyOfTheStandardsExample)
{
    EXPECT_EQ(webSocketAccept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
    EXPECT_EQ(base64(bytesOf("the sample nonce")), "dGhlIHNhbXBsZSBub25jZQ==");
}

/// Section 5.7 has these bytes.
TEST(WebSocket, FramesAreThoseOfTheStandardsExamples)
{
    EXPECT_EQ(webSocketFrame(WebSocketKind::text, "Hello"), "\x81\x05Hello");
    EXPECT_EQ(webSocketFrame(WebSocketKind::text, "Hello", std::array<std::uint8_t, 4>{0x37, 0xfa, 0x21, 0x3d}),
              "\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58");
    EXPECT_EQ(webSocketFrame(WebSocketKind::binary, std::string(256, 'x')).substr(0, 4),
              std::string("\x82\x7E\x01\x00", 4));
    EXPECT_EQ(webSocketFrame(WebSocketKind::binary, std::string(65536, 'x')).substr(0, 10),
              std::string("\x82\x7F\x00\x00\x00\x00\x00\x01\x00\x00", 10));
}

TEST(WebSocket, WhatIsWrittenIsReadInAnyPieces)
{
    for (const std::size_t size : {0U, 1U, 125U, 126U, 65535U, 65536U})
        for (const std::size_t piece : {std::size_t(1), std::size_t(7), std::size_t(1) << 20U}) {
            std::string text(size, 'a');
            for (std::size_t n = 0; n < size; ++n) text[n] = char('a' + n % 26);
            const std::array<std::uint8_t, 4> mask{1, 2, 200, 255};
            const auto plain  = readAll(webSocketFrame(WebSocketKind::text, text), piece, WebSocketSide::server);
            const auto masked = readAll(webSocketFrame(WebSocketKind::text, text, mask), piece, WebSocketSide::client);
            ASSERT_EQ(plain.size(), 1U) << size;
            ASSERT_EQ(masked.size(), 1U) << size;
            EXPECT_EQ(plain[0].payload, text);
            EXPECT_EQ(masked[0].payload, text);
        }
}

TEST(WebSocket, FragmentsAreJoinedAndControlFramesMayStandBetween)
{
    const std::string bytes = std::string("\x01\x03Hel", 5) + webSocketFrame(WebSocketKind::ping, "?") +
                              std::string("\x80\x02lo", 4) + webSocketFrame(WebSocketKind::text, "next");
    const auto messages = readAll(bytes, 1, WebSocketSide::server);
    ASSERT_EQ(messages.size(), 3U);
    EXPECT_EQ(messages[0].kind, WebSocketKind::ping);
    EXPECT_EQ(messages[1].payload, "Hello");
    EXPECT_EQ(messages[2].payload, "next");
}

TEST(WebSocket, BytesThatBreakTheStandardAreRefused)
{
    struct Case {
        const char* what;
        std::string bytes;
    };
    for (const Case& c :
         {Case{"a reserved bit", std::string("\xC1\x00", 2)}, Case{"an unknown kind", std::string("\x83\x00", 2)},
          Case{"a masked frame of a server", std::string("\x81\x80\x01\x02\x03\x04", 6)},
          Case{"a long ping", std::string("\x89\x7E\x00\x80", 4)},
          Case{"a ping in fragments", std::string("\x09\x00", 2)},
          Case{"a fragment without a start", std::string("\x80\x00", 2)},
          Case{"a start within a message", std::string("\x01\x00\x01\x00", 4)},
          Case{"more than 1 MiB", std::string("\x81\x7F\x00\x00\x00\x00\x00\x10\x00\x01", 10)},
          Case{"a length of 2^63", std::string("\x81\x7F\x80\x00\x00\x00\x00\x00\x00\x00", 10)}})
        EXPECT_THROW(readAll(c.bytes, 100, WebSocketSide::server), WebSocketError) << c.what;
    EXPECT_THROW(readAll(webSocketFrame(WebSocketKind::text, "a"), 9, WebSocketSide::client), WebSocketError)
        << "a client's frames are masked";
    const std::string half(600 << 10U, 'x'); // two of them are too many
    std::string       first = webSocketFrame(WebSocketKind::text, half), last = first;
    first[0] = 0x01;
    last[0]  = char(0x80);
    EXPECT_THROW(readAll(first + last, 1 << 20U, WebSocketSide::server), WebSocketError) << "in fragments as well";
}

TEST(WebSocket, TheStandardsKindsOfFramesAreTakenAndNoOthers)
{
    for (unsigned kind = 0; kind < 16; ++kind) {
        const std::string frame{char(0x80U | kind), 0};
        if (kind == 1 || kind == 2 || (kind >= 8 && kind <= 10)) {
            const auto read = readAll(frame, 2, WebSocketSide::server);
            ASSERT_EQ(read.size(), 1U) << kind;
            EXPECT_EQ(unsigned(read[0].kind), kind);
        } else {
            EXPECT_THROW(readAll(frame, 2, WebSocketSide::server), WebSocketError) << kind;
        }
    }
    for (const unsigned reserved : {0x10U, 0x20U, 0x40U})
        EXPECT_THROW(readAll(std::string{char(0x81U | reserved), 0}, 2, WebSocketSide::server), WebSocketError);
}

TEST(WebSocket, SizesAreTakenUpToTheirBounds)
{
    const auto passes = [](WebSocketKind kind, std::size_t size) {
        return readAll(webSocketFrame(kind, std::string(size, 'x')), 1 << 16U, WebSocketSide::server).size() == 1;
    };
    EXPECT_TRUE(passes(WebSocketKind::ping, 125));
    EXPECT_THROW(passes(WebSocketKind::ping, 126), WebSocketError);
    EXPECT_TRUE(passes(WebSocketKind::text, kMostWebSocketMessage));
    EXPECT_THROW(passes(WebSocketKind::text, kMostWebSocketMessage + 1), WebSocketError);

    const std::string half(kMostWebSocketMessage / 2, 'x');
    std::string       first = webSocketFrame(WebSocketKind::text, half), last = first;
    first[0] = 0x01;
    last[0]  = char(0x80);
    EXPECT_EQ(readAll(first + last, 1 << 16U, WebSocketSide::server).size(), 1U) << "both together are as much";
}

TEST(WebSocket, AHeadOfHttpEndsWithinItsBoundAndSaysWhere)
{
    std::string bytes = "HTTP/1.1 200 OK\r\nA:";
    bytes.append(kMostHttpHead - 4 - bytes.size(), 'x').append("\r\n\r\n");
    const auto most = readHttpHead(bytes + "rest");
    ASSERT_TRUE(most);
    EXPECT_EQ(most->size, kMostHttpHead);
    EXPECT_THROW((void)readHttpHead("y" + bytes), WebSocketError);
    EXPECT_FALSE(readHttpHead(bytes.substr(0, kMostHttpHead - 1)));
    const auto least = readHttpHead("a\r\n\r\n");
    ASSERT_TRUE(least);
    EXPECT_EQ(least->first, "a");
    EXPECT_EQ(least->fields, "");
    EXPECT_EQ(readHttpHead("a\r\nB:\r\nC:  \t\r\n\r\n")->field("c"), "") << "nothing but blanks";
}

TEST(WebSocket, HeadsOfHttpAreRead)
{
    EXPECT_FALSE(readHttpHead("HTTP/1.1 101 Switching\r\nA: b\r\n"));
    const auto head =
        readHttpHead("HTTP/1.1 101 Switching\r\nSec-WebSocket-ACCEPT: \t x= \r\nno colon\r\nLast:y\r\n\r\nrest");
    ASSERT_TRUE(head);
    EXPECT_EQ(head->first, "HTTP/1.1 101 Switching");
    EXPECT_EQ(head->field("sec-websocket-accept"), "x=");
    EXPECT_EQ(head->field("last"), "y");
    EXPECT_EQ(head->field("none"), "");
    EXPECT_THROW((void)readHttpHead(std::string(kMostHttpHead, 'x')), WebSocketError);
}

} // namespace
} // namespace palp
