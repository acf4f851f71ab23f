"""Drive a circle that can be paused: the node offers the service /pause."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# BEGIN SOLUTION
from std_srvs.srv import SetBool
# END SOLUTION
# BEGIN STARTER
# # TODO 8: import SetBool from std_srvs.srv.
# END STARTER

# BEGIN SOLUTION
RADIUS = 1.2  # m
# END SOLUTION
# BEGIN STARTER
# RADIUS = 1.0  # m; TODO 9: your radius_m from my_numbers_08.toml
# END STARTER


class PausableCircleNode(Node):
    """Publishes the command for the circle, or the command to stand still."""

    def __init__(self):
        super().__init__("pausable_circle")
        self.paused = False
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send_velocity_command)
        # BEGIN SOLUTION
        self.service = self.create_service(SetBool, "/pause", self.pause)

    def pause(self, request, response):
        self.paused = request.data
        response.success = True
        response.message = "standing still" if self.paused else "driving"
        return response
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 10: create the service /pause, and write its callback: it gets a request and a response, and returns
        # # the response.
        # END STARTER

    def send_velocity_command(self):
        msg = Twist()
        # BEGIN SOLUTION
        if not self.paused:
            msg.linear.x = RADIUS
            msg.angular.z = 1.0
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 11: drive a circle with your radius to the left, but stand still while the node is paused.
        # END STARTER
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
