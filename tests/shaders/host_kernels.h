#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/plate_level.h"
#include "compute_shaders/shared/transfer_layout.h"

/// The shaders' arithmetic as C++: the same headers, with arrays in place of bound buffers. The build compiles this
/// without contraction, so that a device that neither fuses nor re-associates gives the same bits.
namespace palp::host {

using namespace shared;
using std::abs;
using std::exp;
using std::floor;
using std::max;
using std::min;
using std::sqrt;

/// A w of one level.
template <class Real>
struct Operator {
    using real = Real;
    const float* D;
    const Real*  w;
    const Real*  other; ///< nodes of the other colour; w except within a half sweep
    int          stride, shapeAt;

    real rigidity(int i, int j) const { return real(D[i * stride + j]); }
    real foundationShape(int i, int j) const { return real(D[shapeAt + i * stride + j]); }
    real deflection(int i, int j) const { return w[i * stride + j]; }
    real otherColour(int i, int j) const { return other[i * stride + j]; }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};

/// The operator's row, by unit deflections.
template <class Real>
struct RowOf {
    using real = Real;
    const float* D;
    int          stride, shapeAt;
    int          unitI = 0, unitJ = 0;

    real rigidity(int i, int j) const { return D[i * stride + j]; }
    real foundationShape(int i, int j) const { return D[shapeAt + i * stride + j]; }
    real deflection(int i, int j) const { return i == unitI && j == unitJ ? real(1) : real(0); }
    real otherColour(int i, int j) const { return deflection(i, j); }

#include "compute_shaders/shared/plate_divisor.h"
#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};
using Row = RowOf<float>;

struct Coarsen {
    const float* fine;
    int          stride, shapeAt;

    float fineRigidity(int i, int j) const { return fine[i * stride + j]; }
    float fineShape(int i, int j) const { return fine[shapeAt + i * stride + j]; }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/rigidity_coarsen.h"
};

template <class Real>
struct Prolong {
    using real = Real;
    const float* tablesX;
    const float* tablesZ;
    const Real*  coarse;
    int          stride;

    float tableX(int n) const { return tablesX[n]; }
    float tableZ(int n) const { return tablesZ[n]; }
    real  coarseValue(int i, int j) const { return coarse[i * stride + j]; }

#define PALPATE_PROLONGS
#include "compute_shaders/shared/plate_transfer.h"
#undef PALPATE_PROLONGS
};

struct Restrict {
    const float* tablesX;
    const float* tablesZ;
    const float* fine;
    int          stride;

    float tableX(int n) const { return tablesX[n]; }
    float tableZ(int n) const { return tablesZ[n]; }
    float fineValue(int i, int j) const { return fine[i * stride + j]; }

#define PALPATE_RESTRICTS
#include "compute_shaders/shared/plate_transfer.h"
#undef PALPATE_RESTRICTS
};

template <class Real>
struct Scalars {
    using real = Real;
#include "compute_shaders/shared/cg_step.h"
};

} // namespace palp::host
