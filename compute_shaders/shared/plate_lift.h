// plate_lift.h - deflection between the nodes, bilinear (GLSL and C++); include point_layout.h first.
//
// The includer provides  real deflection(int i, int j).

real liftedAt(PointLayout g, float x, float z)
{
    if (!(x >= 0.0f && x <= float(g.cellsX) && z >= 0.0f && z <= float(g.cellsZ))) return real(0.0f);
    int  i = min(int(x), g.cellsX - 1), j = min(int(z), g.cellsZ - 1);
    real a = real(x - float(i)), b = real(z - float(j)), one = real(1.0f);
    real before = (one - b) * deflection(i, j) + b * deflection(i, j + 1);
    real behind = (one - b) * deflection(i + 1, j) + b * deflection(i + 1, j + 1);
    return (one - a) * before + a * behind;
}
