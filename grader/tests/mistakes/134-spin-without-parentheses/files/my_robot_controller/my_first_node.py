import rclpy
from rclpy.node import Node


class ErsterKnoten(Node):
	"""Sagt jede Sekunde Hallo."""

	def __init__(self):
		super().__init__("first_node")
		self.nr = 0
		self.uhr = self.create_timer(1.0, self.melde)

	def melde(self):
		self.get_logger().info(f"Hello {self.nr}")
		self.nr += 1


def main(args=None):
	rclpy.init(args=args)
	knoten = ErsterKnoten()
	rclpy.spin
	rclpy.shutdown()
