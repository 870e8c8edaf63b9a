// log_mean.h - mean of ln D around a node with Gaussian weights (GLSL and C++); include nearest_point.h first.
//
// As in engine/chart/resample.h:  ln D = sum w ln D_n / sum w,  w = exp(-d^2 / (2 s^2)),  over the points in the square
// of half side 4 s about the node. The sum runs over the rows of buckets that the square touches. The square's sides
// are rounded once, before they are compared with points and buckets alike, so the buckets leave out no point.
//
// The includer also provides  float pointLogarithm(int n).

// Whether a node's square holds a point, along one axis.
bool isInReach(float position, float node, float reach)
{
    return position >= node - reach && position <= node + reach;
}

float weightAt(PointLayout g, float distance2)
{
    return exp(distance2 * g.falloff);
}

struct LogMean {
    float weight;    // sum of w [1]; 0: no point in the square
    float logarithm; // sum of w ln D_n [1]
    float nearest2;  // square of the distance of the nearest point in the square [larger spacing^2]
};

LogMean logMeanAt(PointLayout g, int i, int j)
{
    float lowX = float(i) - g.reachX, highX = float(i) + g.reachX;
    float lowZ = float(j) - g.reachZ, highZ = float(j) + g.reachZ;
    int   firstRow = bucketOf(lowX, g.perSide, g.firstX, g.bucketsX);
    int   lastRow  = bucketOf(highX, g.perSide, g.firstX, g.bucketsX);
    int   first    = bucketOf(lowZ, g.perSide, g.firstZ, g.bucketsZ);
    int   last     = bucketOf(highZ, g.perSide, g.firstZ, g.bucketsZ);

    LogMean sum;
    sum.weight    = 0.0f;
    sum.logarithm = 0.0f;
    sum.nearest2  = 3.0e38f;
    for (int row = firstRow; row <= lastRow; ++row) {
        int end = bucketStart(row * g.bucketsZ + last + 1);
        for (int n = bucketStart(row * g.bucketsZ + first); n < end; ++n) {
            float x = pointX(n), z = pointZ(n);
            if (isInReach(x, float(i), g.reachX) && isInReach(z, float(j), g.reachZ)) {
                float distance2 = squared(g, x - float(i), z - float(j));
                float weight    = weightAt(g, distance2);
                sum.weight += weight;
                sum.logarithm += weight * pointLogarithm(n);
                sum.nearest2 = min(sum.nearest2, distance2);
            }
        }
    }
    return sum;
}
