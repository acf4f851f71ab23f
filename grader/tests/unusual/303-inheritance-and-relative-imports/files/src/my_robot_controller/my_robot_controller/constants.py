"""Numbers of the task."""

from typing import Final

NODE_NAME: Final = "draw_circle"
TOPIC: Final = "/turtle1/cmd_vel"
RATE_HZ: Final[float] = 2.0
PERIOD_S: Final[float] = 1.0 / RATE_HZ
RADIUS_M: Final[float] = 2.0
TURN_RAD_S: Final[float] = 1.0
SPEED_M_S: Final[float] = RADIUS_M * TURN_RAD_S
