// The peers of palpate_peers. CMake defines PALPATE_HAS_CHOLMOD and PALPATE_HAS_NANOFLANN where it finds the libraries.
#include "engine/tools/bench/outside_peers.h"

#if PALPATE_HAS_CHOLMOD
#include "engine/tools/bench/cholmod_solver.h"
#endif
#if PALPATE_HAS_NANOFLANN
#include "engine/tools/bench/nanoflann_search.h"
#endif

namespace palp::bench {

const OutsidePeers& outsidePeers()
{
    static const OutsidePeers found = [] {
        OutsidePeers peers;
#if PALPATE_HAS_CHOLMOD
        peers.cholmod     = cholmodSolver;
        peers.cholmodNote = cholmodVersion();
#else
        peers.cholmodNote   = "not found: install libsuitesparse-dev and libopenblas0-serial, and configure again";
#endif
#if PALPATE_HAS_NANOFLANN
        peers.radiusSearch  = nanoflannSearch;
        peers.nearestMap    = nanoflannMap;
        peers.nanoflannNote = "nanoflann";
#else
        peers.nanoflannNote = "not found: install libnanoflann-dev, and configure again";
#endif
        return peers;
    }();
    return found;
}

} // namespace palp::bench
