#include "engine/core/volume_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/spatial_law.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

// Written by nibabel 5.0.0: 2 x 3 x 4 voxels, headers by Nifti1Header.write_to (A, B, C) or whole files by
// Nifti1Image.to_bytes (D, E), packed by Python's gzip with mtime=0 (all but A). Stored values count 0, 1, 2, ... along
// the first axis, then the second, then the third, but for D and E.

/// Big-endian int16 with slope 100 and intercept 5000, mm, a sheared sform; its qform is another one.
const char* const kA =
    "0000015c0000000000000000000000000000000000000000000000000000000000000000000000000003000200030004"
    "000100010001000100000000000000000000000000000004001000003f8000004110000041100000411000003f800000"
    "3f8000003f8000003f80000043b0000042c80000459c4000000000020000000000000000000000000000000000000000"
    "000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
    "000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
    "000000000000000000000000000100010000000000000000000000000000000000000000000000003fddb3d7bf88930a"
    "00000000412000003f800000403646e100000000c1a0000000000000000000004080000041f000000000000000000000"
    "00000000000000006e2b3100000000000000000100020003000400050006000700080009000a000b000c000d000e000f"
    "00100011001200130014001500160017";

/// uint8 counting from 1, micrometres, a qform alone, turned and mirrored (pixdim[0] = -1).
const char* const kB =
    "1f8b08000000000002ff8b6164200a30333001310b032314a20226060e30ddb01f48380069207600d1f6a87883338486"
    "1a39c000e48b3737f5ecd7a75bdb8130d46d50b75306f2b40d21763031b3b0b2b173707271f3f0f2f10b080a098b888a"
    "894b00008e799c0c78010000";

/// float32, 1000, 2000, ..., metres, neither form: pixdim 0.01, 0.02, 0.03.
const char* const kC =
    "1f8b08000000000002ff8b6164200a30333001310b032314a20201060530dd60cf755dd986ebfa629bfe435f6d407c54"
    "bcc11942830191360f4d90a76d086555b93030fc726168b07605b25d191ce6b83234ec766538700bc8ffe5cab080c78d"
    "c141c68de181b61b508d1b8382b71bc381283786842c37a07a37860b2d6e0c0b7adc180aa600d5cd716310580254bbda"
    "8d61c366a0fadd6e00e02634c4c0010000";

/// float64 exp(11 + 0.1 x - 0.05 y + 0.07 z) of places in mm, sizes 2, 3, 4 mm, first voxel at -1, -2, -3 mm.
const char* const kD =
    "1f8b08000000000002ff8b6164200a30333001310b032314a20207200481067b3087c101881b1c207c64bcc119aa0604"
    "9818061ca03ba1613f90380074ff01883f50c41920fe02830348720e50f528204fdb104c1f9ac3a9be70d3738765a1aa"
    "5e673ebe71d8557c69ed8cd4270e6ffdf324d6bc7ce1f074ba0fa76bdf4387efef822c030a9f3a7878ff33ff10f5dec1"
    "3936f90bbfda6787f3ce1f27dcfcf3cae1bc8c54835df5078714aecafe06abe70e17e2d5ff0ac5bf71f81d9d6019beef"
    "8bc3de1517a60984fd74887ab55f70f9ad8f0e2b8e3f9a34fbdc57879a5b0a3dff76bf73d8a015bdfddf914f0edcf73b"
    "d55c8b7e3b5c7c22faeef32106c76d4be68b4e9cffddc179cbb543cdb7fe3884ae9b146b10fac581dd4afbd2c2ab3f1c"
    "0003c9dc2720020000";

/// The same as float32, without a unit, as nibabel writes if it is not told.
const char* const kE =
    "1f8b08000000000002ff8b6164200a30333001310b032314a20201060530dd600f241c8008881b1c207c64bcc119aa66"
    "900026347ec37e207100e8fe03107fa0883340fc05060790e41ca0ea51409eb62198e69c6aeb9ed497ee7e5447d93dd1"
    "d7dd5da388c7bda94bdbbde97a957b83c14cf7b3cfc2ddbfdc6c7667b962e93ee34792fbae4f4bdd5b379c72b7bcdae7"
    "7eb7649dfb97fba5eedfd4a7b96b4ebaed3e5f9ccda3f3cf1e77b92bcfdc9b572e72e75f7bcc1d00e77b5fdac0010000";

/// B in two members of gzip, as bgzip and the joining of files make them, and zeros after them.
const char* const kF =
    "1f8b08000000000002038b6164200a30333001310b032314a20226060e30ddb01f48380069207600d1f6a87883338486"
    "1a494500002ebba99ec80000001f8b08000000000002036360201d3002f19b9b7af6ebd3aded409881a1c11e28e40044"
    "0e0c14823c6d43881d4ccc2cac6cec1c9c5cdc3cbc7cfc028242c222a262e212005cc3d310b000000000000000000000"
    "00";

std::string bytesOf(std::string_view hex)
{
    std::string bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes += char(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    return bytes;
}

VolumeGrid nifti(const std::string& bytes, const VolumeSettings& settings = {})
{
    std::istringstream in(bytes);
    return parseVolume(in, bytes.size(), "test", VolumeFormat::nifti, settings);
}

std::string refusal(const std::string& bytes, const VolumeSettings& settings = {})
{
    return refusalOf([&] { static_cast<void>(nifti(bytes, settings)); });
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected)
{
    EXPECT_LT(glm::length(found - expected), 1e-6 * glm::length(expected))
        << found.x << " " << found.y << " " << found.z;
}

double valueAt(const VolumeGrid& grid, const glm::dvec3& place)
{
    const auto value = grid.at(place);
    return value.at == VolumeGrid::At::inside ? value.value : -1;
}

/// The bytes of a float or a short in a header of little endian, changed.
template <class Number>
std::string changed(std::string bytes, std::size_t at, Number value)
{
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
}

/// A file of little endian as a program of one page would write it: int16, one mm a voxel.
std::string plain(const std::vector<std::int16_t>& values, const std::array<std::int16_t, 3>& size = {2, 2, 2})
{
    std::string bytes(352, '\0');
    bytes = changed(bytes, 0, std::int32_t(348));
    bytes = changed(bytes, 40, std::int16_t(3));
    for (std::size_t k = 0; k < 3; ++k) {
        bytes = changed(bytes, 42 + 2 * k, size[k]);
        bytes = changed(bytes, 80 + 4 * k, 1.0F);
    }
    bytes = changed(bytes, 70, std::int16_t(4));
    bytes = changed(bytes, 108, 352.0F);
    bytes = changed(bytes, 123, char(2));
    bytes.replace(344, 4, std::string("n+1\0", 4));
    for (const std::int16_t value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return bytes;
}

const std::string kPlain = plain({1, 2, 3, 4, 5, 6, 7, 8});

// The numbers of the next three tests are what nibabel says of the files (affine, get_fdata, apply_affine).

TEST(VolumeGrid, TheSformPlacesABigEndianFileAndItsSlopeScalesIt)
{
    const VolumeGrid grid = nifti(bytesOf(kA));

    EXPECT_EQ(grid.size(), (std::array<int, 3>{2, 3, 4}));
    EXPECT_EQ(grid.node(0, 0, 0), 5000);
    EXPECT_EQ(grid.node(1, 2, 3), 7300);
    expectNear(grid.placeOf(0, 0, 0), {10e-3, -20e-3, 30e-3});
    expectNear(grid.placeOf(1, 2, 3), {9.59807622e-3, -13.30384779e-3, 42e-3});
}

TEST(VolumeGrid, TheQformPlacesAFileWithoutSform)
{
    const VolumeGrid grid = nifti(bytesOf(kB));

    EXPECT_EQ(grid.node(1, 2, 3), 24);
    expectNear(grid.placeOf(1, 2, 3), {-1.76794924e-6, 10.79422805e-6, 11.00000062e-6});
    expectNear(grid.placeOf(0, 1, 0) - grid.placeOf(0, 0, 0), {7.01035714e-14, -2.61630079e-13, 4e-6});
}

TEST(VolumeGrid, APackedFileMayHaveSeveralMembers)
{
    const VolumeGrid whole = nifti(bytesOf(kB)), joined = nifti(bytesOf(kF));
    for (int z = 0; z < 4; ++z) EXPECT_EQ(joined.node(1, 2, z), whole.node(1, 2, z));
}

TEST(VolumeGrid, AnInterceptThatIsNoNumberIsNone)
{
    const std::string bytes = changed(changed(kPlain, 112, 2.0F), 116, std::nanf(""));
    EXPECT_EQ(nifti(bytes).node(1, 1, 1), 16) << "as a slope that is none";
}

TEST(VolumeGrid, SizesOfVoxelsPlaceAFileWithoutEitherForm)
{
    const VolumeGrid grid = nifti(bytesOf(kC));

    EXPECT_EQ(grid.node(0, 1, 0), 3000);
    expectNear(grid.placeOf(1, 1, 1), {0.01, 0.02, 0.03});
}

TEST(VolumeGrid, ValuesBetweenNodesAreExactOfAFieldWhoseLogarithmIsLinear)
{
    const VolumeGrid grid  = nifti(bytesOf(kD));
    const auto       field = [](const glm::dvec3& p) { return std::exp(11 + 100 * p.x - 50 * p.y + 70 * p.z); };

    for (const glm::dvec3 p :
         {glm::dvec3(-1e-3, -2e-3, -3e-3), {0, 0, 0}, {0.3e-3, 1.1e-3, 4.7e-3}, {1e-3, 4e-3, 9e-3}})
        EXPECT_NEAR(valueAt(grid, p) / field(p), 1, 2e-7); // nodes are floats
}

TEST(VolumeGrid, AFileWithoutAUnitNeedsOneBesideIt)
{
    EXPECT_TRUE(holds(refusal(bytesOf(kE)), {"test: byte 123", "unit of length", "\"length_unit\": \"mm\""}));
    EXPECT_NEAR(valueAt(nifti(bytesOf(kE), {.lengthUnit = "mm"}), {0, 0, 0}), std::exp(11), 0.01);
    EXPECT_NEAR(valueAt(nifti(bytesOf(kE), {.lengthUnit = "mm", .factor = 1e3}), {0, 0, 0}), 1e3 * std::exp(11), 10);
}

TEST(VolumeGrid, BeyondItsOutermostNodesIsOutside)
{
    const VolumeGrid grid = nifti(kPlain);

    EXPECT_EQ(grid.at({0, 0, 0}).at, VolumeGrid::At::inside);
    EXPECT_NEAR(valueAt(grid, {1e-3, 1e-3, 1e-3}), 8, 1e-12);
    EXPECT_EQ(grid.at({-2e-6, 0, 0}).at, VolumeGrid::At::outside);
    EXPECT_EQ(grid.at({0, 0, 1.002e-3}).at, VolumeGrid::At::outside);
    EXPECT_EQ(grid.at({0, std::nan(""), 0}).at, VolumeGrid::At::outside);
    EXPECT_EQ(grid.extent(), "x 0 to 0.001, y 0 to 0.001, z 0 to 0.001 m");
    EXPECT_EQ(nifti(plain(std::vector<std::int16_t>(24, 7), {2, 3, 4})).extent(),
              "x 0 to 0.001, y 0 to 0.002, z 0 to 0.003 m");
}

TEST(VolumeGrid, ZeroIsUnknownAndDoesNotCountWhereItHasNoWeight)
{
    const VolumeGrid grid = nifti(plain({1, 2, 3, 0, 5, 6, 7, 8}));

    const auto inner = grid.at({0.5e-3, 0.5e-3, 0.5e-3});
    EXPECT_EQ(inner.at, VolumeGrid::At::unknown);
    EXPECT_EQ(inner.node, (std::array<int, 3>{1, 1, 0}));
    EXPECT_NEAR(valueAt(grid, {0, 0, 0.5e-3}), std::sqrt(5), 1e-12);
}

/// A column of layers along z, each so thick [m]; the values repeat in x and y.
VolumeGrid column(const std::vector<float>& layers, double step)
{
    std::vector<float> values;
    for (const float value : layers) values.insert(values.end(), 4, value);
    glm::dmat3 toWorld(step);
    return {{2, 2, int(layers.size())}, values, toWorld, {0, 0, 0}};
}

TEST(VolumeGrid, ASheetWhoseModulusGrowsByEqualFactorsBendsAsTheClosedFormSays)
{
    // E = e^(a t) over [0, 1]: moments m0 = (e^a - 1)/a, m1 = (e^a - m0)/a, m2 = (e^a - 2 m1)/a, and
    // int E (t - t0)^2 = m2 - m1^2/m0.
    const double     a = std::log(100), e = 100, m0 = (e - 1) / a, m1 = (e - m0) / a, m2 = (e - 2 * m1) / a;
    const VolumeGrid grid = column({1, 100}, 1e-3);

    const auto inwards  = grid.sheetAlong({0.5e-3, 0.5e-3, 0}, {0, 0, 1}, 1e-3);
    const auto outwards = grid.sheetAlong({0.5e-3, 0.5e-3, 1e-3}, {0, 0, -1}, 1e-3);

    // Sixteen layers, each with the value in its middle: (a / 16)^2 / 24 = 0.35 % of a value.
    EXPECT_NEAR(inwards.value.value / (12 * (m2 - m1 * m1 / m0)), 1, 0.005);
    EXPECT_NEAR(outwards.value.value / inwards.value.value, 1, 1e-9) << "bending has no side";
    EXPECT_EQ(inwards.share, 1);
}

TEST(VolumeGrid, TwoLayersBendAsTheClosedFormSays)
{
    // Two halves: (E1^2 + 14 E1 E2 + E2^2) / (8 (E1 + E2)), from 12 (sum of E (1/96 + (middle - t0)^2 / 2)).
    for (const float hard : {1.0F, 3.0F, 100.0F, 1e6F}) {
        std::vector<float> layers(400, 1.0F);
        std::fill_n(layers.begin(), 200, hard);
        const VolumeGrid grid = column(layers, 1e-5);
        const double     h    = 400e-5;

        const auto sheet = grid.sheetAlong({0.5e-5, 0.5e-5, -0.5e-5}, {0, 0, 1}, h);

        const double expected = (hard * double(hard) + 14.0 * hard + 1) / (8 * (hard + 1.0));
        EXPECT_NEAR(sheet.value.value / expected, 1, 0.01) << hard << ": the step takes one voxel of 400";
    }
}

TEST(VolumeGrid, OneMaterialIsItselfWhereverTheVolumeEnds)
{
    const VolumeGrid grid = column({7, 7, 7}, 1e-3), gap = column({0, 0, 7, 7, 0, 0, 7, 7}, 1e-3);

    for (const double depth : {1e-5, 1e-3, 2e-3, 9e-3}) {
        EXPECT_NEAR(grid.sheetAlong({0, 0, 0}, {0, 0, 1}, depth).value.value, 7, 1e-5) << depth << ": nodes are floats";
        EXPECT_NEAR(gap.sheetAlong({0, 0, 2e-3}, {0, 0, 1}, depth).value.value, 7, 1e-5);
    }
    const auto late = gap.sheetAlong({0, 0, 0}, {0, 0, 1}, 4e-3); // begins where nothing was measured
    EXPECT_NEAR(late.value.value, 7, 1e-5);
    EXPECT_NEAR(late.share, 0.25, 0.1) << "one of four voxels has values at both its ends";
    EXPECT_EQ(grid.sheetAlong({0, 0, 0}, {0, 0, 1}, 4e-3).share, 0.5);
    EXPECT_EQ(grid.sheetAlong({0, 0, -1}, {0, 0, 1}, 5e-3).value.at, VolumeGrid::At::outside);
    EXPECT_EQ(gap.sheetAlong({0, 0, 0}, {0, 0, 1}, 1e-3).value.at, VolumeGrid::At::unknown);
    EXPECT_EQ(gap.sheetAlong({0, 0, 0}, {0, 0, 1}, 1e-3).share, 0);
}

TEST(VolumeGrid, AGapHasTheNearestValueBeforeIt)
{
    // Half of 1 and half of 8 with nothing measured between: the gap counts as 1, for it comes first.
    std::vector<float> layers(100, 1.0F), filled(100, 1.0F);
    for (std::size_t n = 40; n < 100; ++n) layers[n] = n < 60 ? 0.0F : 8.0F, filled[n] = n < 60 ? 1.0F : 8.0F;

    const auto found = column(layers, 1e-4).sheetAlong({0, 0, 0}, {0, 0, 1}, 9.9e-3);
    const auto same  = column(filled, 1e-4).sheetAlong({0, 0, 0}, {0, 0, 1}, 9.9e-3);

    EXPECT_NEAR(found.value.value / same.value.value, 1, 0.02) << "but for the voxel in which the values change";
}

TEST(VolumeGrid, ValuesThatAreNoStiffnessAreRefusedByTheirIndex)
{
    EXPECT_TRUE(holds(refusal(plain({1, 2, 3, 4, 5, -6, 7, 8})), {"test: the value at [1, 0, 1] is negative"}));
    std::string nan = changed(kPlain, 70, std::int16_t(16)).substr(0, 352);
    for (const float value : {1.0F, 2.0F, 3.0F, NAN, 5.0F, 6.0F, 7.0F, 8.0F})
        nan.append(reinterpret_cast<const char*>(&value), sizeof value);
    EXPECT_TRUE(holds(refusal(nan), {"test: the value at [1, 1, 0] is NaN"}));
    EXPECT_TRUE(holds(refusal(changed(nan, 352 + 12, INFINITY)), {"[1, 1, 0] is infinite"}));
    EXPECT_TRUE(holds(refusal(changed(nan, 352 + 12, 1e35F)), {"[1, 1, 0] is beyond"}));
}

template <class Number>
void demandRead(int code, double last)
{
    std::string bytes = changed(kPlain, 70, std::int16_t(code)).substr(0, 352);
    for (const double value : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, last}) {
        const auto stored = Number(value);
        bytes.append(reinterpret_cast<const char*>(&stored), sizeof stored);
    }
    const VolumeGrid grid = nifti(bytes);
    EXPECT_EQ(grid.node(1, 0, 0), 2) << code;
    EXPECT_EQ(grid.node(1, 1, 1), last) << code;
}

TEST(VolumeGrid, EveryTypeOfNumbersIsReadUpToItsLargest)
{
    demandRead<std::uint8_t>(2, 255);
    demandRead<std::int16_t>(4, 32767);
    demandRead<std::int32_t>(8, 2e9);
    demandRead<float>(16, 0.5);
    demandRead<double>(64, 0.5);
    demandRead<std::int8_t>(256, 127);
    demandRead<std::uint16_t>(512, 65535);
    demandRead<std::uint32_t>(768, 4e9);
}

TEST(VolumeGrid, ARefusalNamesTheByteAndWhatWasExpected)
{
    const auto as16 = [](int value) { return std::int16_t(value); };
    EXPECT_TRUE(holds(refusal(kPlain.substr(0, 100)), {"test: byte 100: the file ends within its header", "248 more"}));
    EXPECT_TRUE(
        holds(refusal(kPlain.substr(0, 360)), {"test: byte 40: the header promises 8 values", "12 bytes follow"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 0, std::int32_t(540))), {"byte 0", "NIfTI-2"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 0, std::int32_t(7))), {"byte 0", "found 7"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 344, std::int32_t(0))), {"byte 344", "n+1"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 345, 'i')), {"byte 344", "two files"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 40, as16(2))), {"byte 40: expected 3 dimensions, found 2"}));
    EXPECT_TRUE(
        holds(refusal(changed(changed(kPlain, 40, as16(4)), 48, as16(5))), {"byte 48", "found 5 along axis 4"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 42, as16(1))), {"byte 42", "two voxels or more along axis 1, found 1"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 42, as16(-3))), {"byte 42", "found -3"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 70, as16(32))), {"byte 70", "found type 32"})); // complex
    EXPECT_TRUE(holds(refusal(changed(kPlain, 108, 7.5F)), {"byte 108"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 108, NAN)), {"byte 108"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 80, 0.0F)), {"byte 80", "above zero"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 254, as16(1))), {"byte 280", "in a plane"})); // an sform of zeros
    EXPECT_TRUE(holds(refusal(changed(changed(kPlain, 252, as16(1)), 256, 1.5F)), {"byte 256", "quaternion"}));
    EXPECT_TRUE(holds(refusal(changed(kPlain, 112, INFINITY)), {"byte 112"}));
    EXPECT_TRUE(holds(refusal(""), {"test: byte 0: the file ends within its header"}));
    const std::string packed = bytesOf(kC);
    EXPECT_TRUE(holds(refusal(packed.substr(0, 100)), {"when unpacked", "ends within its values"}));
    EXPECT_TRUE(holds(refusal(changed(packed, 60, std::int32_t(-1))), {"test: byte"}));
    EXPECT_TRUE(holds(refusal(kPlain, {.spacing = glm::dvec3(1)}), {"are for .npy files"}));
}

TEST(VolumeGrid, AHeaderThatPromisesTooMuchTakesNoMemory)
{
    const std::int16_t most = 32767;
    EXPECT_TRUE(holds(refusal(plain({1}, {most, most, most})), {"byte 40: the header promises 35181150961663 values"}));
}

/// Bytes that note how much memory the process has when they end.
class Ending : public std::stringbuf {
public:
    explicit Ending(const std::string& bytes) : std::stringbuf(bytes) {}

    static std::size_t resident() // [bytes]
    {
        std::size_t all = 0, pages = 0;
        std::ifstream("/proc/self/statm") >> all >> pages;
        return pages * std::size_t(::sysconf(_SC_PAGESIZE));
    }
    std::size_t atEnd = 0; // [bytes]

protected:
    int_type underflow() override
    {
        const int_type next = std::stringbuf::underflow();
        if (next == traits_type::eof()) atEnd = resident();
        return next;
    }
};

// A packed file of 130 kB may promise half a gigabyte: it takes memory as its values come.
TEST(VolumeGrid, ValuesThatArePromisedTakeNoMemoryBeforeTheyCome)
{
    const std::string bytes =
        changed(changed(plain({1, 2, 3, 4}, {512, 512, 512}), 70, std::int16_t(2)), 72, std::int16_t(8));
    Ending            data(bytes);
    std::istream      in(&data);
    const std::size_t before = Ending::resident();

    const std::string said =
        refusalOf([&] { static_cast<void>(parseVolume(in, 1U << 30, "test", VolumeFormat::nifti, {})); });

    EXPECT_TRUE(holds(said, {"ends within its values"}));
    EXPECT_GT(data.atEnd, 0U);
    EXPECT_LT(data.atEnd, before + (std::size_t(128) << 20))
        << "512 MiB were promised; a sanitizer keeps an eighth of that";
}

TEST(VolumeGrid, MoreThanHalfAGigabyteIsRefused)
{
    const std::string bytes =
        changed(changed(plain({1, 2, 3, 4}, {1024, 1024, 1024}), 70, std::int16_t(2)), 72, std::int16_t(8));
    std::istringstream in(bytes);
    EXPECT_TRUE(holds(
        refusalOf([&] { static_cast<void>(parseVolume(in, std::uint64_t(1) << 31, "test", VolumeFormat::nifti, {})); }),
        {"1024 x 1024 x 1024", "take every second one"}));
}

// Any byte may be wrong: either it is read or refused in a sentence.
TEST(VolumeGrid, NoByteOfAHeaderMakesAnythingButAnError)
{
    for (std::size_t at = 0; at < 352; ++at)
        for (const int value : {0, 1, 0x7f, 0x80, 0xff}) {
            const std::string said = refusal(changed(kPlain, at, char(value)));
            EXPECT_TRUE(said.empty() || said.starts_with("test: ")) << at << ": " << said;
        }
}

std::string npy(const std::string& order, const std::string& shape, std::vector<double> values)
{
    std::string header = "{'descr': '<f8', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
    header.resize(117, ' ');
    std::string bytes = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n";
    for (const double value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return bytes;
}

VolumeGrid npyGrid(const std::string& bytes, const VolumeSettings& settings)
{
    std::istringstream in(bytes);
    return parseVolume(in, bytes.size(), "test.npy", VolumeFormat::npy, settings);
}

TEST(VolumeGrid, AnArrayIsReadInBothOrders)
{
    std::vector<double> c, f; // value 100 i + 10 j + k + 1
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 4; ++k) c.push_back(100 * i + 10 * j + k + 1);
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 2; ++i) f.push_back(100 * i + 10 * j + k + 1);
    const VolumeSettings settings{.origin = glm::dvec3(1, 2, 3), .spacing = glm::dvec3(0.1, 0.2, 0.3)};

    for (const VolumeGrid& grid :
         {npyGrid(npy("False", "(2, 3, 4)", c), settings), npyGrid(npy("True", "(2, 3, 4)", f), settings)}) {
        EXPECT_EQ(grid.node(1, 2, 3), 124);
        EXPECT_NEAR(valueAt(grid, {1.1, 2.4, 3.9}), 124, 1e-9);
        EXPECT_NEAR(valueAt(grid, {1, 2.2, 3.3}), 12, 1e-9);
    }
    const auto said = [&](const std::string& bytes, const VolumeSettings& with) {
        return refusalOf([&] { static_cast<void>(npyGrid(bytes, with)); });
    };
    EXPECT_TRUE(holds(said(npy("False", "(2, 3, 4)", c), {}), {"test.npy: expected \"spacing\""}));
    EXPECT_TRUE(holds(said(npy("False", "(6, 4)", c), settings), {"three dimensions", "(6, 4)"}));
    EXPECT_TRUE(holds(said(npy("False", "(2, 3, 5)", c), settings), {"2 x 3 x 5 asks for 30 numbers"}));
    EXPECT_TRUE(holds(said(npy("False", "(24, 1, 1)", c), settings), {"two values or more", "24 x 1 x 1"}));
    EXPECT_TRUE(holds(said(npy("False", "(2147483647, 2147483647, 2147483647)", c), settings), {"asks for"}));
    c[7] = std::nan("");
    EXPECT_TRUE(holds(said(npy("False", "(2, 3, 4)", c), settings), {"the value at [0, 1, 3] is NaN"}));
}

TEST(GridLaw, GivesTheVolumesValueAndNamesThePlaceWhereThereIsNone)
{
    const TemporaryFolder folder;
    const auto            file = folder.write("e.nii", plain({1, 1, 1, 1, 100, 100, 100, 0}));
    const auto            law  = [&](const std::string& more) {
        return parseSpatialLaw("grid:file=" + file.string() + more, {0, 0, 0}, {1, 1, 1}, SpatialLaw::Space::volume);
    };

    EXPECT_NEAR(law("")({0, 0, 0.5e-3}), 10, 1e-6);
    EXPECT_NEAR(law(",factor=1e3")({0, 0, 0.5e-3}), 1e4, 1e-3);
    EXPECT_EQ(law(",outside=7")({1, 0, 0}), 7);
    EXPECT_EQ(law(",outside=7").valueAt({1e-3, 1e-3, 1e-3}, "point 0"), 7);
    EXPECT_TRUE(holds(refusalOf([&] {
                          static_cast<void>(law("").valueAt({1, 0, 0}, "point 3"));
                      }),
                      {"e.nii: expected a volume that holds point 3 at 1.0", "x 0 to 0.001", "\"outside\""}));
    EXPECT_TRUE(holds(refusalOf([&] {
                          static_cast<void>(law("").valueAt({1e-3, 1e-3, 1e-3}, "point 4"));
                      }),
                      {"e.nii", "above zero for point 4", "found zero at [1, 1, 1]", "\"outside\""}));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(law(",form=1")); }), {"form"}));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(law(",outside=0")); }), {"outside"}));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(law("x")); }), {"e.niix: expected a volume in a file .npy"}));
    EXPECT_TRUE(holds(
        refusalOf([&] {
            static_cast<void>(parseSpatialLaw("grid:file=" + file.string(), {}, {1, 0, 1}, SpatialLaw::Space::plane));
        }),
        {"unknown law \"grid\""}));
}

TEST(GridLaw, AnArrayIsPlacedByTheLaw)
{
    const TemporaryFolder folder;
    const std::string     file =
        folder.write("e.npy", npy("False", "(2, 2, 2)", {111, 112, 121, 122, 211, 212, 221, 222})).string();
    const auto law = [&](const std::string& place) {
        return parseSpatialLaw("grid:file=" + file + place, {0, 0, 0}, {1, 1, 1}, SpatialLaw::Space::volume);
    };

    EXPECT_NEAR(law(",spacing=0.1;0.2;0.3")({0.1, 0, 0.3}), 212, 1e-9);
    EXPECT_NEAR(law(",origin=1;2;3,spacing=0.1;0.2;0.3")({1.1, 2.2, 3}), 221, 1e-9);
    EXPECT_EQ(law(",spacing=0.5").volume->extent(), "x 0 to 0.5, y 0 to 0.5, z 0 to 0.5 m");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(law(",spacing=0.1;0;0.3")); }),
                      {"\"spacing\"", "metres above zero", "[0.1,0,0.3]"}));
}

TEST(GridLaw, ThroughTheThicknessItTakesTheSheetBelow)
{
    const TemporaryFolder folder;
    const auto            file = folder.write("e.nii", plain({1, 1, 1, 1, 100, 100, 100, 100}));
    const auto            law  = [&](const std::string& more) {
        return parseSpatialLaw("grid:file=" + file.string() + more, {0, 0, 0}, {1, 1, 1}, SpatialLaw::Space::volume);
    };
    const SpatialLaw through = law(",along=thickness,outside=3");
    const auto       sheet   = through.volume->sheetAlong({0, 0, 0}, {0, 0, 1}, 1e-3),
               thin          = through.volume->sheetAlong({0, 0, 1e-3}, {0, 0, -1}, 0.2e-3);
    const glm::dvec3 up(0, 0, 1);

    EXPECT_EQ(law("").along, SpatialLaw::Along::points);
    EXPECT_EQ(law(",along=points").along, SpatialLaw::Along::points);
    ASSERT_EQ(through.along, SpatialLaw::Along::thickness);
    EXPECT_EQ(through.valueBelow({0, 0, 0}, {-up, true, 1e-3}, "point 0"), sheet.value.value);
    // Without a side the sheet lies where the volume is.
    EXPECT_EQ(through.valueBelow({0, 0, 1e-3}, {up, false, 0.2e-3}, "point 0"), thin.value.value);
    EXPECT_EQ(through.valueBelow({0, 0, 1e-3}, {-up, false, 0.2e-3}, "point 0"), thin.value.value);
    EXPECT_EQ(through.valueBelow({0, 0, -1}, {up, true, 1e-3}, "point 0"), 3) << "outside";
    EXPECT_TRUE(holds(refusalOf([&] {
                          static_cast<void>(through.valueBelow({0, 0, 0.5e-3}, {up, false, 0.2e-3}, "point 5"));
                      }),
                      {"e.nii: expected to know on which side of point 5", "normals or faces"}));
    EXPECT_NEAR(through.valueBelow({0, 0, 0.5e-3}, {{1, 0, 0}, false, 1e-5}, "point 5"), 10, 1e-5)
        << "both sides agree";
    EXPECT_TRUE(
        holds(refusalOf([&] { static_cast<void>(law(",along=depth")); }), {"along", "\"points\" or \"thickness\""}));
    EXPECT_TRUE(
        holds(refusalOf([&] {
                  static_cast<void>(law(",along=thickness").valueBelow({0, 0, -1}, {up, true, 1e-3}, "point 6"));
              }),
              {"e.nii: expected a volume that holds point 6"}));
}

TEST(GridLaw, AFileOfASceneLiesInTheScenesFolder)
{
    EXPECT_EQ(lawWithFileIn("grid:file=e.nii,outside=2", "/a/b"), R"({"file":"/a/b/e.nii","law":"grid","outside":2})");
    EXPECT_EQ(lawWithFileIn(R"({"law": "grid", "file": "/c/e.nii"})", "/a"), R"({"file":"/c/e.nii","law":"grid"})");
    EXPECT_EQ(lawWithFileIn(R"({"law": "gr\u0069d", "file": "e.nii"})", "/a"), R"({"file":"/a/e.nii","law":"grid"})");
    for (const char* other :
         {"constant:value=1", "", "grid", "grid:", R"({"law": "grid)", R"({"law": "grid", "file": 3})"})
        EXPECT_EQ(lawWithFileIn(other, "/a"), other);
    const std::string deep(200'000, '['), shut(200'000, ']'); // the library prints by recursion
    const std::string law = R"({"law": "grid", "file": "e.nii", "origin": )" + deep + shut + "}";
    EXPECT_EQ(lawWithFileIn(law, "/a"), law) << "whoever reads it refuses it";
}

} // namespace
} // namespace palp
