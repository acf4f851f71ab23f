import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.task import Future


class Sender:
    def __init__(self, publisher, commands):
        self.publisher, self.commands = publisher, commands

    def __call__(self):
        self.publisher.publish(next(self.commands))


def circle(radius, turning):
    while True:
        yield Twist(linear=Vector3(x=radius * turning), angular=Vector3(z=turning))


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("draw_circle")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    node.create_timer(0.5, Sender(publisher, circle(radius=2.0, turning=1.0)))
    try:
        rclpy.spin_until_future_complete(node, Future())
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
