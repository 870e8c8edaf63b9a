"""Touch of soft, thin objects of varying stiffness, from numpy arrays.

>>> import numpy as np, palpate
>>> x, y = np.meshgrid(np.linspace(-0.03, 0.03, 61), np.linspace(-0.03, 0.03, 61))
>>> points = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])             # (3721, 3) [m]
>>> stiffness = np.where(np.hypot(x, y).ravel() < 5e-3, 3e6, 3e5)               # (3721,) [Pa]
>>> skin = palpate.Object(points, stiffness, thickness="4 mm", foundation="1.74 MPa/m", window="40 mm", cells=32)
>>> touch = skin.touch([0, 0, 0], side=[0, 0, 1])
>>> 400 < touch.felt < 1000                                                     # [N/m]
True

It is a thin layer over libpalpate.so.0 (palpate.h): numpy is the only dependency, and calls release the interpreter's
lock. Lengths are in metres, forces in newtons, moduli in pascals, times in seconds. Arrays may have any layout and may be
read-only; what comes back is new, writable and in C order. What is wrong raises palpate.Error with a sentence. Where
another solver took over, because a processor was lost or a plate did not converge, a RuntimeWarning says who and why.
"""

from __future__ import annotations

import ctypes
import json
import operator
import os
import threading
import warnings
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

import numpy as np

__all__ = ["Answer", "Error", "Object", "Perception", "Session", "Touch", "felt_map", "plate", "read_recording", "version"]

ArrayLike = Any
_double_p = ctypes.POINTER(ctypes.c_double)
_size_p = ctypes.POINTER(ctypes.c_size_t)
_u64_p = ctypes.POINTER(ctypes.c_uint64)


class Error(ValueError):
    """What was asked for cannot be done; the text says what, where, what was expected and found."""


def _library() -> ctypes.CDLL:
    tried = []
    beside = Path(__file__).with_name("libpalpate.so.0")
    for name in (os.environ.get("PALPATE_LIBRARY"), str(beside) if beside.exists() else None, "libpalpate.so.0"):
        if not name:
            continue
        try:
            return ctypes.CDLL(name)
        except OSError as error:
            tried.append(str(error))
    raise ImportError("palpate: expected the library libpalpate.so.0, found none: " + "; ".join(tried) +
                      "; install libpalpate0, or set PALPATE_LIBRARY to its path")


_lib = _library()


class _Struct(ctypes.Structure):
    """A struct that begins with its size."""

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.size = ctypes.sizeof(self)


class _Points(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("count", ctypes.c_size_t), ("positions", ctypes.c_void_p),
                ("position_type", ctypes.c_int), ("position_stride", ctypes.c_size_t), ("stiffness", ctypes.c_void_p),
                ("stiffness_type", ctypes.c_int), ("stiffness_stride", ctypes.c_size_t),
                ("stiffness_kind", ctypes.c_int), ("uniform_stiffness", ctypes.c_double), ("normals", ctypes.c_void_p),
                ("normal_type", ctypes.c_int), ("normal_stride", ctypes.c_size_t), ("faces", ctypes.c_void_p),
                ("face_count", ctypes.c_size_t), ("stiffening", ctypes.c_void_p), ("stiffening_type", ctypes.c_int),
                ("stiffening_stride", ctypes.c_size_t), ("foundation", ctypes.c_void_p),
                ("foundation_type", ctypes.c_int), ("foundation_stride", ctypes.c_size_t)]


class _TouchResult(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("felt_stiffness", ctypes.c_double), ("compliance", ctypes.c_double),
                ("contact_stiffness", ctypes.c_double), ("rigidity", ctypes.c_double),
                ("solver_error", ctypes.c_double), ("discretisation_error", ctypes.c_double),
                ("place", ctypes.c_double * 3), ("normal", ctypes.c_double * 3), ("stiffening", ctypes.c_double)]


class _Path(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("place", ctypes.c_void_p), ("from_", ctypes.c_void_p),
                ("direction", ctypes.c_void_p), ("reach", ctypes.c_double), ("places", ctypes.c_int)]


class _Perception(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("softest", ctypes.c_double), ("hardest", ctypes.c_double)] + [
        (name, ctypes.c_double * 3) for name in ("weber", "at_rest", "sliding", "passing", "floor", "right")] + [
        ("held", ctypes.c_double)]


class _SessionSettings(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("device_mass", ctypes.c_double), ("device_damping", ctypes.c_double),
                ("maximum_force", ctypes.c_double), ("maximum_stiffness", ctypes.c_double)]


class _Hand(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("position", ctypes.c_double * 3), ("velocity", ctypes.c_double * 3),
                ("age", ctypes.c_double), ("buttons", ctypes.c_uint32), ("absent", ctypes.c_uint32)]


class _Answer(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("force", ctypes.c_double * 3), ("flags", ctypes.c_uint32),
                ("fault", ctypes.c_uint32), ("proxy", ctypes.c_double * 3), ("normal", ctypes.c_double * 3),
                ("depth", ctypes.c_double), ("stiffness", ctypes.c_double)]


class _Plate(_Struct):
    _fields_ = [("size", ctypes.c_size_t), ("cells_x", ctypes.c_int), ("cells_z", ctypes.c_int),
                ("size_x", ctypes.c_double), ("size_z", ctypes.c_double), ("poisson", ctypes.c_double),
                ("foundation", ctypes.c_double), ("edges", ctypes.c_int * 4), ("rigidity", ctypes.c_void_p)]


def _declare(name: str, result: Any, *arguments: Any) -> None:
    function = getattr(_lib, name)
    function.restype = result
    function.argtypes = list(arguments)


_void, _int, _text, _size = ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_size_t
_declare("palpate_version", _text)
_declare("palpate_error_text", _text)
_declare("palpate_takeover_text", _text)
_declare("palpate_object_from_points", _int, ctypes.POINTER(_Points), _text, ctypes.POINTER(_void))
_declare("palpate_object_from_scene", _int, _text, _text, ctypes.POINTER(_void))
_declare("palpate_object_from_file", _int, _text, ctypes.POINTER(_void))
_declare("palpate_object_destroy", None, _void)
_declare("palpate_object_size", _size, _void)
_declare("palpate_object_positions", _int, _void, _void, _size)
_declare("palpate_object_stiffness", _int, _void, _void, _size)
_declare("palpate_object_scene", _int, _void, _text, _size, _size_p)
_declare("palpate_touch", _int, _void, _void, _void, ctypes.POINTER(_TouchResult))
_declare("palpate_touch_displaced", _int, _void, _void, _void, ctypes.c_double, _void, _size)
_declare("palpate_felt_map", _int, _void, _void, _void, _size, _void, _size_p)
_declare("palpate_felt_map_every", _int, _void, ctypes.c_double, _void, _size, _size_p)
_declare("palpate_perceive", _int, _void, ctypes.POINTER(_Path), ctypes.POINTER(_Perception), _void, _void, _size)
_declare("palpate_session_create", _int, _void, ctypes.POINTER(_SessionSettings), ctypes.POINTER(_void))
_declare("palpate_session_destroy", None, _void)
_declare("palpate_session_step", _int, _void, ctypes.c_double, ctypes.POINTER(_Hand), ctypes.POINTER(_Answer))
_declare("palpate_session_words", _int, _void, _text, _size)
_declare("palpate_session_takeover", _int, _void, _text, _size)
_declare("palpate_session_deformed", _int, _void, _void, _size, _u64_p)
_declare("palpate_session_record", _int, _void, _text)
_declare("palpate_session_stop_recording", _int, _void, _u64_p, _u64_p)
_declare("palpate_run", _int, _void, _void, _void, _size, _size, _void, _void)
_declare("palpate_plate_solve", _int, ctypes.POINTER(_Plate), _void, ctypes.c_double, _void, _double_p)


def _check(code: int) -> None:
    if code != 0:
        raise Error(_lib.palpate_error_text().decode("utf-8", "replace") or f"palpate: error {code}")


def _solved(code: int) -> None:
    """Checks a call that solved plates, and warns the caller of our caller if another solver took over."""
    _check(code)
    takeover = _lib.palpate_takeover_text().decode("utf-8", "replace")
    if takeover:
        warnings.warn(takeover, RuntimeWarning, stacklevel=3)


def version() -> str:
    """Returns the library's version.

    >>> palpate.version().count(".")
    2
    """
    return _lib.palpate_version().decode()


def _doubles(values: ArrayLike, what: str, *shape: Optional[int]) -> np.ndarray:
    """Returns values as doubles in C order, of a shape in which None stands for any length. What a mask hides is NaN."""
    try:
        hides = isinstance(values, np.ma.MaskedArray)
        found = np.asarray(values.astype(np.float64).filled(np.nan) if hides else values)
        if found.dtype.kind in "bcSUmM":  # numpy would convert these, and drop an imaginary part
            raise Error(f"{what}: expected real numbers, found {found.dtype}")
        array = np.ascontiguousarray(found, dtype=np.float64)
    except (TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise Error(f"{what}: expected numbers, found {error}") from None
    fits = found.ndim == len(shape) and all(want in (None, have) for want, have in zip(shape, found.shape))
    if not fits:
        wanted = ", ".join("n" if want is None else str(want) for want in shape) + ("," if len(shape) == 1 else "")
        raise Error(f"{what}: expected an array of shape ({wanted}), found {found.shape}")
    return array


def _number(value: Any, what: str) -> float:
    if isinstance(value, (str, bytes)):  # float() would read some of them
        raise Error(f"{what}: expected a number in SI units, found {value!r}")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{what}: expected a number, found {value!r}") from None


def _whole(value: Any, what: str) -> int:
    try:
        found = operator.index(value)
    except TypeError:
        raise Error(f"{what}: expected a whole number, found {value!r}") from None
    if not -2**31 <= found < 2**31:
        raise Error(f"{what}: expected a number of 32 bits, found {found}")
    return found


def _plain(value: Any) -> Any:
    """Returns what json has no form for, such as numbers of numpy, as what it has one for."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"expected numbers, texts and lists of them, found {value!r}")


def _scene_text(scene: Any) -> bytes:
    if isinstance(scene, str):
        return _bytes(scene, "scene")
    for key, value in scene.items() if isinstance(scene, dict) else ():
        try:
            json.dumps({key: value}, default=_plain, allow_nan=False)
        except TypeError as error:
            raise Error(f'scene: key "{key}": {error}') from None
        except (ValueError, RecursionError):
            raise Error(f'scene: key "{key}": expected finite numbers, found {value!r}') from None
    try:
        return json.dumps(scene, default=_plain).encode()
    except (TypeError, ValueError) as error:
        raise Error(f"scene: {error}") from None


def _bytes(text: Union[str, os.PathLike], what: str) -> bytes:
    """Returns a text or a path for C, which would end it at a zero."""
    try:
        found = os.fsencode(text)
    except (TypeError, ValueError):
        raise Error(f"{what}: expected a text, found {text!r}") from None
    if b"\0" in found:
        raise Error(f"{what}: expected a text without a zero byte, found {text!r}")
    return found


def _three(values: Optional[ArrayLike], what: str) -> Optional[np.ndarray]:
    return None if values is None else _doubles(values, what, 3)


def _same(self: Any, _: Any = None) -> Any:
    """An object never changes, so that it is its own copy."""
    return self


def _no_pickle(self: Any, _: Any = None) -> Any:
    raise Error(f"{type(self).__name__.lower()}: expected what can be copied or pickled, found a handle of the library; "
                "make it anew from its arrays")


def _address(array: Optional[np.ndarray]) -> Optional[int]:
    return None if array is None else array.ctypes.data


class Touch(NamedTuple):
    """The answer to one touch."""

    felt: float                 #: stiffness that a finger feels [N/m]
    compliance: float           #: of the plate under the fingertip [m/N]
    contact: float              #: stiffness of the contact itself [N/m]
    rigidity: float             #: flexural, at the contact [N m]
    error: float                #: of the solver, relative
    discretisation: float       #: error of the grid, relative; NaN: unknown
    place: np.ndarray           #: (3,) on the surface [m]
    normal: np.ndarray          #: (3,) towards the finger
    points: Optional[np.ndarray]  #: (n, 3) every point under the force that was asked for [m]
    stiffening: float           #: b of the force felt / b (e^(b d) - 1) at depth d [1/m]; 0: a spring


class Perception(NamedTuple):
    """What people would notice along a path: a prediction, not a study. Arrays of (3,) are for people whose smallest
    noticed change is `weber`; one just noticeable step is told right in three of four trials."""

    along: np.ndarray    #: (places,) where each lies, from the middle of the path [m]
    felt: np.ndarray     #: (places,) stiffness felt there with a finger at rest [N/m]
    weber: np.ndarray    #: (3,) 0.07, 0.15, 0.22
    at_rest: np.ndarray  #: (3,) steps between the softest and the hardest place
    sliding: np.ndarray  #: (3,) the same for a finger that slides, through all of a session
    passing: np.ndarray  #: (3,) of these, within 5 mm
    floor: np.ndarray    #: (3,) sliding over the same points with one stiffness: an artefact, below 0.5 if all is well
    right: np.ndarray    #: (3,) share of right answers, sliding; 0.5 is guessing
    held: float          #: share of the slide in which a wall or a fold holds the hand


class Answer(NamedTuple):
    """The answer to one tick of a session."""

    force: np.ndarray   #: (3,) on the hand, governed [N]
    touching: bool
    stopped: bool       #: the governor has stopped the force, until the first button is held for 20 ms
    waiting: bool       #: no force flows yet
    bad_input: bool
    proxy: np.ndarray   #: (3,) where the tool is held [m]
    normal: np.ndarray  #: (3,) of the surface there; 0 without contact
    depth: float        #: of the hand below the proxy [m]
    stiffness: float    #: rendered [N/m]


def _per_point(given: Any, name: str, count: int, scene: dict) -> Optional[np.ndarray]:
    """Returns the array of a value of each point; one value for all becomes the scene's key of that name."""
    if given is None:
        return None
    if isinstance(given, str) or np.ndim(given) == 0:
        scene[name] = given if isinstance(given, str) else _number(given, name)
        return None
    return _doubles(given, name, count)


class Object:
    """A soft object of points.

    points: (n, 3) [m]. stiffness: (n,), or one number for all, in `unit`: "Pa" of Young's modulus, "N m" of the flexural
    rigidity. normals: (n, 3) outward, 0 where unknown. faces: (m, 3) numbers of points. stiffening: (n,) or one number, b
    [1/m] by which the force stiffens with depth. foundation: (n,) [Pa/m] below each point, or one value for all. Further
    keywords are the keys of a scene: thickness="4 mm", window=0.04, cells=64, ...

    >>> palpate.Object([[0, 0, 0]], 1e6)
    Traceback (most recent call last):
    ...
    palpate.Error: the cloud has fewer than seven points or most of them coincide, so there is no surface to touch; ...
    """

    def __init__(self, points: ArrayLike, stiffness: ArrayLike, unit: str = "Pa", normals: Optional[ArrayLike] = None,
                 faces: Optional[ArrayLike] = None, stiffening: Union[ArrayLike, str, None] = None,
                 foundation: Union[ArrayLike, str, None] = None, **scene: Any) -> None:
        self._handle = _void()
        places = _doubles(points, "points", None, 3)
        given = _Points(count=len(places), positions=_address(places))
        kinds = {"Pa": 0, "N m": 1, "N_m": 1}
        if not isinstance(unit, str) or unit not in kinds:
            raise Error(f'unit: expected "Pa" or "N m", found {unit!r}')
        given.stiffness_kind = kinds[unit]
        values = None
        if stiffness is None or isinstance(stiffness, str) or np.ndim(stiffness) == 0:
            given.uniform_stiffness = _number(stiffness, f"stiffness [{unit}]")
        else:
            values = _doubles(stiffness, "stiffness", len(places))
            given.stiffness = _address(values)
        outward = None if normals is None else _doubles(normals, "normals", len(places), 3)
        given.normals = _address(outward)
        growth, below = _per_point(stiffening, "stiffening", len(places), scene), _per_point(
            foundation, "foundation", len(places), scene)
        given.stiffening, given.foundation = _address(growth), _address(below)
        if below is not None:  # what the points have, over a value of its size
            sound = np.clip(below[below > 0], 1, 1e15)
            scene.setdefault("foundation", float(np.exp(np.mean(np.log(sound)))) if len(sound) else 1.0)
            scene.setdefault("below", "own")
        corners = None
        if faces is not None:
            numbers = np.asarray(faces)
            if numbers.ndim != 2 or numbers.shape[1] != 3 or not np.issubdtype(numbers.dtype, np.integer):
                raise Error(f"faces: expected whole numbers of shape (n, 3), found {numbers.dtype} of {numbers.shape}")
            if len(numbers) and (numbers.min() < 0 or numbers.max() >= len(places)):
                raise Error(f"faces: expected numbers from 0 to {len(places) - 1}, "
                            f"found {numbers.min()} to {numbers.max()}")
            corners = np.ascontiguousarray(numbers, dtype=np.uint32)
            given.faces, given.face_count = _address(corners), len(corners)
        _check(_lib.palpate_object_from_points(ctypes.byref(given), _scene_text(scene), ctypes.byref(self._handle)))

    @classmethod
    def scene(cls, scene: Union[str, dict], folder: Union[str, os.PathLike] = ".") -> "Object":
        """Makes the object of a scene without a hunt: a dict or JSON with a key "cloud".

        >>> len(palpate.Object.scene({"cloud": "sample:sheet", "points": 2000}))
        2000
        """
        made = cls.__new__(cls)
        made._handle = _void()
        _check(_lib.palpate_object_from_scene(_scene_text(scene), _bytes(folder, "folder"),
                                              ctypes.byref(made._handle)))
        return made

    @classmethod
    def file(cls, path: Union[str, os.PathLike]) -> "Object":
        """Makes the object of a scene file without a hunt."""
        made = cls.__new__(cls)
        made._handle = _void()
        _check(_lib.palpate_object_from_file(_bytes(path, "path"), ctypes.byref(made._handle)))
        return made

    def __del__(self) -> None:
        handle, self._handle = getattr(self, "_handle", None), None
        if handle:
            _lib.palpate_object_destroy(handle)

    __copy__ = __deepcopy__ = _same
    __reduce_ex__ = _no_pickle

    def __len__(self) -> int:
        return _lib.palpate_object_size(self._handle)

    def __repr__(self) -> str:
        return f"<palpate.Object of {len(self)} points>"

    @property
    def points(self) -> np.ndarray:
        """(n, 3) at rest [m]."""
        xyz = np.empty((len(self), 3))
        _check(_lib.palpate_object_positions(self._handle, _address(xyz), len(self)))
        return xyz

    @property
    def stiffness(self) -> np.ndarray:
        """(n,) in the unit that it was given in."""
        values = np.empty(len(self))
        _check(_lib.palpate_object_stiffness(self._handle, _address(values), len(self)))
        return values

    @property
    def settings(self) -> dict:
        """Every key of the scene in force."""
        needed = _size()
        _check(_lib.palpate_object_scene(self._handle, None, 0, ctypes.byref(needed)))
        text = ctypes.create_string_buffer(needed.value)
        _check(_lib.palpate_object_scene(self._handle, text, needed, None))
        return json.loads(text.value)

    def touch(self, at: ArrayLike, force: Optional[float] = None, side: Optional[ArrayLike] = None) -> Touch:
        """Touches the object at the foot of a place on the surface.

        at: the place, (3,) [m], at most a quarter of the patch window from a point. force: [N]; if given, the answer
        has every point under it. side: (3,) from where the finger comes; None: away from the middle of the object.
        """
        place, direction = _doubles(at, "at", 3), _three(side, "side")
        newtons = None if force is None else _number(force, "force")
        found = _TouchResult()
        _solved(_lib.palpate_touch(self._handle, _address(place), _address(direction), ctypes.byref(found)))
        moved = None
        if newtons is not None:
            moved = np.empty((len(self), 3))
            _check(_lib.palpate_touch_displaced(self._handle, _address(place), _address(direction), newtons,
                                                _address(moved), len(self)))
        return Touch(found.felt_stiffness, found.compliance, found.contact_stiffness, found.rigidity,
                     found.solver_error, found.discretisation_error, np.array(found.place), np.array(found.normal), moved,
                     found.stiffening)

    def felt_map(self, places: Optional[ArrayLike] = None, sides: Optional[ArrayLike] = None,
                 spacing: Optional[float] = None) -> np.ndarray:
        """Returns the felt stiffness [N/m], (m,), at places (m, 3) [m], on all cores; NaN where nothing can be touched.

        places: None for every point of the object. sides: (m, 3) from where the finger comes to each. spacing: [m]; one
        place is touched in each cube of this edge, and every point gets what lies between them.
        """
        if spacing is not None:
            if places is not None or sides is not None:
                raise Error("spacing: expected places or a spacing, found both")
            felt = np.empty(len(self))
            metres = _number(spacing, "spacing")
            _solved(_lib.palpate_felt_map_every(self._handle, metres, _address(felt), len(felt), None))
            return felt
        at = self.points if places is None else _doubles(places, "places", None, 3)
        directions = None if sides is None else _doubles(sides, "sides", len(at), 3)
        felt = np.empty(len(at))
        _solved(_lib.palpate_felt_map(self._handle, _address(at), _address(directions), len(at), _address(felt), None))
        return felt

    def perceive(self, place: Optional[ArrayLike] = None, side: Optional[ArrayLike] = None,
                 direction: Optional[ArrayLike] = None, reach: float = 0, places: int = 41) -> Perception:
        """Predicts what is noticed along a straight path over the object; it takes some seconds.

        place: (3,) its middle [m]; None: the scene's. side: (3,) from where the finger comes. direction: (3,) along the
        surface; None: the east of the map. reach: to either side [m]; 0: a third of the patch window, or of the object
        that it spans. places: with a finger at rest, 3 to 1001.
        """
        middle, outward, way = _three(place, "place"), _three(side, "side"), _three(direction, "direction")
        asked = _Path(place=_address(middle), from_=_address(outward), direction=_address(way),
                      reach=_number(reach, "reach"), places=_whole(places, "places"))
        found, room = _Perception(), max(3, asked.places or 41)
        along, felt = np.empty(room), np.empty(room)
        _solved(_lib.palpate_perceive(self._handle, ctypes.byref(asked), ctypes.byref(found), _address(along),
                                      _address(felt), room))
        return Perception(along, felt, *(np.array(getattr(found, name)) for name in
                                         ("weber", "at_rest", "sliding", "passing", "floor", "right")), found.held)

    def run(self, times: ArrayLike, places: ArrayLike, ticks: Optional[int] = None) -> "tuple[np.ndarray, np.ndarray]":
        """Runs a whole session in virtual time: a hand at places (n, 3) [m] at times (n,) [s], on straight lines between.

        Returns forces (ticks, 3) [N] and proxies (ticks, 3) [m], one for each millisecond from times[0] on. ticks: None
        for as long as the hand moves. The same input gives the same bits.
        """
        at = _doubles(times, "times", None)
        path = _doubles(places, "places", len(at), 3)
        if ticks is None:
            length = at[-1] - at[0] if len(at) > 1 else 0
            ticks = int(round(1000 * length)) if 0 < length < np.inf else 0  # times that fall are refused below
        ticks = _whole(ticks, "ticks")
        if not 0 <= ticks <= 86_400_000:
            raise Error(f"ticks: expected 0 to 86400000, which is a day, found {ticks}")
        forces, proxies = np.zeros((ticks, 3)), np.zeros((ticks, 3))
        _solved(_lib.palpate_run(self._handle, _address(at), _address(path), len(at), ticks, _address(forces),
                                 _address(proxies)))
        return forces, proxies

    def session(self, mass: float = 0, damping: float = 0, maximum_force: float = 0,
                maximum_stiffness: float = 0) -> "Session":
        """Starts a session in real time; what is not known of the device that holds the hand stays 0.

        mass [kg], damping [N s/m] of the arm without its motors, maximum_force [N], maximum_stiffness [N/m].
        """
        return Session(self, mass, damping, maximum_force, maximum_stiffness)


class Session:
    """A session that a loop of yours steps about a thousand times a second; made by Object.session().

    It may be a context manager. step() belongs to one thread, deformed() to one other; close() may come from any.
    """

    def __init__(self, of: Object, mass: float, damping: float, force: float, stiffness: float) -> None:
        self._handle = _void()
        self._stepping, self._drawing = threading.Lock(), threading.Lock()  # nothing is freed while another thread uses it
        self._count = len(of)
        self._sequence = ctypes.c_uint64(0)
        self._hand, self._answer = _Hand(), _Answer()
        settings = _SessionSettings(device_mass=_number(mass, "mass"), device_damping=_number(damping, "damping"),
                                    maximum_force=_number(force, "maximum_force"),
                                    maximum_stiffness=_number(stiffness, "maximum_stiffness"))
        _solved(_lib.palpate_session_create(of._handle, ctypes.byref(settings), ctypes.byref(self._handle)))

    def close(self) -> None:
        """Ends the session and its recording. It may be called again.

        Raises Error if the recording stopped early, and warns if it lost ticks; the session has ended all the same.
        """
        try:
            lost = self.stop_recording()[1] if getattr(self, "_handle", None) else 0
        finally:
            self._destroy()
        if lost:
            warnings.warn(f"{lost} ticks of the recording were lost", RuntimeWarning, stacklevel=2)

    def _destroy(self) -> None:
        if not getattr(self, "_handle", None):
            return
        with self._stepping, self._drawing:
            handle, self._handle = self._handle, None
            if handle:
                _lib.palpate_session_destroy(handle)

    __del__ = _destroy
    __copy__ = __deepcopy__ = __reduce_ex__ = _no_pickle

    def _open(self) -> _void:
        if not self._handle:
            raise Error("session: expected one that runs, found one that was closed")
        return self._handle

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        try:
            self.close()
        except Error as error:  # what ended the block comes first
            if kind is None:
                raise
            warnings.warn(str(error), RuntimeWarning, stacklevel=2)

    def step(self, time: float, position: ArrayLike, velocity: ArrayLike = (0, 0, 0), buttons: int = 0,
             age: float = 0) -> Answer:
        """Runs one tick. time [s] rises; position (3,) [m], velocity (3,) [m/s]; age [s] of the position.

        A velocity of zero is taken from the positions. A position that is repeated until a tracker's next one states its
        growing age: more than 1 mm and 4 m/s since the last one is a jump, which takes the force until the hand was lifted.

        A hand that is not finite gives zero force and bad_input, and no exception.
        """
        hand, answer = self._hand, self._answer
        try:
            hand.position[:] = [float(v) for v in position]
            hand.velocity[:] = [float(v) for v in velocity]
            hand.buttons, hand.age = buttons & 0xFFFF, age
            now = float(time)
        except (TypeError, ValueError):
            raise Error("step: expected a time, three numbers of a position and of a velocity, whole buttons and an "
                        f"age, found {time!r}, {position!r}, {velocity!r}, {buttons!r}, {age!r}") from None
        with self._stepping:
            _check(_lib.palpate_session_step(self._open(), now, ctypes.byref(hand), ctypes.byref(answer)))
        flags = answer.flags
        return Answer(np.array(answer.force), bool(flags & 1), bool(flags & 2), bool(flags & 4), bool(flags & 8),
                      np.array(answer.proxy), np.array(answer.normal), answer.depth, answer.stiffness)

    @property
    def words(self) -> str:
        """Why the last tick had no force; empty while forces flow."""
        return self._said(_lib.palpate_session_words)

    @property
    def takeover(self) -> str:
        """Who took over last from the solver, and why: a processor was lost, or a plate did not converge; else empty."""
        return self._said(_lib.palpate_session_takeover)

    def _said(self, function: Any) -> str:
        text = ctypes.create_string_buffer(4096)
        with self._stepping:
            _check(function(self._open(), text, len(text)))
        return text.value.decode("utf-8", "replace")

    def deformed(self) -> Optional[np.ndarray]:
        """Returns every point under the present force, (n, 3) [m], if the plate has a new answer; else None."""
        before = self._sequence.value
        xyz = np.empty((self._count, 3))
        with self._drawing:
            _check(_lib.palpate_session_deformed(self._open(), _address(xyz), self._count, ctypes.byref(self._sequence)))
        return xyz if self._sequence.value != before else None

    def record(self, folder: Union[str, os.PathLike]) -> None:
        """Records from the next tick on into a new folder."""
        with self._stepping:
            _check(_lib.palpate_session_record(self._open(), _bytes(folder, "folder")))

    def stop_recording(self) -> "tuple[int, int]":
        """Ends the recording; returns how many ticks are on disk, and how many are lost."""
        ticks, lost = ctypes.c_uint64(), ctypes.c_uint64()
        with self._stepping:
            _check(_lib.palpate_session_stop_recording(self._open(), ctypes.byref(ticks), ctypes.byref(lost)))
        return ticks.value, lost.value


def felt_map(points: ArrayLike, stiffness: ArrayLike, unit: str = "Pa", **scene: Any) -> np.ndarray:
    """Returns the felt stiffness [N/m] at every point, (n,). Arguments as of Object.

    >>> felt = palpate.felt_map(points, stiffness, thickness="4 mm", foundation="1.74 MPa/m", window="40 mm", cells=16)
    >>> felt.shape, bool(np.nanmax(felt) > 1.5 * np.nanmin(felt))
    ((3721,), True)
    """
    return Object(points, stiffness, unit, **scene).felt_map()


def plate(rigidity: ArrayLike, forces: ArrayLike, size: "tuple[float, float]" = (1, 1), poisson: float = 0.3,
          edges: "Union[str, tuple[str, str, str, str]]" = "clamped", foundation: float = 0,
          tolerance: float = 1e-4) -> "tuple[np.ndarray, float]":
    """Solves a Kirchhoff plate of varying rigidity: rigidity (m, n) [N m] and forces (m, n) [N] at its nodes.

    size: (x, z) [m]. edges: "clamped", "supported", "free" or "guided", or four of them for x = 0, x = size, z = 0, z = size.
    foundation: [Pa/m]. Returns the deflection (m, n) [m] and the estimate of its relative error in the energy norm.

    >>> D, f = np.ones((33, 33)), np.zeros((33, 33))
    >>> f[16, 16] = 1
    >>> w, error = palpate.plate(D, f)
    >>> abs(w[16, 16] / 0.00560 - 1) < 0.03   # Timoshenko and Woinowsky-Krieger 1959, table 37
    True
    """
    D = _doubles(rigidity, "rigidity", None, None)
    f = _doubles(forces, "forces", *D.shape)
    names = {"clamped": 0, "supported": 1, "free": 2, "guided": 3}
    four = tuple(edges) if isinstance(edges, (tuple, list)) else (edges,) * 4
    if len(four) != 4 or any(not isinstance(edge, str) or edge not in names for edge in four):
        raise Error(f"edges: expected {', '.join(names)}, or four of them, found {edges!r}")
    if min(D.shape) < 2:
        raise Error(f"rigidity: expected at least 5 x 5 nodes, found {D.shape}")
    metres = _doubles(size, "size", 2)
    given = _Plate(cells_x=D.shape[0] - 1, cells_z=D.shape[1] - 1, size_x=metres[0], size_z=metres[1],
                   poisson=_number(poisson, "poisson"), foundation=_number(foundation, "foundation"),
                   rigidity=_address(D))
    given.edges[:] = [names[edge] for edge in four]
    w, error = np.empty(D.shape), ctypes.c_double()
    _solved(_lib.palpate_plate_solve(ctypes.byref(given), _address(f), _number(tolerance, "tolerance"), _address(w),
                                     ctypes.byref(error)))
    return w, error.value


def read_recording(folder: Union[str, os.PathLike]) -> "tuple[np.ndarray, dict]":
    """Reads a recorded session: its ticks as a structured array ("time", "hip", "force", ...), and session.json.

    Warns if it is not complete.
    """
    place = Path(folder)
    file = place / "markers.jsonl"
    try:
        ticks = np.load(place / "ticks.npy")
        about = json.loads((place / "session.json").read_text())
        found = file.read_bytes().count(b"\n") if file.is_file() else 0
    except (OSError, ValueError) as error:
        raise Error(f"{place}: expected the folder of a recorded session, found {error}") from None
    if not isinstance(about, dict):
        raise Error(f"{place}: expected session.json to be an object, found {type(about).__name__}")
    missing = about.get("stopped")
    for key, what in (("lost", "ticks"), ("markers_lost", "markers")):
        if about.get(key) and not missing:
            missing = f"it lacks {about[key]} {what}"
    if not about.get("finished"):
        missing = "its program was killed, or still records"
    marks = about.get("markers")
    if isinstance(marks, int) and marks > found and not missing:
        missing = f"{file}: expected the {marks} markers that session.json counts, found {found}"
    if missing:
        warnings.warn(f"{place} is not complete: {missing}", RuntimeWarning, stacklevel=2)
    return ticks, about
