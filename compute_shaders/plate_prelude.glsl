// plate_prelude.glsl - the common beginning of every kernel of the plate.
//
// Invocations   x over j (z of the plate, contiguous in memory), y over i, z over loads
// Fields        one number per node, node (i, j) at [i nodesZ + j]; several loads one after the other
// real          float, or double in the variants of conjugate gradients for processors that have it

#include "compute_shaders/shared/plate_push.h"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;

#include "compute_shaders/plate_real.glsl"

int nodesX(PlateLevel g) { return g.cellsX + 1; }
int nodesZ(PlateLevel g) { return g.cellsZ + 1; }
int firstOfLoad(PlateLevel g) { return int(gl_GlobalInvocationID.z) * nodesX(g) * nodesZ(g); }
