"""A stand-in of ROS 2's Python client for the test of samples/ros2: one node whose clock and messages the test moves."""

spun = None  # what spin() does with a node


def init():
    pass


def spin(node):
    spun(node)
