"""Drive the turtle of turtlesim in a circle."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# BEGIN SOLUTION
from geometry_msgs.msg import Twist
# END SOLUTION
# BEGIN STARTER
# # TODO 1: import the message type of /turtle1/cmd_vel. It is the class Twist of the module geometry_msgs.msg.
# END STARTER


class DrawCircleNode(Node):
    """Publishes a velocity command for the turtle twice a second."""

    def __init__(self):
        super().__init__("draw_circle")
        # BEGIN SOLUTION
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.send_velocity_command)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 2: create a publisher and keep it in self. It needs three things: the message type, the
        # # name of the topic, and how many messages may wait in the queue (10).
        # # TODO 3: create a timer and keep it in self. It needs the period in seconds and the method to call.
        # END STARTER
        self.get_logger().info("Draw circle node has been started")

    def send_velocity_command(self):
        # BEGIN SOLUTION
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 4: make a Twist, set the two numbers that matter for the turtle (forwards in m/s, turning in
        # # rad/s; the lesson gives the values), and publish it.
        # pass
        # END STARTER


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircleNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C is the normal way to stop this node.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
