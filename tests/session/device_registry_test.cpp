#include "engine/session/device_registry.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "device/falcon/falcon_record.h"
#include "engine/core/contract.h"
#include "engine/session/gripped_falcon.h"

namespace palp {
namespace {

std::string refusal(std::string_view hand, const DeviceOptionValues& options)
{
    try {
        demandOptionsOf(hand, options);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(DeviceRegistry, EachRecordSaysWhatItsReadersNeed)
{
    std::set<std::string_view> names;
    for (const DeviceRecord* record : deviceRecords()) {
        EXPECT_TRUE(names.insert(record->name).second) << record->name << " twice";
        EXPECT_FALSE(record->model.empty()) << record->name;
        EXPECT_NE(record->make, nullptr) << record->name;
        EXPECT_EQ(record->list != nullptr, !record->simulated) << record->name;
        EXPECT_EQ(record->support != nullptr, !record->simulated) << record->name;
        EXPECT_EQ(deviceNamed(record->name), record);
        for (const DeviceOption& option : record->options) {
            EXPECT_TRUE(option.flag.starts_with("--")) << option.flag;
            EXPECT_FALSE(option.help.empty()) << option.flag;
            EXPECT_EQ(option.kind == DeviceOption::Kind::number, option.least < option.most) << option.flag;
        }
    }
}

TEST(DeviceRegistry, KnowsEveryDeviceThatIsBuiltIn)
{
    for (const char* name : {"falcon", "haply", "forcedimension", "openhaptics", "bridge", "spacemouse", "mouse", "arm", "falcon-emulator", "haply-emulator"})
        EXPECT_NE(deviceNamed(name), nullptr) << name;
}

TEST(DeviceRegistry, ANameMayHaveThePathOfADeviceThatIsPluggedIn)
{
    EXPECT_EQ(deviceNamed("falcon@1-2.3"), &kFalconRecord);
    EXPECT_EQ(devicePath("falcon@1-2.3"), "1-2.3");
    EXPECT_EQ(devicePath("falcon"), "");
    EXPECT_EQ(deviceNamed("haply:127.0.0.1:10001"), deviceNamed("haply"));
    EXPECT_EQ(devicePath("haply:127.0.0.1:10001"), "127.0.0.1:10001");
    EXPECT_EQ(devicePath("haply@127.0.0.1:10001/049D"), "127.0.0.1:10001/049D");
    EXPECT_EQ(deviceNamed("falcon-emulator@1-2"), nullptr) << "it is plugged in nowhere";
    EXPECT_EQ(deviceNamed("falco"), nullptr);
    EXPECT_EQ(deviceNamed(""), nullptr);
}

TEST(DeviceRegistry, AnOptionIsTakenByItsDevicesAloneAndWithinItsBounds)
{
    EXPECT_EQ(refusal("falcon", {{"--falcon-counts", "4200"}}), "");
    EXPECT_EQ(refusal("falcon-emulator", {{"--falcon-counts", "4200"}, {"--falcon-cold", "true"}}), "");
    EXPECT_EQ(refusal("scan", {{"--falcon-counts", ""}}), "") << "an empty text was not given";
    EXPECT_EQ(refusal("scan", {{"--falcon-counts", "4200"}}),
              "--falcon-counts is an option of --hand falcon or falcon-emulator, found --hand scan");
    EXPECT_EQ(refusal("falcon", {{"--falcon-cold", "true"}}),
              "--falcon-cold is an option of --hand falcon-emulator, found --hand falcon");
    EXPECT_EQ(refusal("falcon-emulator", {{"--falcon-counts", "50000"}}),
              "--falcon-counts: expected 2000 to 10000, found 50000");
}

} // namespace
} // namespace palp
