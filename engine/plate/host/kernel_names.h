#pragma once

/// X(name) for every kernel of the plate that the host has, named as in PlateKernels::All.
// clang-format off
#define PALPATE_HOST_KERNELS(X) \
    X(coarsen) \
    X(divisor) \
    X(jumpMark) \
    X(jumpList) \
    X(assemble_f32) \
    X(assemble_f64) \
    X(factor_f32) \
    X(factor_f64) \
    X(relaxFirst) \
    X(relax) \
    X(smoothFirst) \
    X(smooth) \
    X(relaxTile) \
    X(copyTile) \
    X(residual) \
    X(restrict) \
    X(correct) \
    X(coarseSolve_f32) \
    X(coarseSolve_f64) \
    X(start_f32) \
    X(start_f64) \
    X(interpolate_f32) \
    X(interpolate_f64) \
    X(interpolateFirst_f32) \
    X(interpolateFirst_f64) \
    X(apply_f32) \
    X(apply_f64) \
    X(dots_f32) \
    X(dots_f64) \
    X(stepDots_f32) \
    X(stepDots_f64) \
    X(beta_f32) \
    X(beta_f64) \
    X(step_f32) \
    X(step_f64) \
    X(direction_f32) \
    X(direction_f64) \
    X(update_f32) \
    X(update_f64) \
    X(result_f32) \
    X(result_f64) \
    X(rigidityNearest) \
    X(rigidityLogMean) \
    X(lift_f32) \
    X(lift_f64)
// clang-format on
