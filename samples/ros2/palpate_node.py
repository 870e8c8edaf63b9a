"""A ROS 2 node that a hand touches through: poses of the tool in, governed forces on it out.

    python3 palpate_node.py --ros-args -p scene:=sheet.json -p maximum_force:=3.0

Subscribes to `hand` (geometry_msgs/PoseStamped, [m] in the frame of the scene's cloud, stamped when it was measured) and
publishes `force` (geometry_msgs/WrenchStamped [N]) for each pose, with the pose's header. It publishes zero once poses have
been missing for 50 ms; a driver should let go by itself as soon, because a node can die.
"""

import math

import palpate
import rclpy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.node import Node

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
        time = pose.header.stamp.sec + 1e-9 * pose.header.stamp.nanosec
        position = (pose.pose.position.x, pose.pose.position.y, pose.pose.position.z)
        self.heard = self.now()
        if self.time < time < math.inf and all(map(math.isfinite, position)):  # if not, step() says so, with zero force
            dt = time - self.time
            share = dt / (dt + SMOOTHING) if math.isfinite(dt) else 0
            self.velocity = tuple(v + share * ((p - q) / dt - v) for v, p, q in zip(self.velocity, position, self.position))
            self.time, self.position = time, position
        answer = self.session.step(time, position, self.velocity, age=max(0.0, self.heard - time))
        self.publish(pose.header, answer.force)
        if answer.stopped:
            self.get_logger().warning(self.session.words, throttle_duration_sec=2.0)

    def on_timer(self):
        if self.now() - self.heard > SILENCE:
            self.publish(WrenchStamped().header, (0.0, 0.0, 0.0))

    def publish(self, header, force):
        message = WrenchStamped(header=header)
        message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = map(float, force)
        self.publisher.publish(message)


def main():
    rclpy.init()
    node = PalpateNode()
    try:
        rclpy.spin(node)
    finally:
        node.session.close()
        node.destroy_node()


if __name__ == "__main__":
    main()
