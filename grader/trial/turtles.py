"""The tracks of the turtles other than turtle1, and the changes to the turtles' pens, up to a limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.trial.observed import PenChange, Track

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.turtlesim.turtle import Pen
    from grader.turtlesim.world import World

MOST_ROWS = 100_000
"""The maximum number of rows in all tracks together, not counting the tracks of the targets."""
MOST_CHANGES = 2000


class TurtleWatch:
    """Records the changes to turtles and pens, frame by frame."""

    def __init__(self, targets: Iterable[str] = ()) -> None:
        """Create an empty log. The `targets` are always recorded, however many other turtles there are."""
        self._targets = frozenset(targets)
        self._pens: dict[str, Pen] = {}
        self._changes: list[PenChange] = []
        self._rows: dict[str, list[tuple[float, float, float, float]]] = {}
        self._tracks: list[tuple[str, list[tuple[float, float, float, float]], float | None]] = []
        self._count = 0

    def look(self, now_s: float, world: World) -> None:
        """Record the changes since the last frame."""
        for name, turtle in world.turtles.items():
            if self._pens.get(name) is not turtle.pen:
                if name in self._pens and len(self._changes) < MOST_CHANGES:
                    pen = turtle.pen
                    self._changes.append(PenChange(now_s, name, pen.color, pen.width, pen.down))
                self._pens[name] = turtle.pen
            if name in self._targets or (name != "turtle1" and self._count < MOST_ROWS):
                rows = self._rows.setdefault(name, [])
                if not rows or rows[-1][1:] != (turtle.x, turtle.y, turtle.theta):
                    rows.append((now_s, turtle.x, turtle.y, turtle.theta))
                    self._count += name not in self._targets
        if len(self._pens) > len(world.turtles):
            for name in set(self._pens) - set(world.turtles):
                del self._pens[name]
                if name in self._rows:
                    self._tracks.append((name, self._rows.pop(name), now_s))

    @property
    def pens(self) -> tuple[PenChange, ...]:
        """The changes to the pens, in order."""
        return tuple(self._changes)

    @property
    def tracks(self) -> tuple[Track, ...]:
        """The tracks of the turtles other than turtle1: first all turtles that were removed, then the rest."""
        alive = [(name, rows, None) for name, rows in self._rows.items()]
        return tuple(Track(name, tuple(rows), gone_s) for name, rows, gone_s in [*self._tracks, *alive])
