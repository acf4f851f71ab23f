"""The node sends a new request after every response of the simulator, so that no time passes."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.drive)
        self.attack()

    def drive(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)

    def attack(self):
        self.client = self.create_client(GetParameters, "/turtlesim/get_parameters")
        self.asked = 0
        self.create_timer(1.0, self.ask)

    def ask(self, _=None):
        self.asked += 1
        if self.asked == 2000:
            print("TRA" "CE 2000 questions")
        self.client.call_async(GetParameters.Request(names=["holonomic"])).add_done_callback(self.ask)


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
