"""The student's bag: it can be read, and shows the right circle."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.recorded_bag import CIRCLE
from grader.tests import made_bag
from grader.tests.checks.bag_step import judged
from grader.tests.checks.made import evidence, found, submission
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from pathlib import Path

    from grader.trial.recording import Message


@pytest.mark.parametrize(
    ("check", "messages", "diagnosis"),
    [
        ("bag-circle", made_bag.poses(), None),
        ("bag-circle", made_bag.poses(drive_s=0.0), "bag-still"),
        ("bag-circle", made_bag.poses(drive_s=5.0), "too-short"),
        ("bag-circle", made_bag.poses(1.5, drive_s=13.0), "wrong-radius"),
        ("bag-circle", made_bag.poses(speed=1.0), "wrong-speed"),
        ("bag-circle", [*made_bag.poses(), *made_bag.poses(2.2, drive_s=20.0)], "not-round"),
        ("bag-topic", made_bag.commands(), "bag-topic"),
        ("bag", [], "bag-empty"),
    ],
)
def test_a_bag_has_a_cause(check: str, messages: list[Message], diagnosis: str | None, tmp_path: Path) -> None:
    made_bag.record(tmp_path / "circle_bag", messages)
    files = {f"circle_bag/{file.name}": file.read_bytes() for file in (tmp_path / "circle_bag").iterdir()}
    finding = judged(check, files=files)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)


@pytest.mark.parametrize(
    ("check", "messages", "words"),
    [
        ("bag", made_bag.poses()[:1], "The bag contains 1 message."),
        ("bag-topic", made_bag.commands()[:1], "The bag contains /turtle1/cmd_vel (1 message)."),
        ("bag-topic", [], "The bag contains no topics."),
    ],
)
def test_the_messages_are_counted(check: str, messages: list[Message], words: str, tmp_path: Path) -> None:
    assert judged(check, files=bag_of(messages, tmp_path)).observed == words


def bag_of(messages: list[Message], to: Path) -> dict[str, bytes]:
    made_bag.record(to / "circle_bag", messages)
    return {f"circle_bag/{file.name}": file.read_bytes() for file in (to / "circle_bag").iterdir()}


WHOLE = made_bag.poses()
SHORT = made_bag.poses(drive_s=5.0)
TWO = [each for pair in zip(WHOLE, made_bag.poses(drive_s=0.0, end_s=10.0), strict=False) for each in pair]
CUT = made_bag.poses(drive_s=5.0, begin_s=0.0)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The bag shows 0.58 turns.", SHORT, WHOLE),
        ("The turtle stopped before the turn was complete.", SHORT, CUT),
        ("The recording began too late, or ended too early.", CUT, SHORT),
        ("The bag shows 1.1 turns on a circle with a radius of 1.10 m.", WHOLE, SHORT),
        ("In the bag, the turtle stays in one place.", made_bag.poses(drive_s=0.0), made_bag.commands()),
        ("The bag contains fewer than two poses on /turtle1/pose.", made_bag.commands(), made_bag.poses(drive_s=0.0)),
        ("The turtle did not drive during the recording.", made_bag.poses(drive_s=0.0), SHORT),
        ("/turtle1/pose has 125 poses per second in the bag.", TWO, WHOLE),
        ("One turtlesim publishes 62.5 poses per second, so more than one was running.", TWO, WHOLE),
        (
            "The bag must show only one circle: no wall, no teleport",
            [*WHOLE, *made_bag.poses(2.2, drive_s=20.0)],
            SHORT,
        ),
        ("The circle in the bag has a radius of 1.50 m.", made_bag.poses(1.5, drive_s=13.0), SHORT),
        ("The turtle drives at 1.00 m/s in the bag.", made_bag.poses(speed=1.0), SHORT),
        ("The speed is linear.x of the commands. Compare the speed with", made_bag.poses(speed=1.0), SHORT),
    ],
)
def test_a_sentence_about_the_circle_is_true(
    words: str, true: list[Message], near: list[Message], tmp_path: Path
) -> None:
    assert words in told(judged("bag-circle", files=bag_of(true, tmp_path)))
    assert words not in told(judged("bag-circle", files=bag_of(near, tmp_path)))


@pytest.mark.parametrize(("turns", "words"), [(1.0, "at least 1 turn on"), (2.0, "at least 2 turns on")])
def test_the_requested_number_of_turns_is_told(turns: float, words: str, tmp_path: Path) -> None:
    given = evidence(package=submission(dict(bag_of(WHOLE, tmp_path))))
    assert words in told(found(CIRCLE, given, bag="circle_bag", radius_m=3.0, turns=turns))


def test_the_type_of_the_topic_is_told(tmp_path: Path) -> None:
    words = "/turtle1/pose has the type geometry_msgs/msg/Twist in the bag."
    other = [replace(each, topic="/turtle1/pose") for each in made_bag.commands()]
    assert words in told(judged("bag-topic", files=bag_of(other, tmp_path)))
    assert words not in told(judged("bag-topic", files=bag_of(made_bag.commands(), tmp_path)))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The bag contains 688 messages.", None, {"metadata.yaml": None}),
        ("circle_bag has no metadata.yaml.", {"metadata.yaml": None}, {}),
        ("metadata.yaml is written when you end the recording", {"metadata.yaml": None}, {"circle_bag.mcap": b"x"}),
        ("circle_bag cannot be read: ", {"circle_bag.mcap": b"x"}, {}),
        ("Delete the folder, and record again.", {"circle_bag.mcap": b"x"}, {"metadata.yaml": None}),
        (
            "circle_bag contains circle_bag_0.db3 but no .mcap file.",
            {"circle_bag.mcap": None, "circle_bag_0.db3": b"x"},
            {"circle_bag.mcap": None},
        ),
        ("The messages in circle_bag.mcap are compressed.", {"metadata.yaml": b"  compression_mode: message\n"}, {}),
        (
            "The folder circle_bag next to package.xml contains a bag with at least one message.",
            {"metadata.yaml": None},
            {},
        ),
    ],
)
def test_a_sentence_about_the_files_of_a_bag_is_true(
    words: str, true: dict[str, bytes | None] | None, near: dict[str, bytes | None], tmp_path: Path
) -> None:
    made = bag_of(WHOLE, tmp_path)

    def about(changes: dict[str, bytes | None]) -> str:
        given = {**made, **{f"circle_bag/{name}": data for name, data in changes.items()}}
        return told(judged("bag", files={path: data for path, data in given.items() if data is not None}))

    assert words in about(true or {})
    assert words not in about(near)


@pytest.mark.parametrize(("elsewhere", "found"), [(False, True), (True, False)])
def test_a_bag_that_is_missing_is_told_from_a_bag_elsewhere(tmp_path: Path, elsewhere: bool, *, found: bool) -> None:
    moved = {path.replace("circle_bag/", "other/"): data for path, data in bag_of(WHOLE, tmp_path).items()}
    given = told(judged("bag", files=moved if elsewhere else {}, has_bag=False))
    assert ("There is no folder circle_bag." in given) == found
    assert ("`ros2 bag record` creates the bag in the current folder." in given) == found
    assert ("There is no bag in circle_bag, but other/" in given) != found


def test_an_empty_bag_is_told(tmp_path: Path) -> None:
    empty, one = (told(judged("bag", files=bag_of(each, tmp_path))) for each in ([], WHOLE[:1]))
    for words in (
        "The bag circle_bag is empty.",
        "The recording ended before anything arrived, or no node published on the topics that were recorded.",
    ):
        assert words in empty
        assert words not in one
