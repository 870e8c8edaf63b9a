#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "compute_shaders/shared/plate_level.h"
#include "engine/plate/host/rim_view.h"

namespace palp {

/// The nodes of a level within a few of a jump of the rigidity, as a matrix of their own that is solved exactly: the
/// errors that a cycle leaves at a strong jump are there.
///
/// The nodes are divided into halves again and again, by strips two nodes wide that no term of the operator crosses.
/// What a strip couples is a dense front: the factor is a few hundred small dense matrices.
/// \source George 1973 (nested dissection); Duff & Reid 1983 (fronts)
class Rim {
public:
    /// Finds the rim and divides it.
    /// \param jumpTiles  the level's list of tiles with a jump, its length first
    /// \param mostWork   that the factor may take [multiplications]
    /// \return whether it takes no more
    [[nodiscard]] bool divide(const shared::PlateLevel& level, std::span<const float> rigidity,
                              const std::uint32_t* jumpTiles, double mostWork);

    /// Takes all nodes of a level that move, and divides them.
    void divideAll(const shared::PlateLevel& level);
    /// Does the same with some of its nodes.
    /// \param which  1 for those, by node
    void divideThese(const shared::PlateLevel& level, std::vector<std::uint8_t> which);

    /// Makes room for a factor.
    /// \return what the host's kernels need, valid until the next call
    [[nodiscard]] const RimView& prepare(bool doubles);

    [[nodiscard]] double work() const noexcept { return work_; } ///< of the factor [multiplications]
    [[nodiscard]] int    unknowns() const noexcept { return int(nodes_.size()); }

    [[nodiscard]] std::span<const RimFront> fronts() const noexcept { return fronts_; }
    [[nodiscard]] std::span<const int>      borders() const noexcept { return borders_; } ///< numbers of nodes()
    [[nodiscard]] std::span<const int>      nodes() const noexcept { return nodes_; } ///< in the order of elimination

private:
    [[nodiscard]] bool divideFound(double mostWork);
    void               listNodes(); ///< those that isIn_ has and that move
    void findNodes(const shared::PlateLevel& level, std::span<const float> rigidity, const std::uint32_t* jumpTiles);
    void listTiles(const shared::PlateLevel& level);
    /// Divides nodes_[first, end) until halves are small: the nodes of a strip come after those of its halves.
    /// \return false if the factor takes too much work
    [[nodiscard]] bool divideNodes(int first, int end);
    void               addFront(int first, int end, bool isLeaf);
    void               findBorder(RimFront& front);

    shared::PlateLevel         level_{};
    std::vector<std::uint8_t>  isIn_; ///< by node
    std::vector<int>           nodes_, aside_, numbers_, seen_, borders_, counts_;
    std::vector<RimFront>      fronts_;
    std::vector<int>           open_; ///< fronts that no later one has taken yet
    std::vector<std::uint32_t> tiles_;
    std::vector<double>        columns_; ///< or as many floats
    std::size_t                entries_ = 0;
    double                     work_ = 0, mostWork_ = 0; ///< [multiplications]
    RimView                    view_{};
};

} // namespace palp
