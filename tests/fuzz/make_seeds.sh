#!/bin/sh
# Writes small files that the readers accept, or nearly, for the fuzzers to start from. Argument: the folder.
set -eu
mkdir -p "$1/ply" "$1/pcd" "$1/text" "$1/obj" "$1/stl" "$1/glb" "$1/volume" "$1/npy" "$1/npy_cloud" "$1/vtk" "$1/vtk_xml" "$1/problem" "$1/scene" "$1/hand" "$1/haply" "$1/bridge" "$1/plan" "$1/hunt" "$1/trials" "$1/recording" "$1/falcon" "$1/probes" "$1/capi" "$1/calibration" "$1/marker" "$1/space_mouse" "$1/study" "$1/window" "$1/word"
cd "$1"

# The floats 1 and 2, little and big endian, and the doubles 1 and 2, little endian; printf takes octal.
f1='\000\000\200\077' f2='\000\000\000\100' F1='\077\200\000\000' F2='\100\000\000\000'
d1='\000\000\000\000\000\000\360\077' d2='\000\000\000\000\000\000\000\100'
xyz='property float x\nproperty float y\nproperty float z\n'

printf 'ply\nformat ascii 1.0\ncomment length_unit mm\nelement vertex 2\n'"$xyz"'property double stiffness\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3 4e3\n2 3 4 5e3\n3 0 1 0\n' >ply/ascii
printf 'ply\r\nformat binary_little_endian 1.0\r\nelement vertex 2\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nproperty uchar quality\r\nend_header\r\n'"$f1$f1$f1"'a'"$f2$f2$f1"'b' >ply/little
printf 'ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty short s\nelement vertex 2\nproperty list uchar short n\n'"$xyz"'property float D\nend_header\nab\001cd'"$F1$F1$F2$F2"'\000'"$F2$F1$F2$F1" >ply/big
printf 'ply\nformat ascii 1.0\nelement vertex 3\n'"$xyz"'end_header\nnan 1 2\n1 2 3\n-inf 0 1e-300\n' >ply/invalid
printf 'ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\n'"$xyz"'end_header\n1234' >ply/liar

printf 'ply\nformat ascii 1.0\nelement vertex 4\n'"$xyz"'property int stiffness\nelement face 3\nproperty uchar flags\nproperty list uchar float vertex_index\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n7 3 0 1 2\n7 4 0 1 2 3\n7 2 0 1\n' >ply/faces

head='FIELDS x y z E\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n'
printf '# .PCD v.7\n# stiffness_unit N_m\nVERSION .7\n'"$head"'DATA ascii\n1 2 3 4\n5 6 7 8\n' >pcd/ascii
printf 'VERSION .7\n'"$head"'DATA binary\n'"$f1$f1$f1$f1$f2$f2$f1$f2" >pcd/binary
printf 'VERSION 0.7\nFIELDS x y z _ n\nSIZE 8 8 8 1 2\nTYPE F F F U I\nCOUNT 1 1 1 3 2\nWIDTH 1\nHEIGHT 2\nDATA binary\n'"$d1$d1$d1"'abcdefg'"$d2$d2$d1"'abcdefg' >pcd/padded
printf 'VERSION .7\n'"$head"'DATA binary_compressed\n\041\000\000\000\040\000\000\000\037'"$f1$f2$f1$f2$f1$f1$f1$f2" >pcd/compressed
printf 'VERSION .7\n'"$head"'DATA binary_compressed\n\010\000\000\000\040\000\000\000\003'"$f1"'\340\023\003' >pcd/repeated

printf '1 2 3 4\n5 6 7 8\n' >text/plain
printf '# length_unit mm\nx,y,z,"E"\n1,2,3,4\n5,6,7,8\n\n' >text/header
printf '//X;Y;Z;D;label\r\n1;2;3;4;a\r\n5;6;7;nan;b\r\n' >text/semicolons
printf '1 2 a 3 9\n4 5 b 6 9\n' >text/columns

# Version 1.0: a header of 118 bytes after the first ten.
head="{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2), }"
printf '\223NUMPY\001\000\166\000%-117s\n'"$d1$d2" "$head" >npy/double
printf '\223NUMPY\002\000\166\000\000\000%-117s\n'"$f1$f2" "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1), }" >npy/float

printf '\223NUMPY\001\000\166\000%-117s\n'"$d1$d2$d1$d2$d2$d1$d1$d1" "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4), }" >npy_cloud/four
printf '\223NUMPY\001\000\166\000%-117s\n'"$f1$f2$f1$f2$f1$f2$f1$f2$f2$f1$f1$f1$f1$f1" "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 7), }" >npy_cloud/seven

head='# vtk DataFile Version 5.1\ntitle\n'
printf "$head"'ASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nMETADATA\nCOMPONENT_NAMES\nX\n\nZ\n\nPOLYGONS 1 4\n3 0 1 2\nTRIANGLE_STRIPS 1 4\n3 2 1 0\nPOINT_DATA 3\nSCALARS E int\nLOOKUP_TABLE default\n5 6 7\nNORMALS n float\n0 0 1 0 0 1 0 0 1\nFIELD f 1\na%%20b 1 3 float\n1 2 3\n' >vtk/ascii
printf "$head"'BINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n'"$F1$F1$F2$F2$F1$F1"'\nCELLS 2 2\nOFFSETS unsigned_char\n\000\002\nCONNECTIVITY char\n\000\001\nCELL_TYPES 1\n\000\000\000\007\nPOINT_DATA 2\nSCALARS E float\nLOOKUP_TABLE default\n'"$F1$F2" >vtk/binary
printf "$head"'ASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 2 2 1\nPOINTS 4 int\n0 0 0 1 0 0 0 1 0 1 1 0\nPOINT_DATA 4\nCOLOR_SCALARS c 1\n0 0 1 1\n' >vtk/grid

begin='<?xml version="1.0"?><VTKFile type="PolyData" byte_order="LittleEndian" header_type="UInt32"'
points='<Piece NumberOfPoints="3" NumberOfPolys="1"><PointData Normals="n"><DataArray type="Int8" Name="E" format="ascii">4 5 6</DataArray></PointData><Points><DataArray type="Float32" NumberOfComponents="3"'
polys='</Points><Polys><DataArray type="UInt8" Name="connectivity" format="ascii">0 1 2</DataArray><DataArray type="UInt8" Name="offsets" format="ascii">3</DataArray></Polys></Piece></PolyData>'
printf '%s><PolyData>%s format="ascii">0 0 0 1 0 0 0 1 0</DataArray>%s</VTKFile>' "$begin" "$points" "$polys" >vtk_xml/ascii
printf '%s><PolyData>%s format="binary">JAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA==</DataArray>%s</VTKFile>' "$begin" "$points" "$polys" >vtk_xml/base64
printf '%s compressor="vtkZLibDataCompressor"><PolyData>%s format="appended" offset="0"/>%s<AppendedData encoding="base64">_AQAAAACAAAAkAAAAEAAAAA==eJxjYEAGDfYMWPgAFIoBfw==</AppendedData></VTKFile>' "$begin" "$points" "$polys" >vtk_xml/appended
printf '%s><PolyData>%s format="appended" offset="0"/>%s<AppendedData encoding="raw">_\044\000\000\000'"$f1$f1$f1$f2$f2$f2$f1$f2$f1"'</AppendedData></VTKFile>' "$begin" "$points" "$polys" >vtk_xml/raw
printf '%s' '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="2" NumberOfCells="1"><Points><DataArray type="Int8" NumberOfComponents="3" format="ascii">0 0 0 1 1 1</DataArray></Points><Cells><DataArray type="Int8" Name="connectivity" format="ascii">0 1 0</DataArray><DataArray type="Int8" Name="offsets" format="ascii">3</DataArray><DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>' >vtk_xml/cells

printf '# length_unit mm\nv 0 0 0\nv 1 0 0 .5 .5 .5\nvt 0 0\nv 1 1 0\nusemtl a\nf 1/1/1 2//1 \\\n3\nf -3 -2 -1\n' >obj/faces
printf 'v 1 2 3 1\nv 2 3 4\nbevel on\nf 1 2 1\n' >obj/degenerate
printf 'solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\nendsolid a\n' >stl/ascii
printf '%-80s\001\000\000\000'"$f1$f1$f1$f1$f1$f1$f1$f1$f2$f2$f1$f1"'ab' solid >stl/binary

little() { printf '\'"$(printf %03o $(($1 % 256)))"'\'"$(printf %03o $(($1 / 256)))"'\000\000'; }
glb() { # glb JSON, of a length that four divides: with nine floats of binary data
    printf 'glTF\002\000\000\000'; little $((${#1} + 64)); little ${#1}; printf 'JSON%s' "$1"; little 36
    printf 'BIN\000'"$f1$f1$f1$f2$f1$f1$f1$f2$f1"
}
glb "$(printf '%-400s' '{"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"scale":[2,1,1]},{"mesh":0,"rotation":[0,0,1,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]}')" >glb/triangle
glb "$(printf '%-400s' '{"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":0,"componentType":5121,"count":3,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]}')" >glb/indices

# A header of NIfTI-1: 2 x 2 x 2 floats, mm, sizes 1.
zeros() { head -c "$1" /dev/zero; }
{ printf '\134\001\000\000'; zeros 36; printf '\003\000\002\000\002\000\002\000\001\000\001\000\001\000\001\000'; zeros 14
  printf '\020\000\040\000'; zeros 2; printf "$f1$f1$f1$f1"; zeros 16; printf '\000\000\260\103'; zeros 11; printf '\002'
  zeros 220; printf 'n+1\000\000\000\000\000'; printf "$f1$f2$f1$f2$f2$f1$f1$f1"; } >volume/plain
gzip -n -c volume/plain >volume/packed
printf '\223NUMPY\001\000\166\000%-117s\n'"$d1$d2$d1$d2$d2$d1$d1$d1" "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 2, 2), }" >volume/npy

plate='"size": [1, 1.5], "cells": [4, 4], "poisson": 0.3'
point='"load": {"law": "point", "force": 2, "at": [0.5, 0.75]}'
cat >problem/all <<END
{$plate, // a comment
 "edges": {"x0": "clamped", "x1": "free", "z0": "supported", "z1": "clamped"}, "foundation": 5,
 "rigidity": {"law": "linear", "from": 1, "to": 10, "axis": "z"}, $point, "probes": [[0.25, 0.25], [1, 1.5]]}
END
printf '{%s, "rigidity": {"law": "grid", "file": "D.npy"}, "load": {"law": "grid", "file": "D.npy"}}' "$plate" >problem/grid
printf '{%s, "rigidity": {"law": "constant", "value": 2}, "load": {"law": "uniform", "pressure": 3}}' "$plate" >problem/uniform
printf '{%s, "rigidity": {"law": "gaussian", "low": 1, "high": 9, "centre": [0.5, 0.5], "sigma": 0.1}, "load": {"law": "gaussian", "force": 1, "centre": [0.5, 0.5], "sigma": 0.05}}' "$plate" >problem/gaussian
printf '{%s, "rigidity": {"law": "exponential", "from": 1, "to": 10, "start": [0, 0], "end": [1, 1]}, %s}' "$plate" "$point" >problem/exponential
printf '{%s, "rigidity": {"law": "checker", "low": 1, "high": 2, "edge": 0.2}, %s}' "$plate" "$point" >problem/checker
printf '{"size": [1, 1], "cells": [4, 4096], "poisson": 0.5, "rigidity": 3, "load": {}}' >problem/refused

cat >scene/skin <<END
{"\$schema": "scene.schema.json", "cloud": "sample:skin", "points": 4000, "seed": 7, // a comment
 "stiffness": {"law": "gaussian", "from": 0.3e6, "to": 3e6, "centre": [0, 0, 0], "sigma": 3e-3},
 "thickness": "4 mm", "poisson": 0.45, "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 64,
 "footprint_radius": "4.4 mm", "place": [0, 0, 0.0015], "from": [0, 0, 1], "max_force": "6 N", "proxy": "sphere"}
END
printf '{"cloud": "sample:sheet", "thicknes": 0.004}' >scene/unknown
printf '{"cloud": "sample:sheet", "thickness": "4 kPa", "poisson": 0.5, "force_law": "paper", "solver": "host"}' >scene/refused

printf '=$PALPATE_THICKNESS=4 mm\n$PALPATE_CLOUD=sample:skin\n$PALPATE_MAX_FORCE=\nwindow=30\nlength_unit=mm\nplace=1,2,3\npreset=paper\n' >scene/stated
printf 'time,x,y,z\n0,0,0,0.01\n0.1,0,0,0\n1e0,1e-3,0,-2e-3,ignored\n' >hand/csv
printf '# down and up\n0 0 0 0.01\n0.5; 0; 0; -1e-3\n1\t0\t0\t0.01\n' >hand/mixed
printf '0 0 0 nan\n0 0 0 1\n-1 0 0 5000\n' >hand/refused

state='{"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0.01,"y":-2e-2,"z":0},"cursor_velocity":{"x":0,"y":0,"z":0}},"status":{"calibrated":true,"ready":true}}],"wireless_verse_grip":[{"state":{"orientation":{"w":1,"x":0,"y":0,"z":0},"buttons":{"a":true}}}]}'
printf '%s' "$state" >haply/state
printf '\201\176\001\000%s' "$state" >haply/frame
printf '{"inverse3":[{"device_id":"049D","config":{"type":"minverse","preset":"defaults","filters":{"force_gate":{"gain":0.3}}},"status":{}}]}' >haply/full
printf '{"name":"device-safety-triggered","data":{"safety_type":"stall_detected","device_id":"049D"}}' >haply/event
printf '{"ok":true,"data":{"git_tag":"3.5.0"}}' >haply/version
printf 'HTTP/1.1 101 Switching Protocols\r\nSec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n\r\n\201\002{}' >haply/head

# An answer of the bridge: header, sequence, flags; the fuzzer's harness adds the checksum.
{ printf '\001PB\021\001\000\006\000'; zeros 56; } >bridge/answer
{ printf '\001PB\021\001\000\026\000'; zeros 24; printf '\377\177'; zeros 30; } >bridge/turned

cat >plan/all <<END
{"title": "t", "seed": 7, "seconds": 5, "hand": "press", "repetitions": 2, // a comment
 "conditions": [{"name": "even", "scene": "a.json", "values": {"thickness": "3 mm"}},
  {"name": "wart", "scene": "a.json", "preset": "paper"}],
 "tasks": [{"name": "r", "kind": "rating", "statement": "s", "least": "a", "most": "b"},
  {"name": "y", "kind": "yes-no", "question": "q?", "yes_for": ["wart"], "no_for": ["even"]},
  {"name": "p", "kind": "two-alternative", "question": "q?", "pairs": [["even", "wart"]], "right": "second"}]}
END
printf '{"nodules": [{"at": [0, 1e-3, 0], "radius": "4 mm", "modulus": "3 MPa", "depth": "2 mm"}], "press_force": "0.2 N", "too_hard": 2, "ground": 0.02}' >hunt/listed
printf '{"random": {"count": 4, "radius": ["3 mm", "6 mm"], "modulus": [6e5, 3e6], "depth": ["1 mm", "5 mm"]}}' >hunt/random

trials='participant,trial,block,task,kind,condition,condition_second,question,answer,correct,reaction_time_s,seed,session,session_second,force_mean_N,force_peak_N,version'
printf "$trials"',felt\np1,1,1,realism,rating,even,,"How, ""real""?",4,,1.25,7,p1/1a,,0.5,1.5,0.2.0,1\np1,2,1,cut' >trials/cut
printf "$trials"'\np1,1,1,realism,rating,even,,"How, ""real""?",4,,1.25,7,p1/1a,,0.5,1.5,0.1.0\n' >trials/older
printf "$trials"',felt\n' >trials/empty

# The first byte says which file of a recording it is. Rows of 64 bytes.
rows="{'descr': [('time', '<f8'), ('hip', '<f8', (3,)), ('hip_velocity', '<f8', (3,)), ('missed', '<i4'), ('device', '<u4')], 'fortran_order': False, 'shape': (2,), }"
{ printf 't\223NUMPY\001\000\366\000%-245s\n' "$rows"; printf "$d1$d1$d1$d1$d1$d1$d1$f1$f1$d2$d2$d2$d2$d2$d2$d2$f2$f2"; } >recording/ticks
printf 's{"format": 2, "clock": "virtual", "solver": "host", "command": "palpate", "finished": true, "samples": 2, "realtime_ns": 1, "monotonic_ns": null, "cloud": "0", "scene": {"cloud": "sample:sheet"}, "hand": {"model": "arm", "maximum_force_N": 8, "maximum_stiffness_N_per_m": 2e3, "mass_kg": 0.1, "own_damping_N_s_per_m": 1, "weight_N": [0, -1, 0], "senses_grip": true}}' >recording/description
printf 's{"format": 1, "clock": "real", "device": "host", "command": "palpate", "scene": {"cloud": "sample:sheet"}}' >recording/first
printf 'm{"time": 0.5, "text": "a"}\n{"time": 1, "text": "b\\u0001"}\n{"ti' >recording/markers

printf '<AAAABBBBPPPPDA><AAAABBBBPPPP\261A>gar<bage<AAAABBBBPPPPDA><AAAA' >falcon/stream
printf '<AAAAAAAAAAAAAA>' >falcon/zero

printf '# a comment\nprobe,x,y,z,nx,ny,nz,time [ms],depth [mm],force [N],other\na,0,0,0,0,0,1,0,0,0,x\na,0,0,0,0,0,1,10,0.5,0.1,x\na,0,0,0,0,0,1,20,1,0.25,x\na,0,0,0,0,0,1,30,1.5,0.5,x\na,0,0,0,0,0,1,40,2,0.9,x\n' >probes/timed
printf 'depth,force\n0,0\n1e-4,.1\n2e-4,.2\n3e-4,.3\n4e-4,.4\n' >probes/plain

# Little-endian doubles: x, y, z and a stiffness of three points; four ticks of 0.06 s, and a press of a millimetre.
mm='\374\251\361\322\115\142\120\077' E='\000\000\000\000\200\117\022\101' tick='\270\036\205\353\121\270\256\077'
deep='\374\251\361\322\115\142\060\277' n8='\000\000\000\000\000\000\000\000'
mm2='\374\251\361\322\115\142\140\077' places= rows= # 3 x 3 points, 1 mm apart; E in each row
for x in "$n8" "$mm" "$mm2"; do for y in "$n8" "$mm" "$mm2"; do places="$places$x$y$n8" rows="$rows$x$y$n8$E"; done; done
printf "t$rows" >capi/points
printf 'j{"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "foundation": "1 MPa/m", "edges": "free"}' >capi/scene
{ printf s; for height in "$mm" "$mm" "$n8" "$deep" "$deep"; do printf "$tick$mm$mm$height"; zeros 18; done; } >capi/hand
{ printf 'p\001\002'; printf "$d1$d2$mm$n8"; printf '\000\001\002\003'; printf "$d2$mm$d1$d1$d2$E"; } >capi/plate

# Nine points and a face; then each array: doubles, a uniform stiffness, floats in rows of 14 bytes.
{ printf 'a\011\000'"$f1"'\001\002'; printf "$places"; printf '\000\047'; zeros 108; printf '\000\000\000\001\002'; } >capi/arrays
printf "f$d1$mm$mm$n8$n8$n8$d1$n8$n8$n8$n8$n8$n8" >capi/places
printf "e$mm" >capi/every
printf "q\007\003$mm$mm$mm$n8$n8$n8$d1$d1$n8$n8" >capi/path
printf "r\144$n8$mm$mm$mm$tick$mm$mm$n8$d1$mm$mm$deep" >capi/run
constants='{"format": "palpate falcon calibration 1", "serial": "FZ1", "counts_per_torque": 4321.5, "arm_kg": 0.213,'
printf '%s "hold_s": 0.02, "date": "2026-11-22"}\000%s "date": "2026-11-22"}' "$constants" "$constants" >calibration/two
printf 'trial 1\000 \033[2J\t\303\244\302\205\377\340\240\000\000%-300s' long >marker/texts
printf '\015\001\001\000\377\377\134\001\000\000\001\000\002\000\007\001\320\007\060\370\000\000\007\002\001\000\002\000\003\000\002\003\001\005\003\001\000\000\200\002\027\144\007\001\000\200\000\000\000\000' >space_mouse/reports
printf '{"format": 1, "participant": "p1", "title": "t", "plan": "{}", "hand": "press", "clock": "virtual", "clouds": ["0a"], "felt_stiffness_N_per_m": {"even": 300.5, "wart": null}}' >study/all
printf '{"width": 1500, "height": 900, "files": ["/a.ply", "/", 7]}\n' >window/all
printf '1 4mm\n2-1.5e0 N\n3+0.3 MPa\n4 2N_m\n5 1 MPa/m\n6 900 N/m\n7 30 deg\n8 5 ms\n90.1\n0 1e308 km\np1,2mm, 3 in\nr0.26@0.41s,0.31@4.3s\nrnone\nuudp:127.0.0.1:9870\nuudp:[::1]:80\nuudp:7\nh049D\nh[::1]:10001/049D\nhhost:80\nludp:9000\nlserial:/dev/ttyACM0\nlcap\n' >word/words
