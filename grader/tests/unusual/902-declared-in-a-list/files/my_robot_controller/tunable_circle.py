"""Everything about the parameters stands in one table."""

import rclpy
from geometry_msgs.msg import Twist, Vector3
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException

TABLE = {
    # name: (default, lowest, highest, description)
    "radius": (1.8, 0.2, 3.0, "distance from the centre of the circle to the turtle (m)"),
    "speed": (1.0, 0.1, 3.0, "how fast the turtle drives (m/s)"),
}
MAX_TURN = 3.0


def no(reason):
    return SetParametersResult(successful=False, reason=reason)


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("tunable_circle")
    node.declare_parameters(
        "",
        [
            (
                name,
                default,
                ParameterDescriptor(
                    name=name,
                    description=text,
                    floating_point_range=[FloatingPointRange(from_value=low, to_value=high, step=0.0)],
                ),
            )
            for name, (default, low, high, text) in TABLE.items()
        ],
    )

    def now(name):
        return node.get_parameter(name).get_parameter_value().double_value

    def check(parameters):
        values = {name: now(name) for name in TABLE}
        for parameter in parameters:
            if parameter.name not in TABLE:
                continue
            _, low, high, _ = TABLE[parameter.name]
            if not low <= parameter.value <= high:
                return no(f"{parameter.name} must be between {low} and {high}")
            values[parameter.name] = parameter.value
        if values["speed"] / values["radius"] > MAX_TURN:
            return no(f"that is more than {MAX_TURN} rad/s")
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(check)
    publisher = node.create_publisher(Twist, "turtle1/cmd_vel", 10)

    def drive():
        speed, radius = now("speed"), now("radius")
        publisher.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=speed / radius)))

    node.create_timer(1 / 20, drive)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
