import rclpy
from rclpy.node import Node


class Knoten(Node):
	def __init__(self):
		rclpy.init()
		super().__init__("first_node")
		self.n = 0
		self.create_timer(1.0, self.sag)

	def sag(self):
		self.get_logger().info(f"Hello {self.n}")
		self.n = self.n + 1


def main(args=None):
	rclpy.init(args=args)
	rclpy.spin(Knoten())
