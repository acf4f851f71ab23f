"""Functions that test_in_order.py runs in a process with ROS 2. Each requests several calls before any can begin."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from grader.ros.in_order import InOrder
from grader.turtlesim.programs import turtle_teleop_key
from grader.turtlesim.programs.teleop_keys import Drive, Turn
from grader.view.system import Ears

if TYPE_CHECKING:
    from collections.abc import Callable


def _spun(executor: SingleThreadedExecutor, made: list[Any], wanted: int) -> list[Any]:
    while len(made) < wanted:
        executor.spin_once()
    return made


def begun() -> list[int]:
    """Return the order of calls of functions and of coroutines."""
    rclpy.init()
    executor = SingleThreadedExecutor()
    calls = InOrder(executor)
    made: list[int] = []

    async def later(number: int) -> None:
        made.append(number)

    for number in range(6):
        calls.call(later if number % 2 else made.append, number)
    return _spun(executor, made, 6)


def driven() -> list[float]:
    """Return the speeds (m/s) that a view passes to its driving node, for a key that is held and released."""
    rclpy.init()
    ears: Any = Ears(Node("view"), lambda _: None, lambda: False)
    made: list[float] = []

    async def drive(_: str, key: Drive) -> None:
        made.append(key.linear)

    ears._drive = drive
    for speed in (1.0, 2.0, 0.0):
        ears.drive("/turtle1", Drive(speed, 0.0))
    return _spun(ears._executor, made, 3)


def typed() -> list[float | None]:
    """Return the headings (rad) of the turns that turtle_teleop_key begins for G, R and F in one read; None cancels."""
    rclpy.init()
    executor = SingleThreadedExecutor()
    made: list[float | None] = []

    class Told:
        async def turn(self, key: Turn) -> None:
            made.append(round(key.theta, 2))

        async def cancel(self) -> None:
            made.append(None)

    data = iter([b"grf"])
    follow: Callable[..., None] = turtle_teleop_key._follow
    follow(lambda: next(data, None), Told(), InOrder(executor))
    return _spun(executor, made, 3)
