#include "engine/cloud/cloud_format.h"

#include <set>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

template <class Lookup>
std::string refusalOf(const Lookup& lookup)
{
    try {
        static_cast<void>(lookup());
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

TEST(CloudFormats, EachHasOneRowAndEachExtensionOneFormat)
{
    std::set<CloudFormat>      formats;
    std::set<std::string_view> extensions;
    for (const CloudFormatRecord& record : cloudFormats()) {
        EXPECT_TRUE(formats.insert(record.format).second) << record.name;
        EXPECT_EQ(recordOf(record.format).name, record.name);
        EXPECT_FALSE(record.extensions[0].empty()) << record.name;
        for (const std::string_view extension : record.extensions) {
            if (extension.empty()) continue;
            EXPECT_TRUE(extension.starts_with('.')) << extension;
            EXPECT_TRUE(extensions.insert(extension).second) << extension << " belongs to two formats";
            EXPECT_EQ(formatToRead("a" + std::string(extension)).format, record.format);
        }
    }
}

TEST(CloudFormats, AreFoundByTheExtensionInAnyLetters)
{
    EXPECT_EQ(formatToRead("folder.d/Scan.PLY").format, CloudFormat::ply);
    EXPECT_EQ(formatToRead("a.b.Csv").format, CloudFormat::text);
    EXPECT_EQ(formatToWrite("x.pcd").format, CloudFormat::pcd);
}

TEST(CloudFormats, ARefusalNamesTheKnownExtensions)
{
    for (const char* const name : {"scan.las", "scan", ".ply", "scan.ply/", "scanply"}) {
        const std::string read  = refusalOf([&] { return formatToRead(name).format; });
        const std::string write = refusalOf([&] { return formatToWrite(name).format; });
        EXPECT_TRUE(contains(read, {name, extensionsFor(CloudUse::reading)})) << read;
        EXPECT_TRUE(contains(write, {name, extensionsFor(CloudUse::writing)})) << write;
    }
}

TEST(CloudFormats, AFormatThatIsOnlyReadSaysSoWhenItIsToBeWritten)
{
    EXPECT_TRUE(contains(refusalOf([&] { return formatToWrite("a.vtp").format; }),
                         {"a.vtp", ".ply", "VTK XML files are read but not written"}));
}

TEST(CloudFormats, ListsNameWhatEachUseCanDo)
{
    for (const CloudFormatRecord& record : cloudFormats())
        for (const std::string_view extension : record.extensions) {
            if (extension.empty()) continue;
            const auto named = [&](CloudUse use) { return contains(extensionsFor(use), {std::string(extension)}); };
            EXPECT_TRUE(named(CloudUse::reading)) << extension;
            EXPECT_EQ(named(CloudUse::writing), record.write != nullptr) << extension;
            EXPECT_EQ(named(CloudUse::writingFaces), record.write && record.holdsFaces) << extension;
        }
}

} // namespace
} // namespace palp
