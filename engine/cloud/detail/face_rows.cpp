#include "engine/cloud/detail/face_rows.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/cloud/tokens.h"

namespace palp {

FaceRows::FaceRows(const ByteReader& reader, std::uint64_t points, Points kept)
    : reader_(reader), points_(points), kept_(kept)
{
}

void FaceRows::expect(std::uint64_t faces, std::uint64_t leastBytes)
{
    triangles_.reserve(triangles_.size() + std::size_t(std::min(faces, reader_.remaining() / leastBytes + 1)));
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
    // With more corners than points one occurs twice, whatever the others are.
    if (corners_.size() <= points_) corners_.push_back(std::uint32_t(corner));
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
        for (std::size_t k = 2; k < corners_.size(); ++k)
            triangles_.push_back({corners_[0], corners_[k - 1], corners_[k]});
        if (kept_ == Points::someDropped) fans_.push_back(std::uint32_t(corners_.size() - 2));
    } else {
        ++degenerate_;
    }
    corners_.clear();
}

std::vector<Triangle> FaceRows::finish(std::span<const std::uint32_t> dropped)
{
    if (dropped.empty()) return std::move(triangles_);
    const auto isDropped  = [&](std::uint32_t row) { return std::binary_search(dropped.begin(), dropped.end(), row); };
    const auto renumbered = [&](std::uint32_t row) {
        return row - std::uint32_t(std::lower_bound(dropped.begin(), dropped.end(), row) - dropped.begin());
    };
    std::vector<Triangle> left;
    auto                  fan = triangles_.begin();
    for (const std::uint32_t size : fans_) {
        const bool whole = std::none_of(
            fan, fan + size, [&](const Triangle& t) { return isDropped(t[0]) || isDropped(t[1]) || isDropped(t[2]); });
        dropped_ += whole ? 0 : 1;
        for (auto triangle = fan; whole && triangle != fan + size; ++triangle)
            left.push_back({renumbered((*triangle)[0]), renumbered((*triangle)[1]), renumbered((*triangle)[2])});
        fan += size;
    }
    triangles_.clear();
    return left;
}

} // namespace palp
