"""The reasons why messages arrive far too often, or at an increasing rate."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_rate import (
    FRAME_S,
    why_often,
    why_publishers_grow,
    why_several_calls,
    why_timers_grow,
)
from grader.checks.causes.why_sleep import why_rate_in_callback
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission

PERIOD_S = 0.5
NODE = """\
class Driver(Node):
    def __init__(self):
        {made}

    def send(self, msg):{at_send}
        {sent}

    def other(self):
        self.publisher.publish(msg)
"""


def often(source: str, mean_s: float) -> tuple[str, int | None] | None:
    cause = why_often(evidence(recording([]), submission({NODE_FILE: source})), "publish", mean_s, PERIOD_S)
    return None if cause is None else (cause.diagnosis, cause.where.line if cause.where else None)


@pytest.mark.parametrize(
    ("loop", "mean_s", "found"),
    [
        ("while True: self.publisher.publish(msg)", 0.001, True),
        ("while True: publish(msg)", 0.04, True),
        ("while True: publish(msg)", 0.06, False),
        ("while True:  # look\n            if near: turn()\n            publish(msg)", 0.001, True),
        ("while True:\n            if due(): publish(msg)", 0.001, False),
        ("while True:\n            publish(msg)\n            while early(): pass", 0.001, False),
        ("while True: publish(msg); stop.wait(0.5)", 0.001, False),
        ("while True: publish(msg); time.sleep(0.5)", 0.001, False),
        ("while True: publish(msg); rclpy.spin_once(self)", 0.001, False),
        ("while True: publish(msg); rclpy.spin_until_future_complete(self, done, timeout_sec=0.02)", 0.02, False),
        ("while True: publish(msg); self.nap()\n\n    def nap(self):\n        time.sleep(0.02)", 0.02, False),
        ("while True: publish(msg); self.look()  # look\n\n    def look(self):\n        print(3)", 0.02, True),
        ("while True: print(msg)", 0.001, False),
        ("for each in range(3): publish(each)", 0.001, False),
    ],
)
def test_a_loop_that_waits_for_nothing_is_found(loop: str, mean_s: float, *, found: bool) -> None:
    source = NODE.format(made="count = 3", at_send="", sent=loop if LOOK in loop else f"{loop}  # look")
    assert often(source, mean_s) == (("loop-without-pause", line_with(LOOK, source)) if found else None)


SUBSCRIBES = 'self.create_subscription(Pose, "/turtle1/pose", self.send, 10)'


@pytest.mark.parametrize(
    ("made", "sent", "mean_s", "found"),
    [
        (SUBSCRIBES, "publish(msg)", FRAME_S, True),
        ('self.create_subscription(Pose, "/pose", qos_profile=1, callback=self.send)', "publish(msg)", FRAME_S, True),
        (SUBSCRIBES.replace("self.send", "self.driver.send"), "publish(msg)", FRAME_S, True),
        (SUBSCRIBES.replace("pose", "color_sensor"), "publish(msg)", FRAME_S, True),
        (SUBSCRIBES.replace("/turtle1/pose", "/goal"), "publish(msg)", FRAME_S, False),
        (f"{SUBSCRIBES}; self.create_timer(1 / 60, self.other)", "if msg.x > 9: publish(msg)", FRAME_S, False),
        (f"{SUBSCRIBES}; self.create_timer(PERIOD, self.other)", "if msg.x > 9: publish(msg)", FRAME_S, False),
        (f"{SUBSCRIBES}; self.create_timer(0.5, self.other)", "publish(msg)", FRAME_S, True),
        (f"while ok(): self.other(); time.sleep(0.016)  # {SUBSCRIBES}", "publish(msg)", FRAME_S, False),
        (SUBSCRIBES, "publish(msg)", 1.09 * FRAME_S, True),
        (SUBSCRIBES, "publish(msg)", 0.91 * FRAME_S, True),
        (SUBSCRIBES, "publish(msg)", 1.11 * FRAME_S, False),
        (SUBSCRIBES, "publish(msg)", 0.89 * FRAME_S, False),
        (SUBSCRIBES, "print(msg)", FRAME_S, False),
        ('self.create_subscription(Pose, "/turtle1/pose")', "publish(msg)", FRAME_S, False),
        ("self.create_timer(0.016, self.send)", "publish(msg)", FRAME_S, False),
    ],
)
def test_a_method_that_each_message_calls_is_found(made: str, sent: str, mean_s: float, *, found: bool) -> None:
    source = NODE.format(made=made, at_send="  # look", sent=sent)
    assert often(source, mean_s) == (("every-message", line_with(LOOK, source)) if found else None)


ONCE = "self.timer = self.create_timer(0.5, self.send)"


@pytest.mark.parametrize(
    ("made", "sent", "found"),
    [
        ("self.create_timer(0.5, self.send)", "self.create_timer(0.5, self.other)  # look", True),
        ("self.create_timer(0.5, callback=self.send)", "self.create_timer(0.5, self.other)  # look", True),
        (SUBSCRIBES, "self.create_timer(0.5, self.other)  # look", True),
        ("self.create_timer(0.5, self.other)", "self.create_timer(0.5, self.other)  # look", False),
        ("self.create_timer(0.5, self.send)", "self.destroy_timer(self.timer)", False),
        (ONCE, "self.timer.cancel(); self.create_timer(0.5, self.other)  # look", False),
        (ONCE, "self.destroy_timer(self.timer); self.create_timer(0.5, self.other)  # look", False),
        (ONCE, "self.timer.reset(); self.create_timer(0.5, self.other)  # look", True),
        ("self.create_timer(0.5, self.send)", "make()()", False),
        (ONCE, "if self.second is None: self.second = self.create_timer(0.5, self.other)  # look", False),
        (ONCE, "if self.made: return\n        self.create_timer(0.5, self.other)  # look", False),
        (ONCE, "self.second = self.second or self.create_timer(0.5, self.other)  # look", False),
        (ONCE, "self.second = self.second if self.second else self.create_timer(0.5, self.other)  # look", False),
        (ONCE, "if self.made: self.count = 0\n        self.create_timer(0.5, self.other)  # look", True),
        (ONCE, "with self.lock:\n            self.create_timer(0.5, self.other)  # look", True),
    ],
)
def test_a_timer_that_a_callback_makes_is_found(made: str, sent: str, *, found: bool) -> None:
    source = NODE.format(made=made, at_send="", sent=sent)
    cause = why_timers_grow(evidence(recording([]), submission({NODE_FILE: source})))
    got = None if cause is None else (cause.diagnosis, cause.where and cause.where.line)
    assert got == (("timer-in-callback", line_with(LOOK, source)) if found else None)


@pytest.mark.parametrize(
    ("made", "guard", "found"),
    [
        ("self.create_timer(0.5, self.send)", "", True),
        (SUBSCRIBES, "", True),
        ("self.create_timer(0.5, self.other)", "", False),
        (SUBSCRIBES, "if self.publisher is None: ", False),
        (SUBSCRIBES, "if self.publisher is None: print(3)\n        ", True),
    ],
)
def test_a_publisher_that_each_call_makes_anew_is_found(made: str, guard: str, *, found: bool) -> None:
    sent = f'{guard}self.publisher = self.create_publisher(Twist, "/a", 10)  # look'
    source = NODE.format(made=made, at_send="", sent=sent)
    cause = why_publishers_grow(evidence(recording([]), submission({NODE_FILE: source})))
    reported = None if cause is None else (cause.diagnosis, cause.where.line if cause.where else None)
    assert reported == (("publisher-in-callback", line_with(LOOK, source)) if found else None)


def test_what_a_callback_calls_for_every_message_is_found_in_its_own_methods() -> None:
    source = NODE.format(made=SUBSCRIBES, at_send="  # look", sent="self.other()")
    assert often(source, FRAME_S) == ("every-message", line_with(LOOK, source))


@pytest.mark.parametrize(("made", "found"), [(SUBSCRIBES, True), ("self.create_timer(0.016, self.send)", False)])
def test_a_method_that_each_message_calls_is_told(made: str, *, found: bool) -> None:
    source = NODE.format(made=made, at_send="", sent="publish(msg)")
    cause = why_often(evidence(recording([]), submission({NODE_FILE: source})), "publish", FRAME_S, PERIOD_S)
    words = "send is called for every message, 62.5 times per second, and each time it calls publish."
    assert (cause is not None and cause.text == words) == found


@pytest.mark.parametrize(
    ("loop", "words"),
    [
        ("while True: self.publisher.publish(msg)", "This loop calls publish without a pause."),
        ("while True: self.publisher.publish(msg); time.sleep(0.5)", None),
        ("self.timer = self.create_timer(0, self.other)", "The period of this timer is 0 s, so it calls its method"),
        ("self.timer = self.create_timer(0.0, self.idle)\n\n    def idle(self):\n        pass", None),
        ("self.timer = self.create_timer(0.1, self.other)", None),
    ],
)
def test_what_publishes_without_a_pause_is_told(loop: str, words: str | None) -> None:
    source = NODE.format(made="count = 3", at_send="", sent=loop)
    cause = why_often(evidence(recording([]), submission({NODE_FILE: source})), "publish", 0.001, PERIOD_S)
    assert (cause is None) == (words is None)
    assert cause is None or words is None or cause.text.startswith(words)


TWICE = "publish(msg); self.publisher.publish(msg)"


@pytest.mark.parametrize(
    ("sent", "mean_s", "found"),
    [
        (f"self.publisher.{TWICE}", 0.25, True),
        (f"with lock:\n            self.publisher.{TWICE}", 0.25, True),
        (f"self.publisher.{TWICE}", 0.5, False),
        ("if a: self.p.publish(1)\n        else: self.p.publish(2)", 0.25, False),
        ("if a:\n            self.p.publish(1)\n            return\n        self.p.publish(2)", 0.25, False),
        ("for a in b:\n            if a: self.p.publish(1)\n            else: self.p.publish(2)", 0.25, False),
        ("self.p.publish(1)", 0.25, False),
        ("self.p.publish(1); self.q.publish(2)", 0.25, False),
        ("self.p.publish(1) if a else self.p.publish(2)", 0.25, False),
        ("self.p.publish(1); a and self.p.publish(2)", 0.25, False),
        ("match a:\n            case 1: self.p.publish(1)\n            case _: self.p.publish(2)", 0.25, False),
        ("match a:\n            case _: self.p.publish(1); self.p.publish(2)", 0.25, True),
    ],
)
def test_calls_that_all_run_each_time_are_counted(sent: str, mean_s: float, *, found: bool) -> None:
    source = NODE.format(made="count = 3", at_send="", sent=sent)
    given = evidence(recording([]), submission({NODE_FILE: source}))
    cause = why_several_calls(given, "publish", mean_s, PERIOD_S)
    assert (cause is not None) == found
    assert cause is None or cause.text.startswith("Each time send runs, it calls publish 2 times, on lines")


@pytest.mark.parametrize(
    ("made", "last", "found"),
    [
        ("self.rate = self.create_rate(1)", "self.rate.sleep()", True),
        ("self.rate = self.create_rate(1); Thread(target=spin).start()", "self.rate.sleep()", False),
        ("self.rate = self.create_rate(1)", "time.sleep(1)", False),
        ("self.rate = self.create_rate(1); import time as t", "t.sleep(1)", False),
        ("self.rate = 1", "self.rate.sleep()", False),
    ],
)
def test_a_rate_that_nothing_spins_is_told(made: str, last: str, *, found: bool) -> None:
    source = NODE.format(made=made, at_send="", sent=f"{last}  # look")
    cause = why_rate_in_callback(evidence(recording([]), submission({NODE_FILE: source})))
    assert (cause is not None) == found
    words = "The method sleep of a Rate returns only while another thread spins the node, and this program has no other"
    assert cause is None or cause.text.startswith(words)
    assert cause is None or (cause.where and cause.where.line) == line_with(LOOK, source)


@pytest.mark.parametrize(
    ("made", "sent", "found"),
    [
        ("self.rate = self.create_rate(1)", "self.rate.sleep()", True),
        ("self.rate = self.create_rate(1); MultiThreadedExecutor()", "self.rate.sleep()", False),
        ("self.rate = self.create_rate(1)", "time.sleep(1)", False),
    ],
)
def test_a_rate_in_a_callback_is_told_only_for_one_thread(made: str, sent: str, *, found: bool) -> None:
    source = NODE.format(made=f"{made}; self.create_timer(0.5, self.send)", at_send="", sent=sent)
    cause = why_rate_in_callback(evidence(recording([]), submission({NODE_FILE: source})))
    assert (cause is not None) == found
    assert cause is None or "but rclpy.spin waits for this callback." in cause.text
