#include "engine/tools/bench/direct_solver.h"

#include <gtest/gtest.h>

#include "engine/core/extremes.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/outside_peers.h"

namespace palp::bench {
namespace {

using Make = std::function<std::unique_ptr<DirectSolver>(const PlateMatrix&)>;

/// As a benchmark does it: analysed for one map, then given the numbers of others.
void agreesWithTheReference(const Make& make, const PlateEdges& edges, double foundation)
{
    // Condition of 33 nodes, 1e5, times the rounding of doubles, and room. A direct solver does not refine its answer,
    // so that it loses as many digits as the contrast has: measured 1e-8 to 1e-7 at a disc of 1e5.
    constexpr double kAgree = 1e-9, kAgreeBeyond = 1e-6, kStrong = 1e4; // [1]
    Plate            first = plateOf(maps().front(), 33);
    first.edges            = edges;
    first.foundation       = foundation;
    Direct direct{PlateMatrix(first), {}};
    direct.solver = make(direct.matrix);
    for (const Map& map : maps()) {
        Plate plate           = plateOf(map, 33);
        plate.edges           = edges;
        plate.foundation      = foundation;
        const NodeField force = fingertip(plate.grid, 0.4, 0.6);

        direct.factorise(plate);

        const Extremes of = extremesOf(plate.rigidity.values());
        EXPECT_LT(errorOf(direct.solve(force), ReferencePlateSolver(plate).solve(force).deflection),
                  of.most / of.least > kStrong ? kAgreeBeyond : kAgree)
            << direct.solver->name() << " on " << map.name;
    }
}

void agreesWithTheReference(const Make& make)
{
    using enum Edge;
    agreesWithTheReference(make, {}, 0);
    agreesWithTheReference(make, {supported, free, clamped, supported}, 0);
    agreesWithTheReference(make, {free, free, free, free}, 1e5);
}

TEST(DirectSolver, EigenAgreesWithTheReference)
{
    agreesWithTheReference(eigenSolver);
}

TEST(DirectSolver, CholmodAgreesWithTheReference)
{
    if (!outsidePeers().cholmod) GTEST_SKIP() << outsidePeers().cholmodNote;

    agreesWithTheReference(outsidePeers().cholmod);
}

TEST(DirectSolver, CholmodCountsItsMemory)
{
    if (!outsidePeers().cholmod) GTEST_SKIP() << outsidePeers().cholmodNote;
    const Plate plate = plateOf(maps().front(), 65);
    Direct      direct{PlateMatrix(plate), {}};
    direct.solver = outsidePeers().cholmod(direct.matrix);

    direct.factorise(plate);

    // The factor has at least the entries of the matrix.
    EXPECT_GT(direct.solver->peakBytes().value(), direct.matrix.row().size() * sizeof(double));
}

TEST(DirectSolver, WhatIsNotFoundSaysWhatToInstall)
{
    if (!outsidePeers().cholmod) {
        EXPECT_NE(outsidePeers().cholmodNote.find("libsuitesparse-dev"), std::string::npos);
    }
    if (!outsidePeers().radiusSearch) {
        EXPECT_NE(outsidePeers().nanoflannNote.find("libnanoflann-dev"), std::string::npos);
    }
}

} // namespace
} // namespace palp::bench
