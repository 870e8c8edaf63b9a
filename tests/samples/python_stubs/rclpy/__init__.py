"""A stand-in of ROS 2's Python client for the test of samples/ros2: one node whose clock and messages the test moves."""

from .signals import SignalHandlerOptions

spun = None      # what spin() does with a node
handles = False  # the client's own handlers of signals: they end the context, in which nothing can be published any more
is_valid = False  # the context


def init(*, signal_handler_options=SignalHandlerOptions.ALL):
    global handles, is_valid
    handles, is_valid = signal_handler_options is not SignalHandlerOptions.NO, True


def shutdown():
    global is_valid
    if not is_valid:
        raise RuntimeError("the context is not valid")
    is_valid = False


def spin(node):
    global is_valid
    try:
        spun(node)
    except KeyboardInterrupt:
        is_valid = not handles
        raise
