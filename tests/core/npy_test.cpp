#include "engine/core/npy.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// A .npy file of version 1 with the given header and numbers.
template <class Number>
std::string npyOf(const std::string& header, std::initializer_list<Number> numbers)
{
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += char(header.size() & 0xff);
    bytes += char(header.size() >> 8);
    bytes += header;
    for (const Number number : numbers) {
        char raw[sizeof(Number)];
        std::memcpy(raw, &number, sizeof(Number));
        bytes.append(raw, sizeof(Number));
    }
    return bytes;
}

NodeField parsed(const std::string& bytes)
{
    std::istringstream in(bytes);
    return parseNpy(in, bytes.size(), "a.npy");
}

std::string refusal(const std::string& bytes)
{
    return refusalOf([&] { static_cast<void>(parsed(bytes)); });
}

std::string headerOf(const std::string& type, const std::string& shape)
{
    return "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
}

TEST(Npy, WhatIsWrittenIsReadBackBitForBit)
{
    const TemporaryFolder folder;
    NodeField             field(3, 4);
    for (std::size_t k = 0; k < field.values().size(); ++k) field.values()[k] = std::sin(double(k)) / 3;
    field(1, 1) = -0.0;
    field(2, 3) = std::numeric_limits<double>::denorm_min();

    writeNpy(folder / "w.npy", field);
    const NodeField again = readNpy(folder / "w.npy");

    EXPECT_EQ(again.nodesX(), 3);
    EXPECT_EQ(again.nodesZ(), 4);
    EXPECT_EQ(std::memcmp(again.values().data(), field.values().data(), 12 * sizeof(double)), 0);
}

TEST(Npy, TheWrittenHeaderIsOfVersionOneAndNumbersBeginAtAMultipleOf64)
{
    const TemporaryFolder folder;
    writeNpy(folder / "w.npy", NodeField(3, 4, 2.5));

    const std::string bytes = contentsOf(folder / "w.npy");

    ASSERT_EQ(bytes.size() % 64, 12 * sizeof(double) % 64);
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    EXPECT_NE(bytes.find("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }"), std::string::npos);
    EXPECT_EQ(bytes[bytes.size() - 12 * sizeof(double) - 1], '\n');
}

TEST(Npy, TheFirstIndexIsTheSlowOne)
{
    const NodeField field = parsed(npyOf<double>(headerOf("<f8", "(2, 3)"), {0, 1, 2, 10, 11, 12}));

    EXPECT_EQ(field(0, 2), 2);
    EXPECT_EQ(field(1, 0), 10);
}

TEST(Npy, ReadsSinglePrecision)
{
    EXPECT_EQ(parsed(npyOf<float>(headerOf("<f4", "(1, 2)"), {0.1f, -2.f}))(0, 0), double(0.1f));
}

TEST(Npy, ReadsVersionsTwoAndThree)
{
    const std::string header = headerOf("<f8", "(1, 1)");
    for (const char version : {2, 3}) {
        std::string bytes = npyOf<double>(header, {7});
        bytes[6]          = version;
        bytes.insert(10, 2, '\0'); // the header's length takes four bytes
        EXPECT_EQ(parsed(bytes)(0, 0), 7) << int(version);
    }
}

/// The same file with a header of another length, which takes two bytes in version 1 and four in version 2.
std::string withHeaderOf(std::size_t size, char version)
{
    std::string header = headerOf("<f8", "(1, 1)");
    header.insert(header.size() - 1, size - header.size(), ' ');
    std::string bytes = npyOf<double>(header, {7});
    bytes[6]          = version;
    if (version > 1) bytes.insert(10, {char(size >> 16), '\0'});
    return bytes;
}

TEST(Npy, AHeaderMayHave64KiBAndNoMore)
{
    for (const std::size_t size : {255U, 256U, 300U, 4660U, 65535U}) {
        EXPECT_EQ(parsed(withHeaderOf(size, 1))(0, 0), 7) << size;
        EXPECT_EQ(parsed(withHeaderOf(size, 2))(0, 0), 7) << size;
    }
    EXPECT_EQ(parsed(withHeaderOf(65536, 2))(0, 0), 7);
    EXPECT_TRUE(holds(refusal(withHeaderOf(65537, 2)), {"65537 bytes", "65545 are left", "at most 65536"}));
    std::string huge = withHeaderOf(300, 2);
    huge[11]         = 1;
    EXPECT_TRUE(holds(refusal(huge), {std::to_string(300 + (1 << 24)) + " bytes"}));
}

TEST(Npy, WhereAFileEndsIsSaidToTheByte)
{
    const std::string whole = npyOf<double>(headerOf("<f8", "(1, 1)"), {1});
    EXPECT_TRUE(holds(refusal(whole.substr(0, 7)), {"its version", "2 bytes from byte 6", "found 1"}));
    EXPECT_TRUE(holds(refusal(whole.substr(0, 8)), {"length of its header", "2 bytes from byte 8", "found 0"}));
}

TEST(Npy, EitherQuotesAreAHeaders)
{
    for (const char* type : {"<f8", "<f4"}) {
        std::string header = headerOf(type, "(1, 1)");
        std::ranges::replace(header, '\'', '"');
        const std::string bytes = type[2] == '8' ? npyOf<double>(header, {7}) : npyOf<float>(header, {7});
        EXPECT_EQ(parsed(bytes)(0, 0), 7) << type;
    }
}

TEST(Npy, OtherKindsOfArraysAreRefusedWithTheKindFound)
{
    const auto array = [](const std::string& header) { return refusal(npyOf<double>(header, {1})); };

    EXPECT_TRUE(holds(array(headerOf(">f8", "(1, 1)")), {"a.npy", ">f8", "<f8"}));
    EXPECT_TRUE(holds(array(headerOf("<i8", "(1, 1)")), {"<i8", "astype"}));
    EXPECT_TRUE(
        holds(array("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1, 1), }"), {"[('a', '<f8')]"}));
    EXPECT_TRUE(holds(array("{'descr': '<f8', 'fortran_order': True, 'shape': (1, 1), }"), {"C order", "True"}));
    for (const char* shape : {"(1,)", "()", "(1, 1, 1)", "(0, 1)", "(-1, 1)", "(1.5, 1)", "1", "(1, 1", "(1 x 1)"})
        EXPECT_TRUE(holds(array(headerOf("<f8", shape)), {"two dimensions", shape})) << array(headerOf("<f8", shape));
}

TEST(Npy, AShapeOfABillionNumbersIsRefusedBeforeMemoryIsTaken)
{
    const auto array = [](const std::string& shape) { return refusal(npyOf<double>(headerOf("<f8", shape), {1})); };

    EXPECT_TRUE(holds(array("(1000000, 1000000)"), {"1000000 x 1000000", "8 bytes"}));
    EXPECT_TRUE(
        holds(array("(2147483647, 2147483647)"), {"asks for", "2147483647"})); // 2^65 bytes: must not wrap around
    EXPECT_TRUE(holds(array("(2147483648, 2147483648)"), {"too large", "2147483648"}));
    EXPECT_TRUE(holds(array("(99999999999999999999, 1)"), {"too large", "99999999999999999999"}));
    EXPECT_TRUE(holds(array("(1, 99999999999)"), {"too large", "99999999999"}));
    EXPECT_TRUE(holds(array("(99999999999, 0, 1)"), {"two dimensions"}));
    EXPECT_TRUE(holds(array("(536870913, 4)"), {"536870913 x 4"}));
}

TEST(Npy, AFileThatEndsAnywhereTooEarlyIsRefused)
{
    const std::string whole = npyOf<double>(headerOf("<f8", "(1, 2)"), {1, 2});

    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_TRUE(holds(refusal(whole.substr(0, size)), {"a.npy"})) << size;
    EXPECT_TRUE(holds(refusal(whole + "x"), {"17 bytes"}));
    EXPECT_EQ(refusal(whole), "");
}

TEST(Npy, AStreamShorterThanClaimedIsRefused)
{
    const std::string  whole = npyOf<double>(headerOf("<f8", "(1, 2)"), {1, 2});
    std::istringstream in(whole.substr(0, whole.size() - 1));

    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(parseNpy(in, whole.size(), "a.npy")); }), {"ends within"}));
}

TEST(Npy, ForeignBytesAndBrokenHeadersAreRefused)
{
    EXPECT_TRUE(holds(refusal("{\"size\": [1, 1]}"), {"not a .npy file"}));
    EXPECT_TRUE(holds(refusal(npyOf<double>("{'descr': '<f8', 'shape': (1, 1), }", {1})), {"fortran_order"}));
    EXPECT_TRUE(holds(refusal(npyOf<double>("", {1})), {"descr"}));
    std::string future = npyOf<double>(headerOf("<f8", "(1, 1)"), {1});
    future[6]          = 4;
    EXPECT_TRUE(holds(refusal(future), {"version", "4"}));
    future[6] = 0;
    EXPECT_TRUE(holds(refusal(future), {"version", "found 0"}));
}

TEST(Npy, ValuesThatAreNotFiniteAreNamedWithTheirIndex)
{
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const auto   array = [](double bad) { return refusal(npyOf<double>(headerOf("<f8", "(2, 2)"), {1, 1, bad, 1})); };

    EXPECT_TRUE(holds(array(nan), {"[1, 0]", "NaN"}));
    EXPECT_TRUE(holds(array(-infinity), {"[1, 0]", "infinite"}));
    EXPECT_TRUE(
        holds(refusal(npyOf<float>(headerOf("<f4", "(1, 2)"), {1.f, float(infinity)})), {"[0, 1]", "infinite"}));
}

TEST(Npy, AMissingFileIsNamed)
{
    const TemporaryFolder folder;

    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readNpy(folder / "no.npy")); }), {"no.npy", "No such file"}));
}

} // namespace
} // namespace palp
