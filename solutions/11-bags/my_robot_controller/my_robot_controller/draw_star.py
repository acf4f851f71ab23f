"""Draw a star: an action turns the turtle, and commands drive it."""

import math

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.action import RotateAbsolute

# BEGIN SOLUTION
SIDE = 2.3  # m
FIRST = math.radians(10)  # rad: the heading of the first side
# END SOLUTION
# BEGIN STARTER
# SIDE = 1.0  # m; TODO 9: your side_m and first_deg from my_numbers_10.toml
# FIRST = math.radians(0)  # rad: the heading of the first side
# END STARTER
SIDES = 5
CORNER = math.radians(144)  # rad: the turn from one side to the next
TICKS = 10  # calls of the timer in one side
PERIOD = 0.1  # s


class DrawStarNode(Node):
    """Turns, drives a side, and so on, until the star is complete."""

    def __init__(self):
        super().__init__("draw_star")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.client = ActionClient(self, RotateAbsolute, "/turtle1/rotate_absolute")
        self.timer = self.create_timer(PERIOD, self.step)
        self.state = "corner"
        self.sides = 0
        self.ticks = 0

    def step(self):
        if self.publisher.get_subscription_count() == 0 or not self.client.server_is_ready():
            return  # no subscriber or no action server yet
        # BEGIN SOLUTION
        if self.state == "corner":
            self.state = "turn"
            self.turn()
        elif self.state == "drive":
            self.drive(SIDE / (TICKS * PERIOD))
            self.ticks += 1
            if self.ticks == TICKS:
                self.state = "end of the side"
        elif self.state == "end of the side":
            self.drive(0.0)
            self.ticks = 0
            self.sides += 1
            self.state = "corner" if self.sides < SIDES else "done"
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 10: what happens in each state? "corner": send the goal, once. "turn": nothing at all; a command would
        # # abort the goal. "drive": publish the speed TICKS times, then zeros once, then the next corner or the end.
        # END STARTER

    def drive(self, speed):
        msg = Twist()
        msg.linear.x = speed
        self.publisher.publish(msg)

    def turn(self):
        # BEGIN SOLUTION
        goal = RotateAbsolute.Goal()
        goal.theta = FIRST + self.sides * CORNER
        self.client.send_goal_async(goal).add_done_callback(self.goal_accepted)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 11: send the goal for the next side, and request its result, as in lookout.py.
        # pass
        # END STARTER
        # BEGIN SOLUTION

    def goal_accepted(self, future):
        future.result().get_result_async().add_done_callback(self.goal_ended)

    def goal_ended(self, future):
        if future.result().status == GoalStatus.STATUS_SUCCEEDED:
            self.state = "drive"
        # END SOLUTION
        # BEGIN STARTER

    # # TODO 12: when the goal has succeeded, drive.
    # END STARTER


def main(args=None):
    rclpy.init(args=args)
    node = DrawStarNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
