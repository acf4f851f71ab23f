import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node


class Tunable(Node):
    def __init__(self) -> None:
        super().__init__("tunable_circle")
        r = FloatingPointRange(from_value=0.2, to_value=3.0)
        s = FloatingPointRange(from_value=0.1, to_value=3.0)
        self.radius = self.declare_parameter(
            "radius", 1.8, ParameterDescriptor(description="radius [m]", floating_point_range=[r])
        ).value
        self.speed = self.declare_parameter(
            "speed", 1.0, ParameterDescriptor(description="speed [m/s]", floating_point_range=[s])
        ).value
        self.add_on_set_parameters_callback(self.allowed)
        self.add_post_set_parameters_callback(self.changed)
        self.cmd = self.create_publisher(Twist, "/turtle1/cmd_vel", 1)
        self.create_timer(0.1, self.tick)

    def allowed(self, params):
        new = {"radius": self.radius, "speed": self.speed} | {p.name: p.value for p in params}
        ok = new["speed"] <= 3.0 * new["radius"]
        return SetParametersResult(successful=ok, reason="" if ok else "I would get dizzy")

    def changed(self, params):
        for p in params:
            setattr(self, p.name, p.value)

    def tick(self):
        t = Twist()
        t.linear.x = self.speed
        t.angular.z = self.speed / self.radius
        self.cmd.publish(t)


def main():
    rclpy.init()
    try:
        rclpy.spin(Tunable())
    except KeyboardInterrupt:
        pass
