// jump_tiles.h - where the rigidity jumps, tile by tile (GLSL and C++); include tile_layout.h first.
//
// Along the rim of a sharp inclusion a cycle leaves errors that extra sweeps there remove at little cost: with a disc
// of contrast 1000 they halve the number of steps. A tile of kTile x kTile nodes takes part if, at one of its nodes or
// beside it, the rigidity of the 3 x 3 nodes around varies by more than kJump.
//
// The includer provides  float rigidity(int i, int j).

bool jumpsAround(PlateLevel g, int i, int j)
{
    float least = rigidity(i, j), most = least;
    for (int a = max(0, i - 1); a <= min(g.cellsX, i + 1); ++a)
        for (int b = max(0, j - 1); b <= min(g.cellsZ, j + 1); ++b) {
            least = min(least, rigidity(a, b));
            most  = max(most, rigidity(a, b));
        }
    return most > kJump * least;
}

const int kNodesAbout = (kTile + 2) * (kTile + 2); // of a tile and beside it

// Returns whether the rigidity jumps at the n-th of these nodes; it does not beyond the plate.
bool jumpsAtNth(PlateLevel g, int tileI, int tileJ, int n)
{
    int i = tileI * kTile - 1 + n / (kTile + 2), j = tileJ * kTile - 1 + n % (kTile + 2);
    return i >= 0 && i <= g.cellsX && j >= 0 && j <= g.cellsZ && jumpsAround(g, i, j);
}

bool jumpsInTile(PlateLevel g, int tileI, int tileJ)
{
    bool jumps = false;
    for (int n = 0; n < kNodesAbout; ++n) jumps = jumps || jumpsAtNth(g, tileI, tileJ, n);
    return jumps;
}
