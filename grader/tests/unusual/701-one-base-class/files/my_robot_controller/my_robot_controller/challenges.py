"""The four challenges."""
import enum
import math
from pathlib import Path

import rclpy
from ament_index_python.packages import get_package_share_directory
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose


class Driver(Node):
    """Publishes what `command` returns, at a rate."""

    def __init__(self, name, rate=10.0):
        super().__init__(name)
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(1.0 / rate, self.publish_command)

    def publish_command(self):
        speeds = self.command()
        if speeds is not None:
            twist = Twist()
            twist.linear.x, twist.angular.z = map(float, speeds)
            self.publisher.publish(twist)

    def command(self):
        raise NotImplementedError

    @classmethod
    def main(cls, args=None):
        rclpy.init(args=args)
        try:
            rclpy.spin(cls())
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            rclpy.try_shutdown()


class OwnCircle(Driver):
    def __init__(self):
        share = Path(get_package_share_directory("my_robot_controller"))
        lines = (share / "my_numbers.toml").read_text(encoding="utf-8").splitlines()
        numbers = dict(line.split(" = ") for line in lines if " = " in line)
        self.radius = float(numbers["radius_m"])
        self.turn = 1.0 if numbers["direction"] == '"counter-clockwise"' else -1.0
        super().__init__("own_circle", rate=float(numbers["rate_hz"]))

    def command(self):
        return self.radius, self.turn


class FigureEight(Driver):
    """Two lobes of three seconds."""

    TICKS = 30

    def __init__(self):
        super().__init__("figure_eight")
        self.tick = 0

    def command(self):
        lobe, self.tick = self.tick // self.TICKS, self.tick + 1
        turn = 2 * math.pi / 3.0
        return {0: (turn, turn), 1: (turn, -turn)}.get(lobe, (0, 0))


class State(enum.Enum):
    SIDE = enum.auto()
    CORNER = enum.auto()
    DONE = enum.auto()


class DrawSquare(Driver):
    """Knows when to change its state by the node's clock."""

    def __init__(self):
        super().__init__("draw_square", rate=20.0)
        self.state, self.sides, self.until = State.SIDE, 0, None

    def command(self):
        now = self.get_clock().now().nanoseconds / 1e9
        if self.until is None:
            self.until = now + 1.0
        if now >= self.until - 0.01 and self.state is not State.DONE:
            self.until += 1.0
            if self.state is State.SIDE:
                self.sides, self.state = self.sides + 1, State.CORNER
            else:
                self.state = State.SIDE if self.sides < 4 else State.DONE
        if self.state is State.SIDE:
            return 2.0, 0.0
        return (0.0, math.pi / 2) if self.state is State.CORNER else (0.0, 0.0)


class GoToGoal(Driver):
    """Turns on the spot first, then drives straight on."""

    def __init__(self):
        super().__init__("go_to_goal")
        self.pose = None
        self.create_subscription(Pose, "/turtle1/pose", self.hear, 10)

    def hear(self, pose):
        self.pose = pose

    def command(self):
        if self.pose is None:
            return None
        dx, dy = 8.5 - self.pose.x, 2.5 - self.pose.y
        if math.hypot(dx, dy) < 0.05:
            return 0.0, 0.0
        error = math.remainder(math.atan2(dy, dx) - self.pose.theta, math.tau)
        if abs(error) > 0.1:
            return 0.0, 4.0 * error
        return min(2.0, 2.0 * math.hypot(dx, dy)), 4.0 * error


own_circle = OwnCircle.main
figure_eight = FigureEight.main
draw_square = DrawSquare.main
go_to_goal = GoToGoal.main
