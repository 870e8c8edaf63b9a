#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/contract.h"

namespace palp {

/// Most values of a volume: half a gigabyte of memory. Scans of a whole body have less.
inline constexpr std::uint64_t kMostVoxels = std::uint64_t(1) << 27;

/// Takes the values of a volume in the order of its file, checks them, and puts the first axis first.
class VolumeValues {
public:
    /// \throws Error if an axis has fewer than two values, or all of them are too many
    VolumeValues(std::string name, const std::array<int, 3>& size, bool firstIsFastest, double factor)
        : name_(std::move(name)), size_(size), firstIsFastest_(firstIsFastest), factor_(factor)
    {
        std::uint64_t all = 1;
        for (const int each : size) {
            if (each < 2)
                throw Error(name_ + ": expected two values or more along each of three axes, found " + shape());
            all = all > kMostVoxels ? all : all * std::uint64_t(each);
        }
        if (all > kMostVoxels)
            throw Error(name_ + ": expected at most " + std::to_string(kMostVoxels) + " values, found " + shape() +
                        "; take every second one");
        // Where values come in the order in which they are kept, the file's promise alone fills no memory.
        if (firstIsFastest_)
            values_.reserve(std::size_t(all));
        else
            values_.resize(std::size_t(all));
    }

    /// \throws Error naming the index if the value is NaN, infinite, negative or beyond what a float holds
    void add(double stored)
    {
        const std::array<int, 3> node  = nodeOf(added_);
        const double             value = stored * factor_;
        const char* const        wrong = std::isnan(value)                               ? "NaN"
                                         : !std::isfinite(value)                         ? "infinite"
                                         : value < 0                                     ? "negative"
                                         : value > 0 && !(value > 1e-30 && value < 1e30) ? "beyond 1e-30 to 1e30"
                                                                                         : nullptr;
        if (wrong)
            throw Error(name_ + ": the value at [" + std::to_string(node[0]) + ", " + std::to_string(node[1]) + ", " +
                        std::to_string(node[2]) + "] is " + wrong +
                        "; expected a stiffness above zero, or zero where nothing was measured");
        if (firstIsFastest_)
            values_.push_back(float(value));
        else
            values_[std::size_t(node[0]) +
                    std::size_t(size_[0]) * (std::size_t(node[1]) + std::size_t(size_[1]) * std::size_t(node[2]))] =
                float(value);
        ++added_;
    }

    [[nodiscard]] const std::array<int, 3>& size() const noexcept { return size_; }
    [[nodiscard]] std::vector<float>        take() noexcept { return std::move(values_); }

private:
    [[nodiscard]] std::array<int, 3> nodeOf(std::size_t n) const noexcept
    {
        const auto of = [](int size) { return std::size_t(size); };
        if (firstIsFastest_)
            return {int(n % of(size_[0])), int(n / of(size_[0]) % of(size_[1])), int(n / of(size_[0]) / of(size_[1]))};
        return {int(n / of(size_[2]) / of(size_[1])), int(n / of(size_[2]) % of(size_[1])), int(n % of(size_[2]))};
    }

    [[nodiscard]] std::string shape() const
    {
        return std::to_string(size_[0]) + " x " + std::to_string(size_[1]) + " x " + std::to_string(size_[2]);
    }

    std::string        name_;
    std::array<int, 3> size_;
    bool               firstIsFastest_;
    double             factor_;
    std::vector<float> values_;
    std::size_t        added_ = 0;
};

} // namespace palp
