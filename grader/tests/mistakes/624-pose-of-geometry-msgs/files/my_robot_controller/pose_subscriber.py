import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Pose


class Zuhoerer(Node):
	def __init__(self):
		super().__init__("pose_subscriber")
		self.lage = None
		self.weg = 0.0
		self.abo = self.create_subscription(Pose, "/turtle1/pose", self.hoere, 10)
		self.takt = self.create_timer(1.0, self.melde)

	def hoere(self, lage):
		if self.lage is not None:
			self.weg += math.hypot(lage.position.x - self.lage.position.x, lage.position.y - self.lage.position.y)
		self.lage = lage

	def melde(self):
		if self.lage is not None:
			p = self.lage.position
			self.get_logger().info(f"x={p.x:.2f} y={p.y:.2f} distance={self.weg:.2f}")


def main():
	rclpy.init()
	rclpy.spin(Zuhoerer())
