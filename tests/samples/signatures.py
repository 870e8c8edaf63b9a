"""Compares what other languages declare of palpate.h with palpate.h: the Python package and samples/unity. Argument: the checkout."""

import ctypes
import re
import sys
from pathlib import Path

import palpate

CHECKOUT = Path(sys.argv[1])
C_TYPES = {"size_t": "u64", "uint64_t": "u64", "uint32_t": "u32", "int": "i32", "double": "f64", "void": "void"}
SHARP_TYPES = {"UIntPtr": "u64", "ulong": "u64", "uint": "u32", "int": "i32", "double": "f64", "Three": "f64*3",
               "IntPtr": "pointer", "string": "pointer", "void": "void"}


def c_type(text):
    """Of "const double place[3]" and the like, in a function: arrays are pointers there."""
    words = text.replace("const ", "").strip()
    return "pointer" if "*" in words or "[" in words else C_TYPES[words.split()[0]]


def fields(declarations, types, pointer="*"):
    """Returns name and type of each field of "double x, y[3]; int n;"."""
    found = []
    for declaration in filter(None, (part.strip() for part in declarations.split(";"))):
        kind, names = re.fullmatch(r"(?:public\s+)?(?:const\s+)?(\w+\s*\*?)\s*(.*)", declaration, re.S).groups()
        base = "pointer" if pointer in kind else types[kind.strip()]
        for name in names.split(","):
            name, many = re.fullmatch(r"\s*(\w+)(?:\[(\d+)\])?\s*", name).groups()
            found.append((name, f"{base}*{many}" if many else base))
    return found


def of_header():
    text = re.sub(r"/\*.*?\*/", "", (CHECKOUT / "engine/capi/palpate.h").read_text(), flags=re.S)
    structs = {name: fields(body, C_TYPES) for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", text, re.S)}
    functions = {}
    for result, name, arguments in re.findall(r"PALPATE_API ([\w \*]+?)\s*(\bpalpate_\w+)\((.*?)\);", text, re.S):
        given = [] if arguments == "void" else [c_type(argument) for argument in arguments.split(",")]
        functions[name] = [c_type(result), *given]
    return structs, functions


def of_unity():
    text = (CHECKOUT / "samples/unity/Palpate.cs").read_text()
    structs = {name: fields(body, SHARP_TYPES) for name, body in
               re.findall(r"public struct (palpate_\w+)\s*\{(.*?)\}", text, re.S)}
    functions = {}
    for result, name, arguments in re.findall(r"extern (\w+) (palpate_\w+)\((.*?)\);", text, re.S):
        given = [argument.replace("[Out]", "").split() for argument in filter(None, arguments.split(","))]
        functions[name] = [SHARP_TYPES[result]] + ["pointer" if words[0] in ("ref", "out") or "[]" in words[0]
                                                  else SHARP_TYPES[words[0]] for words in given]
    return structs, functions


def python_type(kind):
    if kind is None:
        return "void"
    if issubclass(kind, ctypes.Array):
        return f"{python_type(kind._type_)}*{kind._length_}"
    if kind in (ctypes.c_void_p, ctypes.c_char_p) or issubclass(kind, ctypes._Pointer):
        return "pointer"
    return {ctypes.c_size_t: "u64", ctypes.c_uint64: "u64", ctypes.c_uint32: "u32", ctypes.c_int: "i32", ctypes.c_double: "f64"}[kind]


def of_python(names):
    structs = {}
    for kind in palpate._Struct.__subclasses__():
        name = "palpate" + re.sub("([A-Z])", r"_\1", kind.__name__.lstrip("_")).lower()
        structs[name] = [(field.rstrip("_"), python_type(of)) for field, of in kind._fields_]
    declared = {name: getattr(palpate._lib, name) for name in names}
    functions = {name: [python_type(of.restype), *map(python_type, of.argtypes)] for name, of in declared.items()
                 if of.argtypes is not None}
    return structs, functions


def compare(who, structs, functions, header):
    wrong = 0
    for kind, found, wanted in (("struct", structs, header[0]), ("function", functions, header[1])):
        for name, what in found.items():
            if what != wanted.get(name):
                print(f"{who}: {kind} {name}: expected {wanted.get(name)}, found {what}")
                wrong += 1
    print(f"{who}: {len(structs)} structs and {len(functions)} functions compared with palpate.h")
    return wrong


header = of_header()
assert len(header[1]) == len((CHECKOUT / "engine/capi/symbols.txt").read_text().split()), "every function was understood"
unity, python = of_unity(), of_python(header[1])
assert len(unity[0]) == 4 and len(unity[1]) == 9 and set(python[0]) == set(header[0]), (unity, python)
assert len(python[1]) == len(header[1]), "the package declares every function"
sys.exit(compare("samples/unity", *unity, header) + compare("the Python package", *python, header) != 0)
