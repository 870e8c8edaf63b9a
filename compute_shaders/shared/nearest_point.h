// nearest_point.h - the point nearest to a node (GLSL and C++); include point_layout.h first.
//
// Exact but for the rounding of distances: buckets are searched outward from the node, row by row, until none is left
// that could hold a nearer point; of equally near points the lowest number wins. Rounding is monotone, and a bucket's
// distance is computed as a point's is, so it never exceeds that of a point in it. Jump flooding would need a pass per
// power of two, two maps of the grid and atomics or a race to sow the points, and be wrong here and there; this is one
// pass that writes each node once. No node visits a bucket twice: at worst, all points in one bucket or along one side,
// a node looks at every bucket and every point.
//
// The includer provides  int bucketStart(int n), float pointX(int n), float pointZ(int n), uint pointNumber(int n).

struct Nearest {
    float distance2; // [larger spacing^2]
    int   at;        // place among the sorted points
    uint  number;
};

// Square of a distance whose parts along the axes are given in spacings [larger spacing^2].
float squared(PointLayout g, float x, float z)
{
    float alongX = x * g.scaleX, alongZ = z * g.scaleZ;
    return alongX * alongX + alongZ * alongZ;
}

// The bucket along one axis that a position falls to.
int bucketOf(float position, float perSide, int first, int buckets)
{
    float edge = min(max(floor(position * perSide), float(first)), float(first + buckets - 1));
    return int(edge) - first;
}

// From a position to the nearest place in a bucket, along one axis [spacings].
float gapTo(int edge, float position, float side)
{
    return max(0.0f, max(float(edge) * side - position, position - float(edge + 1) * side));
}

Nearest nearestInBucket(PointLayout g, int i, int j, int bucket, Nearest best)
{
    int end = bucketStart(bucket + 1);
    for (int n = bucketStart(bucket); n < end; ++n) {
        float distance2 = squared(g, pointX(n) - float(i), pointZ(n) - float(j));
        if (distance2 <= best.distance2) {
            uint number = pointNumber(n);
            if (distance2 < best.distance2 || number < best.number) {
                best.distance2 = distance2;
                best.at        = n;
                best.number    = number;
            }
        }
    }
    return best;
}

// \param away  from the node to the row, along x [spacings]
Nearest nearestInRow(PointLayout g, int i, int j, int row, float away, Nearest best)
{
    int home = bucketOf(float(j), g.perSide, g.firstZ, g.bucketsZ);
    for (int b = home; b < g.bucketsZ && squared(g, away, gapTo(g.firstZ + b, float(j), g.side)) <= best.distance2; ++b)
        best = nearestInBucket(g, i, j, row * g.bucketsZ + b, best);
    for (int b = home - 1; b >= 0 && squared(g, away, gapTo(g.firstZ + b, float(j), g.side)) <= best.distance2; --b)
        best = nearestInBucket(g, i, j, row * g.bucketsZ + b, best);
    return best;
}

Nearest nearestPoint(PointLayout g, int i, int j)
{
    Nearest best;
    best.distance2 = 3.0e38f; // farther than any point
    best.at        = 0;
    best.number    = 0u;
    int   home     = bucketOf(float(i), g.perSide, g.firstX, g.bucketsX);
    float least    = gapTo(g.firstZ + bucketOf(float(j), g.perSide, g.firstZ, g.bucketsZ), float(j), g.side);
    for (int a = home; a < g.bucketsX; ++a) {
        float away = gapTo(g.firstX + a, float(i), g.side);
        if (squared(g, away, least) > best.distance2) break;
        best = nearestInRow(g, i, j, a, away, best);
    }
    for (int a = home - 1; a >= 0; --a) {
        float away = gapTo(g.firstX + a, float(i), g.side);
        if (squared(g, away, least) > best.distance2) break;
        best = nearestInRow(g, i, j, a, away, best);
    }
    return best;
}
