// shell_prelude.glsl - the common beginning of every kernel of shells.
//
// Invocations   x over the places of a row, 2 span; y over rows i; z over loads
// Fields        see shared/shell_layout.h; empty places are 0 and stay so
// real          float, or double with PALPATE_APPLIES

#include "compute_shaders/shared/shell_layout.h"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;

#ifdef PALPATE_APPLIES
#define real double
#else
#define real float
#endif

int load() { return int(gl_GlobalInvocationID.z); }
int numbersOf(ShellLayout l) { return (l.cellsX + 1 + 2 * kShellRim) * 4 * l.span; }

// The place of the j-th node of a row among those of its row; j may be up to two beyond its ends.
int placeOf(ShellLayout l, int j) { return (j & 1) * l.span + (j >> 1); }

// The place of a number in the fields; field 0 is w, 1 is phi.
int placeIn(ShellLayout l, int i, int j, int field)
{
    return load() * numbersOf(l) + ((i + kShellRim) * 4 + field * 2) * l.span + placeOf(l, j);
}

// This invocation's node; beyond the row's last one in empty places.
int nodeX() { return int(gl_GlobalInvocationID.y); }
int nodeZ(ShellLayout l)
{
    int place = int(gl_GlobalInvocationID.x), odd = place >= l.span ? 1 : 0;
    return 2 * (place - odd * l.span) + odd;
}
bool isNode(ShellLayout l) { return nodeX() <= l.cellsX && int(gl_GlobalInvocationID.x) < 2 * l.span && nodeZ(l) <= l.cellsZ; }
