#include "engine/cloud/detail/glb_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/face_rows.h"
#include "engine/cloud/detail/scalar_type.h"
#include "engine/core/counted.h"
#include "engine/core/json_limits.h"

// A reader of our own, because of glTF only positions, indices and nodes matter here, and all of a hostile file is
// checked in one place.

namespace palp {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::uint64_t kMostJson  = std::uint64_t(16) << 20; ///< bytes; real ones have some thousand
constexpr int           kTriangles = 4, kFloat = 5126;        ///< of glTF

std::uint32_t word(ByteReader& reader)
{
    return loadAs<std::uint32_t>(reader.take(sizeof(std::uint32_t)), std::endian::little);
}

/// The file's chunks.
struct Glb {
    Json                   json;
    std::vector<std::byte> binary;
    std::uint32_t          length = 0; ///< of the file as its header states it [bytes]
};

Glb readChunks(ByteReader& reader)
{
    if (word(reader) != kMagic)
        reader.fail("byte 0: expected a binary glTF file, which begins with glTF, found another");
    if (const std::uint32_t version = word(reader); version != 2)
        reader.fail("byte 4: expected glTF 2, found version " + std::to_string(version));
    Glb glb;
    glb.length = word(reader);
    if (glb.length > reader.size())
        reader.fail("byte 8: the header promises " + std::to_string(glb.length) + " bytes, found " +
                    std::to_string(reader.size()) + "; it may have been cut short while it was copied");
    const std::uint32_t jsonLength = word(reader);
    if (word(reader) != kJsonChunk) reader.fail("byte 16: expected a first chunk of JSON, found another");
    if (jsonLength > std::min(kMostJson, reader.remaining()))
        reader.fail("byte 12: expected at most " + std::to_string(std::min(kMostJson, reader.remaining())) +
                    " bytes of JSON, found " + std::to_string(jsonLength));
    const auto* const text = reinterpret_cast<const char*>(reader.take(jsonLength));
    if (const auto excess = excessOf({text, jsonLength}, reader.size()))
        reader.fail("byte " + std::to_string(20 + excess->at) + ": " + std::string(excess->what));
    try {
        glb.json = Json::parse(text, text + jsonLength);
    } catch (const Json::exception&) {
        reader.fail("byte 20: expected JSON, found something else; is the file damaged?");
    }
    if (!glb.json.is_object()) reader.fail("byte 20: expected an object of JSON");
    if (reader.offset() >= glb.length) return glb;
    const std::uint32_t length = word(reader);
    if (word(reader) != kBinaryChunk)
        reader.failAtByte("expected a chunk of binary data before this byte, found another");
    const std::byte* const bytes = reader.take(length);
    glb.binary.assign(bytes, bytes + length);
    return glb;
}

/// Numbers of an accessor, checked to lie within the binary chunk.
struct Accessor {
    const std::byte* begin  = nullptr;
    std::uint64_t    count  = 0;
    std::uint64_t    stride = 0; ///< bytes
    int              type   = 0; ///< of a component
};

class GlbParser {
public:
    GlbParser(ByteReader& reader, const CloudReadSettings& settings)
        : reader_(reader), glb_(readChunks(reader)), rows_(reader, header(), settings),
          faces_(reader, std::numeric_limits<std::uint32_t>::max())
    {
    }

    LoadedCloud parse()
    {
        refuseUnknownExtensions();
        const std::size_t roots = has(glb_.json, "scenes") ? index(glb_.json, "scene", "the file", 0) : 0;
        visited_.assign(has(glb_.json, "nodes") ? list(glb_.json, "nodes", "the file").size() : 0, 0);
        takeNodes(list(element("scenes", roots), "nodes", "scene " + std::to_string(roots)), glm::dmat4(1));
        if (otherPrimitives_ > 0)
            rows_.warn(counted(otherPrimitives_, "part") +
                       " of meshes omitted: only triangles are read, not points, lines, strips and fans");
        if (reader_.size() > glb_.length)
            rows_.warn(counted(reader_.size() - glb_.length, "byte") + " after the file's stated end, from byte " +
                       std::to_string(glb_.length) + " on, not read: padding, or a damaged file");
        LoadedCloud loaded = rows_.finish();
        faces_.finish(loaded);
        return loaded;
    }

private:
    /// Refuses a file that needs an extension, unless it changes no triangle: those of materials are about colours.
    void refuseUnknownExtensions() const
    {
        const Json* const needed = find(glb_.json, "extensionsRequired");
        if (!needed) return;
        for (const Json& each : *needed) {
            const std::string name = each.is_string() ? each.get<std::string>() : each.dump();
            if (name.find("_materials_") != name.npos || name.find("_texture_") != name.npos) continue;
            fail("extensionsRequired: expected extensions of materials and textures only, found " +
                 shownText(name, kMostOfWord) + "; save it without compression");
        }
    }

    static CloudHeader header()
    {
        CloudHeader header;
        header.format     = "glTF 2, binary";
        header.properties = {"x", "y", "z"};
        header.lengthUnit = "m";
        return header;
    }

    [[noreturn]] void fail(const std::string& message) const { reader_.fail("in its JSON, " + message); }

    static const Json* find(const Json& object, const char* key)
    {
        const auto found = object.is_object() ? object.find(key) : object.end();
        return object.is_object() && found != object.end() ? &*found : nullptr;
    }
    static bool has(const Json& object, const char* key) { return find(object, key) != nullptr; }

    /// Returns a whole number from 0 to below 2^53.
    std::uint64_t index(const Json& object, const char* key, const std::string& what,
                        std::optional<std::uint64_t> absent = {}) const
    {
        const Json* const value = find(object, key);
        if (!value && absent) return *absent;
        if (!value || !value->is_number_unsigned() || value->get<std::uint64_t>() >= (std::uint64_t(1) << 53))
            fail(what + ": expected a whole number as \"" + key + "\", found " +
                 (value ? shownText(value->dump(), kMostOfWord) : std::string("none")));
        return value->get<std::uint64_t>();
    }

    const Json& list(const Json& object, const char* key, const std::string& what) const
    {
        const Json* const value = find(object, key);
        if (!value || !value->is_array()) fail(what + ": expected a list \"" + key + "\", found none");
        return *value;
    }

    /// Returns an element of one of the file's lists.
    const Json& element(const char* key, std::uint64_t n) const
    {
        const Json& all = list(glb_.json, key, "the file");
        if (n >= all.size())
            fail(std::string(key) + " " + std::to_string(n) + ": expected a number below " +
                 std::to_string(all.size()));
        return all[std::size_t(n)];
    }

    template <std::size_t Count>
    std::optional<std::array<double, Count>> numbers(const Json& object, const char* key, const std::string& what) const
    {
        const Json* const value = find(object, key);
        if (!value) return std::nullopt;
        std::array<double, Count> result{};
        bool                      good = value->is_array() && value->size() == Count;
        for (std::size_t k = 0; good && k < Count; ++k) {
            good = (*value)[k].is_number();
            if (good) result[k] = (*value)[k].template get<double>();
            good = good && std::abs(result[k]) < 1e9;
        }
        if (!good) fail(what + ": expected " + std::to_string(Count) + " numbers below 1e9 as \"" + key + "\"");
        return result;
    }

    glm::dmat4 transformOf(const Json& node, const std::string& what) const
    {
        glm::dmat4 matrix(1);
        if (const auto m = numbers<16>(node, "matrix", what)) {
            for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = (*m)[std::size_t(k)];
            return matrix;
        }
        if (const auto r = numbers<4>(node, "rotation", what))
            matrix = glm::mat4_cast(glm::normalize(glm::dquat((*r)[3], (*r)[0], (*r)[1], (*r)[2])));
        if (const auto s = numbers<3>(node, "scale", what))
            for (int k = 0; k < 3; ++k) matrix[k] *= (*s)[std::size_t(k)];
        if (const auto t = numbers<3>(node, "translation", what)) matrix[3] = {(*t)[0], (*t)[1], (*t)[2], 1};
        return matrix;
    }

    /// Takes nodes and those below them, each once: a tree has no node with two parents.
    void takeNodes(const Json& roots, const glm::dmat4& place)
    {
        std::vector<std::pair<std::uint64_t, glm::dmat4>> left;
        const auto                                        add = [&](const Json& nodes, const glm::dmat4& above) {
            for (const Json& node : nodes) {
                if (!node.is_number_unsigned() || node.get<std::uint64_t>() >= visited_.size())
                    fail("a list of nodes: expected numbers below " + std::to_string(visited_.size()) + ", found " +
                                                                shownText(node.dump(), kMostOfWord));
                const auto n = node.get<std::uint64_t>();
                if (std::exchange(visited_[std::size_t(n)], char(1)) != 0)
                    fail("node " + std::to_string(n) + ": expected one parent, found two");
                left.emplace_back(n, above);
            }
        };
        for (add(roots, place); !left.empty();) {
            const auto [n, above]  = left.back();
            const std::string what = "node " + std::to_string(n);
            left.pop_back();
            const Json&      node = element("nodes", n);
            const glm::dmat4 here = above * transformOf(node, what);
            if (has(node, "skin")) fail(what + ": expected no skin, which bends its mesh; save the mesh as it is bent");
            if (has(node, "mesh")) {
                const std::uint64_t mesh = index(node, "mesh", what);
                if (has(node, "weights")) // in place of the mesh's
                    failIfMorphed(node, what);
                else
                    failIfMorphed(element("meshes", mesh), "mesh " + std::to_string(mesh));
                takeMesh(mesh, here);
            }
            if (has(node, "children")) add(list(node, "children", what), here);
        }
    }

    /// Refuses a shape that is mixed with others, of a mesh or a node.
    void failIfMorphed(const Json& of, const std::string& what)
    {
        const Json* const weights = find(of, "weights");
        if (!weights || !weights->is_array()) return;
        const auto counts = [](const Json& weight) { return !weight.is_number() || weight.get<double>() != 0; };
        if (std::ranges::any_of(*weights, counts))
            fail(what +
                 ": expected \"weights\" of zero, found a shape that others are mixed into; save the mesh as it is "
                 "shown");
    }

    void takeMesh(std::uint64_t n, const glm::dmat4& place)
    {
        const std::string what = "mesh " + std::to_string(n);
        for (const Json& primitive : list(element("meshes", n), "primitives", what)) {
            constexpr std::uint64_t kLook = 64; // [bytes] that a look at a part counts as: nodes may repeat a mesh
            reader_.checkUnpacked(bytes_ += kLook);
            if (index(primitive, "mode", what, kTriangles) != kTriangles) {
                ++otherPrimitives_;
                continue;
            }
            const Json* const attributes = find(primitive, "attributes");
            if (!attributes) fail(what + ": expected \"attributes\", found none");
            const Accessor corners = accessor(index(*attributes, "POSITION", what), "VEC3", 3);
            const Accessor indices =
                has(primitive, "indices") ? accessor(index(primitive, "indices", what), "SCALAR", 1) : Accessor{};
            takeTriangles(corners, indices, place, what);
        }
    }

    void takeTriangles(const Accessor& corners, const Accessor& indices, const glm::dmat4& place,
                       const std::string& what)
    {
        if (corners.type != kFloat)
            fail(what + ": expected positions as floats (5126), found " + std::to_string(corners.type));
        if (indices.begin && indices.type == kFloat) fail(what + ": expected indices as whole numbers, found floats");
        bytes_ += 3 * sizeof(float) * corners.count + sizeof(std::uint32_t) * indices.count;
        reader_.checkUnpacked(bytes_);
        const std::uint64_t count = indices.begin ? indices.count : corners.count;
        if (count % 3 != 0) fail(what + ": expected three indices to a triangle, found " + std::to_string(count));
        for (std::uint64_t n = 0; n < corners.count; ++n) {
            const auto at = [&](std::size_t k) {
                return double(
                    loadAs<float>(corners.begin + n * corners.stride + k * sizeof(float), std::endian::little));
            };
            const glm::dvec4 p = place * glm::dvec4(at(0), at(1), at(2), 1);
            CloudRow         row{};
            row[kSlotX] = p.x, row[kSlotY] = p.y, row[kSlotZ] = p.z;
            rows_.add(row, CloudRows::Place::unpacked);
        }
        const bool mirrored = glm::determinant(glm::dmat3(place)) < 0; // which turns a triangle's corners around
        for (std::uint64_t n = 0; n < count; ++n) {
            const std::uint64_t which  = mirrored && n % 3 != 0 ? n + 3 - 2 * (n % 3) : n; // 0, 2, 1
            const std::uint64_t corner = indices.begin ? indexAt(indices, which) : which;
            if (corner >= corners.count)
                fail(what + ": expected an index below " + std::to_string(corners.count) + ", found " +
                     std::to_string(corner));
            faces_.addCorner(double(vertices_ + corner), CloudRows::Place::unpacked);
            if (n % 3 == 2) faces_.endFace();
        }
        vertices_ += corners.count;
    }

    static std::uint64_t indexAt(const Accessor& accessor, std::uint64_t n)
    {
        const std::byte* const at = accessor.begin + n * accessor.stride;
        if (accessor.type == 5121) return loadAs<std::uint8_t>(at, std::endian::little);
        if (accessor.type == 5123) return loadAs<std::uint16_t>(at, std::endian::little);
        return loadAs<std::uint32_t>(at, std::endian::little);
    }

    /// Returns an accessor whose every number lies in the binary chunk.
    Accessor accessor(std::uint64_t n, const char* type, std::uint64_t components) const
    {
        const std::string what = "accessor " + std::to_string(n);
        const Json&       json = element("accessors", n);
        if (has(json, "sparse")) fail(what + ": expected all its numbers in a row, found \"sparse\"; save it without");
        if (const Json* const is = find(json, "type"); !is || *is != type)
            fail(what + ": expected the type " + type + ", found " +
                 (is ? shownText(is->dump(), kMostOfWord) : std::string("none")));
        Accessor accessor;
        accessor.count           = index(json, "count", what);
        const std::uint64_t kind = index(json, "componentType", what);
        accessor.type            = kind <= kFloat ? int(kind) : 0;
        const std::uint64_t each = accessor.type == 5121                              ? 1
                                   : accessor.type == 5123                            ? 2
                                   : accessor.type == 5125 || accessor.type == kFloat ? 4
                                                                                      : 0;
        if (each == 0)
            fail(what + ": expected a componentType 5121, 5123, 5125 or 5126, found " + std::to_string(kind));
        const Json& view = element("bufferViews", index(json, "bufferView", what));
        if (index(view, "buffer", what) != 0 || has(element("buffers", 0), "uri"))
            fail(what + ": expected its numbers in the file itself, found them in another; save all of it as one .glb");
        const std::uint64_t size = each * components, begin = index(view, "byteOffset", what, 0),
                            length = index(view, "byteLength", what), offset = index(json, "byteOffset", what, 0);
        accessor.stride   = index(view, "byteStride", what, size);
        const bool inside = begin + length <= glb_.binary.size() && accessor.stride >= size && accessor.stride <= 252 &&
                            offset <= length && accessor.count > 0 && accessor.count <= length &&
                            offset + (accessor.count - 1) * accessor.stride + size <= length;
        if (!inside)
            fail(what + ": expected " + std::to_string(accessor.count) + " elements within " + std::to_string(length) +
                 " bytes of the file's " + std::to_string(glb_.binary.size()) + " of binary data");
        accessor.begin = glb_.binary.data() + begin + offset;
        return accessor;
    }

    ByteReader&       reader_;
    Glb               glb_;
    CloudRows         rows_;
    FaceRows          faces_;
    std::vector<char> visited_; ///< by node
    std::uint64_t     vertices_ = 0, bytes_ = 0;
    std::size_t       otherPrimitives_ = 0;
};

} // namespace

LoadedCloud parseGlb(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    ByteReader reader(stream, size, name);
    return GlbParser(reader, settings).parse();
}

} // namespace palp
