import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose

class Listener(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.d = 0.0
        self.sub = self.create_subscription(Pose, "/turtle1/pose", self.listener_callback, 10)
        self.t = self.create_timer(1.0, self.show)
    def listener_callback(self):
        self.x = msg.x
        self.y = msg.y
    def show(self):
        self.get_logger().info(f"x={self.x:.2f} y={self.y:.2f} distance={self.d:.2f}")

def main(args=None):
    rclpy.init(args=args)
    node = Listener()
    rclpy.spin(node)
    rclpy.shutdown()
