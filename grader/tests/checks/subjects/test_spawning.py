"""A node that spawns turtles, and removes the turtles that were caught."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.spawning import PLACES_DIFFER, REMOVES, SPAWNS
from grader.tests.checks.made import NODE_FILE, found, submission
from grader.tests.checks.spawner import CAUGHT_S, PLACES, SPAWNER, catch, given, kill, said, spawn
from grader.tests.checks.told import told
from grader.trial.recording import ProcessEnd

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Call


def of_spawns(given: Evidence) -> Finding:
    return found(SPAWNS, given, turtles=3)


def of_removes(given: Evidence) -> Finding:
    return found(REMOVES, given, service="/catch", type="turtlesim/srv/Kill", topic="/targets")


def diagnosis(finding: Finding) -> str | None:
    return finding.diagnosis


def test_a_right_spawner_passes() -> None:
    for finding in (of_spawns(given()), of_removes(given())):
        assert finding.status is Status.PASSED, finding


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([spawn(0.5, "target1", 2.0, 3.0)], "target-count"),
        ([spawn(0.5, f"target{number}", 2.0, number) for number in range(1, 5)], "target-count"),
        ([spawn(0.5, "", 2.0, 3.0, response={"name": "turtle2"})], "target-name"),
        ([spawn(0.5, name, 0.0, 0.0) for name in PLACES], "target-place"),
        ([spawn(0.5, name, 3.0, 4.0) for name in PLACES], "target-place"),
        ([spawn(0.5, name, 3.0, 10.5) for name in PLACES], "target-place"),
    ],
)
def test_wrong_numbers_names_and_places_are_named(calls: list[Call], expected: str) -> None:
    assert diagnosis(of_spawns(given(calls=calls))) == expected


@pytest.mark.parametrize(
    ("calls", "gone"),
    [([catch()], {}), ([catch(), kill("")], {}), ([catch(), kill("target3")], {"target3": CAUGHT_S})],
)
def test_a_caught_target_that_was_not_removed_is_reported(calls: list[Call], gone: dict[str, float]) -> None:
    assert diagnosis(of_removes(given(calls=calls, gone=gone))) == "not-killed"


def test_a_node_that_has_ended_removes_nobody() -> None:
    ended = ProcessEnd(by="itself", exit_code=0, t_s=CAUGHT_S + 0.1, stop_s=None)
    finding = of_removes(given(calls=[catch()], gone={}, end=ended))
    assert finding.diagnosis == "ended-early"
    assert finding.observed.endswith("The node exited on its own after 5.1 s.")


def test_the_end_of_a_node_is_the_cause_even_if_its_response_got_lost() -> None:
    ended = ProcessEnd(by="itself", exit_code=0, t_s=CAUGHT_S + 0.1, stop_s=None)
    unanswered = replace(catch(), response=None, answered_s=None)
    assert diagnosis(of_removes(given(calls=[unanswered], gone={}, end=ended))) == "ended-early"
    assert diagnosis(of_removes(given(calls=[unanswered], gone={}))) == "no-response"


def test_a_target_that_was_removed_without_being_caught_is_reported() -> None:
    removed = of_removes(
        given(calls=[catch(), kill("target2"), kill("target3")], gone={"target2": CAUGHT_S, "target3": CAUGHT_S})
    )
    assert diagnosis(removed) == "killed-uncaught"
    assert removed.cause.startswith("/kill was called for target3")


def test_places_that_are_the_same_each_time_are_not_random() -> None:
    twice = given()
    finding = found(PLACES_DIFFER, twice, other=twice.trial.id)
    assert diagnosis(finding) == "target-place"
    assert "x=2.00, y=3.00 both times" in finding.observed
    assert found(PLACES_DIFFER, given(calls=[]), other=twice.trial.id).status is Status.SKIPPED
    other = found(PLACES_DIFFER, twice, other=twice.trial.id, name="prey")
    assert "no turtle whose name begins with prey was spawned." in other.observed


ALL = [spawn(0.5, name, *place) for name, place in PLACES.items()]
REFUSED = spawn(0.6, "target1", 5.0, 5.0, response={"name": ""})
UNANSWERED = spawn(9.9, "target3", 5.0, 5.0, response=None)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node spawned 3 turtles.", ALL, ALL[:2]),
        ("The node spawns 3 turtles, target1 to target3, in random places. x and y are from 1 to 10.", ALL[:2], ALL),
        ("The node never called /spawn.", [], ALL[:1]),
        (
            "The node spawned a turtle named mouse.",
            [spawn(0.5, "mouse", 2.0, 3.0)],
            [spawn(0.5, "target9", 2.0, 3.0)],
        ),
        ("The name is a field of the request.", [spawn(0.5, "mouse", 2.0, 3.0)], ALL[:2]),
        ("The node spawned 2 turtles: target1 and target2.", ALL[:2], ALL),
        ("The node spawned 0 turtles.", [REFUSED], ALL),
        (
            "turtlesim refused a name because another turtle already has it.",
            [*ALL[:2], REFUSED],
            [*ALL[:2], UNANSWERED],
        ),
        (
            "Count the requests when you send them",
            [*ALL, spawn(0.7, "target4", 5.0, 5.0), spawn(0.8, "target5", 5.0, 6.0)],
            ALL[:2],
        ),
        (
            "There is one request too many. Check the condition that limits the requests: should <= be <?",
            [*ALL, spawn(0.7, "target4", 5.0, 5.0)],
            [*ALL, spawn(0.7, "target1", 5.0, 5.0)],
        ),
        ("target2 is at x=7.50, y=10.50.", [ALL[0], spawn(0.5, "target2", 7.5, 10.5), ALL[2]], ALL),
        (
            "The field is about 11 m wide, and a turtle at the edge is hard to reach.",
            [ALL[0], spawn(0.5, "target2", 7.5, 10.5), ALL[2]],
            [ALL[0], spawn(0.5, "target2", 0.0, 0.0), ALL[2]],
        ),
        (
            "The fields x and y of a request are 0 until the node sets them.",
            [ALL[0], spawn(0.5, "target2", 0.0, 0.0), ALL[2]],
            [*ALL, spawn(0.6, "target1", 0.0, 0.0, response={"name": ""})],
        ),
        (
            "All turtles are at x=3.00, y=4.00.",
            [spawn(0.5, name, 3.0, 4.0) for name in PLACES],
            [*(spawn(0.5, name, 3.0, 4.0) for name in list(PLACES)[:2]), ALL[2]],
        ),
        (
            "Draw new numbers for each turtle, for example with random.uniform.",
            [spawn(0.5, name, 3.0, 4.0) for name in PLACES],
            [spawn(0.5, name, 0.0, 0.0) for name in PLACES],
        ),
    ],
)
def test_a_sentence_about_spawned_turtles_is_true(words: str, true: list[Call], near: list[Call]) -> None:
    assert words in told(of_spawns(given(calls=true)))
    assert words not in told(of_spawns(given(calls=near)))


def test_a_single_turtle_has_one_name() -> None:
    expected = found(SPAWNS, given(calls=[]), turtles=1).expected
    assert expected.startswith("The node spawns 1 turtle, target1, in random places.")


CAUGHT, LATE = {"target2": CAUGHT_S}, {"target2": CAUGHT_S + 2.0}
Gone = dict[str, float]


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("A call to /catch removes the turtle.", ([catch(), kill()], CAUGHT), ([], {})),
        ("had ended before the call.", ([], {}), ([catch()], {})),
        (
            "the node calls /kill to remove the turtle whose name is in the request, and no other turtle",
            ([catch()], {}),
            ([catch(), kill()], CAUGHT),
        ),
        (
            "target3 was removed, although nobody caught it.",
            ([catch(), kill(), kill("target3")], {**CAUGHT, "target3": CAUGHT_S}),
            ([catch(), catch("target3"), kill(), kill("target3")], {**CAUGHT, "target3": CAUGHT_S}),
        ),
        ("target2 was caught, but it still exists.", ([catch()], {}), ([catch(), kill()], LATE)),
        ("The callback of the service must send a request to /kill.", ([catch()], {}), ([catch(), kill("")], {})),
        ("target2 was removed too late: 2.0 s after it was caught.", ([catch(), kill()], LATE), ([catch()], {})),
        (
            "target2 was caught, but the node called /kill for a turtle without a name.",
            ([catch(), kill("")], {}),
            ([catch(), kill()], LATE),
        ),
        ("The name to remove is request.name", ([catch(), kill("target1")], {}), ([catch(), kill()], LATE)),
    ],
)
def test_a_sentence_about_removed_turtles_is_true(
    words: str, true: tuple[list[Call], Gone], near: tuple[list[Call], Gone]
) -> None:
    assert words in told(of_removes(given(calls=true[0], gone=true[1])))
    assert words not in told(of_removes(given(calls=near[0], gone=near[1])))


@pytest.mark.parametrize(("names", "found"), [("target1 target3", True), ("target1 target2", False)])
def test_a_turtle_that_was_never_announced_is_told(names: str, *, found: bool) -> None:
    reported = told(of_removes(given(calls=[catch()], gone={}, messages=(said(1.0, names),))))
    assert "target2 was caught, but it still exists." in reported
    assert ("target2 was never announced. Perhaps target2 is not in the list" in reported) == found


@pytest.mark.parametrize(("before", "found"), [("target1 target3", True), ("target1 target2", False)])
def test_a_turtle_that_was_forgotten_too_early_is_told(before: str, *, found: bool) -> None:
    messages = (said(1.0, "target1 target2"), said(CAUGHT_S - 0.5, before))
    reported = told(of_removes(given(calls=[catch()], gone={}, messages=messages)))
    words = "The message before the call did not contain target2. Was target2 removed from the list too early?"
    assert (words in reported) == found


@pytest.mark.parametrize(("killed_s", "found"), [(1.0, True), (None, False)])
def test_a_turtle_that_is_spared_although_others_are_killed_is_told(killed_s: float | None, *, found: bool) -> None:
    kills = [] if killed_s is None else [replace(kill("target1"), t_s=killed_s)]
    reported = told(of_removes(given(calls=[*kills, catch()], gone={})))
    words = "The node called /kill for target1, but not for target2. Was target2 still in the list of the remaining"
    assert (words in reported) == found


def test_places_are_compared_with_those_of_another_trial() -> None:
    words = "Draw the places with random, but without random.seed, which makes the numbers the same each time."
    same, other = given(), given(calls=[spawn(0.5, "target1", 4.0, 4.0)])
    spec = replace(same.trial, id="other")
    both = replace(same, exercise=replace(same.exercise, trials=(same.trial, spec)))
    for run, is_same in ((same.run, True), (other.run, False)):
        trials = replace(both, runs={same.trial.id: same.run, "other": run})
        reported = told(found(PLACES_DIFFER, trials, other="other"))
        assert (words in reported) == is_same
        assert ("The node was started twice, and target1 was at x=2.00, y=3.00 both times." in reported) == is_same
        assert (reported.strip() == "Each time the node starts, the turtles are in different places.") != is_same
    none = replace(both, runs={same.trial.id: same.run, "other": given(calls=[]).run})
    assert "no turtle whose name begins with target was spawned." in told(found(PLACES_DIFFER, none, other="other"))


@pytest.mark.parametrize(
    ("source", "told"), [(SPAWNER, False), (SPAWNER.replace("self.killer.call_async(Kill.Request())", "pass"), True)]
)
def test_a_node_that_never_kills_is_told_so_first(source: str, *, told: bool) -> None:
    calls = [spawn(0.5, name, *place) for name, place in PLACES.items()]
    made = given(calls=[*calls, catch()], gone={}, messages=(said(0.6, "target2"), said(1.0, "target1")))
    finding = of_removes(replace(made, submission=submission({NODE_FILE: source})))
    assert ("The callback of the service must send a request to /kill." in finding.cause) == told
