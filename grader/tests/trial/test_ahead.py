from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, cast

import pytest

from grader.errors import MachineError
from grader.tests.checks.made import good
from grader.tests.waiting import HANG_S
from grader.trial.ahead import Ahead
from grader.trial.trial import OverwhelmedError

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.trial.recording import Recording
    from grader.trial.trial import Trial

SEEN = good()


class Made:
    """A trial that runs no processes, for tests.

    The method `run` calls `runs`, and the trial is ready when `ready` is set.
    """

    def __init__(self, runs: Callable[[], Recording]) -> None:
        self.runs = runs
        self.open = False
        self.opened = threading.Event()
        self.ready = threading.Event()
        self.ready.set()
        self.closed = threading.Event()

    def __enter__(self) -> Made:  # noqa: PYI034 - typing.Self is Python 3.11's
        self.open = True
        self.opened.set()
        return self

    def await_ready(self) -> None:
        assert self.ready.wait(HANG_S)

    def __exit__(self, *_: object) -> None:
        self.open = False
        self.closed.set()
        self.ready.set()  # like a real trial, which tells all waiting threads that it has ended

    def run(self, *_: Any) -> Recording:  # noqa: ANN401
        return self.runs()


@pytest.fixture
def ahead() -> Ahead:
    return Ahead(at_once=2)


def start(ahead: Ahead, name: str, runs: Callable[[], Recording] = lambda: SEEN, *, run: bool = True) -> Made:
    trial = Made(runs)
    ahead.start(name, cast("Trial", trial))
    if run:
        ahead.run(name, "package", "node", b"")
    return trial


def test_trials_run_side_by_side(ahead: Ahead) -> None:
    both = threading.Barrier(2)

    def meets() -> Recording:
        both.wait(HANG_S)
        return SEEN

    with ahead:
        for name in ("", "eight"):
            start(ahead, name, meets)
        for name in ("", "eight"):
            trial = ahead.trial(name)
            assert trial is not None
            assert trial.run("package", "node", b"") is SEEN


def test_what_was_not_run_ahead_is_run_when_it_is_requested(ahead: Ahead) -> None:
    with ahead:
        start(ahead, "", run=False)
        trial = ahead.trial("")
        assert trial is not None
        assert trial.run("package", "node", b"") is SEEN
        assert ahead.trial("square") is None


def start_two(ahead: Ahead) -> tuple[Made, Made]:
    """Return two trials. The start of the first trial has begun but is not finished yet."""
    first, second = Made(lambda: SEEN), Made(lambda: SEEN)
    first.ready.clear()
    ahead.start("", cast("Trial", first))
    ahead.start("eight", cast("Trial", second))
    assert first.opened.wait(HANG_S)
    return first, second


def test_one_is_started_when_the_one_before_is_ready(ahead: Ahead) -> None:
    with ahead:
        first, second = start_two(ahead)
        assert not second.opened.wait(0.05)
        first.ready.set()
        assert second.opened.wait(HANG_S)


def test_leaving_ends_the_one_that_is_being_started_and_starts_no_other(ahead: Ahead) -> None:
    with ahead:
        first, second = start_two(ahead)
    assert first.closed.is_set()
    assert not second.opened.is_set()


def test_clearing_ends_all_trials_and_new_ones_may_start(ahead: Ahead) -> None:
    with ahead:
        first, second = start_two(ahead)
        ahead.run("", "package", "node", b"")
        ahead.clear()
        assert first.closed.is_set()
        assert not second.opened.is_set()
        assert ahead.trial("") is None
        other = start(ahead, "")
        trial = ahead.trial("")
        assert trial is not None
        assert trial.run("package", "node", b"") is SEEN
        assert not other.closed.is_set()
    assert other.closed.is_set()


def test_a_node_that_was_started_goes_on(ahead: Ahead) -> None:
    runs: list[int] = []

    def counted() -> Recording:
        runs.append(1)
        return SEEN

    with ahead:
        start(ahead, "", counted)
        ahead.run("", "package", "node", b"")
        trial = ahead.trial("")
        assert trial is not None
        trial.run("package", "node", b"")
    assert runs == [1]


def test_an_error_at_the_start_of_a_trial_is_raised_when_the_trial_is_run(ahead: Ahead) -> None:
    class Broken(Made):
        def await_ready(self) -> None:
            raise MachineError("no room")  # noqa: EM101

    with ahead:
        ahead.start("", cast("Trial", Broken(lambda: SEEN)))
        trial = ahead.trial("")
        assert trial is not None
        with pytest.raises(MachineError, match="no room"):
            trial.run("package", "node", b"")


def test_a_node_that_brings_its_simulator_down_is_reported_to_the_caller(ahead: Ahead) -> None:
    def breaks() -> Recording:
        raise OverwhelmedError("it ended")  # noqa: EM101

    with ahead:
        start(ahead, "", breaks)
        start(ahead, "eight")
        eight, own = ahead.trial("eight"), ahead.trial("")
        assert eight is not None
        assert eight.run("package", "node", b"") is SEEN
        assert own is not None
        with pytest.raises(OverwhelmedError, match="it ended"):
            own.run("package", "node", b"")


def test_the_trials_are_settled_when_none_is_running(ahead: Ahead) -> None:
    goes_on, ended = threading.Event(), threading.Event()

    def waits() -> Recording:
        assert goes_on.wait(HANG_S)
        ended.set()
        return SEEN

    with ahead:
        start(ahead, "", waits)
        settling = threading.Thread(target=ahead.settle)
        settling.start()
        settling.join(0.05)
        assert settling.is_alive()
        goes_on.set()
        settling.join(HANG_S)
        assert ended.is_set()
        assert not settling.is_alive()


def test_leaving_ends_trials_that_nobody_waits_for(ahead: Ahead) -> None:
    def waits() -> Recording:
        begun.set()
        ended_first.append(slow.closed.wait(HANG_S))
        raise OverwhelmedError("it was ended")  # noqa: EM101

    begun = threading.Event()
    ended_first: list[bool] = []
    with ahead:
        slow = start(ahead, "", waits, run=False)
        ahead.run("", "package", "node", b"")
        others = [start(ahead, name) for name in ("eight", "square")]
        assert begun.wait(HANG_S)
    assert ended_first == [True], "not the pool before its trials"
    assert not slow.open
    assert not any(trial.open for trial in others)
