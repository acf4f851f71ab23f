import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException


def _spin(name, period, make_callback, args):
    rclpy.init(args=args)
    node = rclpy.create_node(name)
    node.create_timer(period, make_callback(node))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


def first(args=None):
    numbers = iter(range(10**9))
    _spin("first_node", 1.0, lambda node: lambda: node.get_logger().info(f"Hello {next(numbers)}"), args)


def circle(args=None):
    def make(node):
        radius = node.declare_parameter("radius", 1.5)
        publisher = node.create_publisher(Twist, "turtle1/cmd_vel", 10)

        def drive():
            twist = Twist()
            twist.angular.z = 0.8
            twist.linear.x = twist.angular.z * radius.value
            publisher.publish(twist)

        return drive

    _spin("draw_circle", 0.25, make, args)
