import math
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose

class Ecoute(Node):
    def __init__(self):
        super().__init__("pose_subscriber")
        self.x = self.y = None
        self.trajet = 0.0
        self.create_subscription(Pose, "/turtle1/pose", self.recu, 10)
        self.create_timer(1.0, self.dit)

    def recu(self, msg):
        x, y = msg.position.x, msg.position.y
        if self.x is not None:
            self.trajet += math.hypot(x - self.x, y - self.y)
        self.x, self.y = x, y

    def dit(self):
        if self.x is not None:
            self.get_logger().info(f"x={self.x:.2f} y={self.y:.2f} distance={self.trajet:.2f}")

def main():
    rclpy.init()
    rclpy.spin(Ecoute())
