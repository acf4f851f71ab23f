"""The targets in a recording (the turtles other than turtle1): their places and the announced names."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.lazy import np
from grader.evidence import activity

if TYPE_CHECKING:
    from grader.trial.observed import Track
    from grader.trial.recording import Recording

STRING = "std_msgs/msg/String"
HEADER = 8
"""The number of bytes before the characters of a String: the CDR header and the length (uint32)."""


@dataclass(frozen=True)
class Announcement:
    """The text of a String message on a topic, and the arrival time of the message (s)."""

    t_s: float
    text: str

    @property
    def names(self) -> list[str]:
        """The announced names, which are separated by spaces in the text."""
        return self.text.split()


def announcements(recording: Recording, topic: str) -> list[Announcement]:
    """Return the String messages on the topic before the end of the scenario, in order."""
    until = activity.end_s(recording)
    return [
        Announcement(message.t_s, _text(message.data))
        for message in recording.messages
        if message.topic == topic and message.type == STRING and message.t_s < until
    ]


def _text(data: bytes) -> str:
    """Return the characters of a serialized String. In CDR, the length of a String includes a zero byte at the end."""
    if len(data) < HEADER:
        return ""
    (length,) = struct.unpack_from("<I", data, HEADER - 4)
    return data[HEADER : HEADER + length].rstrip(b"\0").decode("utf-8", "replace")


def place_of_turtle1(recording: Recording, t_s: float) -> tuple[float, float]:
    """Return the position of turtle1 at this time: x and y (m)."""
    frames = recording.frames
    if not len(frames.t_s):
        return recording.start.x, recording.start.y
    index = min(int(np.searchsorted(frames.t_s, t_s)), len(frames.t_s) - 1)
    return float(frames.x[index]), float(frames.y[index])


def place_at(track: Track, t_s: float) -> tuple[float, float]:
    """Return the position of a target at this time: x and y (m)."""
    before = [row for row in track.rows if row[0] <= t_s] or [track.rows[0]]
    return before[-1][1], before[-1][2]


def distance_m(recording: Recording, track: Track, t_s: float) -> float:
    """Return the distance between turtle1 and a target at this time (m)."""
    (x, y), (to_x, to_y) = place_of_turtle1(recording, t_s), place_at(track, t_s)
    return math.hypot(to_x - x, to_y - y)


def is_there(track: Track, from_s: float, to_s: float) -> bool:
    """Return whether the target existed at any time between these two times (s)."""
    return track.rows[0][0] <= to_s and (track.gone_s is None or track.gone_s >= from_s)


def moved_targets(recording: Recording) -> list[Track]:
    """Return the turtles other than turtle1 that did not stay where they appeared."""
    return [track for track in recording.tracks if len({row[1:] for row in track.rows}) > 1]


def caught(recording: Recording) -> list[Track]:
    """Return the targets that were removed before the end of the scenario, in the order of their removal.

    A target that the trial withdrew before the node had caught it does not count.
    """
    until = activity.end_s(recording)
    tracks = (track for track in recording.tracks if track.turtle not in recording.withdrawn)
    return sorted(
        (track for track in tracks if track.gone_s is not None and track.gone_s <= until),
        key=lambda track: track.gone_s or 0.0,
    )
