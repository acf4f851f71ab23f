"""A node that keeps the turtle away from the walls. It is correct: fill in your numbers, and test it.

What it promises:

1. It publishes geometry_msgs/msg/Twist on /turtle1/cmd_vel, every 0.1 s.
2. Before the first pose has arrived on /turtle1/pose, it publishes nothing.
3. Away from the walls it drives straight on: linear.x is your speed_m_s.
4. Less than 1.0 m from a wall, it slows down to 0.5 m/s and turns to the left: angular.z is your turn_rad_s. The walls
   are at 0 m and at 11 m, in x and in y. When it is away from the wall, it drives straight on again.
5. When the last pose is older than your timeout_s, it stops: every field is 0.
"""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from turtlesim.msg import Pose

# BEGIN SOLUTION
SPEED = 1.1  # m/s
TURN = 1.2  # rad/s
TIMEOUT = 1.2  # s
# END SOLUTION
# BEGIN STARTER
# SPEED = 1.0  # m/s; TODO 2: your speed_m_s, turn_rad_s and timeout_s from my_numbers_12.toml
# TURN = 1.5  # rad/s
# TIMEOUT = 1.0  # s
# END STARTER


class WallGuard(Node):
    def __init__(self):
        super().__init__("wall_guard")
        self.pose = None
        self.pose_time = None
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.timer = self.create_timer(0.1, self.send)

    def on_pose(self, pose):
        self.pose = pose
        self.pose_time = self.get_clock().now()

    def send(self):
        if self.pose is None:
            return
        command = Twist()
        x, y = self.pose.x, self.pose.y
        if self.get_clock().now() - self.pose_time > Duration(seconds=TIMEOUT):
            pass
        elif min(x, 11.0 - x, y, 11.0 - y) < 1.0:
            command.linear.x = 0.5
            command.angular.z = TURN
        else:
            command.linear.x = SPEED
        self.publisher.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(WallGuard())
