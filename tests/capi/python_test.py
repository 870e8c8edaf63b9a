"""Tests of the Python package. Arguments: a scratch folder that may be emptied."""

import copy
import doctest
import os
import pickle
import shutil
import sys
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np
import palpate

SCRATCH = Path(sys.argv.pop())
SCENE = dict(thickness="4 mm", poisson=0.45, foundation="1.74 MPa/m", window="40 mm", cells=32, footprint_radius="3.6 mm",
             solver="host")


def sheet():
    x, y = np.meshgrid(np.linspace(-0.03, 0.03, 61), np.linspace(-0.03, 0.03, 61))
    points = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    return points, np.where(np.hypot(x, y).ravel() < 5e-3, 3e6, 3e5)


class Arrays(unittest.TestCase):
    def setUp(self):
        self.points, self.stiffness = sheet()
        self.felt = palpate.Object(self.points, self.stiffness, **SCENE).touch([0, 0, 0], side=[0, 0, 1]).felt

    def touched(self, points, stiffness):
        return palpate.Object(points, stiffness, **SCENE).touch([0, 0, 0], side=[0, 0, 1]).felt

    def test_any_layout_gives_the_same(self):
        wide = np.zeros((len(self.points), 7))
        wide[:, 2:5] = self.points
        self.assertEqual(self.touched(wide[:, 2:5], self.stiffness), self.felt)
        self.assertEqual(self.touched(np.asfortranarray(self.points), self.stiffness[::1]), self.felt)
        self.assertEqual(self.touched(self.points[::-1], self.stiffness[::-1]) > 0, True)
        self.assertEqual(self.touched(self.points.tolist(), list(self.stiffness)), self.felt)
        frozen = self.points.copy()
        frozen.flags.writeable = False
        self.assertEqual(self.touched(frozen, self.stiffness), self.felt)
        self.assertAlmostEqual(self.touched(self.points.astype(np.float32), self.stiffness) / self.felt, 1, places=4)

    def test_what_comes_back_is_ones_own(self):
        made = palpate.Object(self.points, self.stiffness, **SCENE)
        points = made.points
        np.testing.assert_array_equal(points, self.points)
        points[:] = 7
        np.testing.assert_array_equal(made.points, self.points)
        np.testing.assert_array_equal(made.stiffness, self.stiffness)
        self.assertTrue(points.flags.c_contiguous and points.flags.writeable)
        self.assertEqual(made.settings["cells"], 32)

    def test_a_rigidity_is_the_modulus_times_its_factor(self):
        per = 4e-3 ** 3 / 12 / (1 - 0.45 ** 2)
        made = palpate.Object(self.points, per * self.stiffness, unit="N m", **SCENE)
        self.assertAlmostEqual(made.touch([0, 0, 0], side=[0, 0, 1]).felt / self.felt, 1, places=9)

    def test_stiffening_and_foundation_of_each_point(self):
        def touched(**keys):
            made = palpate.Object(self.points, self.stiffness, **{**SCENE, **keys})
            return made.touch([0, 0, 0], side=[0, 0, 1])

        n = len(self.points)
        self.assertEqual(touched().stiffening, 0)
        self.assertEqual(touched(stiffening=800).stiffening, 800)
        self.assertAlmostEqual(touched(stiffening=np.full(n, 800.0)).stiffening / 800, 1, places=9)
        right = touched(stiffening=np.where(self.points[:, 0] > 0, 800, 0)).stiffening
        self.assertTrue(0 < right < 800, right)  # half of the fingertip lies on it
        self.assertEqual(touched(stiffening=np.full(n, 800), ).felt, self.felt)  # the first touch is the same
        # An even array is the key; firmer below a part of it is felt, and less than firmer below all of it.
        even = touched(foundation=np.full(n, 1.74e6)).felt
        self.assertAlmostEqual(even / self.felt, 1, places=9)
        near = np.hypot(*self.points[:, :2].T) < 5e-3
        under, away = (touched(foundation=np.where(at, 1.74e7, 1.74e6)).felt for at in (near, ~near))
        firm = touched(foundation="17.4 MPa/m").felt
        self.assertTrue(1.2 * even < under < firm and 1.2 * even < away < firm, (even, under, away, firm))
        for wrong, words in [(dict(stiffening=np.full(n, -1.0)), "stiffening: expected 0 to 100000 1/m, found -1 at point 0"),
                             (dict(stiffening=np.full(n, np.nan)), "stiffening: expected"),
                             (dict(foundation=np.full(n, -1.0)), "foundation: expected"),
                             (dict(foundation=np.zeros(n)), "foundation: expected 1 to .*found 0 at point 0"),
                             (dict(stiffening=[1.0, 2.0]), "stiffening: expected")]:
            with self.assertRaisesRegex(palpate.Error, words):
                touched(**wrong)

    def test_what_is_wrong_is_a_sentence(self):
        for words, wrong in ((("points", "(n, 3)"), lambda: palpate.Object(self.points[:, :2], 1e6)),
                             (("stiffness", "(3721,)"), lambda: palpate.Object(self.points, self.stiffness[:-1])),
                             (("stiffness", "numbers"), lambda: palpate.Object(self.points, ["soft"] * 3721)),
                             (("unit", "MPa"), lambda: palpate.Object(self.points, 1e6, unit="MPa")),
                             (("point 0",), lambda: palpate.Object(self.points, -1)),
                             (("point 5",), lambda: palpate.Object(np.where(np.arange(3721)[:, None] == 5, np.nan,
                                                                            self.points), 1e6)),
                             (("faces", "3720"), lambda: palpate.Object(self.points, 1e6, faces=[[0, 1, 9999]])),
                             (("thickness",), lambda: palpate.Object(self.points, 1e6, thicknes="4 mm")),
                             (("window",), lambda: palpate.Object(self.points, 1e6, window="a lot")),
                             (("JSON",), lambda: palpate.Object.scene("nonsense")),
                             (("nowhere",), lambda: palpate.Object.file("/nowhere.json")),
                             (("edges",), lambda: palpate.plate(np.ones((9, 9)), np.ones((9, 9)), edges="soft")),
                             (("forces", "(9, 9)"), lambda: palpate.plate(np.ones((9, 9)), np.ones((9, 8)))),
                             (("nowhere",), lambda: palpate.read_recording("/nowhere")),
                             (("stiffness [Pa]", "300 kPa"), lambda: palpate.Object(self.points, "300 kPa")),
                             (("stiffness [Pa]", "None"), lambda: palpate.Object(self.points, None)),
                             (("stiffness", "bool"), lambda: palpate.Object(self.points, self.stiffness > 0)),
                             (("points", "complex"), lambda: palpate.Object(self.points + 0j, 1e6)),
                             (("point 7", "nan"), lambda: palpate.Object(
                                 np.ma.masked_array(self.points, np.arange(3721)[:, None] * [1, 1, 1] == 7), 1e6)),
                             (("foundation", "number"), lambda: palpate.Object(self.points, 1e6, foundation={})),
                             (('"thickness"', "finite"), lambda: palpate.Object(self.points, 1e6, thickness=np.nan)),
                             (('"thickness"', "object"), lambda: palpate.Object(self.points, 1e6, thickness=object())),
                             (("path", "zero"), lambda: palpate.Object.file("a\0b")),
                             (("size", "(2,)"), lambda: palpate.plate(np.ones((9, 9)), np.ones((9, 9)), 1)),
                             (("poisson", "soft"), lambda: palpate.plate(np.ones((9, 9)), np.ones((9, 9)), poisson="soft")),
                             (("tolerance", "None"), lambda: palpate.plate(np.ones((9, 9)), np.ones((9, 9)),
                                                                           tolerance=None))):
            with self.assertRaises(palpate.Error) as caught:
                wrong()
            for word in words:
                self.assertIn(word, str(caught.exception))


    def test_numbers_of_numpy_are_values_of_keys(self):
        scene = dict(SCENE, cells=np.int64(32), poisson=np.float32(0.45), place=np.zeros(3))
        made = palpate.Object(self.points, self.stiffness, **scene)
        self.assertEqual(made.settings["cells"], 32)

    def test_a_copy_is_the_object_itself(self):
        made = palpate.Object(self.points, self.stiffness, **SCENE)
        again = [copy.copy(made), copy.deepcopy({"made": made})["made"]]
        del made  # each would give the library's memory back
        self.assertEqual([len(one) for one in again], [3721, 3721])
        self.assertIn("3721 points", repr(again[0]))
        with self.assertRaises(palpate.Error) as caught:
            pickle.dumps(again[0])
        self.assertIn("make it anew", str(caught.exception))
        with again[0].session() as session, self.assertRaises(palpate.Error):
            copy.copy(session)


class Touching(unittest.TestCase):
    def setUp(self):
        self.made = palpate.Object(*sheet(), **SCENE)

    def test_a_force_moves_the_points(self):
        touch = self.made.touch([0, 0, 0], force=0.5, side=[0, 0, 1])
        self.assertEqual(touch.points.shape, (3721, 3))
        self.assertAlmostEqual(-touch.points[:, 2].min() / (0.5 * touch.compliance), 1, delta=0.3)
        self.assertIsNone(self.made.touch([0, 0, 0]).points)

    def test_a_felt_map_is_one_touch_after_the_other(self):
        places = np.array([[0, 0, 0], [0.02, 0, 0], [9, 9, 9]])
        felt = self.made.felt_map(places, sides=np.tile([0, 0, 1.0], (3, 1)))
        for n in range(2):
            self.assertAlmostEqual(felt[n] / self.made.touch(places[n], side=[0, 0, 1]).felt, 1, places=6)
        self.assertTrue(np.isnan(felt[2]))

    def test_a_felt_map_by_cubes_lies_near_the_touches(self):
        felt = self.made.felt_map(spacing=4e-3)
        self.assertEqual(felt.shape, (3721,))
        middle = np.argmin(np.linalg.norm(self.made.points, axis=1))
        touched = self.made.touch([0, 0, 0], side=[0, 0, 1]).felt
        self.assertAlmostEqual(felt[middle] / touched, 1, delta=0.2)  # the places lie some millimetres beside it
        for wrong in (-1, "2 mm"):
            with self.assertRaises(palpate.Error):
                self.made.felt_map(spacing=wrong)

    def test_what_is_noticed_along_a_path_over_the_stiff_disc(self):
        found = self.made.perceive(place=[0, 0, 0], side=[0, 0, 1], direction=[1, 0, 0], reach=0.015, places=11)
        np.testing.assert_allclose(found.along, np.linspace(-0.015, 0.015, 11), atol=1e-6)
        self.assertEqual(np.argmax(found.felt), 5)
        self.assertTrue(np.all(found.sliding > 1) and np.all(found.floor < 0.5), (found.sliding, found.floor))
        self.assertTrue(np.all(np.diff(found.at_rest) < 0), "duller people tell fewer steps")
        for wrong in (2, 2.5, 2**40):
            with self.assertRaises(palpate.Error):
                self.made.perceive(places=wrong)

    def test_a_run_is_the_same_again_and_pushes_back(self):
        times, places = [0, 1, 2], [[0, 0, 3e-3], [0, 0, -1.5e-3], [0, 0, -1.5e-3]]
        forces, proxies = self.made.run(times, places)
        again, _ = self.made.run(times, places)
        np.testing.assert_array_equal(forces, again)
        self.assertEqual(forces.shape, (2000, 3))
        felt = self.made.touch([0, 0, 0], side=[0, 0, 1]).felt
        self.assertAlmostEqual(forces[-1, 2] / (felt * 1.5e-3), 1, delta=0.05)
        self.assertAlmostEqual(proxies[-1, 2], 0, delta=1e-4)
        for words, wrong in ((("time must rise",), lambda: self.made.run([0, -1], places[:2])),
                             (("ticks", "2.5"), lambda: self.made.run(times, places, ticks=2.5)),
                             (("at", "(3,)"), lambda: self.made.touch(None)),
                             (("place", "(0, nan, 0)"), lambda: self.made.touch([0, np.nan, 0])),
                             (("from", "(0, 0, 0)"), lambda: self.made.touch([0, 0, 0], side=[0, 0, 0])),
                             (("force", "inf"), lambda: self.made.touch([0, 0, 0], force=np.inf)),
                             (("force", "1 N"), lambda: self.made.touch([0, 0, 0], force="1 N"))):
            with self.assertRaises(palpate.Error) as caught:
                wrong()
            for word in words:
                self.assertIn(word, str(caught.exception))


class Takeovers(unittest.TestCase):
    """Where multigrid does not converge: a soft disc in a very stiff shell, or a very stiff disc in a plate."""

    shell = dict(cloud="sample:ellipsoid", points=6000, thickness="1 mm", foundation="1.74 MPa/m", window="60 mm", cells=24,
                 footprint_radius="4 mm", theory="shell", place=[0, 0, 0.03], deformation_rate=10, solver="host",
                 stiffness={"law": "disc", "from": 1e12, "to": 1e3, "centre": [0, 0, 0.03], "radius": 0.014})

    def test_calls_warn(self):
        made, place = palpate.Object.scene(self.shell), [0, 0, 0.03]
        D, f = np.ones((65, 65)), np.zeros((65, 65))
        x, z = np.meshgrid(np.linspace(0, 1, 65), np.linspace(0, 1, 65), indexing="ij")
        D[np.hypot(x - 0.45, z - 0.55) < 0.2] = 1e9
        f[32, 32] = 1
        for call in (lambda: made.touch(place), lambda: made.felt_map([place]), lambda: made.felt_map(spacing=0.02),
                     lambda: made.run([0, 0.2], [[0, 0, 0.031], [0, 0, 0.029]]), lambda: palpate.plate(D, f)):
            with self.assertWarns(RuntimeWarning) as warned:
                call()
            self.assertTrue(str(warned.warning).startswith("the reference solver took over: "), warned.warning)
            self.assertEqual(warned.filename, __file__, "it names the line that called")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            made.points
            palpate.Object(*sheet(), **SCENE).touch([0, 0, 0], side=[0, 0, 1])

    def test_a_session_says_it(self):
        with palpate.Object.scene(self.shell).session() as session:
            self.assertEqual(session.takeover, "")
            for n in range(10_000):
                session.step(1e-3 * n, [0, 0, 0.033 - 4.5e-3 * min(1, 1e-3 * n)])
                time.sleep(0.001)
                if session.takeover:
                    break
            self.assertTrue(session.takeover.startswith("the reference solver took over: "), session.takeover)
        with self.assertRaises(palpate.Error):
            session.takeover


class Sessions(unittest.TestCase):
    def test_a_loop_of_ones_own(self):
        made = palpate.Object(*sheet(), **SCENE)
        folder = SCRATCH / "recorded"
        with made.session(maximum_force=4) as session, made.session() as other:
            session.record(folder)
            seen, over = [], threading.Event()

            def draw():
                while not over.is_set():
                    seen.append(session.deformed())
                    time.sleep(0.01)

            painter = threading.Thread(target=draw)
            painter.start()
            for n in range(3000):  # the hand's clock is slower than ours, so that a busy machine keeps up
                now = 1e-3 * n
                answer = session.step(now, [0, 0, 3e-3 - 4.5e-3 * min(1, now)])
                other.step(now, [0, 0, 0.01])
                time.sleep(0.001)
            over.set()
            painter.join()
            self.assertTrue(answer.touching and not answer.stopped, session.words)
            self.assertGreater(answer.force[2], 0.2)
            wrong = session.step(now + 1, [0, float("nan"), 0])
            self.assertTrue(wrong.bad_input and not wrong.force.any())
            self.assertTrue(any(points is not None and points[:, 2].min() < -1e-4 for points in seen))
            with self.assertRaises(palpate.Error) as caught:
                session.record(SCRATCH / "second")
            self.assertIn("end that recording first", str(caught.exception))
            self.assertFalse((SCRATCH / "second").exists())
            ticks, lost = session.stop_recording()
            for wrong in (("now", [0, 0, 0]), (4, [0, 0]), (4, None), (4, ["a", 0, 0])):
                with self.assertRaises(palpate.Error):
                    session.step(*wrong)
        for closed in (lambda: session.step(5, [0, 0, 0]), session.deformed, lambda: session.words,
                       lambda: session.record(folder), session.stop_recording):
            with self.assertRaises(palpate.Error) as caught:
                closed()
            self.assertIn("closed", str(caught.exception))
        table, about = palpate.read_recording(folder)
        self.assertEqual((len(table), lost), (ticks, 0))
        self.assertGreater(table["force"][-2][2], 0.2)
        self.assertIn("scene", about)

    def test_a_recording_that_was_cut_is_said(self):
        folder = SCRATCH / "cut"
        with self.assertRaises(palpate.Error) as caught:
            with palpate.Object(*sheet(), **SCENE).session() as session:
                session.record(folder)
                session.step(0, [0, 0, 0.01])
                time.sleep(0.1)  # its writer looks each 2 ms
                with self.assertWarns(RuntimeWarning) as warned:
                    palpate.read_recording(folder)
                self.assertIn("still records", str(warned.warning))
                os.truncate(folder / "ticks.npy", 0)
        self.assertIn("cut", str(caught.exception))

    def test_what_ends_a_block_comes_before_its_recording(self):
        folder = SCRATCH / "cut too"
        with self.assertWarns(RuntimeWarning) as warned:
            try:
                with palpate.Object(*sheet(), **SCENE).session() as session:
                    session.record(folder)
                    session.step(0, [0, 0, 0.01])
                    time.sleep(0.1)
                    os.truncate(folder / "ticks.npy", 0)
                    raise KeyError("the caller's own")
            except KeyError:
                pass
        self.assertIn("cut", str(warned.warning))

    def test_what_a_recording_lacks_is_said(self):
        folder = SCRATCH / "whole"
        with palpate.Object(*sheet(), **SCENE).session() as session:
            session.record(folder)
            session.step(0, [0, 0, 0.01])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            palpate.read_recording(folder)
        about = (folder / "session.json").read_text()
        for was, now, words in (('"lost": 0', '"lost": 3', "3 ticks"), ('"stopped": null', '"stopped": "full"', "full"),
                                ('"markers_lost": 0', '"markers_lost": 2', "2 markers"),
                                ('"markers": 0', '"markers": 2', "markers.jsonl: expected the 2 markers")):
            (folder / "session.json").write_text(about.replace(was, now, 1))
            with self.assertWarns(RuntimeWarning) as warned:
                palpate.read_recording(folder)
            self.assertIn(words, str(warned.warning))

    def test_a_current_folder_that_is_gone(self):
        gone, here = SCRATCH / "gone", os.getcwd()
        gone.mkdir()
        with palpate.Object(*sheet(), **SCENE).session() as session:
            os.chdir(gone)
            try:
                gone.rmdir()
                with self.assertRaises(palpate.Error) as caught:
                    session.record("/tmp/palpate-never-made")
            finally:
                os.chdir(here)
        self.assertIn("the current folder", str(caught.exception))


if __name__ == "__main__":
    shutil.rmtree(SCRATCH, ignore_errors=True)
    SCRATCH.mkdir(parents=True)
    points, stiffness = sheet()
    done = doctest.testmod(palpate, optionflags=doctest.ELLIPSIS,
                           extraglobs={"palpate": palpate, "np": np, "points": points, "stiffness": stiffness})
    print(done)
    if done.failed or done.attempted < 10:
        sys.exit(1)
    unittest.main()
