#pragma once
#include "engine/plate/host/frame.h"
#include "engine/plate/host/host_kernels.h"

// Loads side by side: at each node a field then has the numbers of kLoadsTogether loads, one after the other. A kernel
// on fields is a template of what lies at a node, a number or a Together of numbers. The numbers that a stencil needs
// are then whole registers, small levels cost no more per node than large ones, and what belongs to the plate is read
// once for all loads. The arithmetic of each load is that of a field of its own, to the bit.

namespace palp::PALPATE_ISA {

/// The numbers of kLoadsTogether loads at one node.
template <class Real>
struct Together {
    // Longer registers are slower, and where they are shorter a compiler splits them.
    static constexpr int kBytes = 32, kLanes = kBytes / int(sizeof(Real)), kParts = kLoadsTogether / kLanes;
    typedef Real         Vector __attribute__((vector_size(kBytes), aligned(sizeof(Real)), may_alias));

    Vector parts[kParts];

    Together() = default;
    explicit Together(Real ofAll)
    {
        for (Vector& part : parts) part = ofAll - Vector{};
    }
    template <class Other>
    explicit Together(const Together<Other>& other)
    {
        constexpr int kFour = 4;
        typedef Other From __attribute__((vector_size(kFour * sizeof(Other))));
        typedef Real  To __attribute__((vector_size(kFour * sizeof(Real))));
        for (int n = 0; n < kLoadsTogether; n += kFour) {
            From from;
            __builtin_memcpy(&from, reinterpret_cast<const char*>(other.parts) + n * sizeof(Other), sizeof from);
            const To to = __builtin_convertvector(from, To);
            __builtin_memcpy(reinterpret_cast<char*>(parts) + n * sizeof(Real), &to, sizeof to);
        }
    }

    Real&       operator[](int load) { return reinterpret_cast<Real*>(parts)[load]; }
    const Real& operator[](int load) const { return reinterpret_cast<const Real*>(parts)[load]; }

    Together& operator+=(const Together& b) { return *this = *this + b; }
    Together& operator-=(const Together& b) { return *this = *this - b; }
    Together& operator*=(Real b) { return *this = b * *this; }

#define PALPATE_BY_PARTS(op)                                                                                           \
    friend Together operator op(const Together& a, const Together& b)                                                  \
    {                                                                                                                  \
        Together c;                                                                                                    \
        for (int n = 0; n < kParts; ++n) c.parts[n] = a.parts[n] op b.parts[n];                                        \
        return c;                                                                                                      \
    }                                                                                                                  \
    friend Together operator op(Real a, const Together& b)                                                             \
    {                                                                                                                  \
        Together c;                                                                                                    \
        for (int n = 0; n < kParts; ++n) c.parts[n] = a op b.parts[n];                                                 \
        return c;                                                                                                      \
    }
    PALPATE_BY_PARTS(+)
    PALPATE_BY_PARTS(-)
    PALPATE_BY_PARTS(*)
#undef PALPATE_BY_PARTS
};

/// Reads and writes eight numbers that follow each other.
// By registers: of a copy of bytes GCC makes halves of one, for which AVX2 then waits.
template <class Real>
[[gnu::always_inline]] inline Together<Real> eightOf(const Real* from)
{
    using Eight = Together<Real>;
    Eight v;
    for (int n = 0; n < Eight::kParts; ++n)
        v.parts[n] = *reinterpret_cast<const typename Eight::Vector*>(from + std::ptrdiff_t(n) * Eight::kLanes);
    return v;
}
template <class Real>
[[gnu::always_inline]] inline void store(Real* to, const Together<Real>& v)
{
    using Eight = Together<Real>;
    for (int n = 0; n < Eight::kParts; ++n)
        *reinterpret_cast<typename Eight::Vector*>(to + std::ptrdiff_t(n) * Eight::kLanes) = v.parts[n];
}

template <class At>
struct NodeOf {
    using Number                = At;
    static constexpr int kLoads = 1;
    template <class Real>
    using Of = Real;
};
template <class Real>
struct NodeOf<Together<Real>> {
    using Number                = Real;
    static constexpr int kLoads = kLoadsTogether;
    template <class Other>
    using Of = Together<Other>;
};

/// The type of the numbers at a node.
template <class At>
using NumberOf = typename NodeOf<At>::Number;

/// As many numbers of another type.
template <class Real, class At>
using AsMany = typename NodeOf<At>::template Of<Real>;

/// Returns the number of one load at a node.
template <class Real>
Real numberOf(Real number, int)
{
    return number;
}
template <class Real>
Real numberOf(const Together<Real>& numbers, int load)
{
    return numbers[load];
}

/// Returns how many fields a dispatch has, each with what At says at its nodes.
template <class At>
std::ptrdiff_t fieldsOf(const HostDispatch& d)
{
    return std::ptrdiff_t(d.groups.z) / NodeOf<At>::kLoads;
}

/// The kernel `name` for one load in a field, and name_together for several.
#define PALPATE_ALONE_AND_TOGETHER(name, Real)                                                                         \
    void name(const HostDispatch& d)                                                                                   \
    {                                                                                                                  \
        name##Of<Real>(d);                                                                                             \
    }                                                                                                                  \
    void name##_together(const HostDispatch& d)                                                                        \
    {                                                                                                                  \
        name##Of<Together<Real>>(d);                                                                                   \
    }

/// The same in both precisions.
#define PALPATE_REALS_ALONE_AND_TOGETHER(name)                                                                         \
    PALPATE_IN_BOTH_PRECISIONS(name)                                                                                   \
    void name##_f32_together(const HostDispatch& d)                                                                    \
    {                                                                                                                  \
        name##Of<Together<float>>(d);                                                                                  \
    }                                                                                                                  \
    void name##_f64_together(const HostDispatch& d)                                                                    \
    {                                                                                                                  \
        name##Of<Together<double>>(d);                                                                                 \
    }

} // namespace palp::PALPATE_ISA
