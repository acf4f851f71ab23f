"""Look to the left and to the right, again and again, until somebody asks to stop."""

import math

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import Trigger
from turtlesim.action import RotateAbsolute

# BEGIN SOLUTION
LEFT = math.radians(85)  # rad
RIGHT = math.radians(-80)  # rad
# END SOLUTION
# BEGIN STARTER
# LEFT = math.radians(45)  # rad; TODO 3: your left_deg and right_deg from my_numbers_10.toml
# RIGHT = math.radians(-45)  # rad
# END STARTER


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
        # BEGIN SOLUTION
        if self.goal is not None and self.remaining is not None:
            self.get_logger().info(f"{self.remaining:.2f} rad to go")
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 7: while there is a goal, log the number from the last feedback, as in "1.25 rad to go".
        # END STARTER

    def turn(self):
        # BEGIN SOLUTION
        goal = RotateAbsolute.Goal()
        goal.theta = self.heading
        future = self.client.send_goal_async(goal, feedback_callback=self.feedback_received)
        future.add_done_callback(self.goal_accepted)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 4: send a goal with the heading self.heading, without waiting. Pass two methods: one for the feedback,
        # # and one for the response to the goal.
        # pass
        # END STARTER

    def goal_accepted(self, future):
        # BEGIN SOLUTION
        self.goal = future.result()
        self.goal.get_result_async().add_done_callback(self.goal_ended)
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 5: store the goal handle, and request the result without waiting.
        # pass
        # END STARTER

    def feedback_received(self, message):
        # BEGIN SOLUTION
        self.remaining = message.feedback.remaining
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 7: store the number that message.feedback contains.
        # pass
        # END STARTER

    def goal_ended(self, future):
        # BEGIN SOLUTION
        self.goal = None
        self.remaining = None
        if future.result().status != GoalStatus.STATUS_SUCCEEDED:
            self.get_logger().info("stopped")
            return
        self.heading = RIGHT if self.heading == LEFT else LEFT
        self.turn()
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 6: the goal has ended. If it succeeded, send the next goal, on the other side.
        # pass
        # END STARTER

    def stop(self, request, response):
        # BEGIN SOLUTION
        response.success = self.goal is not None
        response.message = "stopping" if response.success else "there is nothing to stop"
        if self.goal is not None:
            self.goal.cancel_goal_async()
        # END SOLUTION
        # BEGIN STARTER
        # # TODO 8: if there is a goal, cancel it, without waiting. The response shows whether there was a goal.
        # END STARTER
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
