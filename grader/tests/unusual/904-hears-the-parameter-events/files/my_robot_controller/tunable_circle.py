import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, ParameterEvent, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def describe(text, low, high):
    return ParameterDescriptor(description=text, floating_point_range=[FloatingPointRange(from_value=low, to_value=high)])


class TunableCircleNode(Node):
    def __init__(self):
        super().__init__("tunable_circle")
        self.declare_parameter("radius", 1.8, describe("Radius (m).", 0.2, 3.0))
        self.declare_parameter("speed", 1.0, describe("Speed (m/s).", 0.1, 3.0))
        self.add_on_set_parameters_callback(self.validate)
        self.command = Twist()
        self.read()
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.events = self.create_subscription(ParameterEvent, "/parameter_events", self.on_event, 10)
        self.timer = self.create_timer(0.1, lambda: self.publisher.publish(self.command))

    def read(self):
        radius, speed = (parameter.value for parameter in self.get_parameters(["radius", "speed"]))
        self.command.linear.x = speed
        self.command.angular.z = speed / radius

    def on_event(self, event):
        if event.node == self.get_fully_qualified_name() and event.changed_parameters:
            self.read()

    def validate(self, parameters):
        new = {"radius": self.get_parameter("radius").value, "speed": self.get_parameter("speed").value}
        for parameter in parameters:
            new[parameter.name] = parameter.value
        if new["speed"] > 3 * new["radius"]:
            return SetParametersResult(successful=False, reason="speed / radius is above 3 rad/s")
        return SetParametersResult(successful=True)


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
