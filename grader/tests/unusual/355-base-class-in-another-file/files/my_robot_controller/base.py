from geometry_msgs.msg import Twist
from rclpy.node import Node


class TurtleNode(Node):
    def __init__(self, name, turtle="turtle1"):
        super().__init__(name)
        self.publisher = self.create_publisher(Twist, f"/{turtle}/cmd_vel", 10)
