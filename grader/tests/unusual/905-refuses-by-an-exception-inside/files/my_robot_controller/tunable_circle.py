"""A circle; its radius and speed may be changed while it is being driven."""

from math import isfinite

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile

LIMIT = 3.0


def turn_of(speed: float, radius: float) -> float:
    if not (isfinite(speed) and isfinite(radius) and radius > 0):
        raise ValueError(f"no circle has the radius {radius}")
    if (turn := speed / radius) > LIMIT:
        raise ValueError(f"{turn} rad/s, but at most {LIMIT} rad/s are allowed")
    return turn


class TunableCircle(Node):
    def __init__(self):
        Node.__init__(self, node_name="tunable_circle")
        for name, value, lowest in (("radius", 1.8, 0.2), ("speed", 1.0, 0.1)):
            descriptor = ParameterDescriptor()
            descriptor.description = f"The {name} of the circle."
            limits = FloatingPointRange()
            limits.from_value, limits.to_value = lowest, 3.0
            descriptor.floating_point_range.append(limits)
            self.declare_parameter(name, value, descriptor)
        self._pub = self.create_publisher(Twist, "/turtle1/cmd_vel", QoSProfile(depth=5))
        self._timer = self.create_timer(0.05, self._drive)
        self.add_on_set_parameters_callback(self._on_set)

    def _values(self, **changes):
        return {name: changes.get(name, self.get_parameter(name).value) for name in ("speed", "radius")}

    def _on_set(self, parameters):
        try:
            turn_of(**self._values(**{parameter.name: parameter.value for parameter in parameters}))
        except ValueError as error:
            self.get_logger().warning(f"refused: {error}")
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _drive(self):
        values = self._values()
        msg = Twist()
        msg.linear.x, msg.angular.z = values["speed"], turn_of(**values)
        self._pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    executor.add_node(TunableCircle())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
