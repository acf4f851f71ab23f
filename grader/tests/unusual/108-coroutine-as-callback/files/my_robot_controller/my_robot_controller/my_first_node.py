"""A node that greets."""
import rclpy
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Greeter(Node):
    """Greets."""

    def __init__(self, name="first_node"):
        super().__init__(name)
        self.declare_parameters("", [
            ("word", "Hello", ParameterDescriptor(description="what to say")),
            ("period", 1.0),
        ])
        self.add_on_set_parameters_callback(self.changed)
        self.counter = 0
        self.timer = None
        self.arm()

    def arm(self):
        if self.timer:
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(self.get_parameter("period").value, self.greet)

    def changed(self, parameters):
        return SetParametersResult(successful=True)

    async def greet(self):
        word = self.get_parameter("word").get_parameter_value().string_value
        self.get_logger().info(" ".join([word, str(self.counter)]))
        self.counter += 1
        if self.counter == 1:
            self.arm()


def talker(args=None):
    rclpy.init(args=args)
    rclpy.spin(Greeter("talker"))


def main(args=None):
    rclpy.init(args=args)
    try:
        node = Greeter()
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    except ExternalShutdownException:
        pass
    else:
        node.destroy_node()
