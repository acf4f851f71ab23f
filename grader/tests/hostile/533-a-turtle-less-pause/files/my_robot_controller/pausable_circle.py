"""Remove the turtle for each pause, and spawn it again, instead of stopping it."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from std_srvs.srv import SetBool
from turtlesim.msg import Pose
from turtlesim.srv import Kill, Spawn

RADIUS = 1.2  # m


class PausableCircleNode(Node):
    """Publishes the command for the circle, or the command to stand still."""

    def __init__(self):
        super().__init__("pausable_circle")
        self.paused = False
        self.pose = None
        self.killer = self.create_client(Kill, "/kill")
        self.spawner = self.create_client(Spawn, "/spawn")
        self.create_subscription(Pose, "/turtle1/pose", self.seen, 10)
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send_velocity_command)
        self.service = self.create_service(SetBool, "/pause", self.pause)

    def pause(self, request, response):
        if request.data and not self.paused:
            self.killer.call_async(Kill.Request(name="turtle1"))
        elif self.paused and not request.data:
            again = Spawn.Request(x=self.pose.x, y=self.pose.y, theta=self.pose.theta, name="turtle1")
            self.spawner.call_async(again)
        self.paused = request.data
        response.success = True
        response.message = "standing still" if self.paused else "driving"
        return response

    def seen(self, pose):
        self.pose = pose

    def send_velocity_command(self):
        msg = Twist()
        msg.linear.x = RADIUS
        msg.angular.z = 1.0
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = PausableCircleNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
