#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/contract.h"

namespace palp {

/// A position in the plane of the plate. Its owner states the origin; in a chart that is the contact.
struct ChartPoint {
    double x = 0; ///< [m]
    double z = 0; ///< [m]
};

/// The regular grid of a plate: cellsX by cellsZ cells, and one node more along each side.
///
///     node (i, j) lies at x = i spacingX, z = j spacingZ from the corner; it is stored at [i * nodesZ() + j]
///     (x first, C order: a field is the array of shape (cellsX + 1, cellsZ + 1) of a .npy file)
struct PlateGrid {
    int    cellsX   = 0;
    int    cellsZ   = 0;
    double spacingX = 0; ///< [m]
    double spacingZ = 0; ///< [m]

    [[nodiscard]] int         nodesX() const noexcept { return cellsX + 1; }
    [[nodiscard]] int         nodesZ() const noexcept { return cellsZ + 1; }
    [[nodiscard]] std::size_t nodes() const noexcept { return std::size_t(nodesX()) * std::size_t(nodesZ()); }
    [[nodiscard]] double      sizeX() const noexcept { return cellsX * spacingX; } ///< [m]
    [[nodiscard]] double      sizeZ() const noexcept { return cellsZ * spacingZ; } ///< [m]
    bool                      operator==(const PlateGrid&) const = default;
};

/// One number per node of a PlateGrid. Its owner states the unit.
class NodeField {
public:
    NodeField() = default;
    explicit NodeField(const PlateGrid& grid, double value = 0) : NodeField(grid.nodesX(), grid.nodesZ(), value) {}
    NodeField(int nodesX, int nodesZ, double value = 0)
        : nodesX_(nodesX), nodesZ_(nodesZ), values_(std::size_t(nodesX) * std::size_t(nodesZ), value)
    {
    }

    /// \param values  one per node, those of a row along z together
    NodeField(int nodesX, int nodesZ, std::vector<double> values)
        : nodesX_(nodesX), nodesZ_(nodesZ), values_(std::move(values))
    {
        PALP_EXPECT(values_.size() == std::size_t(nodesX) * std::size_t(nodesZ),
                    std::to_string(values_.size()) + " values for " + std::to_string(nodesX) + " x " +
                        std::to_string(nodesZ) + " nodes");
    }

    [[nodiscard]] int  nodesX() const noexcept { return nodesX_; }
    [[nodiscard]] int  nodesZ() const noexcept { return nodesZ_; }
    [[nodiscard]] bool on(const PlateGrid& g) const noexcept { return nodesX_ == g.nodesX() && nodesZ_ == g.nodesZ(); }

    double&       operator()(int i, int j) noexcept { return values_[index(i, j)]; }
    const double& operator()(int i, int j) const noexcept { return values_[index(i, j)]; }

    [[nodiscard]] std::vector<double>&       values() noexcept { return values_; }
    [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }

private:
    [[nodiscard]] std::size_t index(int i, int j) const noexcept
    {
        return std::size_t(i) * std::size_t(nodesZ_) + std::size_t(j);
    }

    int                 nodesX_ = 0;
    int                 nodesZ_ = 0;
    std::vector<double> values_;
};

} // namespace palp
