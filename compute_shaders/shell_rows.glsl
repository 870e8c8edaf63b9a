// shell_rows.glsl - rows of a shell's matrix at this invocation's node, A w + B phi and B' w - C phi.
//
// The order of additions is that of engine/plate/host/shell_kernels.cpp, and `precise` keeps it: without, drivers
// reorder sums of products. The bits are the same, and tests compare them.
// The includer declares  entries,  the coefficients, and  x,  the fields, both of reals.

struct ShellRow {
    real w;
    real f;
};

real entryAt(ShellLayout l, int plane, int i, int j)
{
    return entries[((i + kShellRim) * kShellPlanes + plane) * 2 * l.span + placeOf(l, j)];
}

// What one field's changes to its neighbours do to its own row, and to that of the other one.
struct Changes {
    real east, west, north, south, northEast, northWest, southEast, southWest;
};

Changes changesOf(ShellLayout l, int field, int i, int j, real here)
{
    precise Changes c;
    c.east      = x[placeIn(l, i + 1, j, field)] - here;
    c.west      = x[placeIn(l, i - 1, j, field)] - here;
    c.north     = x[placeIn(l, i, j + 1, field)] - here;
    c.south     = x[placeIn(l, i, j - 1, field)] - here;
    c.northEast = x[placeIn(l, i + 1, j + 1, field)] - here;
    c.northWest = x[placeIn(l, i - 1, j + 1, field)] - here;
    c.southEast = x[placeIn(l, i + 1, j - 1, field)] - here;
    c.southWest = x[placeIn(l, i - 1, j - 1, field)] - here;
    return c;
}

// A of w, or with the planes of C, C of phi.
real ownRow(ShellLayout l, int from, int field, int i, int j, real here, Changes c)
{
    precise real sum = entryAt(l, from + kBendEast, i, j) * c.east + entryAt(l, from + kBendEast, i - 1, j) * c.west;
    sum += entryAt(l, from + kBendNorth, i, j) * c.north + entryAt(l, from + kBendNorth, i, j - 1) * c.south;
    sum += entryAt(l, from + kBendNorthEast, i, j) * c.northEast + entryAt(l, from + kBendSouthEast, i - 1, j + 1) * c.northWest;
    sum += entryAt(l, from + kBendSouthEast, i, j) * c.southEast + entryAt(l, from + kBendNorthEast, i - 1, j - 1) * c.southWest;
    sum += entryAt(l, from + kBendEast2, i, j) * (x[placeIn(l, i + 2, j, field)] - here) +
           entryAt(l, from + kBendEast2, i - 2, j) * (x[placeIn(l, i - 2, j, field)] - here);
    sum += entryAt(l, from + kBendNorth2, i, j) * (x[placeIn(l, i, j + 2, field)] - here) +
           entryAt(l, from + kBendNorth2, i, j - 2) * (x[placeIn(l, i, j - 2, field)] - here);
    return sum;
}

ShellRow shellRow(ShellLayout l, int i, int j)
{
    precise ShellRow row;
    real     w = x[placeIn(l, i, j, 0)], f = x[placeIn(l, i, j, 1)];
    Changes  c = changesOf(l, 0, i, j, w);
    row.w      = ownRow(l, kBendEast, 0, i, j, w, c) + entryAt(l, kBed, i, j) * w;
    row.f      = entryAt(l, kCoupleWest, i + 1, j) * c.east + entryAt(l, kCoupleEast, i - 1, j) * c.west;
    row.f += entryAt(l, kCoupleSouth, i, j + 1) * c.north + entryAt(l, kCoupleNorth, i, j - 1) * c.south;
    row.f += entryAt(l, kCoupleSouthWest, i + 1, j + 1) * c.northEast + entryAt(l, kCoupleSouthEast, i - 1, j + 1) * c.northWest;
    row.f += entryAt(l, kCoupleNorthWest, i + 1, j - 1) * c.southEast + entryAt(l, kCoupleNorthEast, i - 1, j - 1) * c.southWest;
    row.f += entryAt(l, kColumnSum, i, j) * w;
    c = changesOf(l, 1, i, j, f);
    row.f -= ownRow(l, kStressEast, 1, i, j, f, c) + entryAt(l, kStressBed, i, j) * f;
    row.w += entryAt(l, kCoupleEast, i, j) * c.east + entryAt(l, kCoupleWest, i, j) * c.west;
    row.w += entryAt(l, kCoupleNorth, i, j) * c.north + entryAt(l, kCoupleSouth, i, j) * c.south;
    row.w += entryAt(l, kCoupleNorthEast, i, j) * c.northEast + entryAt(l, kCoupleNorthWest, i, j) * c.northWest;
    row.w += entryAt(l, kCoupleSouthEast, i, j) * c.southEast + entryAt(l, kCoupleSouthWest, i, j) * c.southWest;
    return row;
}
