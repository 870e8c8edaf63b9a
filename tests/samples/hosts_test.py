"""Runs the hosts of samples/ros2 and samples/sofa on stand-ins of ROS 2 and SOFA. Arguments: the checkout, a scratch folder."""

import json
import os
import signal
import sys
import time
import types
import unittest
from pathlib import Path

CHECKOUT, SCRATCH = Path(sys.argv[1]), Path(sys.argv[2])
for folder in ("samples/sofa", "samples/ros2", "tests/samples/python_stubs"):
    sys.path.insert(0, str(CHECKOUT / folder))

import numpy as np  # noqa: E402
import palpate  # noqa: E402
import palpate_force_feedback  # noqa: E402
import palpate_node  # noqa: E402
import rclpy  # noqa: E402
import rclpy.node  # noqa: E402
from geometry_msgs.msg import PoseStamped  # noqa: E402
from Sofa.Core import Data  # noqa: E402

SHEET = {"cloud": "sample:sheet", "points": 6000, "stiffness": {"law": "constant", "value": 3e5}, "thickness": "4 mm",
         "foundation": "1.74 MPa/m", "window": "40 mm", "cells": 32, "footprint_radius": "3.6 mm", "place": [0, 0, 0],
         "solver": "host"}


def height(now):
    """Down onto the sheet in a second, and 1 mm deep from then on [m]."""
    return max(-1e-3, 3e-3 - 4e-3 * now)


class Ros2(unittest.TestCase):
    def run_node(self, work, **parameters):
        """Spins the node with the work, and returns it with what it published: times and forces."""
        (SCRATCH / "sheet.json").write_text(json.dumps(SHEET))
        rclpy.node.parameters = {"scene": str(SCRATCH / "sheet.json"), **parameters}
        made = []
        def spun(node):
            made.append(node)
            self.node = node
            work(node)

        rclpy.spun = spun
        palpate_node.main()
        node = made[0]
        self.assertTrue(node.destroyed)
        return node, [(m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec, m.wrench.force.z) for _, m in node.published]

    def hear(self, node, now, z):
        pose = PoseStamped()
        pose.header.frame_id = "cloud"
        pose.header.stamp.sec, pose.header.stamp.nanosec = int(now), int(1e9 * (now % 1))
        pose.pose.position.z = z
        node.clock = now + 1e-3  # the message took a millisecond
        node.subscribed["hand"](pose)

    def press(self, node):
        for n in range(2200):  # the node's clock is slower than ours, so that the plate keeps up on a busy machine
            self.hear(node, 7 + 1e-3 * n, height(1e-3 * n))
            time.sleep(1e-3)

    def test_each_pose_is_answered_by_a_force_and_silence_by_none(self):
        def work(node):
            self.press(node)
            period, on_timer = node.timers[0]
            on_timer()
            self.assertEqual(len(node.published), 2200, "nothing is amiss yet")
            node.clock += 0.1
            on_timer()
            self.assertLessEqual(period, 0.05)

        node, forces = self.run_node(work, maximum_force=3.0)
        self.assertEqual({topic for topic, _ in node.published}, {"force"})
        self.assertEqual(node.published[0][1].header.frame_id, "cloud")
        self.assertAlmostEqual(forces[2199][0], 9.199, places=6)
        self.assertTrue(0.2 < forces[2199][1] < 2, forces[2199])
        self.assertEqual(forces[2200][1], 0, "the hand has gone silent")

    def test_a_pose_that_is_wrong_has_no_force_and_spoils_nothing(self):
        def work(node):
            self.press(node)
            self.hear(node, 9.2, float("nan"))
            self.hear(node, 9.0, -1e-3)  # a stamp of before
            for n in range(1, 200):
                self.hear(node, 9.2 + 1e-3 * n, -1e-3)
                time.sleep(1e-3)
            self.assertTrue(all(abs(v) < 1e-2 for v in node.velocity), node.velocity)

        _, forces = self.run_node(work)
        self.assertEqual([force for _, force in forces[2200:2202]], [0, 0])

    def test_its_end_is_zero_force_however_it_comes(self):
        def press_and(end):
            def work(node):
                answer = types.SimpleNamespace(force=np.array([0, 0, 2.0]), stopped=False)
                node.session.step = lambda *a, **k: answer
                self.hear(node, 7.0, 0.0)
                end(node)

            return work

        def interrupt(node):
            raise KeyboardInterrupt

        def terminate(node):
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(5)

        def fail(node):
            def step(*_, **__):
                raise palpate.Error("as a test wants it")

            node.session.step = step
            self.hear(node, 7.001, 0.0)

        for end, error in ((interrupt, None), (terminate, None), (fail, palpate.Error)):
            made = []
            try:
                made.append(self.run_node(press_and(end))[1])
                self.assertIsNone(error)
            except palpate.Error:
                self.assertIs(error, palpate.Error)
                made.append([(0, m.wrench.force.z) for _, m in self.node.published])
            forces = [force for _, force in made[0]]
            self.assertEqual(forces[0], 2)
            self.assertEqual(set(forces[1:]), {0})
            self.assertGreaterEqual(len(forces), 4, "several, for one may be lost")
            self.assertFalse(rclpy.is_valid)

    def test_a_scene_that_is_missing_is_a_sentence(self):
        with self.assertRaisesRegex(palpate.Error, "nowhere.json"):
            self.run_node(lambda node: None, scene="/nowhere.json")


class Sofa(unittest.TestCase):
    def driver(self):
        return types.SimpleNamespace(positionDevice=Data([0, 0, 5, 0, 0, 0, 1]), button1=Data(False),
                                     inputForceFeedback=Data([0, 0, 0]), maxInputForceFeedback=Data(3.0))

    def test_the_driver_is_given_forces_and_the_surface_its_dent(self):
        driver, drawn = self.driver(), types.SimpleNamespace(position=Data(None))
        touch = palpate_force_feedback.PalpateForceFeedback(palpate.Object.scene(SHEET), driver, surface=drawn)
        self.assertTrue(touch.initialised)
        self.addCleanup(setattr, palpate_force_feedback, "time", time)
        palpate_force_feedback.time = types.SimpleNamespace(monotonic=lambda: self.now)
        for n in range(500):  # at 100 Hz
            self.now = 0.01 * n
            driver.positionDevice.value[2] = 100 * height(self.now)  # in centimetres
            touch.onAnimateBeginEvent({})
            force = driver.inputForceFeedback.value
            time.sleep(0.01)
        # The sheet's 475 N/m are more than a tenth of 1000, which is what may be held for 10 ms; and the hand is 1 mm deep.
        self.assertAlmostEqual(force[2], 0.1, delta=0.005)
        self.assertLess(drawn.position.value[:, 2].min(), -1e-3, "some hundredths of a millimetre, in centimetres")
        self.now += 0.01
        driver.positionDevice.value[0] = float("nan")
        touch.onAnimateBeginEvent({})
        self.assertEqual(driver.inputForceFeedback.value, [0, 0, 0])

    def test_a_force_ends_with_the_steps_and_with_one_that_fails(self):
        driver = self.driver()
        touch = palpate_force_feedback.PalpateForceFeedback(palpate.Object.scene(SHEET), driver)
        touch.session = types.SimpleNamespace(step=lambda *a, **k: types.SimpleNamespace(force=np.array([0, 0, 2.0])))
        self.assertTrue(self.becomes(driver, [0, 0, 2.0], touch))
        self.assertTrue(self.becomes(driver, [0, 0, 0]), "the animation pauses")
        self.assertTrue(self.becomes(driver, [0, 0, 2.0], touch), "it goes on")

        def fail(*_, **__):
            raise palpate.Error("as a test wants it")

        touch.session.step = fail
        with self.assertRaises(palpate.Error):
            touch.onAnimateBeginEvent({})
        self.assertEqual(driver.inputForceFeedback.value, [0, 0, 0])

    def becomes(self, driver, force, touch=None):
        """Returns whether the driver is given this force within 5 s, for a busy machine; steps are made if there is a touch."""
        for _ in range(500):
            if touch:
                touch.onAnimateBeginEvent({})
            if list(driver.inputForceFeedback.value) == force:
                return True
            time.sleep(0.01)
        return False


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
