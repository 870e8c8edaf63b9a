#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <new>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/footprint_layout.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tile_layout.h"
#include "compute_shaders/shared/transfer_layout.h"
#include "engine/compute/host_dispatch.h"

// The common parts of the host's kernels. Their files are compiled once per instruction set, each time in another
// namespace: all definitions must be in it, or a linker might give a processor code that it cannot run.
//
// The arithmetic is that of the shaders' headers, node by node and in the same order; contraction is off. So the
// results are those of the shaders, to the bit (but for the sign of a zero), on every instruction set. Only the loops
// are different: they run along rows and have no branches, so that compilers make vector instructions of them.

#ifndef PALPATE_ISA
#error "set PALPATE_ISA, the namespace of an instruction set"
#endif

namespace palp::PALPATE_ISA {

using namespace shared;
using compute::HostDispatch;

inline float min(float a, float b)
{
    return b < a ? b : a;
}
inline float max(float a, float b)
{
    return a < b ? b : a;
}
inline double min(double a, double b)
{
    return b < a ? b : a;
}
inline double max(double a, double b)
{
    return a < b ? b : a;
}
inline int min(int a, int b)
{
    return b < a ? b : a;
}
inline int max(int a, int b)
{
    return a < b ? b : a;
}
inline float abs(float a)
{
    return __builtin_fabsf(a);
}
inline double abs(double a)
{
    return __builtin_fabs(a);
}
inline int abs(int a)
{
    return a < 0 ? -a : a;
}
inline float sqrt(float a)
{
    return __builtin_sqrtf(a);
}
inline double sqrt(double a)
{
    return __builtin_sqrt(a);
}

template <class T>
T* bound(const HostDispatch& d, int n)
{
    return static_cast<T*>(d.buffers[n]);
}

template <class Push>
const Push& pushed(const HostDispatch& d)
{
    return *static_cast<const Push*>(d.push);
}

inline std::ptrdiff_t nodesOf(const PlateLevel& g)
{
    return std::ptrdiff_t(g.cellsX + 1) * (g.cellsZ + 1);
}

/// The kernels name_f32 and name_f64, of the template nameOf.
#define PALPATE_IN_BOTH_PRECISIONS(name)                                                                               \
    void name##_f32(const HostDispatch& d)                                                                             \
    {                                                                                                                  \
        name##Of<float>(d);                                                                                            \
    }                                                                                                                  \
    void name##_f64(const HostDispatch& d)                                                                             \
    {                                                                                                                  \
        name##Of<double>(d);                                                                                           \
    }

/// Keeps the numbers of one kind that a kernel needs while it runs, from run to run; new ones are zeros.
/// \thread each has its own
template <class T>
class Scratch {
public:
    Scratch()                          = default;
    Scratch(const Scratch&)            = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() { free(); }

    T* of(std::ptrdiff_t count)
    {
        if (count > size_) {
            free();
            data_ = static_cast<T*>(::operator new(sizeof(T) * std::size_t(count), kLine));
            size_ = count;
            for (std::ptrdiff_t n = 0; n < count; ++n) data_[n] = T(0);
        }
        return data_;
    }

private:
    static constexpr std::align_val_t kLine{64}; ///< of the cache [bytes]

    void free()
    {
        ::operator delete(data_, kLine);
        data_ = nullptr;
        size_ = 0;
    }

    T*             data_ = nullptr;
    std::ptrdiff_t size_ = 0;
};

} // namespace palp::PALPATE_ISA
