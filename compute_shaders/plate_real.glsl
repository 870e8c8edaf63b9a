// plate_real.glsl - the numbers of conjugate gradients: float, or double in the variants for processors that have it.
//
// A shader that has both a cycle, which is in floats, and a step of conjugate gradients includes this behind its cycle.

#undef real
#ifdef PALPATE_DOUBLE
#define real double
#else
#define real float
#endif
