from functools import partial
from itertools import repeat
from math import atan2, cos, hypot, pi, sin

from my_robot_controller.player import play


def circle_program(player):
    yield from repeat((1.8, -1.0))


def eight_program(player, ticks=35, period=0.1):
    w = 2 * pi / (ticks * period)
    for side in (1, -1):
        yield from repeat((w, side * w), ticks)


def square_program(player, ticks=10, period=0.1):
    for _ in range(4):
        yield from repeat((2.0 / (ticks * period), 0.0), ticks)
        yield from repeat((0.0, -pi / 2 / (ticks * period)), ticks)


def goal_program(player, x=8.5, y=2.5):
    while player.pose is None:
        yield 0.0, 0.0
    while (away := hypot(x - player.pose.x, y - player.pose.y)) > 0.04:
        off = atan2(y - player.pose.y, x - player.pose.x) - player.pose.theta
        off = atan2(sin(off), cos(off))
        yield max(0.0, cos(off)) ** 3 * min(2.0, 1.5 * away), 3.0 * off


circle = partial(play, "own_circle", 1 / 2.0, circle_program)
eight = partial(play, "figure_eight", 0.1, eight_program)
square = partial(play, "draw_square", 0.1, square_program)
goal = partial(play, "go_to_goal", 0.1, goal_program)
