// jump_tiles.h - where the rigidity jumps, tile by tile (GLSL and C++); include tile_layout.h first.
//
// Along the rim of a sharp inclusion a cycle leaves errors that extra sweeps there remove at little cost: with a disc of
// contrast 1000 they halve the number of steps. A tile of kTile x kTile nodes takes part if, at one of its nodes or
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

bool jumpsInTile(PlateLevel g, int tileI, int tileJ)
{
    bool jumps = false;
    for (int i = max(0, tileI * kTile - 1); i <= min(g.cellsX, (tileI + 1) * kTile); ++i)
        for (int j = max(0, tileJ * kTile - 1); j <= min(g.cellsZ, (tileJ + 1) * kTile); ++j)
            jumps = jumps || jumpsAround(g, i, j);
    return jumps;
}
