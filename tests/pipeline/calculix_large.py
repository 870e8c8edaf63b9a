#!/usr/bin/env python3
"""Presses whole thin objects by CalculiX as deep as they are thick, and prints tests/pipeline/calculix_large.h.

    python3 tests/pipeline/calculix_large.py [FOLDER] > tests/pipeline/calculix_large.h

Objects, meshes and footprint are those of calculix_shells.py; the step is NLGEOM, its force grows in ten even increments,
and after each the depth is the work of the load over the force. The tests read the header and need no ccx.
"""

import os
import sys

import calculix_shells as shells

# name, thickness [m], force at the end [N]: about 1.6 thicknesses deep
PRESSES = [
    ("sheet", 1e-3, 0.046),
    ("sphere", 1e-3, 0.042),
    ("sphere", 2e-3, 0.34),
    ("ellipsoid", 1e-3, 0.028),
    ("wart_under", 1e-3, 0.121),
    ("wart_beside", 1e-3, 0.07),
    ("soft_spot", 1e-3, 0.031),
    ("band", 1.5e-3, 0.025),
    ("low_arch", 1.5e-3, 0.012),
]
INCREMENTS = 10


def depths(folder, name, thickness, force, cells):
    shape = next(o for o in shells.OBJECTS if o.name == name and o.thickness == thickness)
    mesh = shells.Mesh(shape, cells)
    forces = shells.footprint(mesh)
    linear = shells.deck(mesh, shape, forces, force)
    # The temperature, which is the modulus, must not grow with the load.
    step = f"*AMPLITUDE, NAME=AT_ONCE\n0., 1., 1., 1.\n*STEP, NLGEOM\n*STATIC, DIRECT\n{1 / INCREMENTS}, 1.\n"
    deep = linear.replace("*STEP\n*STATIC\n*TEMPERATURE\n", step + "*TEMPERATURE, AMPLITUDE=AT_ONCE\n")
    assert deep != linear
    job = f"large_{name}_{round(thickness * 1e3)}_{cells}"
    lines, said = shells.run(folder, job, deep)
    result = []
    for words in lines:
        if words[:1] == ["displacements"]:
            result.append(0.0)
        elif result:
            result[-1] += shells.depth(words, shape, forces)
    if len(result) < INCREMENTS:
        sys.stderr.write(f"{job}: {len(result)} of {INCREMENTS} increments; ccx said:\n{said[-1500:]}\n")
    return result


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    os.makedirs(folder, exist_ok=True)
    only = sys.argv[2:]
    print("#pragma once\n#include <array>\n#include <string_view>\n")
    print("// Made by calculix_large.py, which says how: CalculiX 2.20, C3D20R, NLGEOM.\n")
    print("namespace palp {\n")
    print("/// How deep a fingertip presses a whole thin object.")
    print("struct CalculixPress {")
    print("    std::string_view name;")
    print("    double           thickness; ///< [m]")
    print("    double           force;     ///< of the last depth; the others are even parts of it [N]")
    print("    double           meshError; ///< of the last depth: change from elements 1.5 times as large [1]")
    print()
    print(f"    std::array<double, {INCREMENTS}> depths; ///< [m]")
    print("};\n")
    print(f"inline constexpr std::array<CalculixPress, {len(PRESSES)}> kCalculixPresses{{{{")
    for name, thickness, force in PRESSES:
        if only and name not in only:
            continue
        coarse, fine = (depths(folder, name, thickness, force, cells) for cells in (16, 24))
        known = min(len(coarse), len(fine))
        numbers = ", ".join(f"{d:.5g}" for d in fine)
        print(f'    {{"{name}",')
        print(f"     {thickness:g},")
        print(f"     {force:g},")
        print(f"     {fine[known - 1] / coarse[known - 1] - 1:.1e},")
        print(f"     {{{numbers}}}}},", flush=True)
    print("}};\n\n} // namespace palp")


if __name__ == "__main__":
    main()
