"""Feedback in the log: lines that say how far the turtle still has to turn."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from grader.checks.subjects.feedback import LOG_FEEDBACK
from grader.report.scene import scene_of
from grader.tests.checks.goals import CLIENT, given, goal
from grader.tests.checks.made import DURATION_S, NODE_FILE, evidence, found, frames, recording, submission
from grader.tests.checks.told import told
from grader.trial.recording import Frames, LogLine, Pose
from grader.turtlesim.turtle import Start, normalize


def turning(from_s: float, until_s: float) -> Frames:
    """Return the frames of a turtle that turns left at 1 rad/s between two times."""
    still = frames([], Pose(*Start()), DURATION_S)
    theta = [normalize(min(max(t_s - from_s, 0.0), until_s - from_s)) for t_s in still.t_s.tolist()]
    return replace(still, theta=still.theta * 0.0 + theta)


@pytest.mark.parametrize(
    ("times", "text", "diagnosis"),
    [
        ((0.5, 1.0, 1.5, 2.0, 2.5), "{:.2f} rad to go", None),
        ((1.5,), "{:.2f} rad to go", "feedback-not-logged"),
        ([0.2 + 0.016 * index for index in range(150)], "{:.2f} rad to go", "every-message"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "-{:.2f} rad to go", "wrong-sign"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "{:.1f} rad to go", "log-numbers"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "1.25 rad to go", "stale-feedback"),
        ((0.5, 1.0, 1.5, 2.0, 2.5), "1{:.2f} rad to go", "wrong-feedback"),
    ],
)
def test_the_log_says_how_far_it_is(times: list[float], text: str, diagnosis: str | None) -> None:
    lines = tuple(LogLine(t_s, "INFO", "node", text.format(3.0 - t_s)) for t_s in times)
    trial = given(goal(0.0, math.degrees(3.0), 3.0), goal(3.0, 170.0, 3.1), log=lines, frames=turning(0.0, 3.0))
    finding = found(LOG_FEEDBACK, trial, format="{remaining:.2f} rad to go")
    assert finding.diagnosis == diagnosis


def test_feedback_without_a_callback_is_named() -> None:
    trial = evidence(
        recording([], goals=(goal(0.0, 80.0, 3.0),)), submission({NODE_FILE: CLIENT.replace(", self.heard", "")})
    )
    finding = found(LOG_FEEDBACK, trial, format="{remaining:.2f} rad to go")
    assert finding.diagnosis == "feedback-not-logged"
    assert "feedback_callback" in finding.cause


def test_a_picture_of_a_turtle_that_only_turned_says_so() -> None:
    scene = scene_of(given(goal(0.0, math.degrees(3.0), 3.0), frames=turning(0.0, 3.0)))
    assert scene.notice == "The turtle only turned."
    assert "1 goal: 1 succeeded" in scene.facts
    assert scene_of(given()).notice == "The turtle did not move."


TIMES = (0.5, 1.0, 1.5, 2.0, 2.5)


def about(
    text: str, times: tuple[float, ...] = TIMES, long: tuple[float, float] = (0.0, 3.0), code: str = CLIENT
) -> str:
    """Return what is reported if the node logs this text at these times, and the goal has this begin and end (s)."""
    lines = tuple(LogLine(t_s, "INFO", "node", text.format(3.0 - t_s)) for t_s in times)
    begin_s, end_s = long
    made = recording([], goals=(goal(begin_s, math.degrees(3.0), end_s),), log=lines, frames=turning(0.0, 3.0))
    return told(found(LOG_FEEDBACK, evidence(made, submission({NODE_FILE: code})), format="{remaining:.2f} rad to go"))


RIGHT = "{:.2f} rad to go"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The lines show how far the turtle still has to turn.", RIGHT, "-" + RIGHT),
        ("Log the number from the feedback unchanged.", "-" + RIGHT, "1" + RIGHT),
        ("At 0.5 s, the line shows 12.50, but the turtle still had to turn by 2.5", "1" + RIGHT, RIGHT),
        ("The message has a field feedback, which has the field remaining.", "1" + RIGHT, "1.25 rad to go"),
        ("The number never changes. Store the number in self", "1.25 rad to go", "1" + RIGHT),
        ("While the turtle turns, a line such as", "-" + RIGHT, RIGHT),
        ('The last log line during the goals is "2 rad', "2 rad to go", RIGHT),
    ],
)
def test_a_sentence_about_the_feedback_is_true(words: str, true: str, near: str) -> None:
    assert words in about(true)
    assert words not in about(near)


@pytest.mark.parametrize(("factor", "is_told"), [(math.degrees(1.0), True), (50.0, False)])
def test_degrees_are_told_if_all_lines_are_in_degrees(factor: float, *, is_told: bool) -> None:
    log = tuple(LogLine(t_s, "INFO", "node", f"{factor * (3.0 - t_s):.2f} rad to go") for t_s in TIMES)
    trial = given(goal(0.0, math.degrees(3.0), 3.0), log=log, frames=turning(0.0, 3.0))
    reported = told(found(LOG_FEEDBACK, trial, format="{remaining:.2f} rad to go"))
    assert ("The feedback is in radians, and the line must be in radians too." in reported) == is_told


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("No goal arrived at /turtle1/rotate_absolute.", None, (0.0, 0.9)),
        ("No goal lasted 1 s, so the log lines could not be judged.", (0.0, 0.9), (0.0, 3.0)),
    ],
)
def test_a_goal_that_is_too_short_for_a_line_is_told(
    words: str, true: tuple[float, float] | None, near: tuple[float, float]
) -> None:
    none = told(found(LOG_FEEDBACK, given(), format="{remaining:.2f} rad to go"))
    assert words in (none if true is None else about(RIGHT, long=true))
    assert words not in about(RIGHT, long=near)


def test_the_number_of_lines_is_told() -> None:
    many = tuple(0.2 + 0.016 * index for index in range(150))
    assert "150 lines with the feedback appeared while the turtle turned for 3.0 s." in about(RIGHT, many)
    assert "The feedback arrives 62.5 times per second." in about(RIGHT, many)
    few = about(RIGHT, TIMES[:1])
    assert "1 line with the feedback appeared while the turtle turned for 3.0 s." in few
    assert "Log the number in the callback of a timer while there is a goal." in few
    assert "The feedback arrives 62.5 times per second." not in few
    assert "with the feedback appeared" not in about(RIGHT)


def test_one_wrong_line_does_not_show_that_the_number_never_changes() -> None:
    one = about("1.25 rad to go", TIMES[:1])
    assert "The number never changes." not in one
    assert "The message has a field feedback, which has the field remaining." in one


UNHEARD = CLIENT.replace(", self.heard", "")


@pytest.mark.parametrize(
    ("text", "code", "found"), [("2 rad", UNHEARD, True), ("2 rad", CLIENT, False), (RIGHT, UNHEARD, False)]
)
def test_a_log_without_feedback_is_told(text: str, code: str, *, found: bool) -> None:
    given = about(text, code=code)
    assert ("The log has no line with the feedback." in given) == found
    assert ("Nothing in the node receives the feedback." in given) == found


@pytest.mark.parametrize(
    ("times", "stalls", "passes"),
    [
        ((0.5, 1.0, 1.5, 2.0, 2.5), (), True),
        ((0.7, 1.7, 2.7), (), False),
        ((0.7, 1.7, 2.7), ((1.0, 1.3),), False),
        ((0.7, 1.7, 2.7), ((1.0, 1.3), (2.0, 2.2)), True),
    ],
)
def test_the_time_between_two_lines_is_that_of_the_exercise_unless_the_machine_stalled(
    times: tuple[float, ...], stalls: tuple[tuple[float, float], ...], *, passes: bool
) -> None:
    lines = tuple(LogLine(t_s, "INFO", "node", f"{3.0 - t_s:.2f} rad to go") for t_s in times)
    made = recording([], goals=(goal(0.0, math.degrees(3.0), 3.0),), log=lines, frames=turning(0.0, 3.0))
    trial = evidence(replace(made, stalls=stalls), submission({NODE_FILE: CLIENT}))
    finding = found(LOG_FEEDBACK, trial, format="{remaining:.2f} rad to go")
    assert finding.diagnosis == (None if passes else "timer-period")


def test_only_the_lines_during_the_goals_count() -> None:
    assert "The node logged nothing during the goals." in about("2 rad", (3.5, 4.0))
    assert "The node logged nothing during the goals." not in about("2 rad", (2.5, 4.0))
