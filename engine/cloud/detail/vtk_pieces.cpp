#include "engine/cloud/detail/vtk_pieces.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/face_rows.h"

namespace palp {
namespace {

/// Longest list of points of a cell: lists are bounded by their array, this only by what a double holds exactly.
constexpr std::uint64_t kAnyLength = std::uint64_t(1) << 53;

/// What becomes of the cells of a type.
enum class CellUse { ignored, corners, pixel, strip, volume };

struct CellType {
    std::uint64_t first, last; ///< numbers of types
    CellUse       use;
    std::uint64_t corners; ///< that the cell's polygon has, in order; 0: as many as points
};

/// The numbers of cell types. Of curved cells the corners come first, and the points on their edges are left out of the
/// faces; points of the cloud they are.
/// \source VTK, "VTK File Formats" and vtkCellType.h, the enumeration VTKCellType
constexpr std::array kCellTypes = {
    CellType{5, 5, CellUse::corners, 3},   // triangle
    CellType{6, 6, CellUse::strip, 0},     // triangle strip
    CellType{7, 7, CellUse::corners, 0},   // polygon
    CellType{8, 8, CellUse::pixel, 4},     // rectangle, row by row
    CellType{9, 9, CellUse::corners, 4},   // quadrilateral
    CellType{10, 16, CellUse::volume, 0},  // tetrahedron to hexagonal prism
    CellType{22, 22, CellUse::corners, 3}, // quadratic triangle
    CellType{23, 23, CellUse::corners, 4}, // quadratic quadrilateral
    CellType{24, 27, CellUse::volume, 0},  // quadratic tetrahedron to pyramid
    CellType{28, 28, CellUse::corners, 4}, // biquadratic quadrilateral
    CellType{29, 29, CellUse::volume, 0},  // triquadratic hexahedron
    CellType{30, 30, CellUse::corners, 4}, // quadratic-linear quadrilateral
    CellType{31, 33, CellUse::volume, 0},  // wedge and hexahedra of mixed order
    CellType{34, 34, CellUse::corners, 3}, // biquadratic triangle
    CellType{37, 37, CellUse::volume, 0},  // triquadratic pyramid
    CellType{42, 42, CellUse::volume, 0},  // polyhedron
    CellType{69, 69, CellUse::corners, 3}, // Lagrange triangle
    CellType{70, 70, CellUse::corners, 4}, // Lagrange quadrilateral
    CellType{71, 74, CellUse::volume, 0},  // Lagrange solids
    CellType{76, 76, CellUse::corners, 3}, // Bezier triangle
    CellType{77, 77, CellUse::corners, 4}, // Bezier quadrilateral
    CellType{78, 81, CellUse::volume, 0},  // Bezier solids
};

CellType typeNumbered(std::uint64_t number)
{
    for (const CellType& type : kCellTypes)
        if (type.first <= number && number <= type.last) return type;
    return {number, number, CellUse::ignored, 0}; // vertices, lines, what came later
}

/// Reads the cells of pieces.
class CellReader {
public:
    CellReader(FaceRows& faces, const VtkPiece& piece, std::uint64_t firstPoint)
        : faces_(faces), points_(piece.points), firstPoint_(firstPoint)
    {
    }

    void read(const VtkCells& cells)
    {
        Numbers                lists = cells.lists.open();
        std::optional<Numbers> offsets, types;
        if (cells.offsets) offsets.emplace(cells.offsets->open());
        if (cells.types) types.emplace(cells.types->open());
        if (cells.beginsAtZero && cells.count > 0) static_cast<void>(offsets->nextIndex(1));
        std::uint64_t end = 0;
        for (std::uint64_t cell = 0; cell < cells.count; ++cell) {
            const std::uint64_t begin = end;
            end                       = offsets ? offsets->nextIndex(kAnyLength) : begin + lists.nextIndex(kAnyLength);
            if (end < begin)
                lists.fail("cell " + std::to_string(cell) + " ends at " + std::to_string(end) +
                           ", before it begins at " + std::to_string(begin));
            CellType type{0, 0, cells.kind == VtkCells::Kind::strips ? CellUse::strip : CellUse::corners, 0};
            if (types) type = typeNumbered(types->nextIndex(256));
            readPoints(lists, end - begin, type);
            use(type, cell, lists);
        }
        lists.expectEnd();
    }

    [[nodiscard]] std::uint64_t volumes() const noexcept { return volumes_; }

private:
    /// Reads the points of a cell, and keeps them if they are used.
    void readPoints(Numbers& lists, std::uint64_t length, const CellType& type)
    {
        list_.clear();
        const bool used = type.use != CellUse::ignored && type.use != CellUse::volume;
        for (std::uint64_t k = 0; k < length; ++k) {
            const std::uint64_t point = lists.nextIndex(points_);
            if (used) list_.push_back(point);
        }
    }

    void use(const CellType& type, std::uint64_t cell, const Numbers& lists)
    {
        if (type.use == CellUse::volume) ++volumes_;
        if (type.use == CellUse::ignored || type.use == CellUse::volume) return;
        if (list_.size() < type.corners)
            lists.fail("cell " + std::to_string(cell) + ": expected at least " + std::to_string(type.corners) +
                       " points, found " + std::to_string(list_.size()));
        if (type.use == CellUse::strip) {
            for (std::size_t k = 2; k < list_.size(); ++k) // every other triangle turns the other way
                addFace({list_[k - 2], list_[k - 1 + k % 2], list_[k - k % 2]});
            return;
        }
        if (type.use == CellUse::pixel) std::swap(list_[2], list_[3]);
        if (type.corners > 0) list_.resize(type.corners);
        addFace(list_);
    }

    void addFace(const std::vector<std::uint64_t>& corners)
    {
        for (const std::uint64_t corner : corners)
            faces_.addCorner(double(firstPoint_ + corner), CloudRows::Place::unpacked);
        faces_.endFace();
    }

    FaceRows&                  faces_;
    std::uint64_t              points_;
    std::uint64_t              firstPoint_;
    std::vector<std::uint64_t> list_;
    std::uint64_t              volumes_ = 0;
};

/// Adds the faces of a grid that is a surface: one of its dimensions is 1.
/// \return  true if it is none, but a volume
bool readGrid(const std::vector<std::uint64_t>& dimensions, std::uint64_t firstPoint, FaceRows& faces)
{
    std::vector<std::uint64_t> wide;
    for (const std::uint64_t dimension : dimensions)
        if (dimension > 1) wide.push_back(dimension);
    if (wide.size() != 2) return wide.size() == 3;
    for (std::uint64_t row = 0; row + 1 < wide[1]; ++row)
        for (std::uint64_t column = 0; column + 1 < wide[0]; ++column) {
            const std::uint64_t corner = firstPoint + row * wide[0] + column;
            for (const std::uint64_t point : {corner, corner + 1, corner + wide[0] + 1, corner + wide[0]})
                faces.addCorner(double(point), CloudRows::Place::unpacked);
            faces.endFace();
        }
    return false;
}

/// A number of each point: a component of an array.
struct Column {
    std::string   name;  ///< of the property
    std::string   array; ///< that it comes from
    std::uint64_t component = 0;
    std::size_t   slot      = kSlots;
};

/// Returns the columns of the first piece's point data, which all pieces must have as far as they are used.
std::vector<Column> columnsOf(const VtkPiece& piece)
{
    constexpr std::array kNormal = {"nx", "ny", "nz"};
    std::vector<Column>  columns;
    for (const VtkArray& array : piece.pointData) {
        const bool isCoordinate = array.name == "x" || array.name == "y" || array.name == "z";
        if (array.components == 1) columns.push_back({isCoordinate ? array.name + " (data)" : array.name, array.name});
        if (array.components == 3 && array.isNormals)
            for (std::size_t k = 0; k < 3; ++k) columns.push_back({kNormal[k], array.name, k});
    }
    return columns;
}

/// The arrays of a piece that fill slots.
class PointReader {
public:
    PointReader(const WholeFile& file, const VtkPiece& piece, const std::vector<Column>& columns)
        : coordinates_(piece.coordinates.open())
    {
        coordinates_.expectAtLeast(piece.points, 3);
        for (const Column& column : columns) {
            if (column.slot == kSlots) continue;
            const auto has = [&](const VtkArray& array) { return array.name == column.array; };
            const auto at  = std::find_if(piece.pointData.begin(), piece.pointData.end(), has);
            if (at == piece.pointData.end())
                file.reader.fail("expected the array " + inQuotes(column.array) + " of the first piece in every piece");
            if (arrays_.empty() || arrays_.back().name != column.array)
                arrays_.push_back({column.array, at->open(), at->components, {}});
            arrays_.back().slots.push_back({column.component, column.slot});
        }
    }

    [[nodiscard]] CloudRow next()
    {
        CloudRow row{};
        for (const RowSlot slot : {kSlotX, kSlotY, kSlotZ}) row[slot] = coordinates_.next();
        for (Used& array : arrays_)
            for (std::uint64_t k = 0; k < array.components; ++k) {
                const double value = array.numbers.next();
                for (const auto& [component, slot] : array.slots)
                    if (component == k) row[slot] = value;
            }
        return row;
    }

    void expectEnd()
    {
        coordinates_.expectEnd();
        for (Used& array : arrays_) array.numbers.expectEnd();
    }

private:
    struct Used {
        std::string                                        name;
        Numbers                                            numbers;
        std::uint64_t                                      components;
        std::vector<std::pair<std::uint64_t, std::size_t>> slots; ///< component, RowSlot
    };

    Numbers           coordinates_;
    std::vector<Used> arrays_;
};

} // namespace

LoadedCloud cloudOf(const WholeFile& file, std::span<const VtkPiece> pieces, const std::string& format,
                    const CloudReadSettings& settings)
{
    std::vector<Column> columns;
    if (!pieces.empty()) columns = columnsOf(pieces.front());

    CloudHeader header;
    header.format     = format;
    header.properties = {"x", "y", "z"};
    for (const Column& column : columns) header.properties.push_back(column.name);
    CloudRows rows(file.reader, header, settings);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].slot = rows.slotOf(3 + i);

    std::uint64_t points = 0;
    for (const VtkPiece& piece : pieces) {
        PointReader reader(file, piece, columns);
        rows.makeRoom(points += piece.points);
        for (std::uint64_t i = 0; i < piece.points; ++i) rows.add(reader.next(), CloudRows::Place::unpacked);
        reader.expectEnd();
    }

    FaceRows      faces(file.reader, points);
    std::uint64_t first = 0, volumes = 0;
    bool          isVolume = false;
    for (const VtkPiece& piece : pieces) {
        CellReader reader(faces, piece, first);
        for (const VtkCells& cells : piece.cells) reader.read(cells);
        if (!piece.dimensions.empty()) isVolume = readGrid(piece.dimensions, first, faces) || isVolume;
        volumes += reader.volumes();
        first += piece.points;
    }
    if (volumes > 0 || isVolume)
        rows.warn((isVolume ? std::string("the grid is a volume") : std::to_string(volumes) + " cells are volumes") +
                  ": all of its points were taken, the inner ones too; ParaView's Extract Surface leaves the skin");
    LoadedCloud loaded = rows.finish();
    faces.finish(loaded);
    return loaded;
}

} // namespace palp
