#!/usr/bin/env python3
"""Writes, for each reader, a file that it reads to its end and that is as long as asked for.

usage: make_long.py FOLDER RECORDS

A record is a point, a row, a tick, a message, or a comment where a file may hold only a few of anything. Two such folders
let palp_fuzz_replay --linear compare how long a reader takes for either. Beside that file, "long", there are others:
"deep" and "wide", for each reader of JSON, lists that it refuses: one is ten times as deep, so that whoever prints it by
recursion has no stack left, the other is of objects that are empty, which take the most memory; and of single formats what
once took a time that grew with the square, or much memory for each byte.
"""
import base64
import json
import math
import pathlib
import struct
import sys


def points(count):
    """A sheet of points a millimetre apart with a stiffness each, no two in one place."""
    side = math.isqrt(count - 1) + 1
    return [(n // side * 1e-3, n % side * 1e-3, 1e-6 * (n % 7), 3e5 + n % 11) for n in range(count)]


def triangles(count):
    return [(n, n + 1, n + 2) for n in range(count - 2)]


def npy(values, shape, letter="d"):
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + struct.pack(f"<{len(values)}{letter}", *values)


def ply(count):
    head = (f"ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
            f"property double stiffness\nelement face {count - 2}\nproperty list uchar int vertex_indices\nend_header\n")
    return head + "".join("%g %g %g %g\n" % p for p in points(count)) + "".join("3 %d %d %d\n" % t for t in triangles(count))


def pcd(count):
    return (f"VERSION .7\nFIELDS x y z E\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH {count}\nHEIGHT 1\n"
            f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA ascii\n" + "".join("%g %g %g %g\n" % p for p in points(count)))


def text(count):
    """The shortest rows that there are: a point takes the most memory for each byte of them."""
    return "# length_unit mm\n" + "".join("%d %d %d\n" % (n % 100, n // 100 % 100, n // 10000) for n in range(count))


def obj(count):
    return "".join("v %g %g %g\n" % p[:3] for p in points(count)) + "".join("f %d %d %d\n" % tuple(k + 1 for k in t) for t in triangles(count))


def stl(count):
    at = points(count)
    facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % at[k][:3] for k in t) + "endloop\nendfacet\n"
                     for t in triangles(count))
    return "solid long\n" + facets + "endsolid long\n"


def chunks(description, raw):
    """A .glb of its two parts, of bytes."""
    description += b" " * (-len(description) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(description) + len(raw)) + struct.pack("<I4s", len(description), b"JSON")
            + description + struct.pack("<I4s", len(raw), b"BIN\0") + raw)


def glb(count):
    raw = b"".join(struct.pack("<3f", *p[:3]) for p in points(count))
    return chunks(json.dumps({
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count // 3 * 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(raw)}], "buffers": [{"byteLength": len(raw)}]}).encode(), raw)


def volume(count):
    side = max(2, round(count ** (1 / 3)))
    middle, values = (side - 1) / 2, []
    for i in range(side):
        for j in range(side):
            for k in range(side):
                values.append(1e6 if math.dist((i, j, k), (middle, middle, middle)) < 0.8 * middle else 0.0)
    return npy(values, (side, side, side))


def vtk(count):
    faces = triangles(count)
    return ("# vtk DataFile Version 3.0\nlong\nASCII\nDATASET POLYDATA\n" + f"POINTS {count} float\n"
            + "".join("%g %g %g\n" % p[:3] for p in points(count)) + f"POLYGONS {len(faces)} {4 * len(faces)}\n"
            + "".join("3 %d %d %d\n" % t for t in faces) + f"POINT_DATA {count}\nSCALARS E float\nLOOKUP_TABLE default\n"
            + "".join("%g\n" % p[3] for p in points(count)))


def vtk_xml(count):
    raw = b"".join(struct.pack("<3f", *p[:3]) for p in points(count))
    place = base64.b64encode(struct.pack("<I", len(raw)) + raw).decode()
    stiffness = " ".join("%g" % p[3] for p in points(count))
    return ('<?xml version="1.0"?><VTKFile type="PolyData" byte_order="LittleEndian" header_type="UInt32"><PolyData>'
            f'<Piece NumberOfPoints="{count}"><PointData><DataArray type="Float32" Name="E" format="ascii">{stiffness}</DataArray>'
            '</PointData><Points><DataArray type="Float32" NumberOfComponents="3" format="binary">' + place
            + "</DataArray></Points></Piece></PolyData></VTKFile>")


def commented(document, count):
    """Where a file holds a few dozen of anything at most, its comments can be long."""
    return "// a line of a comment, as people write them\n" * count + json.dumps(document)


SCENE = {"cloud": "sample:sheet", "window": "40 mm", "cells": 32}


def problem(count):
    return json.dumps({"size": [1, 1], "cells": [4, 4], "poisson": 0.3, "rigidity": {"law": "constant", "value": 2},
                       "load": {"law": "uniform", "pressure": 3},
                       "probes": [[0.1 + 0.8 * n / count, 0.5] for n in range(count)]})


def plan(count):
    return commented({"title": "t", "conditions": [{"name": "even", "scene": "a.json"}],
                      "tasks": [{"name": "r", "kind": "rating", "statement": "s", "least": "a", "most": "b"}]}, count)


def hunt(count):
    return commented({"random": {"count": 4, "radius": ["3 mm", "6 mm"], "modulus": [6e5, 3e6]}}, count)


def trials(count):
    head = ("participant,trial,block,task,kind,condition,condition_second,question,answer,correct,reaction_time_s,seed,session,"
            "session_second,force_mean_N,force_peak_N,version,felt\n")
    return head + "".join(f'p1,{n + 1},1,realism,rating,even,,"How, ""real""?",4,,1.25,7,p1/{n + 1}a,,0.5,1.5,0.1.0,1\n' for n in range(count))


def hand(count):
    return "time,x,y,z\n" + "".join("%g,%g,0,0.01\n" % (n * 1e-3, n * 1e-6) for n in range(count))


def recording(count):
    head = ("{'descr': [('time', '<f8'), ('hip', '<f8', (3,)), ('hip_velocity', '<f8', (3,)), ('missed', '<i4'), "
            f"('device', '<u4')], 'fortran_order': False, 'shape': ({count},), }}").ljust(245) + "\n"
    rows = b"".join(struct.pack("<7d2I", n * 1e-3, 0, 0, 0.01, 0, 0, 0, 0, 0) for n in range(count))
    return b"t\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + rows


def haply(count):
    device = {"device_id": "049D", "state": {"cursor_position": {"x": 0.01, "y": -0.02, "z": 0},
                                             "cursor_velocity": {"x": 0, "y": 0, "z": 0}}}
    return json.dumps({"inverse3": [device] * count})


def capi(count):
    return b"s" + b"".join(struct.pack("<4d4fBB", 1e-3, 4e-3, 4e-3, 1e-3, 0, 0, 0, 0, 0, 0) for n in range(count))


def bridge(report):
    """A report with its checksum: CRC-16 of CCITT, low byte first."""
    total = 0xFFFF
    for byte in report:
        total ^= byte << 8
        for _ in range(8):
            total = (total << 1 ^ 0x1021 if total & 0x8000 else total << 1) & 0xFFFF
    return report + struct.pack("<H", total)


FORMATS = {
    "ply": ply, "pcd": pcd, "text": text, "obj": obj, "stl": stl, "glb": glb, "volume": volume, "vtk": vtk, "vtk_xml": vtk_xml,
    "npy": lambda count: npy([1.0] * (count // 2 * 2), (2, count // 2)),
    "npy_cloud": lambda count: npy([value for p in points(count) for value in p], (count, 4)),
    "problem": problem, "scene": lambda count: commented(SCENE, count), "plan": plan, "hunt": hunt, "trials": trials,
    "hand": hand, "recording": recording, "haply": haply, "capi": capi,
    "bridge": lambda count: bridge(bytes([1]) + b"PB\x11\x01\x00\x06\x00" + bytes(54)) * count,
    "falcon": lambda count: "<AAAABBBBPPPPDA>" * count,
    "calibration": lambda count: (json.dumps({"format": "palpate falcon calibration 1", "serial": "FZ1", "counts_per_torque": 4321.5,
                                              "arm_kg": 0.213, "date": "2026-11-22"}) + "\0") * (count // 8),
    "marker": lambda count: "trial of the second block\0" * count,
    "space_mouse": lambda count: (b"\x0d\x01" + bytes(12) + b"\x02\x03\x01") * count,
    "study": lambda count: json.dumps({"format": 1, "participant": "p", "plan": "p" * count, "clouds": ["0a1b2c3d4e5f"] * count}),
    "window": lambda count: json.dumps({"width": 1500, "height": 900, "files": ["/not/here"] * count}),
    "word": lambda count: "1 4 mm\np0, 1mm, 2\nr0.26@0.41s\nuudp:127.0.0.1:9870\nhhost:80/049D\n" * count,
    "probes": lambda count: "depth,force\n" + "".join("%g,%g\n" % (n * 1e-7, n * 1e-4) for n in range(count)),
}


def of_json(lists):
    """For each reader of JSON, a text whose lists it has to refuse."""
    return {
        "problem": '{"size": %s}' % lists, "scene": '{"cloud": %s}' % lists, "plan": '{"title": "t", "conditions": %s}' % lists,
        "hunt": '{"random": {"count": %s}}' % lists, "recording": 's{"format": 2, "clock": "virtual", "scene": {"cloud": %s}}' % lists,
        "haply": '{"inverse3": %s}' % lists, "capi": 'j{"window": %s}' % lists,
        "calibration": '{"format": %s}' % lists, "study": '{"format": 1, "plan": %s}' % lists,
        "glb": chunks(b'{"nodes": [{"mesh": %s}], "scenes": [{"nodes": [0]}]}' % lists.encode(), b""),
    }


def same(count):
    """Rows that differ but for one; many, because a reader may take half a megabyte whatever it reads."""
    return text(10 * count) + "0 0 0\n"


def faces(count):
    """As many lists of faces as faces: whoever makes room for each list alone moves all the earlier ones."""
    element = "element face 1\nproperty list uchar int vertex_indices\n"
    return ply(4).split("element face")[0] + element * count + "end_header\n" + "".join("%g %g %g %g\n" % p for p in points(4)) + "3 0 1 2\n" * count


def bits(count):
    """Polygons of 200 corners each, whose numbers have a byte."""
    corners = range(200)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex 200\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face {count // 10}\nproperty list uchar uchar vertex_indices\nend_header\n").encode()
    return head + b"".join(struct.pack("<3f", *p[:3]) for p in points(200)) + bytes([200, *corners]) * (count // 10)


def digits(count):
    """Polygons of nine corners each, whose numbers have a digit."""
    return "".join("v %g %g %g\n" % p[:3] for p in points(10)) + ("f " + " ".join(str(n) for n in range(1, 10)) + "\n") * count


def cap(count):
    """A polygon of many corners, and triangles of long numbers: what follows is not like the first face."""
    faces = triangles(count)
    return "".join("v %g %g %g\n" % p[:3] for p in points(count)) + "f " + " ".join(str(n + 1) for n in range(min(count, 200))) + "\n" + \
        "".join("f %d %d %d\n" % tuple(k + 1 for k in t) for t in faces)


def single(count):
    return "depth,force,probe\n" + "".join("%d,1,%x\n" % (n % 2, n) for n in range(count))


def conditions(count):
    head = trials(0)
    return head + "".join(f"p,{n + 1},1,r,rating,c{n},,q,4,,1,7,s,,1,1,v,1\n" for n in range(count))


def cells_of_nothing(count):
    return trials(0) + "".join(f"p,{n + 1},1,r,rating,c,,q,4,,1,7,s,,1,1,v,1\n" for n in range(count))


# What single readers once took too long for, or too much memory.
SHAPES = {
    ("text", "same"): same, ("ply", "bits"): bits, ("obj", "digits"): digits, ("obj", "cap"): cap, ("ply", "faces"): faces, ("probes", "single"): single,
    ("trials", "lines"): lambda count: trials(0) + "\n" * count, ("trials", "conditions"): conditions, ("trials", "short"): cells_of_nothing,
    ("vtk", "parts"): lambda count: vtk(9).split("POINT_DATA")[0] + "CELLS 0 0\n" * count,
    ("recording", "keys"): lambda count: 's{"format": 1, "clock": "virtual", "device": "host", "command": "palpate", "scene": {%s}}'
    % ", ".join('"k%d": 1' % n for n in range(count)),
    ("recording", "markers"): lambda count: 'm{"time": 1, "text": [%s1]}\n' % ("{}," * 10 * count),
    ("plan", "tasks"): lambda count: json.dumps({"title": "t", "conditions": [{"name": "even", "scene": "a.json"}],
                                                  "tasks": [{"kind": [{}] * 15 * count}]}),
    ("scene", "below"): lambda count: '{"cloud": "sample:sheet", "below": {%s}}' % ", ".join('"k%d": 1' % n for n in range(count)),
    ("window", "nested"): lambda count: '{"files": [%s]}' % ("[" * 10 * count + "]" * 10 * count),
    ("hand", "columns"): lambda count: "time,x,y,z" + ",a" * count + "\n" + ("0,0,0,0" + ",1" * count + "\n") * 2,
    ("ply", "elements"): lambda count: ply(4).replace("end_header\n", "element face 0\nproperty list uchar int v\n" * count + "end_header\n"),
}


def main():
    folder, count = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    lists = {"deep": "[" * 10 * count + "]" * 10 * count, "wide": "[%s{}]" % ("{}," * 15 * count)}
    files = [(name, "long", write(count)) for name, write in FORMATS.items()]
    files += [(name, file, content) for file, text in lists.items() for name, content in of_json(text).items()]
    files += [(name, file, write(count)) for (name, file), write in SHAPES.items()]
    for name, file, content in files:
        (folder / name).mkdir(parents=True, exist_ok=True)
        (folder / name / file).write_bytes(content if isinstance(content, bytes) else content.encode())


main()
