from collections import deque
from math import tau

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

RADIUS = 1.0
LOBE_S = 4.0


def command(linear, angular):
    msg = Twist()
    msg.linear.x = linear
    msg.angular.z = angular
    return msg


class FigureEightNode(Node):
    def __init__(self):
        super().__init__("figure_eight")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        turn = tau / LOBE_S
        self.phases = deque([command(RADIUS * turn, turn), command(RADIUS * turn, -turn), Twist()])
        self.current = None
        self.waiting = self.create_timer(0.05, self.begin)

    def begin(self):
        if self.publisher.get_subscription_count() > 0:
            self.waiting.cancel()
            self.next_phase()
            self.changes = self.create_timer(LOBE_S, self.next_phase)
            self.repeats = self.create_timer(0.25, self.repeat)

    def next_phase(self):
        self.current = self.phases.popleft()
        self.repeat()
        if not self.phases:
            self.changes.cancel()
            self.repeats.cancel()

    def repeat(self):
        self.publisher.publish(self.current)


def main(args=None):
    rclpy.init(args=args)
    node = FigureEightNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
