#include "engine/cloud/detail/face_rows.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/cloud/detail/polygon.h"
#include "engine/cloud/detail/room.h"
#include "engine/cloud/tokens.h"

namespace palp {

FaceRows::FaceRows(const ByteReader& reader, std::uint64_t points) : reader_(reader), points_(points) {}

void FaceRows::expect(std::uint64_t faces, std::uint64_t leastBytes)
{
    promised_ += faces;
    makeRoomFor(triangles_, triangles_.size() + std::size_t(std::min(faces, reader_.remaining() / leastBytes + 1)));
}

void FaceRows::addCorner(double corner, CloudRows::Place place)
{
    if (!(corner >= 0 && corner < double(points_)) || corner != std::floor(corner)) { // NaN fails every comparison
        const std::string message = "face " + std::to_string(faces_) +
                                    ": expected the number of a point from 0 to below " + std::to_string(points_) +
                                    ", found " + shown(corner);
        if (place == CloudRows::Place::line) reader_.failAtLine(message);
        reader_.fail("before byte " + std::to_string(reader_.offset()) + ": " + message);
    }
    if (began_ == 0) began_ = reader_.offset();
    // With more corners than points one occurs twice, whatever the others are.
    if (corners_.size() <= points_) corners_.push_back(std::uint32_t(corner));
}

/// Makes room for so many triangles, and once a ninth of the faces' bytes is read, for all that follow if the file goes
/// on as it has so far: a list that doubles takes three times its memory while it is moved.
void FaceRows::makeRoom(std::size_t count)
{
    if (count <= triangles_.capacity()) return;
    const auto read = double(reader_.offset() - began_), rest = double(reader_.remaining());
    if (read < rest / 8) return makeRoomFor(triangles_, count);
    const double each  = double(count) / double(faces_);
    const double bytes = std::min(1.0, double(count) / read) * rest;
    const double faces = promised_ > 0 ? each * double(promised_ - std::min<std::uint64_t>(promised_, faces_)) : bytes;
    triangles_.reserve(std::max(count + std::size_t(1.02 * std::min(bytes, faces)),
                                triangles_.capacity() + triangles_.capacity() / 8));
}

bool FaceRows::cornersDiffer()
{
    sorted_ = corners_;
    std::sort(sorted_.begin(), sorted_.end());
    return std::adjacent_find(sorted_.begin(), sorted_.end()) == sorted_.end();
}

void FaceRows::endFace()
{
    ++faces_;
    if (corners_.size() >= 3 && cornersDiffer()) {
        makeRoom(triangles_.size() + corners_.size() - 2);
        for (std::size_t k = 2; k < corners_.size(); ++k)
            triangles_.push_back({corners_[0], corners_[k - 1], corners_[k]});
        fans_.push_back(std::uint32_t(corners_.size() - 2));
    } else {
        ++degenerate_;
    }
    corners_.clear();
}

std::vector<Triangle> FaceRows::byPoints(std::span<const std::uint32_t> pointOfRow, CloudFileReport& report)
{
    std::vector<Triangle> left;
    auto                  fan = triangles_.begin();
    for (const std::uint32_t size : fans_) {
        const std::size_t before = left.size();
        bool              whole  = true;
        for (auto triangle = fan; triangle != fan + size; ++triangle) {
            const Triangle t = {pointOfRow[(*triangle)[0]], pointOfRow[(*triangle)[1]], pointOfRow[(*triangle)[2]]};
            whole            = whole && t[0] != kNoPoint && t[1] != kNoPoint && t[2] != kNoPoint;
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) left.push_back(t);
        }
        if (!whole) {
            left.resize(before);
            ++report.droppedFaces;
        } else if (left.size() == before) {
            ++report.degenerateFaces;
        }
        fan += size;
    }
    return left;
}

/// Puts triangles that lie within their polygon in the place of fans that do not.
void FaceRows::keepWithinPolygons(const LoadedCloud& loaded)
{
    const auto positions = loaded.cloud.positions();
    const auto pointOf   = [&](std::uint32_t row) { return loaded.pointOfRow.empty() ? row : loaded.pointOfRow[row]; };
    std::vector<std::uint32_t> rows;
    std::vector<glm::dvec3>    corners;
    auto                       fan = triangles_.begin();
    for (const std::uint32_t size : fans_) {
        const auto triangles = std::exchange(fan, fan + size);
        if (size < 2) continue;
        rows.assign({(*triangles)[0], (*triangles)[1]});
        for (auto triangle = triangles; triangle != fan; ++triangle) rows.push_back((*triangle)[2]);
        if (std::ranges::any_of(rows, [&](std::uint32_t row) { return pointOf(row) == kNoPoint; })) continue;
        corners.clear();
        for (const std::uint32_t row : rows) corners.push_back(positions[pointOf(row)]);
        if (const auto within = trianglesOfConcave(corners))
            std::ranges::transform(*within, triangles, [&](const Triangle& t) {
                return Triangle{rows[t[0]], rows[t[1]], rows[t[2]]};
            });
    }
}

void FaceRows::finish(LoadedCloud& loaded)
{
    keepWithinPolygons(loaded);
    loaded.report.faces           = faces_;
    loaded.report.degenerateFaces = degenerate_;
    loaded.faces = loaded.pointOfRow.empty() ? std::move(triangles_) : byPoints(loaded.pointOfRow, loaded.report);
}

} // namespace palp
