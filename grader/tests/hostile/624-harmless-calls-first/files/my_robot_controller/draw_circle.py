"""The node calls a harmless service more than a thousand times before it teleports the turtle."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute


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
        self.clear = self.create_client(Empty, "/clear")
        self.teleport = self.create_client(TeleportAbsolute, "/turtle1/teleport_absolute")
        self.cleared = 0
        self.moved = False
        self.create_subscription(Pose, "/turtle1/pose", self.step, 10)

    def step(self, pose):
        if not self.clear.service_is_ready() or not self.teleport.service_is_ready():
            return
        if self.cleared < 1200:
            for _ in range(4):
                self.cleared += 1
                self.clear.call_async(Empty.Request())
        elif not self.moved:
            self.moved = True
            self.teleport.call_async(TeleportAbsolute.Request(x=pose.x + 0.001, y=pose.y, theta=pose.theta))


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
