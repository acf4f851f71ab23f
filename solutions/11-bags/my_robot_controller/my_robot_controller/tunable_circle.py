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
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send_velocity_command)

    def check(self, parameters):
        wanted = {name: self.get_parameter(name).value for name in ("radius", "speed")}
        wanted.update({parameter.name: parameter.value for parameter in parameters})
        turn = wanted["speed"] / wanted["radius"]
        if turn > FASTEST_TURN:
            return SetParametersResult(successful=False, reason=f"{turn:.1f} rad/s is too fast a turn")
        return SetParametersResult(successful=True)

    def send_velocity_command(self):
        msg = Twist()
        radius = self.get_parameter("radius").value
        speed = self.get_parameter("speed").value
        msg.linear.x = speed
        msg.angular.z = speed / radius
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
