import rclpy
from geometry_msgs.msg import Twist
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class DrawCircle(LifecycleNode):
    def __init__(self):
        super().__init__("draw_circle")

    def on_configure(self, state):
        self.publisher = self.create_lifecycle_publisher(Twist, "/turtle1/cmd_vel", 10)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.timer = self.create_timer(0.5, self.send)
        return super().on_activate(state)

    def send(self):
        msg = Twist()
        msg.linear.x = 2.0
        msg.angular.z = 1.0
        self.publisher.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(DrawCircle())
    rclpy.shutdown()
