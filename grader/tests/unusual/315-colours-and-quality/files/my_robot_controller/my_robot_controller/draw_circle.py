import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    deadline=Duration(seconds=1),
    liveliness=LivelinessPolicy.AUTOMATIC,
)


class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", QOS)
        self.painter = self.create_client(SetParameters, "/turtlesim/set_parameters")
        self.timer = self.create_timer(0.5, self.drive)
        self.painted = False

    def paint(self, **colours):
        request = SetParameters.Request()
        for name, value in colours.items():
            value = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=value)
            request.parameters.append(Parameter(name=f"background_{name}", value=value))
        self.painter.call_async(request)

    def drive(self):
        if not self.painted and self.painter.service_is_ready():
            self.painted = True
            self.paint(r=20, g=20, b=20)
        self.publisher.publish(self.twist())

    @staticmethod
    def twist():
        twist = Twist()
        twist.linear.x = 2.0
        twist.angular.z = 1.0
        return twist


def main(args=None):
    rclpy.init(args=args)
    node = DrawCircle()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
