"""Prove causes: in a copy of the submission, fix the place to which a failed check points, and run the copy.

A fix stays in the copy while the next cause is tested, unless it was refuted or its test was inconclusive. In this way,
mistakes that were hidden by other mistakes are also found. If the submission runs in the sandbox, so does the copy. The
copy runs only in simulated time.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from grader.checks.edit import applied, difference
from grader.checks.outcome import Status
from grader.evidence.tries import Tries, Try

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence
    from grader.evidence.tries import Result
    from grader.exercise.model import CheckSpec, Exercise
    from grader.submission.package import Submission

    Regrade = Callable[[Exercise, Submission], Sequence[Outcome]]
    Key = tuple[str, str | None, str]

MOST_TRIES = 6
MOST_F = 1.5
"""The time for testing the fixes of a submission, relative to the time that a build and a minimal node take. After the
first test, a test that would probably exceed this time is not started."""
BARE_NODE_S = 0.35
"""The time that a minimal process with one node takes to start and exit (s)."""
ENOUGH = f"at most {MOST_TRIES} fixes are tested"
TOO_LONG = "there was no time to test more fixes"
NOT_SIMULATED = "a node with a fix could not be tested in simulated time"


def explain(
    evidence: Evidence,
    outcomes: Sequence[Outcome],
    build_s: float,
    regrade: Regrade,
    give_up: Callable[[], bool] = lambda: False,
) -> Tries:
    """Test fixes for the causes of the failed outcomes. `build_s` is the duration of the build (s).

    `give_up` is called before each change is tested. Once `give_up` returns true, no more changes are tested.
    """
    return _Explaining(evidence, outcomes, MOST_F * (build_s + BARE_NODE_S), regrade, give_up).run()


def part_of(exercise: Exercise, check: str) -> Exercise:
    """Return a copy of the exercise with only the checks of this check's trial, and the checks and trials they need."""
    specs = {spec.id: spec for spec in exercise.checks}
    trial = specs[check].trial
    wanted: dict[str, CheckSpec] = {}
    waiting = [spec for spec in exercise.checks if spec.trial == trial]
    while waiting:
        spec = waiting.pop()
        wanted[spec.id] = spec
        waiting += [specs[need] for need in spec.needs if need not in wanted]
    kept = {spec.trial for spec in wanted.values()}
    kept |= {exercise.trial(id_).beside for id_ in kept}
    return replace(
        exercise,
        checks=tuple(spec for spec in exercise.checks if spec.id in wanted),
        trials=tuple(each for each in exercise.trials if each.id in kept or (each.beside and each.beside in kept)),
    )


@dataclass
class _Explaining:
    evidence: Evidence
    outcomes: Sequence[Outcome]
    seconds: float
    regrade: Regrade
    give_up: Callable[[], bool]
    made: list[Try] = field(default_factory=list)
    behind: set[tuple[str | None, str]] = field(default_factory=set)
    """The causes that only appeared after a fix. A mistake often makes several checks fail with the same cause."""

    def run(self) -> Tries:
        begun = time.monotonic()
        longest = 0.0
        files: Mapping[str, bytes] = self.evidence.submission.files
        current = {outcome.id: outcome for outcome in self.outcomes}
        known = {_cause(outcome) for outcome in self.outcomes}
        tried: set[Key] = set()
        stopped = ""
        tests = 0
        while True:
            target = next((each for each in current.values() if _may_be_tried(each) and _key(each) not in tried), None)
            if target is None or self.give_up():
                break
            tried.add(_key(target))
            changed = applied(files, target.finding.fix)
            if changed is None or changed == files:
                continue
            if tests == MOST_TRIES or time.monotonic() - begun + longest > self.seconds:
                stopped = ENOUGH if tests == MOST_TRIES else TOO_LONG
                break
            tests += 1
            at = time.monotonic()
            copy = replace(self.evidence.submission, files=changed, digest="")
            found = {each.id: each for each in self.regrade(part_of(self.evidence.exercise, target.id), copy)}
            longest = max(longest, time.monotonic() - at)
            result = _result(target, current, found)
            if result is None:
                stopped = NOT_SIMULATED
                continue
            self.made.append(Try(target.id, target.finding.diagnosis or "", result, difference(files, changed)))
            if result != "refuted":
                tried |= self._share(target, found, difference(files, changed))
                files = changed
                current |= found
                self.behind |= {_cause(each) for each in found.values() if _failed(each)} - known
        return Tries(tuple(self.made), len(self.behind), stopped)

    def _share(self, target: Outcome, found: Mapping[str, Outcome], diff: str) -> set[Key]:
        """Record the result of a test for all other failed checks that have the same cause and were judged again.

        Only a result that confirms the cause is recorded. Return the keys of all these checks.
        """
        same = [
            each
            for each in self.outcomes
            if _failed(each) and each.id != target.id and each.id in found and _cause(each) == _cause(target)
        ]
        for each in same:
            result = _result(each, {each.id: each}, found)
            if result in ("passes", "further"):
                self.made.append(Try(each.id, each.finding.diagnosis or "", result, diff))
        return {_key(each) for each in same}


def _result(target: Outcome, before: Mapping[str, Outcome], after: Mapping[str, Outcome]) -> Result | None:
    """Return the result of testing a change, or None if the test is inconclusive."""
    now = after.get(target.id)
    if now is not None and now.status is Status.ERROR:
        return None
    if now is not None and now.status is Status.PASSED:
        return "passes"
    passed = [id_ for id_, each in before.items() if each.status is Status.PASSED]
    lost = any(id_ in after and after[id_].status is not Status.PASSED for id_ in passed)
    if now is None or lost or now.status is not Status.FAILED or _cause(now) == _cause(target):
        return "refuted"
    return "further"


def _may_be_tried(outcome: Outcome) -> bool:
    return _failed(outcome) and bool(outcome.finding.fix)


def _failed(outcome: Outcome) -> bool:
    return outcome.status is Status.FAILED and not outcome.advice


def _cause(outcome: Outcome) -> tuple[str | None, str]:
    return outcome.finding.diagnosis, str(outcome.finding.where)


def _key(outcome: Outcome) -> Key:
    return (outcome.id, *_cause(outcome))
