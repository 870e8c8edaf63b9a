#pragma once
#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/cloud/point_cloud_io.h"
#include "engine/core/contract.h"

namespace palp {

/// Reads the bytes of a file that is called "test".
inline LoadedCloud parsed(const std::string& bytes, CloudFormat format, const CloudReadSettings& settings = {})
{
    std::istringstream stream(bytes);
    return parseCloud(stream, bytes.size(), "test", format, settings);
}

/// The sentence with which the bytes are refused; empty if they are not.
inline std::string refusalOf(const std::string& bytes, CloudFormat format, const CloudReadSettings& settings = {})
{
    try {
        static_cast<void>(parsed(bytes, format, settings));
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// Whether `text` contains every one of `parts`; says which one is missing.
inline testing::AssertionResult contains(const std::string& text, const std::vector<std::string>& parts)
{
    for (const std::string& part : parts)
        if (text.find(part) == std::string::npos)
            return testing::AssertionFailure() << "expected \"" << part << "\" in \"" << text << '"';
    return testing::AssertionSuccess();
}

/// Appends a number as it stands in a binary file.
template <class T>
void append(std::string& bytes, T value, std::endian order = std::endian::little)
{
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (order != std::endian::native) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

/// Returns the bytes that hexadecimal digits stand for.
inline std::string bytesOfHex(std::string_view digits)
{
    std::string bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes += char(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
    return bytes;
}

inline CloudReadSettings withProperty(const std::string& name)
{
    CloudReadSettings settings;
    settings.stiffnessProperty = name;
    return settings;
}

inline CloudReadSettings withRange(const std::string& property, double from, double to,
                                   RangeScale scale = RangeScale::linear)
{
    CloudReadSettings settings = withProperty(property);
    settings.range             = StiffnessRange{from, to, scale};
    return settings;
}

} // namespace palp
