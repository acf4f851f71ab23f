"""Waits inside callbacks are found under any name, and waits outside of callbacks are allowed."""

from __future__ import annotations

import pytest

from grader.checks.causes.waiting import has_threads, waits_in_callback, waits_in_callbacks
from grader.tests.checks.made import NODE_FILE, evidence, submission

NODE = """\
import time
import rclpy
from functools import partial
from rclpy import spin_until_future_complete as until
from rclpy.node import Node


class Painter(Node):
    def __init__(self):
        super().__init__("painter")
        self.pen = self.create_client(SetPen, "/turtle1/set_pen")
        {init}
        self.create_timer(0.1, {callback})

    def step(self):
        {step}

    def ask(self, request):
        {ask}


def main():
    rclpy.init()
    node = Painter()
    {main}
    rclpy.spin(node)
"""


def waits(
    *, init: str = "pass", callback: str = "self.step", step: str = "pass", ask: str = "pass", main: str = "pass"
) -> list[str]:
    """Return the names of the functions that wait in a callback of this node, as rclpy calls them."""
    source = NODE.format(init=init, callback=callback, step=step, ask=ask, main=main)
    return [wait.name for wait in waits_in_callbacks(evidence(package=submission({NODE_FILE: source})))]


@pytest.mark.parametrize(
    ("step", "name"),
    [
        ("self.pen.call(request)", "call"),
        ("self.pen.call(request, timeout_sec=1.0)", "call"),
        ("self.clients['pen'].call(request)", "call"),
        ("ask = self.pen.call; ask(request)", "call"),
        ("getattr(self.pen, 'call')(request)", "call"),
        ("ask = getattr(self.pen, 'call'); ask(request)", "call"),
        ("ask = partial(self.pen.call, request); ask()", "call"),
        ("(lambda: self.pen.call(request))()", "call"),
        ("rclpy.spin_until_future_complete(self, future)", "spin_until_future_complete"),
        ("until(self, future)", "spin_until_future_complete"),
        ("self.executor.spin_until_future_complete(future)", "spin_until_future_complete"),
        ("self.pen.wait_for_service()", "wait_for_service"),
        ("self.pen.wait_for_service(timeout_sec=None)", "wait_for_service"),
        ("while not self.pen.wait_for_service(timeout_sec=1.0): pass", "wait_for_service"),
        ("time.sleep(1.0)", "sleep"),
        ("while not future.done(): pass", "while"),
    ],
)
def test_a_wait_in_a_callback_is_found(step: str, name: str) -> None:
    assert waits(step=step) == [name]


def test_an_alias_that_the_constructor_makes_is_followed() -> None:
    assert waits(init="self.query = self.pen.call", step="self.query(request)") == ["call"]


def test_a_wait_in_a_method_that_a_callback_calls_is_found() -> None:
    assert waits(step="self.ask(request)", ask="self.pen.call(request)") == ["call"]


@pytest.mark.parametrize("callback", ["partial(self.ask, 3)", "lambda: self.ask(3)", "callback=self.ask"])
def test_a_callback_may_be_passed_in_any_form(callback: str) -> None:
    assert waits(callback=callback, ask="self.pen.call(request)") == ["call"]


@pytest.mark.parametrize(
    "other",
    [
        {"main": "node.pen.call(request)"},
        {"main": "until(node, node.pen.call_async(request))"},
        {"main": "node.ask(request)", "ask": "self.pen.call(request)"},
        {"init": "self.pen.wait_for_service(timeout_sec=5.0)"},
        {"init": "while not self.pen.wait_for_service(timeout_sec=1.0): pass"},
        {"init": "self.ask(1)", "ask": "self.pen.call(request)"},
        {"step": "self.pen.wait_for_service(timeout_sec=0.0)"},
        {"step": "self.pen.call_async(request).add_done_callback(self.ask)"},
        {"step": "subprocess.call(words)"},
        {"step": "call(words)"},
        {"step": "self.call(words)"},
        {"step": "if self.future.done(): pass"},
        {"step": "rclpy.spin_once(self, timeout_sec=0)"},
        {"init": "Thread(target=self.ask, args=(1,)).start()", "ask": "self.pen.call(request); time.sleep(1.0)"},
        {"init": "Thread(target=lambda: rclpy.spin(self)).start()"},
        {"init": "self.pool.submit(self.ask, 1)", "ask": "time.sleep(1.0)"},
    ],
)
def test_a_near_miss_is_not_blamed(other: dict[str, str]) -> None:
    assert waits(**other) == []


def test_a_method_of_the_nodes_own_is_not_the_one_of_rclpy() -> None:
    source = NODE.format(init="pass", callback="self.step", step="self.lamp.call(1)", ask="pass", main="pass")
    source += "\n\nclass Lamp:\n    def call(self, number):\n        print(number)\n"
    assert waits_in_callbacks(evidence(package=submission({NODE_FILE: source}))) == []


def test_the_cause_names_the_deadlock_and_the_line() -> None:
    source = NODE.format(init="pass", callback="self.step", step="self.pen.call(1)", ask="pass", main="pass")
    cause = waits_in_callback(evidence(package=submission({NODE_FILE: source})))
    assert cause is not None
    assert "deadlock" in cause.text
    assert cause.text.endswith("Use call_async, and pass the next step to add_done_callback.")
    assert str(cause.where) == f"{NODE_FILE}:16"


@pytest.mark.parametrize(("step", "found"), [("time.sleep(0.5)", True), ("self.pen.call(1)", False)])
def test_a_sleep_in_a_callback_is_told_from_a_deadlock(step: str, *, found: bool) -> None:
    source = NODE.format(init="pass", callback="self.step", step=step, ask="pass", main="time.sleep(0.5)")
    (wait,) = waits_in_callbacks(evidence(package=submission({NODE_FILE: source})))
    words = "While a callback sleeps, a node with one thread calls no other callback. Count the timer calls instead,"
    assert wait.cause.text.startswith(words) == found
    assert wait.deadlock != found


@pytest.mark.parametrize(
    ("step", "words"),
    [
        ("rclpy.spin_once(self, timeout_sec=0.1)", "spin_once waits inside a callback, at most until its timeout."),
        ("self.executor.spin_once(0.1)", "spin_once waits inside a callback, at most until its timeout."),
        ("until(self, future, None, 1.0)", "until, which is spin_until_future_complete, waits inside a callback until"),
        ("self.pen.call(request, 2.0)", "call waits inside a callback until its timeout, because rclpy.spin receives"),
        ("self.pen.call(request, timeout_sec=self.limit)", "call waits inside a callback until its timeout, because"),
    ],
)
def test_a_wait_with_a_timeout_is_no_deadlock(step: str, words: str) -> None:
    source = NODE.format(init="pass", callback="self.step", step=step, ask="pass", main="pass")
    (wait,) = waits_in_callbacks(evidence(package=submission({NODE_FILE: source})))
    assert wait.cause.text.startswith(words)
    assert not wait.deadlock


def test_an_endless_wait_is_named_before_one_with_a_timeout() -> None:
    step = "rclpy.spin_once(self, timeout_sec=0.1)"
    source = NODE.format(init="pass", callback="self.step", step=step, ask="pass", main="pass")
    cause = waits_in_callback(evidence(package=submission({NODE_FILE: source})))
    assert cause is not None
    assert "until its timeout" in cause.text
    source = source.replace(step, f"{step}; self.pen.call(request)")
    cause = waits_in_callback(evidence(package=submission({NODE_FILE: source})))
    assert cause is not None
    assert cause.text.startswith("call waits")


@pytest.mark.parametrize(
    "step",
    [
        "rclpy.spin_once(self, timeout_sec=None)",
        "rclpy.spin_once(self, timeout_sec=-1)",
        "rclpy.spin_once(self)",
        "until(self, future)",
        "self.executor.spin_until_future_complete(future)",
        "self.pen.call(request)",
    ],
)
def test_a_wait_without_a_timeout_is_a_deadlock(step: str) -> None:
    source = NODE.format(init="pass", callback="self.step", step=step, ask="pass", main="pass")
    cause = waits_in_callback(evidence(package=submission({NODE_FILE: source})))
    assert cause is not None
    assert "a deadlock" in cause.text


def test_a_spin_in_a_callback_has_no_method_of_the_same_name() -> None:
    source = NODE.format(init="pass", callback="self.step", step="until(self, future)", ask="pass", main="pass")
    cause = waits_in_callback(evidence(package=submission({NODE_FILE: source})))
    assert cause is not None
    assert "Use the method that ends in _async" in cause.text


def test_threads_are_noticed() -> None:
    source = NODE.format(init="pass", callback="self.step", step="pass", ask="pass", main="MultiThreadedExecutor(4)")
    assert has_threads(evidence(package=submission({NODE_FILE: source})))
    assert not has_threads(evidence(package=submission({NODE_FILE: source.replace("MultiThreaded", "SingleThreaded")})))


@pytest.mark.parametrize(("step", "found"), [("while not self.future.done(): pass", True), ("self.pen.call(1)", False)])
def test_a_loop_in_a_callback_is_described(step: str, *, found: bool) -> None:
    source = NODE.format(init="pass", callback="self.step", step=step, ask="pass", main="pass")
    (wait,) = waits_in_callbacks(evidence(package=submission({NODE_FILE: source})))
    assert wait.cause.text.startswith("A loop that checks done() waits inside a callback") == found


@pytest.mark.parametrize(
    ("step", "words"),
    [
        ("rclpy.spin_once(self)", "spin_once waits inside a callback, but the executor calls no other callback until"),
        ("rclpy.spin(self)", "spin waits inside a callback, but the executor calls no other callback until this one"),
        ("until(self, future)", "until, which is spin_until_future_complete, waits inside a callback, so rclpy.spin"),
        ("self.pen.call(request)", "call waits inside a callback, so rclpy.spin receives no response: a deadlock."),
    ],
)
def test_a_wait_for_anything_is_not_a_wait_for_a_response(step: str, words: str) -> None:
    source = NODE.format(init="pass", callback="self.step", step=step, ask="pass", main="pass")
    cause = waits_in_callback(evidence(package=submission({NODE_FILE: source})))
    assert cause is not None
    assert cause.text.startswith(words)
    assert ("Remove the call." not in cause.text) == ("so rclpy.spin" in words or "no response" in words)
