"""Look to the left and to the right, again and again, until somebody asks to stop."""

import math

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import Trigger
from turtlesim.action import RotateAbsolute

LEFT = math.radians(45)  # rad; TODO 3: your left_deg and right_deg from my_numbers_10.toml
RIGHT = math.radians(-45)  # rad


class LookoutNode(Node):
    """Sends one goal after the other, and reports how far the turtle still has to turn."""

    def __init__(self):
        super().__init__("lookout")
        self.client = ActionClient(self, RotateAbsolute, "/turtle1/rotate_absolute")
        self.service = self.create_service(Trigger, "/stop", self.stop)
        self.timer = self.create_timer(0.5, self.look)
        self.begun = False
        self.heading = LEFT
        self.goal = None  # the handle of the goal that the turtle follows, or None
        self.remaining = None  # rad, from the last feedback

    def look(self):
        if not self.begun and self.client.server_is_ready():
            self.begun = True
            self.turn()
        # TODO 7: while there is a goal, log the number from the last feedback, as in "1.25 rad to go".

    def turn(self):
        # TODO 4: send a goal with the heading self.heading, without waiting. Pass two methods: one for the feedback,
        # and one for the response to the goal.
        pass

    def goal_accepted(self, future):
        # TODO 5: store the goal handle, and request the result without waiting.
        pass

    def feedback_received(self, message):
        # TODO 7: store the number that message.feedback contains.
        pass

    def goal_ended(self, future):
        # TODO 6: the goal has ended. If it succeeded, send the next goal, on the other side.
        pass

    def stop(self, request, response):
        # TODO 8: if there is a goal, cancel it, without waiting. The response shows whether there was a goal.
        return response


def main(args=None):
    rclpy.init(args=args)
    node = LookoutNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
