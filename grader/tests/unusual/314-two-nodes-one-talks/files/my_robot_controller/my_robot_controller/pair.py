import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float64


class Captain(Node):
    def __init__(self):
        super().__init__("captain")
        self.pub = self.create_publisher(Float64, "turning_speed", 10)
        self.timer = self.create_timer(0.5, self.order)

    def order(self):
        self.pub.publish(Float64(data=1.0))


class Helmsman(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.sub = self.create_subscription(Float64, "turning_speed", self.ordered, 10)

    def ordered(self, order):
        twist = Twist()
        twist.linear.x = 2.0 * order.data
        twist.angular.z = order.data
        self.pub.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    for node in (Captain(), Helmsman()):
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        for node in executor.get_nodes():
            node.destroy_node()
        rclpy.try_shutdown()
