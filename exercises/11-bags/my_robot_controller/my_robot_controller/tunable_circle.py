"""Drive a circle whose radius and speed are parameters."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

FASTEST_TURN = 3.0  # rad/s


class TunableCircleNode(Node):
    """Reads its parameters before each command."""

    def __init__(self):
        super().__init__("tunable_circle")
        # TODO 2: declare the parameters radius and speed, with your own numbers from my_numbers_09.toml as defaults.
        # Each gets a ParameterDescriptor with a description and a range: radius 0.2 to 3.0, speed 0.1 to 3.0.
        # TODO 3: let rclpy call self.check before a parameter changes: add_on_set_parameters_callback.
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send_velocity_command)

    def check(self, parameters):
        # TODO 4: reject values that would make the turtle turn faster than FASTEST_TURN, and give the reason. Accept
        # all other values.
        return SetParametersResult(successful=True)

    def send_velocity_command(self):
        msg = Twist()
        # TODO 5: read both parameters, and drive the circle to the left.
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = TunableCircleNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
