"""A node that announces the remaining turtles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.announcing import ANNOUNCES
from grader.tests.checks.made import found
from grader.tests.checks.spawner import CAUGHT_S, PLACES, catch, given, kill, names_at, said
from grader.tests.checks.told import told
from grader.trial.recording import ProcessEnd

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.trial.recording import Message


ENDED = ProcessEnd(by="itself", exit_code=0, t_s=5.6, stop_s=None)


def of_announces(given: Evidence) -> Finding:
    return found(ANNOUNCES, given, topic="/targets")


def diagnosis(finding: Finding) -> str | None:
    return finding.diagnosis


def test_right_announcements_pass() -> None:
    assert of_announces(given()).status is Status.PASSED


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("target1, target2, target3", "target-format"),
        ("target1 target2 target3 mouse", "still-announced"),
        ("target1", "target-unannounced"),
    ],
)
def test_wrong_announcements_are_named(text: str, expected: str) -> None:
    messages = (*(said(2.0 + 0.5 * number, names_at(2.0 + 0.5 * number)) for number in range(16)), said(2.1, text))
    assert diagnosis(of_announces(given(messages=messages))) == expected


def test_a_turtle_that_was_caught_is_no_longer_announced() -> None:
    every = tuple(said(1.0 + 0.5 * number, " ".join(PLACES)) for number in range(18))
    finding = of_announces(given(messages=every))
    assert finding.diagnosis == "still-announced"
    assert "contains target2, which no longer exists." in told(finding)
    assert "which no longer exists" not in told(of_announces(given()))


def test_a_turtle_that_does_not_exist_yet_is_not_announced() -> None:
    messages = tuple(said(0.25 + 0.5 * number, names_at(0.25 + 0.5 * number)) for number in range(20))
    finding = of_announces(given(messages=messages))
    assert finding.diagnosis == "still-announced"
    assert finding.observed == "The message at 0.2 s contains target1, which did not exist before 0.5 s."
    assert "A turtle exists when the response from /spawn arrives." in told(finding)
    assert "which did not exist before" not in told(of_announces(given()))


def test_a_node_that_has_ended_is_not_blamed_for_its_timer() -> None:
    messages = tuple(said(1.0 + 0.5 * number, names_at(1.0 + 0.5 * number)) for number in range(10))
    ended = of_announces(given(messages=messages, end=ENDED))
    assert ended.diagnosis == "ended-early"
    assert ended.observed.endswith("The node exited on its own after 5.6 s.")
    assert of_announces(given(messages=messages)).diagnosis == "timer-period"


def test_a_turtle_that_the_node_has_asked_to_remove_need_not_be_announced() -> None:
    late_s = CAUGHT_S + 0.4
    early = tuple(said(t_s, "target1" if t_s > CAUGHT_S else " ".join(PLACES)) for t_s in (1.0, 1.5, late_s - 0.2))
    gone = {"target2": late_s, "target3": late_s}
    asked = of_announces(given(calls=[catch(), kill("target3")], gone=gone, messages=early))
    assert diagnosis(asked) != "target-unannounced"
    assert diagnosis(of_announces(given(calls=[catch()], gone=gone, messages=early))) == "target-unannounced"


def test_a_turtle_is_announced_again_and_again() -> None:
    once = (said(1.0, names_at(1.0)), said(CAUGHT_S, names_at(CAUGHT_S)))
    assert diagnosis(of_announces(given(messages=once))) == "timer-period"


@pytest.mark.parametrize(("gone_s", "diagnosed"), [(4.2, "silent-when-empty"), (6.0, "timer-period")])
def test_a_node_is_silent_when_no_target_is_left(gone_s: float, diagnosed: str) -> None:
    early = tuple(said(1.0 + 0.5 * number, " ".join(PLACES)) for number in range(7))
    finding = of_announces(given(calls=[catch()], gone=dict.fromkeys(PLACES, gone_s), messages=early))
    assert diagnosis(finding) == diagnosed
    words = "At this time, there was no target. Even then, the node must publish a message with an empty string."
    assert (words in told(finding)) == (diagnosed == "silent-when-empty")


def test_a_node_that_is_silent_with_targets_too_has_a_wrong_timer() -> None:
    rare = tuple(said(t_s, " ".join(PLACES)) for t_s in (1.0, 2.5, 3.0, 3.5, 4.0))
    finding = of_announces(given(calls=[catch()], gone=dict.fromkeys(PLACES, 4.2), messages=rare))
    assert (diagnosis(finding), finding.observed[:27]) == ("timer-period", "After the message at 1.0 s,")


TIMES = [1.0 + 0.5 * number for number in range(18)]
RIGHT = tuple(said(t_s, names_at(t_s)) for t_s in TIMES)


def with_one(text: str, t_s: float = 2.1) -> tuple[Message, ...]:
    return (*(each for each in RIGHT if each.t_s < t_s), said(t_s, text), *(each for each in RIGHT if each.t_s > t_s))


NEVER_NAMED = tuple(said(t_s, "target1") for t_s in TIMES)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node announces the remaining targets.", RIGHT, RIGHT[:1]),
        ("Every 0.5 s, the node publishes the names of all remaining targets", RIGHT[:1], RIGHT),
        ("No String arrived on /targets.", (), RIGHT[:1]),
        (
            'The text consists of the names, separated by single spaces: " ".join(names).',
            with_one("target1,target2,target3"),
            with_one("target1 target2 target3 target9"),
        ),
        (
            'The text consists of the names, separated by single spaces: " ".join(names).',
            with_one("target1target2 target3"),
            with_one("mouse"),
        ),
        (
            "The message at 2.1 s contains target9, but there is no such target.",
            with_one("target1 target2 target3 target9"),
            with_one("target1 target2 target3"),
        ),
        (
            "turtle1 drives to the targets, so it is not a target itself.",
            with_one("turtle1 target1 target2 target3"),
            with_one("target1 target2 target3 target9"),
        ),
        (
            "Remove a name when its turtle is caught, and add a name when the response from /spawn arrives.",
            with_one("target1 target2 target3 target9"),
            with_one("target1 target2"),
        ),
        (
            "The message at 2.1 s does not contain target3.",
            with_one("target1 target2"),
            with_one("target1 target2 target3"),
        ),
        ("Add the name of a turtle to the list in the callback", NEVER_NAMED, with_one("target1 target2")),
        (
            "An earlier message contained target3, so the node has removed the name.",
            with_one("target1 target2"),
            NEVER_NAMED,
        ),
        ("After the message at 1.0 s, no message arrived for 9.0 s.", RIGHT[:1], RIGHT),
        ("Publish each time the timer fires.", RIGHT[:1], ()),
        (
            "Publish in the callback of one timer.",
            tuple(said(0.01 * number, names_at(0.01 * number)) for number in range(60, 990)),
            RIGHT[:1],
        ),
        (
            "930 messages arrived in 9.4 s.",
            tuple(said(0.01 * number, names_at(0.01 * number)) for number in range(60, 990)),
            RIGHT,
        ),
    ],
)
def test_a_sentence_about_announcements_is_true(
    words: str, true: tuple[Message, ...], near: tuple[Message, ...]
) -> None:
    assert words in told(of_announces(given(messages=true)))
    assert words not in told(of_announces(given(messages=near)))


LETTERS = "join puts spaces between the letters, because it got one string. It needs a list of names."


def with_text(text: str) -> str:
    messages = (*(said(2.0 + 0.5 * number, names_at(2.0 + 0.5 * number)) for number in range(16)), said(2.1, text))
    return told(of_announces(given(messages=messages)))


@pytest.mark.parametrize(
    ("text", "found_"), [("t a r g e t 1", True), ("target1", False), ("t a r", False), ("target 1", False)]
)
def test_a_name_in_letters_is_told(text: str, *, found_: bool) -> None:
    assert (LETTERS in with_text(text)) == found_


def test_a_name_with_a_space_has_the_wrong_format() -> None:
    assert "separated by single spaces" in with_text("target 1")
    assert "separated by single spaces" not in with_text("target1")
