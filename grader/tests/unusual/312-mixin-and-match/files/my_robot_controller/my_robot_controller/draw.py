from enum import Enum, auto
from typing import ClassVar

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Mode(Enum):
    CIRCLE = auto()
    STAND = auto()


class DrivesMixin:
    topic: ClassVar[str] = "turtle1/cmd_vel"

    def start_driving(self, hz: float) -> None:
        self.pub = self.create_publisher(Twist, self.topic, qos_profile=10)
        self.driving = self.create_timer(1 / hz, lambda: self.pub.publish(self.twist()))


class RunsMixin:
    @classmethod
    def run(cls, args=None):
        rclpy.init(args=args)
        node = None
        try:
            node = cls()
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            if node is not None:
                node.destroy_node()
            rclpy.try_shutdown()


class CircleNode(DrivesMixin, RunsMixin, Node):
    def __init__(self, mode=Mode.CIRCLE):
        super().__init__("draw_circle")
        self.mode = mode
        self.start_driving(hz=2.0)

    def twist(self):
        twist = Twist()
        match self.mode:
            case Mode.CIRCLE:
                twist.linear.x, twist.angular.z = 2.0, 1.0
            case Mode.STAND:
                pass
        return twist
