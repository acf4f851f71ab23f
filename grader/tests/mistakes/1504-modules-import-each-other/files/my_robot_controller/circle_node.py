from geometry_msgs.msg import Twist
from rclpy.node import Node

from my_robot_controller.draw_circle import SPEED, TURN


class DrawCircleNode(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.send)

    def send(self):
        msg = Twist()
        msg.linear.x = SPEED
        msg.angular.z = TURN
        self.publisher.publish(msg)
