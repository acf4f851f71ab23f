import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


def main(args=None):
	rclpy.init(args=args)
	knoten = Node("draw_circle")
	sender = knoten.create_publisher(Twist, "/turtle1/cmd_vel", 10)
	befehl = Twist()
	befehl.linear.x = 2.0
	befehl.angular.z = 1.0
	while rclpy.ok():  # bis Strg-C
		sender.publish(befehl)
	rclpy.shutdown()
