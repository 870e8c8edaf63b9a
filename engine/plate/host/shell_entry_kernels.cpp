#include "engine/plate/host/operator_rows.h"
#include "engine/plate/host/shell_view.h"

// The coefficients of a level of a shell from its maps, row by row and in doubles. Sides enter by factors of rows and
// columns, so that loops along a row have no branch.

namespace palp::PALPATE_ISA {
namespace {

/// The shared headers in doubles.
struct ShellRules : Rules<double> {
    [[noreturn]] static float curvatureXZ(int, int) { __builtin_unreachable(); }

#include "compute_shaders/shared/shell_coupling.h"
#include "compute_shaders/shared/shell_relax.h"
};

constexpr int kRim = kShellRim;

/// Numbers at the nodes of a level and two beyond each side, in rows along z.
struct Map {
    double*        first;
    std::ptrdiff_t stride;

    double* row(int i) const { return first + (i + kRim) * stride + kRim; }
};

/// What a field's own energy is made of.
struct Moments {
    Map xx, zz, xz; ///< of second differences along x, along z, and of their product, at nodes
    Map twist;      ///< of the cell whose first corner is the node
};

class ShellEntries {
public:
    explicit ShellEntries(const HostDispatch& d)
        : push_(pushed<ShellPush>(d)), maps_(*bound<const ShellMaps>(d, 0)), floats_(bound<float>(d, 1)),
          doubles_(push_.toDoubles ? bound<double>(d, 2) : nullptr), cellsX_(push_.layout.cellsX),
          cellsZ_(push_.layout.cellsZ), stride_(cellsZ_ + 1 + 2 * kRim)
    {
        constexpr int                       kMaps = 13, kAxes = 4;
        const std::ptrdiff_t                map = (cellsX_ + 1 + 2 * kRim) * stride_;
        const std::ptrdiff_t                all = kMaps * map + (kShellPlanes * kKept + kAxes) * stride_;
        static thread_local Scratch<double> scratch;
        next_ = scratch.of(all);
        for (std::ptrdiff_t n = 0; n < all; ++n) next_[n] = 0;
        for (Map* m : {&bend_.xx, &bend_.zz, &bend_.xz, &bend_.twist, &stress_.xx, &stress_.zz, &stress_.xz,
                       &stress_.twist, &alongX_, &alongZ_, &cellTwist_, &wMoves_, &fMoves_})
            *m = {take(map), stride_};
        for (double** axis : {&north_, &south_, &northOfStress_, &southOfStress_}) *axis = take(stride_) + kRim;
        kept_ = take(kShellPlanes * kKept * stride_);
    }

    void make()
    {
        moments(maps_.bending, maps_.rigidity, bend_);
        moments(maps_.stress, maps_.compliance, stress_);
        curvatures();
        for (int j = 0; j <= cellsZ_; ++j) {
            north_[j]         = difference(j, 1, cellsZ_, false, false);
            south_[j]         = difference(j, -1, cellsZ_, false, false);
            northOfStress_[j] = acrossZ(j, 1);
            southOfStress_[j] = acrossZ(j, -1);
        }
        coupling(0);
        for (int i = 0; i <= cellsX_; ++i) {
            entries(bend_, kBendEast, i);
            entries(stress_, kStressEast, i);
            coupling(i + 1);
            bed(maps_.bending, maps_.shape, wMoves_, kept(kBed, i), i);
            bed(maps_.stress, maps_.stressShape, fMoves_, kept(kStressBed, i), i);
            columnSum(i);
            inverses(i);
            for (int plane = 0; plane < kShellPlanes; ++plane) write(plane, i);
        }
    }

private:
    static constexpr int kKept = 3; ///< rows of a plane at a time

    double* take(std::ptrdiff_t numbers)
    {
        double* const at = next_;
        next_ += numbers;
        return at;
    }

    /// Row i of a plane, as long as it is no more than two rows from the newest one.
    double* kept(int plane, int i) const { return kept_ + (plane * kKept + (i + kKept) % kKept) * stride_ + kRim; }

    static double difference(int n, int step, int cells, bool hingedFirst, bool hingedLast)
    {
        return rules.secondDifferenceEntry(n, step, cells, hingedFirst, hingedLast);
    }
    double acrossX(int i, int step) const
    {
        return difference(i, step, cellsX_, (maps_.stress.hinged & kSideX0) != 0U,
                          (maps_.stress.hinged & kSideX1) != 0U);
    }
    double acrossZ(int j, int step) const
    {
        return difference(j, step, cellsZ_, (maps_.stress.hinged & kSideZ0) != 0U,
                          (maps_.stress.hinged & kSideZ1) != 0U);
    }

    const float* at(const float* map, int i) const { return map + std::ptrdiff_t(i) * (cellsZ_ + 1); }

    void moments(const PlateLevel& g, const float* rigidity, const Moments& to)
    {
        for (int i = 0; i <= cellsX_; ++i) {
            const float *D = at(rigidity, i), *after = D + (cellsZ_ + 1);
            const bool   onX   = rules.isHingedX(g, i);
            const double share = i == 0 || i == cellsX_ ? 0.5 : 1;
            double *     xx = to.xx.row(i), *zz = to.zz.row(i), *xz = to.xz.row(i), *twist = to.twist.row(i);
            const double kxx = onX ? 0 : share * g.kxx, kxz = onX ? 0 : share * g.kxz,
                         kzz = onX ? g.ezz : share * g.kzz;
            for (int j = 0; j <= cellsZ_; ++j) {
                xx[j] = kxx * D[j];
                zz[j] = kzz * D[j];
                xz[j] = kxz * D[j];
            }
            for (const int j : {0, cellsZ_}) {
                const bool onZ = rules.isHingedZ(g, j);
                xx[j] *= onZ ? (onX ? 0 : g.exx / double(g.kxx)) : 0.5;
                zz[j] *= onZ ? 0 : 0.5;
                xz[j] *= onZ ? 0 : 0.5;
            }
            if (i == cellsX_) continue;
            for (int j = 0; j < cellsZ_; ++j)
                twist[j] = g.twist * ((double(D[j]) + D[j + 1]) + (double(after[j]) + after[j + 1]));
        }
    }

    void curvatures()
    {
        const PlateLevel& g    = maps_.stress;
        const double      slim = sqrt(sqrt(double(g.kxx) / double(g.kzz))); // hz / hx
        for (int i = 0; i <= cellsX_; ++i) {
            const float *kx = at(maps_.curvatureX, i), *kz = at(maps_.curvatureZ, i), *kxz = at(maps_.curvatureXZ, i);
            const float* after = kxz + (cellsZ_ + 1);
            const double share = i == 0 || i == cellsX_ ? 0.5 : 1;
            double *     x = alongX_.row(i), *z = alongZ_.row(i), *twist = cellTwist_.row(i);
            for (int j = 0; j <= cellsZ_; ++j) {
                x[j] = -(share * slim) * kz[j];
                z[j] = -(share / slim) * kx[j];
            }
            for (const int j : {0, cellsZ_}) {
                x[j] *= 0.5;
                z[j] *= 0.5;
            }
            for (int j = 0; j <= cellsZ_; ++j) {
                wMoves_.row(i)[j] = rules.isHeld(maps_.bending, i, j) ? 0 : 1;
                fMoves_.row(i)[j] = rules.isHeld(maps_.stress, i, j) ? 0 : 1;
            }
            if (i == cellsX_) continue;
            for (int j = 0; j < cellsZ_; ++j)
                twist[j] = 0.5 * rules.cellTwist(kxz[j], after[j], kxz[j + 1], after[j + 1]);
        }
    }

    /// The entries of A, or C, of row i that belong to its nodes: half of the energy's mixed terms each.
    void entries(const Moments& m, int plane, int i)
    {
        const double here  = difference(i, 1, cellsX_, false, false),
                     back  = difference(i + 1, -1, cellsX_, false, false),
                     there = difference(i + 1, 1, cellsX_, false, false);
        const double *xx = m.xx.row(i), *zz = m.zz.row(i), *xz = m.xz.row(i), *t = m.twist.row(i);
        const double *xxE = m.xx.row(i + 1), *xzE = m.xz.row(i + 1), *tW = m.twist.row(i - 1);
        const double *qn = north_, *qs = south_;
        double *      east = kept(plane + kBendEast, i), *north = kept(plane + kBendNorth, i);
        double *      east2 = kept(plane + kBendEast2, i), *north2 = kept(plane + kBendNorth2, i);
        double *      northEast = kept(plane + kBendNorthEast, i), *southEast = kept(plane + kBendSouthEast, i);
        for (int j = 0; j <= cellsZ_; ++j) {
            east[j]      = -2 * (here * (xx[j] + xz[j]) + back * (xxE[j] + xzE[j])) - (t[j] + t[j - 1]);
            north[j]     = -2 * (qn[j] * (zz[j] + xz[j]) + qs[j + 1] * (zz[j + 1] + xz[j + 1])) - (t[j] + tW[j]);
            east2[j]     = back * there * xxE[j];
            north2[j]    = qs[j + 1] * qn[j + 1] * zz[j + 1];
            northEast[j] = here * qs[j + 1] * xz[j + 1] + back * qn[j] * xzE[j] + t[j];
            southEast[j] = here * qn[j - 1] * xz[j - 1] + back * qs[j] * xzE[j] + t[j - 1];
        }
    }

    void coupling(int i)
    {
        double* to[8];
        for (int n = 0; n < 8; ++n) to[n] = kept(kCoupleEast + n, i);
        if (i > cellsX_) {
            for (double* row : to)
                for (int j = 0; j <= cellsZ_; ++j) row[j] = 0;
            return;
        }
        const double  east = acrossX(i, 1), west = acrossX(i, -1);
        const double *x = alongX_.row(i), *z = alongZ_.row(i), *moves = wMoves_.row(i);
        const double *t = cellTwist_.row(i), *tW = cellTwist_.row(i - 1);
        for (int j = 0; j <= cellsZ_; ++j) {
            const double ne = t[j], nw = tW[j], se = t[j - 1], sw = tW[j - 1], on = moves[j];
            to[0][j] = on * (east * x[j] + (se - ne));
            to[1][j] = on * (west * x[j] + (nw - sw));
            to[2][j] = on * (northOfStress_[j] * z[j] + (nw - ne));
            to[3][j] = on * (southOfStress_[j] * z[j] + (se - sw));
            to[4][j] = on * ne;
            to[5][j] = on * -nw;
            to[6][j] = on * -se;
            to[7][j] = on * sw;
        }
    }

    /// The entry of a node's own phi in its row of w.
    double ownCoupling(int i, int j) const
    {
        double sum = 0;
        for (int n = 0; n < 8; ++n) sum -= kept(kCoupleEast + n, i)[j];
        return sum;
    }

    void bed(const PlateLevel& g, const float* shape, const Map& moves, double* to, int i) const
    {
        for (int j = 0; j <= cellsZ_; ++j) {
            const double all = double(g.bed) * rules.nodeShare(g, i, j) * moves.row(i)[j];
            to[j]            = shape ? all * at(shape, i)[j] : all;
        }
    }

    void columnSum(int i)
    {
        double*       to   = kept(kColumnSum, i);
        const auto    from = [&](int plane, int di) { return kept(plane, i + di); };
        const double *e = from(kCoupleEast, -1), *w = from(kCoupleWest, 1), *n = from(kCoupleNorth, 0),
                     *s = from(kCoupleSouth, 0), *ne = from(kCoupleNorthEast, -1), *nw = from(kCoupleNorthWest, 1),
                     *se = from(kCoupleSouthEast, -1), *sw = from(kCoupleSouthWest, 1);
        for (int j = 0; j <= cellsZ_; ++j)
            to[j] = ownCoupling(i, j) + ((e[j] + w[j]) + (n[j - 1] + s[j + 1])) +
                    ((ne[j - 1] + nw[j - 1]) + (se[j + 1] + sw[j + 1]));
    }

    /// A node's divisor for its field's own operator: see compute_shaders/shared/plate_relax.h.
    void divisors(int plane, const Map& moves, int i, double* to) const
    {
        const auto    from = [&](int of, int di) { return kept(plane + of, i + di); };
        const double *e = from(kBendEast, 0), *w = from(kBendEast, -1), *n = from(kBendNorth, 0);
        const double *e2 = from(kBendEast2, 0), *w2 = from(kBendEast2, -2), *n2 = from(kBendNorth2, 0);
        const double *ne = from(kBendNorthEast, 0), *se = from(kBendSouthEast, 0), *nw = from(kBendSouthEast, -1),
                     *sw   = from(kBendNorthEast, -1);
        const double *here = moves.row(i), *mE = moves.row(i + 1), *mW = moves.row(i - 1), *mE2 = moves.row(i + 2),
                     *mW2 = moves.row(i - 2);
        const double* bed = kept(plane == kBendEast ? kBed : kStressBed, i);
        for (int j = 0; j <= cellsZ_; ++j) {
            const double all = ((e[j] + w[j]) + (n[j] + n[j - 1])) + ((e2[j] + w2[j]) + (n2[j] + n2[j - 2])) +
                               ((ne[j] + sw[j - 1]) + (se[j] + nw[j + 1]));
            const double same = abs(e2[j]) * mE2[j] + abs(w2[j]) * mW2[j] + abs(n2[j]) * here[j + 2] +
                                abs(n2[j - 2]) * here[j - 2] + abs(ne[j]) * mE[j + 1] + abs(sw[j - 1]) * mW[j - 1] +
                                abs(se[j]) * mE[j - 1] + abs(nw[j + 1]) * mW[j + 1];
            to[j] = rules.relaxationDivisor(bed[j] - all, same);
        }
    }

    void inverses(int i)
    {
        double *ww = kept(kInverseW, i), *wf = kept(kInverseWF, i), *ff = kept(kInverseF, i);
        divisors(kBendEast, wMoves_, i, ww);
        divisors(kStressEast, fMoves_, i, ff);
        for (int j = 0; j <= cellsZ_; ++j) {
            const auto of =
                rules.shellInverse(ww[j], ff[j], ownCoupling(i, j), wMoves_.row(i)[j] != 0, fMoves_.row(i)[j] != 0);
            ww[j] = of.ww;
            wf[j] = of.wf;
            ff[j] = of.ff;
        }
    }

    void write(int plane, int i)
    {
        const int            span = push_.layout.span;
        const std::ptrdiff_t at   = (std::ptrdiff_t(i + kShellRim) * kShellPlanes + plane) * 2 * span;
        const double*        row  = kept(plane, i);
        for (int odd = 0; odd < 2; ++odd)
            for (int j = odd, m = odd * span; j <= cellsZ_; j += 2, ++m) {
                floats_[at + m] = float(row[j]);
                if (doubles_) doubles_[at + m] = row[j];
            }
    }

    static inline ShellRules rules{};

    const ShellPush& push_;
    const ShellMaps& maps_;
    float*           floats_;
    double*          doubles_;
    int              cellsX_, cellsZ_;
    std::ptrdiff_t   stride_;
    double*          next_ = nullptr;
    Moments          bend_{}, stress_{};
    Map              alongX_{}, alongZ_{}; ///< of phi's second differences along x and z in the row of w
    Map              cellTwist_{}, wMoves_{}, fMoves_{};
    double *         north_ = nullptr, *south_ = nullptr, *northOfStress_ = nullptr, *southOfStress_ = nullptr;
    double*          kept_ = nullptr;
};

} // namespace

// Buffers: ShellMaps, coefficients in floats, and in doubles if they are wanted.
void shellEntries(const HostDispatch& d)
{
    ShellEntries(d).make();
}

} // namespace palp::PALPATE_ISA
