"""A ROS 2 node that a hand touches through: poses of the tool in, governed forces on it out.

    python3 palpate_node.py --ros-args -p scene:=sheet.json -p maximum_force:=3.0

Subscribes to `hand` (geometry_msgs/PoseStamped, [m] in the frame of the scene's cloud, stamped when it was measured) and
publishes `force` (geometry_msgs/WrenchStamped [N]) for each pose, with the pose's header. It publishes zero once poses have
been missing for 50 ms, and when it ends; a driver should let go by itself as soon, because a node can die.
"""

import math
import signal
import time

import palpate
import rclpy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

SMOOTHING = 5e-3  # time constant of the velocity [s]
SILENCE = 50e-3   # between poses [s]


class PalpateNode(Node):
    def __init__(self):
        super().__init__("palpate")
        asked = {name: self.declare_parameter(name, value).value for name, value in
                 (("scene", ""), ("maximum_force", 0.0), ("maximum_stiffness", 0.0))}
        self.session = palpate.Object.file(asked.pop("scene")).session(**asked)
        self.time, self.position, self.velocity = -math.inf, (0, 0, 0), (0, 0, 0)
        self.heard = self.now()
        self.publisher = self.create_publisher(WrenchStamped, "force", 1)
        self.create_subscription(PoseStamped, "hand", self.on_hand, 1)  # the newest pose only: forces must not lag
        self.create_timer(SILENCE / 2, self.on_timer)

    def now(self):
        return 1e-9 * self.get_clock().now().nanoseconds

    def on_hand(self, pose):
        try:
            self.answer(pose)
        except BaseException:
            self.let_go()
            raise

    def answer(self, pose):
        stamp = pose.header.stamp.sec + 1e-9 * pose.header.stamp.nanosec
        position = (pose.pose.position.x, pose.pose.position.y, pose.pose.position.z)
        self.heard = self.now()
        if self.time < stamp < math.inf and all(map(math.isfinite, position)):  # if not, step() says so, with zero force
            dt = stamp - self.time
            share = dt / (dt + SMOOTHING) if math.isfinite(dt) else 0
            self.velocity = tuple(v + share * ((p - q) / dt - v) for v, p, q in zip(self.velocity, position, self.position))
            self.time, self.position = stamp, position
        answer = self.session.step(stamp, position, self.velocity, age=max(0.0, self.heard - stamp))
        self.publish(pose.header, answer.force)
        if answer.stopped:
            self.get_logger().warning(self.session.words, throttle_duration_sec=2.0)

    def on_timer(self):
        if self.now() - self.heard > SILENCE:
            self.let_go()

    def let_go(self):
        self.publish(WrenchStamped().header, (0.0, 0.0, 0.0))

    def publish(self, header, force):
        message = WrenchStamped(header=header)
        message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = map(float, force)
        self.publisher.publish(message)


    def end(self):
        for _ in range(3):  # one may be lost
            self.let_go()
            time.sleep(5e-3)
        self.session.close()
        self.destroy_node()


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # its own would end the context before zero is published
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C
    node = None
    try:
        node = PalpateNode()
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        if node:
            node.end()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
