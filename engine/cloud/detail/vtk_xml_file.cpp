#include "engine/cloud/detail/vtk_xml_file.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "engine/cloud/detail/packed_bytes.h"
#include "engine/cloud/detail/vtk_pieces.h"
#include "engine/cloud/detail/xml_tree.h"
#include "engine/cloud/tokens.h"

namespace palp {
namespace {

constexpr std::string_view kCompressor = "vtkZLibDataCompressor";

/// Most numbers of a tuple; the largest in use are descriptors.
constexpr std::uint64_t kMostComponents = 1u << 16;

constexpr std::array<std::pair<std::string_view, ScalarType>, 10> kTypes = {{{"Int8", ScalarType::int8},
                                                                             {"UInt8", ScalarType::uint8},
                                                                             {"Int16", ScalarType::int16},
                                                                             {"UInt16", ScalarType::uint16},
                                                                             {"Int32", ScalarType::int32},
                                                                             {"UInt32", ScalarType::uint32},
                                                                             {"Int64", ScalarType::int64},
                                                                             {"UInt64", ScalarType::uint64},
                                                                             {"Float32", ScalarType::float32},
                                                                             {"Float64", ScalarType::float64}}};

/// Makes pieces of the elements of a file.
class VtkXmlParser {
public:
    explicit VtkXmlParser(const WholeFile& file) : file_(file)
    {
        auto [root, appended] = parseXml(file, "AppendedData");
        root_                 = std::move(root);
        if (root_.name != "VTKFile") fail(root_, "expected an element VTKFile: this is no XML file of VTK", root_.name);
        kind_ = std::string(root_.attribute("type").value_or("no type"));
        if (kind_ != "PolyData" && kind_ != "UnstructuredGrid")
            fail(root_,
                 "expected the type PolyData or UnstructuredGrid; ParaView's Extract Surface makes a PolyData "
                 "of others",
                 kind_);
        readForm();
        if (!appended.empty()) findAppended(appended);
    }

    std::vector<VtkPiece> parse() const
    {
        const XmlElement* const data = root_.child(kind_);
        if (!data) fail(root_, "expected an element " + kind_, "none");
        std::vector<VtkPiece> pieces;
        for (const XmlElement& element : data->children)
            if (element.name == "Piece" && countOf(element, "NumberOfPoints") > 0) pieces.push_back(pieceOf(element));
        return pieces;
    }

    [[nodiscard]] std::string format() const { return "VTK XML, " + kind_; }

private:
    [[noreturn]] void fail(const XmlElement& element, const std::string& message, std::string_view found) const
    {
        file_.failAtLine(element.name.data(), message + ", found " + inQuotes(found));
    }

    void readForm()
    {
        const auto order = root_.attribute("byte_order").value_or("LittleEndian");
        if (order != "LittleEndian" && order != "BigEndian")
            fail(root_, "expected byte_order LittleEndian or BigEndian", order);
        form_.order       = order == "BigEndian" ? std::endian::big : std::endian::little;
        const auto header = root_.attribute("header_type").value_or("UInt32");
        if (header != "UInt32" && header != "UInt64") fail(root_, "expected header_type UInt32 or UInt64", header);
        form_.sizeBytes  = header == "UInt64" ? 8 : 4;
        compressor_      = std::string(root_.attribute("compressor").value_or(""));
        form_.compressed = !compressor_.empty();
    }

    /// Finds the bytes after the underscore.
    void findAppended(std::string_view appended)
    {
        const XmlElement& element  = root_.children.back();
        const auto        encoding = element.attribute("encoding").value_or("raw");
        if (encoding != "raw" && encoding != "base64") fail(element, "expected encoding raw or base64", encoding);
        spelling_ = encoding == "raw" ? PackedBytes::Spelling::raw : PackedBytes::Spelling::base64;
        appended.remove_prefix(std::min(appended.find_first_not_of(" \t\r\n"), appended.size()));
        if (!appended.starts_with('_')) fail(element, "expected _ before the appended data", appended.substr(0, 1));
        const std::size_t last = file_.text.find_last_not_of(" \t\r\n");
        if (!file_.text.substr(0, last + 1).ends_with("</VTKFile>"))
            file_.failAtByte(file_.text.data() + file_.text.size(),
                             "expected </VTKFile> at the end; was the file cut short?");
        appended_ = appended.substr(1);
    }

    std::uint64_t countOf(const XmlElement& element, std::string_view key) const
    {
        const auto text = element.attribute(key);
        if (!text) return 0;
        const auto count = parseCount(*text);
        if (!count) fail(element, "expected a number from 0 up for " + std::string(key), *text);
        return *count;
    }

    VtkPiece pieceOf(const XmlElement& element) const
    {
        VtkPiece piece;
        piece.points             = countOf(element, "NumberOfPoints");
        const XmlElement* points = element.child("Points");
        const XmlElement* places = points ? points->child("DataArray") : nullptr;
        if (!places) fail(element, "expected Points with a DataArray", "none");
        piece.coordinates = arrayOf(*places, "points");
        if (piece.coordinates.components != 3)
            fail(*places, "expected 3 components of a point", std::to_string(piece.coordinates.components));
        if (const XmlElement* const data = element.child("PointData")) piece.pointData = dataOf(*data);
        addCells(piece, element, "Polys", "NumberOfPolys", VtkCells::Kind::polygons);
        addCells(piece, element, "Strips", "NumberOfStrips", VtkCells::Kind::strips);
        addCells(piece, element, "Cells", "NumberOfCells", VtkCells::Kind::mixed);
        return piece;
    }

    std::vector<VtkArray> dataOf(const XmlElement& element) const
    {
        const auto            normals = element.attribute("Normals");
        std::vector<VtkArray> arrays;
        for (const XmlElement& child : element.children) {
            if (child.name != "DataArray") continue; // such as an Array of texts
            const std::string name(child.attribute("Name").value_or("unnamed"));
            if (child.attribute("type") == "String" || child.attribute("type") == "Bit") continue;
            arrays.push_back(arrayOf(child, name));
            arrays.back().isNormals = name == "Normals" || name == "normals" || name == normals;
        }
        return arrays;
    }

    void addCells(VtkPiece& piece, const XmlElement& element, const char* name, const char* number,
                  VtkCells::Kind kind) const
    {
        VtkCells cells;
        cells.kind                    = kind;
        cells.count                   = countOf(element, number);
        const XmlElement* const group = element.child(name);
        if (cells.count == 0) return;
        if (!group) fail(element, std::string("expected an element ") + name, "none");
        cells.lists   = named(*group, "connectivity");
        cells.offsets = named(*group, "offsets");
        if (kind == VtkCells::Kind::mixed) cells.types = named(*group, "types");
        piece.cells.push_back(std::move(cells));
    }

    VtkArray named(const XmlElement& group, std::string_view name) const
    {
        for (const XmlElement& child : group.children)
            if (child.name == "DataArray" && child.attribute("Name") == name) return arrayOf(child, std::string(name));
        fail(group, "expected a DataArray " + std::string(name), "none");
    }

    VtkArray arrayOf(const XmlElement& element, const std::string& name) const
    {
        const auto word  = element.attribute("type").value_or("no type");
        const auto known = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == word; });
        if (known == kTypes.end()) fail(element, "expected a type such as Float32, Float64 or Int32", word);
        const bool          stated     = element.attribute("NumberOfComponents").has_value();
        const std::uint64_t components = stated ? countOf(element, "NumberOfComponents") : 1;
        if (components < 1 || components > kMostComponents)
            fail(element, "expected 1 to " + std::to_string(kMostComponents) + " components",
                 std::to_string(components));
        const auto format = element.attribute("format").value_or("no format");
        if (format != "ascii" && format != "binary" && format != "appended")
            fail(element, "expected format ascii, binary or appended", format);
        const std::string what = "array " + inQuotes(name);
        VtkArray          array{name, components, {}};
        if (format == "ascii")
            array.open = [this, what, text = element.text] { return Numbers(file_, what, text); };
        else
            array.open = [this, what, &element, type = known->second] {
                return Numbers(file_, what, type, form_.order, bytesOf(element));
            };
        return array;
    }

    std::vector<std::byte> bytesOf(const XmlElement& element) const
    {
        if (form_.compressed && compressor_ != kCompressor)
            fail(root_, "expected compressor vtkZLibDataCompressor or none (Compressor Type in ParaView's Save Data)",
                 compressor_);
        if (element.attribute("format") == "binary") {
            PackedBytes packed(file_, element.text, PackedBytes::Spelling::base64);
            return counted(arrayBytes(file_, packed, form_));
        }
        const std::uint64_t offset = countOf(element, "offset");
        if (!appended_) fail(element, "expected an element AppendedData for the offset", "none");
        if (offset > appended_->size())
            fail(element, "expected an offset of up to " + std::to_string(appended_->size()), std::to_string(offset));
        PackedBytes packed(file_, appended_->substr(offset), spelling_);
        return counted(arrayBytes(file_, packed, form_));
    }

    /// Refuses pieces that share an array until all of them hold far more than the file.
    std::vector<std::byte> counted(std::vector<std::byte> bytes) const
    {
        file_.reader.checkUnpacked(opened_ += bytes.size());
        return bytes;
    }

    const WholeFile&                file_;
    XmlElement                      root_;
    std::string                     kind_; ///< PolyData or UnstructuredGrid
    BlockForm                       form_;
    std::string                     compressor_;
    std::optional<std::string_view> appended_; ///< from after the underscore to the end of the file
    PackedBytes::Spelling           spelling_ = PackedBytes::Spelling::raw;
    mutable std::uint64_t           opened_   = 0; ///< [bytes] of arrays, so far
};

} // namespace

LoadedCloud parseVtkXml(std::istream& stream, std::uint64_t size, const std::string& name,
                        const CloudReadSettings& settings)
{
    ByteReader         reader(stream, size, name);
    const WholeFile    file{reader, {reinterpret_cast<const char*>(reader.take(size)), size}};
    const VtkXmlParser parser(file); // the arrays of the pieces refer to it
    return cloudOf(file, parser.parse(), parser.format(), settings);
}

} // namespace palp
