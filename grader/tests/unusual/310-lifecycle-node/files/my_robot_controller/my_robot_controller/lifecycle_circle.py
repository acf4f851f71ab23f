import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class LifecycleCircle(LifecycleNode):
    def __init__(self):
        super().__init__("draw_circle")
        self._publisher = None
        self._timer = None

    def on_configure(self, state):
        self._publisher = self.create_lifecycle_publisher(Twist, "/turtle1/cmd_vel", 10)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self._timer = self.create_timer(0.5, self.send)
        return super().on_activate(state)

    def on_deactivate(self, state):
        self.destroy_timer(self._timer)
        return super().on_deactivate(state)

    def send(self):
        twist = Twist()
        twist.linear.x = 2.0
        twist.angular.z = 1.0
        self._publisher.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    node = LifecycleCircle()
    node.trigger_configure()
    node.trigger_activate()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_node()
