import rclpy
from rclpy.node import Node


class Zaehler(Node):
	def __init__(self):
		super().__init__("first_node")
		self.zahl = 0
		self.timer = self.create_timer(1.0, self.zaehle)

	def zaehle(self):
		self.get_logger().info(f"Hello {self.zahl}")
        self.zahl += 1


def main():
	rclpy.init()
	rclpy.spin(Zaehler())
