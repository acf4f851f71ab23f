from abc import abstractmethod

from geometry_msgs.msg import Twist
from rclpy.node import Node


class Mover(Node):
    """Sends the speeds of a subclass."""

    period = 0.5

    def __init__(self, name):
        super().__init__(name)
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(self.period, self.tick)

    @abstractmethod
    def speeds(self): ...

    def tick(self):
        m = Twist()
        m.linear.x, m.angular.z = self.speeds()
        self.pub.publish(m)
