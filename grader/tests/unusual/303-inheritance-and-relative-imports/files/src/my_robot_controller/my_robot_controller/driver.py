"""What all drivers have in common."""

from __future__ import annotations

import abc

from geometry_msgs.msg import Twist
from rclpy.node import Node

from . import constants


class Driver(Node, metaclass=abc.ABCMeta):
    """Sends `command()` again and again."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._publisher = self.create_publisher(Twist, constants.TOPIC, 10)
        self._start_timer()

    def _start_timer(self) -> None:
        self._timer = self.create_timer(constants.PERIOD_S, self._tick)

    def _tick(self) -> None:
        self._publisher.publish(self.command())

    @abc.abstractmethod
    def command(self) -> Twist:
        """What to send now."""
