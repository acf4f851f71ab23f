"""Checks of a bag that the student recorded: it can be read, contains the topic, and shows a circle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import a_list, count, shorten
from grader.evidence.circle_fit import fit_circle, turns_about
from grader.submission.bag_folder import Poses
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

BAG = "The folder of the bag in the package."
STILL_M = 0.05
"""A turtle that never leaves a square with sides of this length (m) has not moved."""
MOVES_M = 1e-4
"""The minimum distance (m) between two successive poses of a turtle that moves."""
FASTEST_HZ = 110.0
"""If the rate of the poses is higher than this (Hz), more than one turtlesim published them.

One turtlesim publishes 62.5 poses per second.
"""
SHORTEST_S = 2.0
ROUND_M = 0.05
"""The maximum deviation of the poses from the circle (m, root mean square)."""


@dataclass(frozen=True, kw_only=True)
class InBag:
    """The folder of the student's bag, inside the package."""

    bag: str = string("the name of a folder", about=BAG)


def readable(evidence: Evidence, params: InBag) -> Finding:
    """The bag exists, can be read, and contains messages."""
    bag, where = evidence.bag(params.bag), Where(params.bag)
    expected = f"The folder {params.bag} next to package.xml contains a bag with at least one message."
    if bag.problem == "missing":
        return failed(
            f"There is no folder {params.bag}.",
            expected,
            Cause("no-bag", "`ros2 bag record` creates the bag in the current folder."),
        )
    if bag.problem == "elsewhere":
        observed = f"There is no bag in {params.bag}, but {shorten(bag.detail)} belongs to a bag."
        cause = "The option -o sets the name of the bag, which is created in the current folder."
        return failed(observed, expected, Cause("bag-name", cause, Where(bag.detail)))
    if bag.problem == "unfinished":
        cause = (
            "metadata.yaml is written when you end the recording with Ctrl-C. If the recorder was killed, `ros2 bag "
            "reindex` writes the file."
        )
        return failed(f"{params.bag} has no metadata.yaml.", expected, Cause("bag-unfinished", cause, where))
    if bag.problem == "storage":
        cause = (
            "The default storage format of ROS 2 Jazzy is MCAP. Record without the options -s and --compression-mode."
        )
        observed = f"{params.bag} contains {shorten(bag.detail)} but no .mcap file."
        if bag.detail.endswith(".mcap"):
            observed = f"The messages in {shorten(bag.detail)} are compressed."
        return failed(observed, expected, Cause("bag-storage", cause, where))
    if bag.problem:
        cause = "Delete the folder, and record again."
        return failed(f"{params.bag} cannot be read: {bag.detail}.", expected, Cause("bag-damaged", cause, where))
    if not sum(bag.counts.values()):
        cause = "The recording ended before anything arrived, or no node published on the topics that were recorded."
        return failed(f"The bag {params.bag} is empty.", expected, Cause("bag-empty", cause, where))
    return passed(f"The bag contains {count(sum(bag.counts.values()), 'message')}.")


@dataclass(frozen=True, kw_only=True)
class TopicInBag(InBag):
    """The topic that the bag must contain, with the topic's type."""

    topic: str = string("a topic", start="/", about="The topic that must be in the bag.")
    type: str = string("a type", about="The type of the messages on the topic.")


def topic_in_bag(evidence: Evidence, params: TopicInBag) -> Finding:
    """The bag contains messages on the topic, which has the right type."""
    bag, where = evidence.bag(params.bag), Where(params.bag)
    expected = f"The bag contains {params.topic} with messages of type {params.type}."
    held = [f"{shorten(topic)} ({count(amount, 'message')})" for topic, amount in sorted(bag.counts.items())]
    observed = f"The bag contains {a_list(held) or 'no topics'}."
    if bag.types.get(params.topic, params.type) != params.type:
        observed = f"{params.topic} has the type {shorten(bag.types[params.topic])} in the bag."
        return failed(observed, expected, Cause("wrong-type", "", where))
    if not bag.counts.get(params.topic):
        cause = "The last arguments of `ros2 bag record` are the topics to record. Each topic begins with a slash."
        return failed(observed, expected, Cause("bag-topic", cause, where))
    return passed(observed)


@dataclass(frozen=True, kw_only=True)
class CircleInBag(InBag):
    """A circle that the turtle drives during the recording, at any speed if `speed_m_s` is 0."""

    topic: str = string("a topic", start="/", default="/turtle1/pose", about="The topic with the poses.")
    radius_m: float = number(above=0, about="The radius of the circle.")
    tolerance_percent: float = number(5.0, above=0, at_most=100, about="The maximum error in the radius.")
    speed_m_s: float = number(0.0, at_least=0, about="The speed of the turtle; 0 if any speed is right.")
    speed_tolerance_percent: float = number(8.0, above=0, at_most=100, about="The maximum error in the speed.")
    turns: float = number(1.0, above=0, about="The minimum number of turns in the bag.")


def circle_in_bag(evidence: Evidence, params: CircleInBag) -> Finding:
    """The poses in the bag make the required number of turns on a circle with the required radius and speed."""
    poses, where = evidence.bag(params.bag).poses.get(params.topic, Poses()), Where(params.bag)
    turns = "1 turn" if params.turns == 1.0 else f"{params.turns:g} turns"
    expected = f"The poses show at least {turns} on a circle with a radius of {params.radius_m:g} m."
    x, y = np.array(poses.x), np.array(poses.y)
    if len(x) < 2:
        return failed(
            f"The bag contains fewer than two poses on {params.topic}.", expected, Cause("bag-topic", where=where)
        )
    if max(np.ptp(x), np.ptp(y)) < STILL_M:
        cause = (
            "The turtle did not drive during the recording. Start the recording, then a node that drives the turtle."
        )
        return failed("In the bag, the turtle stays in one place.", expected, Cause("bag-still", cause, where))
    if _rate_hz(poses) > FASTEST_HZ:
        observed = f"{params.topic} has {_rate_hz(poses):.0f} poses per second in the bag."
        cause = "One turtlesim publishes 62.5 poses per second, so more than one was running. Stop the others."
        return failed(observed, expected, Cause("not-round", cause, where))
    circle = fit_circle(x, y)
    if circle is None or circle.rms > ROUND_M:
        cause = "The bag must show only one circle: no wall, no teleport and no other figure."
        return failed("The path in the bag is not a circle.", expected, Cause("not-round", cause, where))
    driven = abs(turns_about(x, y, circle.x, circle.y))
    if not Band.around(params.radius_m, params.radius_m * params.tolerance_percent / 100.0).holds(circle.radius):
        cause = "The radius is the speed divided by the turning speed. Compare the result with your numbers."
        observed = f"The circle in the bag has a radius of {circle.radius:.2f} m."
        return failed(observed, expected, Cause("wrong-radius", cause, where))
    if not driven >= params.turns - 0.01:
        steps = np.hypot(np.diff(x), np.diff(y))
        cause = "The turtle stopped before the turn was complete."
        if max(steps[0], steps[-1]) > MOVES_M:
            cause = "The recording began too late, or ended too early."
        return failed(f"The bag shows {driven:.2f} turns.", expected, Cause("too-short", cause, where))
    speed = _speed(poses)
    if params.speed_m_s and not Band.around(
        params.speed_m_s, params.speed_m_s * params.speed_tolerance_percent / 100.0
    ).holds(speed):
        cause = "The speed is linear.x of the commands. Compare the speed with your numbers."
        expected = f"{expected[:-1]}, at {params.speed_m_s:g} m/s."
        return failed(f"The turtle drives at {speed:.2f} m/s in the bag.", expected, Cause("wrong-speed", cause, where))
    return passed(f"The bag shows {driven:.1f} turns on a circle with a radius of {circle.radius:.2f} m.")


def _rate_hz(poses: Poses) -> float:
    """Return the mean rate of the poses (Hz), or 0 if the bag is so short that a delay may change the rate."""
    took_s = poses.t_s[-1] - poses.t_s[0]
    return (len(poses.t_s) - 1) / took_s if took_s > SHORTEST_S else 0.0


def _speed(poses: Poses) -> float:
    """Return the mean speed (m/s) from the first movement to the last."""
    steps = np.hypot(np.diff(poses.x), np.diff(poses.y))
    moving = np.nonzero(steps > MOVES_M)[0]
    if not len(moving):
        return 0.0
    took_s = poses.t_s[moving[-1] + 1] - poses.t_s[moving[0]]
    return float(np.sum(steps)) / took_s if took_s > 0 else math.inf


READABLE = Kind(
    "bag",
    "source",
    "The bag can be read",
    InBag,
    readable,
    about="A folder of the package contains a bag (uncompressed MCAP) that can be read, with at least one message and "
    "`metadata.yaml`.",
)
TOPIC = Kind(
    "bag_topic",
    "source",
    "The bag contains the topic",
    TopicInBag,
    topic_in_bag,
    about="The bag contains messages on the given topic, which has the given type.",
)
CIRCLE = Kind(
    "bag_circle",
    "source",
    "The bag shows a circle",
    CircleInBag,
    circle_in_bag,
    about="The poses in the bag lie on a circle with the given radius, make at least the given number of turns, and "
    "have the given speed.",
)
