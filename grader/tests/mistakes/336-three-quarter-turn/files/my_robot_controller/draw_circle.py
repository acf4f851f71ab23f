import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.send)
        self.count = 0

    def send(self):
        msg = Twist()
        self.count += 1
        if self.count < 10:
            msg.linear.x = 2.0
            msg.angular.z = 1.0
        self.pub.publish(msg)  # zeros: stop


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()
