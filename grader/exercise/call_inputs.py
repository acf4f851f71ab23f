"""The inputs of the calls in a trial without a simulator: points, and bags with poses on a circle."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.lazy import np

if TYPE_CHECKING:
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Arc:
    """`count` points on a circle, evenly spaced from `from_deg` to `to_deg` (counter-clockwise from east).

    The centre and the radius are in m. `noise_m` is the standard deviation of each coordinate (m).
    """

    x_m: float
    y_m: float
    radius_m: float
    from_deg: float
    to_deg: float
    count: int
    noise_m: float

    def points(self, name: str, seed: int) -> tuple[Floats, Floats]:
        """Return x and y (m), each of shape (count,). The random noise depends on `seed` and `name`."""
        angle = self.angles()
        noise = np.random.default_rng([seed, zlib.crc32(name.encode())]).normal(0.0, self.noise_m, (2, self.count))
        x = self.x_m + self.radius_m * np.cos(angle) + noise[0]
        y = self.y_m + self.radius_m * np.sin(angle) + noise[1]
        return x, y

    def angles(self) -> Floats:
        """Return the angles of the points (rad)."""
        radians: Floats = np.radians(np.linspace(self.from_deg, self.to_deg, self.count))
        return radians

    def deviations(self) -> tuple[float, float, float]:
        """Return the standard deviations (m) of centre x, centre y and radius of a circle that is fitted to the points.

        The deviations follow from the noise through the Cramér-Rao bound, as in Chernov, "Circular and Linear
        Regression" (2010), section 7.2.
        """
        angle = self.angles()
        slopes = np.column_stack((np.cos(angle), np.sin(angle), np.ones_like(angle)))
        x, y, radius = (float(each) for each in self.noise_m * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes))))
        return x, y, radius


@dataclass(frozen=True)
class PointsInput:
    """One call to a function with the coordinates x and y (m) of points, which are on an arc or are listed one by one.

    If `lists` is set, the function gets lists instead of arrays.
    """

    id: str
    arc: Arc | None = None
    x: tuple[float, ...] = ()
    y: tuple[float, ...] = ()
    lists: bool = False


@dataclass(frozen=True)
class BagInput:
    """One run of a program that takes the path of a bag as its argument: "bags/" and the id.

    The bag contains poses of turtle1 on an arc, at a mean rate of `rate_hz`, and `commands` velocity commands in the
    same period. If `poses` is false, the bag contains only the commands.
    """

    id: str
    arc: Arc
    rate_hz: float
    commands: int = 0
    poses: bool = True


@dataclass(frozen=True)
class CallsSpec:
    """The calls in a trial without a simulator: to a function ("package.module:function") or to the executable."""

    function: str = ""
    points: tuple[PointsInput, ...] = ()
    bags: tuple[BagInput, ...] = ()

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all calls, in order."""
        return (*(each.id for each in self.points), *(each.id for each in self.bags))

    def __bool__(self) -> bool:
        """Return whether there are any calls."""
        return bool(self.points or self.bags)


NO_CALLS = CallsSpec()
