// push_echo.comp - writes every field of a struct back, one word each in the order of declaration.
// Domain     one invocation
// Reads      push
// Writes     bits of the fields
// Variants   ECHO_LEVEL, ECHO_RELAX, ECHO_SMOOTH, ECHO_TRANSFER, ECHO_VECTOR, ECHO_SCALARS, ECHO_AIM, ECHO_PROBE;
// ECHO_TAIL and ECHO_RIGIDITY with an array of structs
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/rigidity_level.h"
#include "compute_shaders/shared/tail_level.h"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;
layout(set = 0, binding = 0) writeonly buffer Words { uint words[]; };

#if defined(ECHO_LEVEL)
layout(push_constant) uniform Constants { LevelPush push; };
#elif defined(ECHO_RELAX)
layout(push_constant) uniform Constants { RelaxPush push; };
#elif defined(ECHO_SWEEP)
layout(push_constant) uniform Constants { SweepPush push; };
#elif defined(ECHO_SMOOTH)
layout(push_constant) uniform Constants { SmoothPush push; };
#elif defined(ECHO_TRANSFER)
layout(push_constant) uniform Constants { TransferPush push; };
#elif defined(ECHO_UP)
layout(push_constant) uniform Constants { UpPush push; };
#elif defined(ECHO_VECTOR)
layout(push_constant) uniform Constants { VectorPush push; };
#elif defined(ECHO_AIM)
layout(push_constant) uniform Constants { AimPush push; };
#elif defined(ECHO_PROBE)
layout(push_constant) uniform Constants { ProbePush push; };
#elif defined(ECHO_NESTED)
layout(push_constant) uniform Constants { NestedPush push; };
#elif defined(ECHO_TAIL)
layout(push_constant) uniform Constants { TailPush push; };
layout(std430, binding = 1) readonly buffer Levels { TailLevel levels[]; };
#elif defined(ECHO_RIGIDITY)
layout(push_constant) uniform Constants { RigidityPush push; };
layout(std430, binding = 1) readonly buffer Levels { RigidityLevel levels[]; };
#else // ECHO_SCALARS
layout(push_constant) uniform Constants { ScalarsPush push; };
#endif

int count = 0;
void echo(uint value) { words[count++] = value; }
void echo(int value) { words[count++] = uint(value); }
void echo(float value) { words[count++] = floatBitsToUint(value); }

void echo(PlateLevel g)
{
    echo(g.cellsX);
    echo(g.cellsZ);
    echo(g.hinged);
    echo(g.free);
    echo(g.kxx);
    echo(g.kzz);
    echo(g.kxz);
    echo(g.exx);
    echo(g.ezz);
    echo(g.twist);
    echo(g.bed);
    echo(g.shapeAt);
}

void main()
{
    if (gl_GlobalInvocationID.x + gl_GlobalInvocationID.y > 0) return;
#if defined(ECHO_LEVEL)
    echo(push.level);
#elif defined(ECHO_RELAX)
    echo(push.level);
    echo(push.colour);
#elif defined(ECHO_SWEEP)
    echo(push.level);
    echo(push.first);
    echo(push.tilesOnly);
#elif defined(ECHO_SMOOTH)
    echo(push.level);
    echo(push.ahead);
    echo(push.step);
#elif defined(ECHO_TRANSFER)
    echo(push.fine);
    echo(push.coarse);
#elif defined(ECHO_UP)
    echo(push.fine);
    echo(push.coarse);
    echo(push.begins);
#elif defined(ECHO_RIGIDITY)
    echo(push.levels);
    echo(push.rows);
    echo(levels[1].plate);
    echo(levels[1].field);
    echo(levels[1].list);
    echo(levels[1].row);
    echo(levels[1].tileRow);
#elif defined(ECHO_VECTOR)
    echo(push.nodes);
    echo(push.partials);
    echo(push.iteration);
#elif defined(ECHO_AIM)
    echo(push.nodes);
    echo(push.begins);
#elif defined(ECHO_PROBE)
    echo(push.level);
    echo(push.loads);
    echo(push.argumentWords);
    echo(push.tolerance);
#elif defined(ECHO_NESTED)
    echo(push.first);
    echo(push.levels);
    echo(push.nodes);
    echo(push.steps);
#elif defined(ECHO_TAIL)
    echo(push.first);
    echo(push.levels);
    echo(push.nodes);
    echo(levels[1].plate);
    echo(levels[1].field);
    echo(levels[1].tableX);
    echo(levels[1].tableZ);
    echo(levels[1].w);
    echo(levels[1].force);
#else
    echo(push.loads);
    echo(push.partials);
    echo(push.begins);
    echo(push.argumentWords);
    echo(push.tolerance);
#endif
}
