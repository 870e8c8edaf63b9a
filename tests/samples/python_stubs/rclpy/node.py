from types import SimpleNamespace

import rclpy

parameters = {}


class Node:
    def __init__(self, name):
        self.name, self.clock, self.published, self.subscribed, self.timers, self.warnings = name, 0.0, [], {}, [], []
        self.destroyed = False

    def declare_parameter(self, name, default):
        value = parameters.get(name, default)
        if type(value) is not type(default):
            raise TypeError(f"{name}: expected {type(default)}, found {value!r}")  # as a statically typed parameter
        return SimpleNamespace(value=value)

    def create_publisher(self, kind, topic, depth):
        def publish(message):
            if not rclpy.is_valid:
                raise RuntimeError("publisher's context is invalid")
            if type(message) is not kind:
                raise TypeError(f"{topic}: expected {kind}, found {type(message)}")
            self.published.append((topic, message))

        return SimpleNamespace(publish=publish)

    def create_subscription(self, kind, topic, callback, depth):
        self.subscribed[topic] = callback

    def create_timer(self, period, callback):
        self.timers.append((period, callback))

    def get_clock(self):
        return SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=round(1e9 * self.clock)))

    def get_logger(self):
        return SimpleNamespace(warning=lambda text, throttle_duration_sec: self.warnings.append(text))

    def destroy_node(self):
        self.destroyed = True
