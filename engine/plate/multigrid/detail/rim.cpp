#include "engine/plate/multigrid/detail/rim.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "compute_shaders/shared/tile_layout.h"
#include "engine/core/contract.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"

namespace palp {
namespace {

constexpr int kReach = 4;  ///< nodes beside a jump: fewer take more steps, more cost more than they save
constexpr int kLeaf  = 12; ///< nodes that are not divided
constexpr int kStrip = 2;  ///< nodes across a strip: a term of the operator reaches as far

/// Multiplications of a factor per unknown are at least so many, unless a rim is very small.
constexpr double kLeastWork = 1400;
constexpr int    kSmall     = 500;

/// Returns whether the rigidity jumps around a node, as shared/jump_tiles.h has it.
bool jumpsAround(const shared::PlateLevel& g, std::span<const float> rigidity, int i, int j)
{
    float least = rigidity[std::size_t(i) * std::size_t(g.cellsZ + 1) + std::size_t(j)], most = least;
    for (int a = std::max(0, i - 1); a <= std::min(g.cellsX, i + 1); ++a)
        for (int b = std::max(0, j - 1); b <= std::min(g.cellsZ, j + 1); ++b) {
            const float here = rigidity[std::size_t(a) * std::size_t(g.cellsZ + 1) + std::size_t(b)];
            least            = std::min(least, here);
            most             = std::max(most, here);
        }
    return most > shared::kJump * least;
}

bool isHeld(const shared::PlateLevel& g, int i, int j)
{
    return (i == 0 && !(g.free & shared::kSideX0)) || (i == g.cellsX && !(g.free & shared::kSideX1)) ||
           (j == 0 && !(g.free & shared::kSideZ0)) || (j == g.cellsZ && !(g.free & shared::kSideZ1));
}

} // namespace

bool Rim::divide(const shared::PlateLevel& level, std::span<const float> rigidity, const std::uint32_t* jumpTiles,
                 double mostWork)
{
    level_ = level;
    findNodes(level, rigidity, jumpTiles);
    if (unknowns() > kSmall && kLeastWork * unknowns() > mostWork) return false;
    return divideFound(mostWork);
}

void Rim::divideAll(const shared::PlateLevel& level)
{
    divideThese(level, std::vector<std::uint8_t>(nodesOf(level), 1));
}

void Rim::divideThese(const shared::PlateLevel& level, std::vector<std::uint8_t> which)
{
    level_ = level;
    isIn_  = std::move(which);
    listNodes();
    const bool isDivided = divideFound(std::numeric_limits<double>::infinity());
    PALP_EXPECT(isDivided, "the halves of a grid are as deep as their number's logarithm");
}

bool Rim::divideFound(double mostWork)
{
    mostWork_ = mostWork;
    listTiles(level_);
    numbers_.assign(nodesOf(level_), -1);
    seen_.assign(nodesOf(level_), -1);
    fronts_.clear();
    borders_.clear();
    open_.clear();
    entries_ = 0;
    work_    = 0;
    if (!nodes_.empty() && !divideNodes(0, unknowns())) return false;
    for (int& node : borders_) node = numbers_[std::size_t(node)];
    for (const RimFront& front : fronts_) {
        const auto border = borders_.begin() + front.borderAt;
        std::sort(border, border + front.border);
    }
    return work_ <= mostWork;
}

void Rim::findNodes(const shared::PlateLevel& g, std::span<const float> rigidity, const std::uint32_t* jumpTiles)
{
    const int nodes = g.cellsZ + 1;
    isIn_.assign(nodesOf(g), 0);
    for (std::uint32_t n = 0; n < jumpTiles[0]; ++n) {
        const int tile = int(jumpTiles[1 + n]);
        const int i0 = tile / shared::tilesZ(g) * shared::kTile, j0 = tile % shared::tilesZ(g) * shared::kTile;
        for (int i = i0; i <= std::min(i0 + shared::kTile - 1, g.cellsX); ++i)
            for (int j = j0; j <= std::min(j0 + shared::kTile - 1, g.cellsZ); ++j) {
                if (!jumpsAround(g, rigidity, i, j)) continue;
                const int from = std::max(0, j - kReach), to = std::min(g.cellsZ, j + kReach);
                for (int a = std::max(0, i - kReach); a <= std::min(g.cellsX, i + kReach); ++a)
                    std::fill_n(isIn_.begin() + std::ptrdiff_t(a) * nodes + from, to - from + 1, std::uint8_t(1));
            }
    }
    listNodes();
}

void Rim::listNodes()
{
    const int nodes = level_.cellsZ + 1;
    nodes_.clear();
    for (int i = 0; i <= level_.cellsX; ++i)
        for (int j = 0; j <= level_.cellsZ; ++j)
            if (isIn_[std::size_t(i * nodes + j)] && !isHeld(level_, i, j)) nodes_.push_back(i * nodes + j);
}

void Rim::listTiles(const shared::PlateLevel& g)
{
    const int                 nodes = g.cellsZ + 1, across = shared::tilesZ(g);
    std::vector<std::uint8_t> has(std::size_t(shared::tilesX(g) * across), 0);
    for (const int node : nodes_)
        has[std::size_t(node / nodes / shared::kTile * across + node % nodes / shared::kTile)] = 1;
    tiles_.assign(1, 0);
    for (std::size_t n = 0; n < has.size(); ++n)
        if (has[n]) tiles_.push_back(std::uint32_t(n));
    tiles_[0] = std::uint32_t(tiles_.size() - 1);
}

bool Rim::divideNodes(int first, int end)
{
    const int  nodes    = level_.cellsZ + 1;
    const auto place    = [&](int node, bool x) { return x ? node / nodes : node % nodes; };
    int        least[2] = {level_.cellsX, level_.cellsZ}, most[2] = {0, 0};
    for (int n = first; n < end; ++n)
        for (int axis : {0, 1}) {
            const int at = place(nodes_[std::size_t(n)], axis == 0);
            least[axis]  = std::min(least[axis], at);
            most[axis]   = std::max(most[axis], at);
        }
    const bool x    = most[0] - least[0] >= most[1] - least[1];
    const int  from = least[x ? 0 : 1], length = most[x ? 0 : 1] - from + 1;
    if (end - first <= kLeaf || length < kStrip + 2) {
        addFront(first, end, true);
        return work_ <= mostWork_ && int(open_.size()) <= kMostOpenFronts;
    }
    // The strip with the fewest nodes that leaves at least a third of the others on either side, or the middle one.
    counts_.assign(std::size_t(length), 0);
    for (int n = first; n < end; ++n) ++counts_[std::size_t(place(nodes_[std::size_t(n)], x) - from)];
    int before = 0, best = -1, bestCost = end - first, middle = 1, middleGap = end - first;
    for (int at = 1; at + kStrip < length; ++at) {
        before += counts_[std::size_t(at - 1)];
        const int strip = counts_[std::size_t(at)] + counts_[std::size_t(at + 1)];
        const int after = end - first - before - strip;
        const int gap   = std::abs(before - after);
        if (gap < middleGap) {
            middle    = at;
            middleGap = gap;
        }
        if (3 * before >= end - first - strip && 3 * after >= end - first - strip && strip < bestCost) {
            best     = at;
            bestCost = strip;
        }
    }
    const int strip = from + (best >= 0 ? best : middle);
    aside_.clear();
    // Stable, so that nodes of a front stay in order: nodes before the strip, after it, in it.
    int              at = first;
    std::vector<int> after;
    for (int n = first; n < end; ++n) {
        const int node = nodes_[std::size_t(n)], p = place(node, x);
        if (p < strip)
            nodes_[std::size_t(at++)] = node;
        else
            (p < strip + kStrip ? aside_ : after).push_back(node);
    }
    const int half = at;
    for (const int node : after) nodes_[std::size_t(at++)] = node;
    const int rest = at;
    for (const int node : aside_) nodes_[std::size_t(at++)] = node;
    if (!divideNodes(first, half) || !divideNodes(half, rest)) return false;
    addFront(rest, end, false);
    return true;
}

void Rim::addFront(int first, int end, bool isLeaf)
{
    RimFront front{first, end - first, 0, 0, 0, std::ptrdiff_t(borders_.size()), std::ptrdiff_t(entries_), isLeaf};
    for (int n = first; n < end; ++n) numbers_[std::size_t(nodes_[std::size_t(n)])] = n;
    findBorder(front);
    const auto whole = [](int count) { return (count + kWholeRows - 1) / kWholeRows * kWholeRows; };
    front.border     = int(borders_.size()) - int(front.borderAt);
    front.borderRows = whole(front.border);
    front.ownRows    = whole(front.own);
    entries_ += std::size_t(front.rows()) * std::size_t(front.own);
    for (int k = 0; k < front.own; ++k) work_ += 0.5 * (front.own + front.border - k) * (front.own + front.border - k);
    open_.push_back(int(fronts_.size()));
    fronts_.push_back(front);
}

// The border is known by node until all are numbered: a strip's nodes are numbered after those of its halves.
void Rim::findBorder(RimFront& front)
{
    const int  stamp = int(fronts_.size()), nodes = level_.cellsZ + 1;
    const auto add = [&](int node) {
        if (numbers_[std::size_t(node)] >= 0 || seen_[std::size_t(node)] == stamp) return;
        seen_[std::size_t(node)] = stamp;
        borders_.push_back(node);
    };
    if (!front.isLeaf)
        for (int n = 0; n < 2; ++n) {
            const RimFront& half = fronts_[std::size_t(open_.back())];
            open_.pop_back();
            for (int m = 0; m < half.border; ++m) add(borders_[std::size_t(half.borderAt + m)]);
        }
    for (int n = front.first; n < front.first + front.own; ++n) {
        const int node = nodes_[std::size_t(n)], i = node / nodes, j = node % nodes;
        for (int a = -2; a <= 2; ++a)
            for (int b = std::abs(a) - 2; b <= 2 - std::abs(a); ++b) {
                if (i + a < 0 || j + b < 0 || i + a > level_.cellsX || j + b > level_.cellsZ) continue;
                const int other = node + a * nodes + b;
                if (isIn_[std::size_t(other)] && !isHeld(level_, i + a, j + b)) add(other);
            }
    }
}

const RimView& Rim::prepare(bool doubles)
{
    int mostRows = kWholeRows;
    for (const RimFront& front : fronts_) mostRows = std::max(mostRows, front.rows());
    // One vector more than needed: loads of eight may begin at the last number.
    columns_.resize(doubles ? entries_ + kWholeRows : entries_ / 2 + kWholeRows);
    view_ = {nodes_.data(),   numbers_.data(),    fronts_.data(),      borders_.data(), tiles_.data(),
             columns_.data(), int(nodes_.size()), int(fronts_.size()), mostRows,        doubles};
    return view_;
}

} // namespace palp
