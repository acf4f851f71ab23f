"""Draw a star with one coroutine, from the first corner to the last."""

import math

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from turtlesim.action import RotateAbsolute

SIDE = 2.3  # m
FIRST = 10  # degrees: the heading of the first side
SPEED = 2.3  # m/s
PERIOD = 0.1  # s


class Metronome:
    """Completes a new future in each call of a timer."""

    def __init__(self, node):
        self.beat = Future()
        node.create_timer(PERIOD, self.strike)

    def strike(self):
        beat, self.beat = self.beat, Future()
        beat.set_result(None)

    async def beats(self, number=1):
        for _ in range(number):
            await self.beat


class DrawStarNode(Node):
    def __init__(self):
        super().__init__("draw_star")
        self.pencil = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.compass = ActionClient(self, RotateAbsolute, "/turtle1/rotate_absolute")
        self.metronome = Metronome(self)

    async def draw(self):
        while not (self.compass.server_is_ready() and self.pencil.get_subscription_count()):
            await self.metronome.beats()
        for side in range(5):
            await self.face(math.radians(FIRST + 144 * side))
            await self.metronome.beats()  # a side lasts from beat to beat
            for _ in range(round(SIDE / SPEED / PERIOD)):
                self.pencil.publish(Twist(linear=Vector3(x=SPEED)))
                await self.metronome.beats()
            self.pencil.publish(Twist())
            await self.metronome.beats()

    async def face(self, heading):
        """Turn to a heading (rad). Try again if the turn was aborted."""
        status = None
        while status != GoalStatus.STATUS_SUCCEEDED:
            ticket = await self.compass.send_goal_async(RotateAbsolute.Goal(theta=heading))
            status = (await ticket.get_result_async()).status


def main(args=None):
    rclpy.init(args=args)
    node = DrawStarNode()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    executor.create_task(node.draw)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
