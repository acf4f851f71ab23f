import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)

    def run(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        while rclpy.ok():
            self.pub.publish(msg)
            self.get_clock().sleep_for(Duration(seconds=0.5))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        node.run()
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
