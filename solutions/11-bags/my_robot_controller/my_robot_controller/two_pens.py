"""Draw two arcs in two colours, and spawn a second turtle in between."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.srv import SetPen, Spawn

# BEGIN SOLUTION
RADIUS = 1.2  # m
# END SOLUTION
# BEGIN STARTER
# RADIUS = 1.0  # m; TODO 3: your radius_m from my_numbers_08.toml
# END STARTER
TICKS = 30  # calls of the timer in one arc
PERIOD = 0.1  # s
TURN = math.pi / (TICKS * PERIOD)  # rad/s: an arc is half a circle


class TwoPensNode(Node):
    """Sets a pen, draws an arc, spawns a turtle, sets another pen, draws an arc, and stops."""

    def __init__(self):
        super().__init__("two_pens")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.pen = self.create_client(SetPen, "/turtle1/set_pen")
        # BEGIN SOLUTION
        self.spawn = self.create_client(Spawn, "/spawn")
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 4: create a client for the service /spawn. Which type does it have?
        # END STARTER
        self.timer = self.create_timer(PERIOD, self.step)
        self.state = "begin"
        self.ticks = 0

    def step(self):
        if self.publisher.get_subscription_count() == 0:
            return  # no subscriber yet: the command would be lost
        msg = Twist()
        # BEGIN SOLUTION
        if self.state == "begin":
            if self.pen.service_is_ready() and self.spawn.service_is_ready():
                self.state = "wait"
                self.ask_for_pen(255, 220, 0, self.first_pen_is_set)
        elif self.state == "first arc":
            msg.linear.x, msg.angular.z = RADIUS * TURN, TURN
            self.ticks += 1
            if self.ticks == TICKS:
                self.state = "first arc is done"
        elif self.state == "first arc is done":
            self.state = "wait"
            self.ask_for_turtle()
        elif self.state == "second arc":
            msg.linear.x, msg.angular.z = RADIUS * TURN, -TURN
            self.ticks += 1
            if self.ticks == TICKS:
                self.state = "done"
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 5: what happens in each state? "begin": request the yellow pen as soon as both services are ready.
        # # "first arc": half a circle to the left in TICKS calls; then request the turtle "painter" from /spawn.
        # # "second arc": half a circle to the right. In all other states, stand still.
        # END STARTER
        self.publisher.publish(msg)

    def ask_for_pen(self, red, green, blue, callback):
        request = SetPen.Request()
        request.r, request.g, request.b, request.width = red, green, blue, 4
        # BEGIN SOLUTION
        self.pen.call_async(request).add_done_callback(callback)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 6: make the call without waiting, and let rclpy call `callback` when the response arrives.
        # END STARTER
        # BEGIN SOLUTION

    def first_pen_is_set(self, future):
        self.state = "first arc"

    def ask_for_turtle(self):
        request = Spawn.Request()
        request.x, request.y, request.theta, request.name = 2.0, 9.0, 0.0, "painter"
        self.spawn.call_async(request).add_done_callback(self.turtle_is_there)

    def turtle_is_there(self, future):
        self.get_logger().info(f"Spawned {future.result().name}")
        self.ask_for_pen(90, 180, 60, self.second_pen_is_set)

    def second_pen_is_set(self, future):
        self.ticks = 0
        self.state = "second arc"
        # END SOLUTION
        # BEGIN STARTER

    # # TODO 7: for each response, write a method that begins the next task. Your numbers are in my_numbers_08.toml.
    # END STARTER


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
