"""Draw two arcs in two colours, and spawn a second turtle in between."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.srv import SetPen, Spawn

RADIUS = 1.0  # m; TODO 3: your radius_m from my_numbers_08.toml
TICKS = 30  # calls of the timer in one arc
PERIOD = 0.1  # s
TURN = math.pi / (TICKS * PERIOD)  # rad/s: an arc is half a circle


class TwoPensNode(Node):
    """Sets a pen, draws an arc, spawns a turtle, sets another pen, draws an arc, and stops."""

    def __init__(self):
        super().__init__("two_pens")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.pen = self.create_client(SetPen, "/turtle1/set_pen")
        # TODO 4: create a client for the service /spawn. Which type does it have?
        self.timer = self.create_timer(PERIOD, self.step)
        self.state = "begin"
        self.ticks = 0

    def step(self):
        if self.publisher.get_subscription_count() == 0:
            return  # no subscriber yet: the command would be lost
        msg = Twist()
        # TODO 5: what happens in each state? "begin": request the yellow pen as soon as both services are ready.
        # "first arc": half a circle to the left in TICKS calls; then request the turtle "painter" from /spawn.
        # "second arc": half a circle to the right. In all other states, stand still.
        self.publisher.publish(msg)

    def ask_for_pen(self, red, green, blue, callback):
        request = SetPen.Request()
        request.r, request.g, request.b, request.width = red, green, blue, 4
        # TODO 6: make the call without waiting, and let rclpy call `callback` when the response arrives.

    # TODO 7: for each response, write a method that begins the next task. Your numbers are in my_numbers_08.toml.


def main(args=None):
    rclpy.init(args=args)
    node = TwoPensNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
