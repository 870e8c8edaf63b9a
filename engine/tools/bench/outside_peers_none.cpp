#include "engine/tools/bench/outside_peers.h"

namespace palp::bench {

const OutsidePeers& outsidePeers()
{
    static const OutsidePeers none{{},
                                   "not built in: install libsuitesparse-dev and libopenblas0-serial, configure with "
                                   "-DPALPATE_BENCH_PEERS=ON and build; the program palpate_peers has it then",
                                   {},
                                   {},
                                   "not built in: install libnanoflann-dev, configure with -DPALPATE_BENCH_PEERS=ON "
                                   "and build; the program palpate_peers has it then"};
    return none;
}

} // namespace palp::bench
