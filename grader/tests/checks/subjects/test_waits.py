"""The check that no callback waits, for nodes with one thread and for nodes with several threads."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.waits import NEVER_WAITS
from grader.tests.checks.made import NODE, NODE_FILE, every, evidence, found, recording, submission
from grader.tests.checks.told import told
from grader.trial.observed import Call
from grader.trial.recording import LogLine

if TYPE_CHECKING:
    from grader.trial.recording import Recording

WAITS = "        self.pen.call(request)"
THREADS = "\nexecutor = MultiThreadedExecutor(4)\n"
PEN = Call(1.0, "/turtle1/set_pen", "turtlesim/srv/SetPen", {}, {}, 1.6)


def judged(line: str, *, more: str = "", until_s: float = 10.0) -> Finding:
    """Return the finding about a node whose callback contains this line, and that drives until a time (s)."""
    source = NODE.replace("        msg = Twist()", f"{line}\n        msg = Twist()") + more
    trial = recording(every(0.5, 2.0, 1.0, until_s), calls=(PEN,))
    return found(NEVER_WAITS, evidence(trial, submission({NODE_FILE: source})))


@pytest.mark.parametrize(
    ("line", "diagnosis", "words"),
    [
        (WAITS, "waits-in-callback", "deadlock"),
        ("        self.pen.wait_for_service()", "waits-for-server", "service_is_ready"),
        ("        time.sleep(1.0)", "sleep-in-callback", "sleeps"),
    ],
)
def test_a_wait_in_a_callback_fails_at_its_line(line: str, diagnosis: str, words: str) -> None:
    finding = judged(line)
    assert (finding.diagnosis, str(finding.where)) == (diagnosis, f"{NODE_FILE}:13")
    assert words in finding.cause


@pytest.mark.parametrize("call", ["rclpy.spin_once(self)", "rclpy.spin_until_future_complete(self, future)"])
def test_only_a_wait_that_spins_may_be_refused_by_rclpy(call: str) -> None:
    assert "a deadlock, or an exception from rclpy 7.1.9 on" in judged(f"        {call}").cause
    assert "a deadlock, or an exception from rclpy 7.1.9 on" not in judged(WAITS).cause


def test_a_wait_is_found_before_the_build_unless_the_node_has_threads() -> None:
    source = NODE.replace("        msg = Twist()", f"{WAITS}\n        msg = Twist()")
    early = NEVER_WAITS.judge_early(evidence(None, submission({NODE_FILE: source})), {})
    assert early is not None
    assert early.status is Status.FAILED
    assert NEVER_WAITS.judge_early(evidence(None, submission({NODE_FILE: source + THREADS})), {}) is None


@pytest.mark.parametrize("line", [WAITS, "        self.pen.call(request, timeout_sec=1.0)"])
def test_with_threads_the_node_may_wait_if_it_goes_on(line: str) -> None:
    assert judged(line, more=THREADS).status is Status.PASSED


@pytest.mark.parametrize(("timeout", "words"), [("", "at all: a deadlock."), (", 1.0", "before the timeout.")])
def test_in_one_group_a_wait_with_a_timeout_is_no_deadlock(timeout: str, words: str) -> None:
    cause = of_node(PLAIN, TIMER, f"        self.pen.call(request{timeout})").cause
    assert f"so nothing receives the response {words} Use call_async" in cause


def test_with_threads_in_one_group_the_node_hangs() -> None:
    finding = judged(WAITS, more=THREADS, until_s=1.2)
    assert finding.diagnosis == "waits-in-callback"
    assert "callback group" in finding.cause


def test_a_node_without_a_wait_passes() -> None:
    assert judged("        pass").status is Status.PASSED


SILENT = recording(every(0.5, 2.0, 1.0, 1.2), calls=(PEN,))
LOGGING = replace(SILENT, log=(LogLine(5.0, "INFO", "draw_circle", "I go on."),))
DRIVING = recording(every(0.5, 2.0, 1.0), calls=(PEN,))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("After a response, the node did nothing more.", SILENT, LOGGING),
        ("Several threads do not help here", SILENT, LOGGING),
        ("Other threads receive the responses for which a callback waits.", DRIVING, SILENT),
    ],
)
def test_a_sentence_about_a_node_with_threads_is_true(words: str, true: Recording, near: Recording) -> None:
    source = NODE.replace("        msg = Twist()", f"{WAITS}\n        msg = Twist()") + THREADS
    package = submission({NODE_FILE: source})
    assert words in told(found(NEVER_WAITS, evidence(true, package)))
    assert words not in told(found(NEVER_WAITS, evidence(near, package)))


CLIENT = "        self.timer = self.create_timer(0.5, self.send)"


def of_node(client: str, timer: str, line: str = WAITS) -> Finding:
    """Return the finding about a node of several threads that goes on, with this client, timer and wait."""
    source = NODE.replace(CLIENT, f"        {client}\n        {timer}").replace("        msg = Twist()", line)
    trial = recording(every(0.5, 2.0, 1.0, 10.0), calls=(PEN,))
    return found(NEVER_WAITS, evidence(trial, submission({NODE_FILE: source + THREADS})))


PLAIN = 'self.pen = self.create_client(SetPen, "/turtle1/set_pen")'
TIMER = "self.create_timer(0.5, self.send)"


@pytest.mark.parametrize(
    ("client", "timer", "line"),
    [
        (PLAIN, TIMER, WAITS),
        (PLAIN, TIMER, f"        self.ask()\n\n    def ask(self):\n{WAITS}"),
        (PLAIN, 'self.create_service(Empty, "/go", callback=self.send)', WAITS),
    ],
)
def test_a_wait_in_the_clients_group_is_a_deadlock_even_if_other_groups_go_on(
    client: str, timer: str, line: str
) -> None:
    finding = of_node(client, timer, line)
    assert finding.diagnosis == "waits-in-callback"
    assert "callback group" in finding.cause


@pytest.mark.parametrize(
    ("client", "timer", "line"),
    [
        (PLAIN.replace('")', '", callback_group=self.other)'), TIMER, WAITS),
        (PLAIN, TIMER.replace("send)", "send, self.other)"), WAITS),
        (PLAIN, TIMER.replace("send)", "send, callback_group=self.other)"), WAITS),
        (f"self._default_callback_group = ReentrantCallbackGroup()\n        {PLAIN}", TIMER, WAITS),
        (PLAIN, "self.future.add_done_callback(self.send)", WAITS),
        (PLAIN.replace("self.create", "helper.create"), TIMER, WAITS),
    ],
)
def test_a_wait_for_a_client_of_another_group_is_allowed(client: str, timer: str, line: str) -> None:
    assert of_node(client, timer, line).status is Status.PASSED


@pytest.mark.parametrize(
    ("line", "diagnosis"),
    [
        ("        self.pen.call(request)", "waits-in-callback"),
        ('        self.create_client(SetPen, "/turtle1/set_pen").call(request)', "waits-in-callback"),
        ("        self.helper.call(request)", None),
        ("        self.call(request)", None),
        ("        super().call(request)", None),
    ],
)
def test_a_function_of_ones_own_that_is_named_call_hides_no_wait(line: str, diagnosis: str | None) -> None:
    own = f"    def call(self, request):\n        pass\n\n    def prepare(self):\n        {PLAIN}\n\n    def send"
    source = NODE.replace("        msg = Twist()", line).replace("    def send", own)
    finding = found(NEVER_WAITS, evidence(recording(every(0.5, 2.0, 1.0)), submission({NODE_FILE: source})))
    assert finding.diagnosis == diagnosis


GROUPED = "\nfrom rclpy.callback_groups import ReentrantCallbackGroup\ngroup = ReentrantCallbackGroup()\n"


@pytest.mark.parametrize(
    ("timer", "more", "deadlock"),
    [
        (TIMER, "", True),
        (TIMER.replace("send)", "send, callback_group=group)"), "", False),
        (TIMER.replace("send)", "send, group)"), GROUPED, False),
    ],
)
def test_an_await_in_the_clients_group_is_a_deadlock(timer: str, more: str, *, deadlock: bool) -> None:
    source = NODE.replace(CLIENT, f"        {PLAIN}\n        {timer}").replace("    def send(", "    async def send(")
    source = source.replace(
        "        msg = Twist()", "        await self.pen.call_async(request)\n        msg = Twist()"
    )
    assert "async def" in source
    trial = recording(every(0.5, 2.0, 1.0, 10.0), calls=(PEN,))
    finding = found(NEVER_WAITS, evidence(trial, submission({NODE_FILE: source + more})))
    assert (finding.diagnosis == "waits-in-callback") is deadlock, finding
