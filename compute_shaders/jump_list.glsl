// jump_list.glsl - the list of marked tiles, by one workgroup of which each invocation lists a stretch of the tiles.
//
// The includer provides  uint markOf(int tile)  and  void put(uint place, uint word),  which writes a word of the list.

shared uint counts[gl_WorkGroupSize.x];

// Lists the tiles behind the first word; returns to the last invocation what belongs there.
uint listTiles(PlateLevel g)
{
    int tiles = tilesX(g) * tilesZ(g);
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    int stretch = (tiles + lanes - 1) / lanes, first = lane * stretch, end = min(tiles, first + stretch);
    uint count = 0u;
    for (int n = first; n < end; ++n) count += markOf(n);
    counts[lane] = count;
    barrier();
    uint at = 1u;
    for (int n = 0; n < lane; ++n) at += counts[n];
    uint all = min(at - 1u + count, kMostListed);
    for (int n = first; n < end; ++n)
        if (markOf(n) == 1u) put(at++, uint(n));
    return all;
}
