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
        # BEGIN SOLUTION
        self.declare_parameter(
            "radius",
            1.8,
            ParameterDescriptor(
                description="radius of the circle, in m",
                floating_point_range=[FloatingPointRange(from_value=0.2, to_value=3.0)],
            ),
        )
        self.declare_parameter(
            "speed",
            1.0,
            ParameterDescriptor(
                description="forward speed, in m/s",
                floating_point_range=[FloatingPointRange(from_value=0.1, to_value=3.0)],
            ),
        )
        self.add_on_set_parameters_callback(self.check)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 2: declare the parameters radius and speed, with your own numbers from my_numbers_09.toml as defaults.
        # # Each gets a ParameterDescriptor with a description and a range: radius 0.2 to 3.0, speed 0.1 to 3.0.
        # # TODO 3: let rclpy call self.check before a parameter changes: add_on_set_parameters_callback.
        # END STARTER
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send_velocity_command)

    def check(self, parameters):
        # BEGIN SOLUTION
        wanted = {name: self.get_parameter(name).value for name in ("radius", "speed")}
        wanted.update({parameter.name: parameter.value for parameter in parameters})
        turn = wanted["speed"] / wanted["radius"]
        if turn > FASTEST_TURN:
            return SetParametersResult(successful=False, reason=f"turning at {turn:.1f} rad/s is too fast")
        return SetParametersResult(successful=True)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 4: reject values that would make the turtle turn faster than FASTEST_TURN, and give the reason. Accept
        # # all other values.
        # return SetParametersResult(successful=True)
        # END STARTER

    def send_velocity_command(self):
        msg = Twist()
        # BEGIN SOLUTION
        radius = self.get_parameter("radius").value
        speed = self.get_parameter("speed").value
        msg.linear.x = speed
        msg.angular.z = speed / radius
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 5: read both parameters, and drive the circle to the left.
        # END STARTER
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
