#!/usr/bin/env python3
"""Draws the circle; the watchdog runs in the same process."""
import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import String

from my_robot_controller.watchdog_node import Watchdog


class CirclePublisher(Node):

    def __init__(self) -> None:
        super().__init__(node_name='draw_circle')
        self.driving = MutuallyExclusiveCallbackGroup()
        self.talking = ReentrantCallbackGroup()
        qos = QoSProfile(depth=5, reliability=QoSReliabilityPolicy.RELIABLE)
        self.cmd_pub = self.create_publisher(msg_type=Twist, topic='turtle1/cmd_vel', qos_profile=qos)
        self.status_pub = self.create_publisher(String, '~/status', 10)
        self.cmd_timer = self.create_timer(timer_period_sec=0.5, callback=self.on_drive, callback_group=self.driving)
        self.status_timer = self.create_timer(2.0, self.on_status, self.talking)
        self.sent = 0

    def on_drive(self) -> None:
        cmd = Twist()
        cmd.linear.x = 2.0
        cmd.angular.z = 1.0
        self.cmd_pub.publish(cmd)
        self.sent += 1

    def on_status(self) -> None:
        self.status_pub.publish(String(data='%d commands sent' % self.sent))


def main(args=None):
    rclpy.init(args=args)
    circle = CirclePublisher()
    watchdog = Watchdog()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(circle)
    executor.add_node(watchdog)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        watchdog.destroy_node()
        circle.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == '__main__':
    main()
