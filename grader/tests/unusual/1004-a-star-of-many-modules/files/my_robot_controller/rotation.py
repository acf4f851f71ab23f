"""The action rotate_absolute as a method with a callback."""

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from turtlesim.action import RotateAbsolute


class Rotation:
    def __init__(self, node):
        self._client = ActionClient(node, RotateAbsolute, "/turtle1/rotate_absolute")

    @property
    def ready(self):
        return self._client.server_is_ready()

    def turn_to(self, heading, then):
        def accepted(future):
            future.result().get_result_async().add_done_callback(ended)

        def ended(future):
            if future.result().status == GoalStatus.STATUS_SUCCEEDED:
                then()

        self._client.send_goal_async(RotateAbsolute.Goal(theta=heading)).add_done_callback(accepted)
