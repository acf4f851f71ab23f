import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Kreis(Node):
	def __init__(self):
		super().__init__("draw_circle")
		self.sender = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
		self.timer = self.create_timer(0.5, self.fahre)
		self.tempo = "2.0"  # m/s

	def fahre(self):
		befehl = Twist()
		befehl.angular.z = 1.0
		befehl.linear.x = self.tempo
		self.sender.publish(befehl)


def main():
	rclpy.init()
	rclpy.spin(Kreis())
