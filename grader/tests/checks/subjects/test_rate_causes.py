from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.causes.why_period import why_slow_timer
from grader.tests.checks.made import NODE_FILE, every, evidence, finding, node, recording
from grader.tests.checks.shapes import SHAPES

if TYPE_CHECKING:
    from grader.checks.outcome import Finding

TIMER = "self.create_timer(0.5, self.send)"


def rate(shape: str, *changes: tuple[str, str]) -> Finding:
    return finding("rate", evidence(SHAPES[shape](), node(*changes)))


def test_a_timer_with_that_period_is_pointed_at() -> None:
    found = rate("one hertz", (TIMER, "self.create_timer(1.0, self.send)"))
    assert (found.diagnosis, str(found.where)) == ("timer-period", f"{NODE_FILE}:10")


def test_the_only_timer_sets_the_rate_unless_its_callback_chooses_when_to_publish() -> None:
    unknown = (TIMER, "self.create_timer(self.period, self.send)")
    found = rate("one hertz", unknown)
    assert (found.diagnosis, str(found.where)) == ("timer-period", f"{NODE_FILE}:10")
    chooses = ("        self.publisher.publish(", "        if self.due():\n            self.publisher.publish(")
    assert rate("one hertz", unknown, chooses).diagnosis == "wrong-rate"


@pytest.mark.parametrize(
    ("timer", "guard", "found"),
    [
        ("self.create_timer(0.25, self.send)", "if self.due():", True),
        ("self.create_timer(0.3, self.send)", "if self.due():", False),
        ("self.create_timer(0.25, self.send)", "if True: pass\n        if 1:", True),
        (
            "self.create_timer(0.25, self.send); self.create_subscription(Pose, 'p', self.send, 1)",
            "if self.due():",
            False,
        ),
        ("self.create_timer(0.25, self.look)", "if self.due():", False),
    ],
)
def test_a_callback_that_sends_in_some_of_its_calls_is_told_in_how_many(timer: str, guard: str, *, found: bool) -> None:
    chooses = ("        self.publisher.publish(", f"        {guard}\n            self.publisher.publish(")
    finding_ = rate("one hertz", (TIMER, timer), chooses)
    assert (finding_.diagnosis, str(finding_.where)) == ("wrong-rate", f"{NODE_FILE}:10")
    assert ("send is called every 0.25 s, and one in 4 calls sends a command." in finding_.cause) == found


FAR = "if self.far:\n            "


@pytest.mark.parametrize(
    ("timer", "rest", "blamed"),
    [
        ("0.5", "time.sleep(1.0)", True),
        ("0.5", "time.sleep(0.5)", True),
        ("0.2", "time.sleep(0.45)", True),
        ("0.5", "time.sleep(0.02)", False),
        ("0.5", "for _ in range(50):\n            time.sleep(0.02)", True),
        ("0.5", "for _ in range(50):\n            time.sleep(self.rest)", False),
        ("0.5", "time.sleep(self.rest)", False),
        ("0.5", "time.sleep(0.3); time.sleep(0.3)", True),
        ("0.5", f"{FAR}time.sleep(0.3)\n        else:\n            time.sleep(0.4)", False),
        ("0.5", f"{FAR}time.sleep(0.1)\n        else:\n            time.sleep(0.5)", True),
        ("0.5", f"{FAR}time.sleep(0.3)\n        time.sleep(0.3)", True),
        ("0.5", f"{FAR}time.sleep(0.3)\n            return\n        time.sleep(0.4)", False),
        ("0.5", "with self.lock:\n            time.sleep(0.3)\n        time.sleep(0.3)", True),
        ("0.5", "time.sleep(0.3); self.other()\n\n    def other(self):\n        time.sleep(0.3)", False),
    ],
)
def test_only_a_sleep_that_is_long_enough_explains_messages_that_are_too_rare(
    timer: str, rest: str, *, blamed: bool
) -> None:
    sleeps = ("    def send(self):", f"    def send(self):\n        {rest}")
    found = rate("one hertz", ("0.5", timer), sleeps)
    assert (found.diagnosis == "sleep-in-callback") == blamed


@pytest.mark.parametrize(
    ("line", "blamed"),
    [
        ("rclpy.spin_once(self, timeout_sec=1.0)", True),
        ("rclpy.spin_until_future_complete(self, future, timeout_sec=0.6)", True),
        ("self.pen.call(request, 1.0)", True),
        ("rclpy.spin_once(self, timeout_sec=0.1)", False),
        ("rclpy.spin_once(self, timeout_sec=self.limit)", False),
        ("rclpy.spin_once(self)", False),
        ("rclpy.spin_once(self, timeout_sec=1.0); MultiThreadedExecutor()", False),
        ("self.pen.wait_for_service(timeout_sec=1.0)", False),
    ],
)
def test_a_wait_with_a_long_timeout_explains_messages_that_are_too_rare(line: str, *, blamed: bool) -> None:
    waits = ("    def send(self):", f"    def send(self):\n        {line}")
    found = rate("one hertz", waits)
    assert ("waits inside a callback" in found.cause) == blamed
    assert (str(found.where) == f"{NODE_FILE}:13") == blamed
    assert "waits inside a callback" not in rate("four hertz", waits).cause


REPORTS = ("    def send(self):", "    def report(self):\n        print(3)\n\n    def send(self):")


@pytest.mark.parametrize(("called", "line"), [("report", 11), ("send", 10)])
def test_a_timer_that_sends_nothing_does_not_set_the_rate(called: str, line: int) -> None:
    timers = f"self.create_timer(1.0, self.{called})\n        self.timer = self.create_timer(PERIOD, self.send)"
    found = rate("one hertz", (f"self.timer = {TIMER}", timers), REPORTS)
    assert (found.diagnosis, str(found.where)) == ("timer-period", f"{NODE_FILE}:{line}")


def test_a_timer_may_be_the_reason_if_nothing_calls_publish() -> None:
    other = ("        self.publisher.publish(msg)", "        self.sender.send(msg)")
    found = rate("one hertz", (TIMER, "self.create_timer(1.0, self.send)"), other)
    assert (found.diagnosis, str(found.where)) == ("timer-period", f"{NODE_FILE}:10")


@pytest.mark.parametrize(("called", "told"), [("report", False), ("send", True)])
def test_only_a_timer_that_sends_explains_too_few_messages(called: str, *, told: bool) -> None:
    slow = node((TIMER, f"self.create_timer(4.0, self.{called})"), REPORTS)
    assert (why_slow_timer(evidence(recording([]), slow), "publish", 2.0, 2) is not None) == told


@pytest.mark.parametrize(("shape", "diagnosis"), [("four hertz", "timer-period"), ("one hertz", "sleep-in-callback")])
def test_a_sleep_does_not_explain_too_many_messages(shape: str, diagnosis: str) -> None:
    unknown = (TIMER, "self.create_timer(self.period, self.send)")
    found = rate(shape, unknown, ("        msg = Twist()", "        time.sleep(0.6)\n        msg = Twist()"))
    assert found.diagnosis == diagnosis


def test_a_period_by_a_name_is_found() -> None:
    found = rate(
        "one hertz", (f"self.timer = {TIMER}", f"period = 2 / 2\n        self.timer = {TIMER.replace('0.5', 'period')}")
    )
    assert (found.diagnosis, str(found.where)) == ("timer-period", f"{NODE_FILE}:11")


def test_the_rate_given_as_the_period_is_reported() -> None:
    found = rate("two seconds", (TIMER, "self.create_timer(2.0, self.send)"))
    assert found.diagnosis == "rate-for-period"


def test_a_sleep_in_the_timers_method_is_reported() -> None:
    found = rate("one hertz", ("        msg = Twist()", "        time.sleep(0.6)\n        msg = Twist()"))
    assert (found.diagnosis, str(found.where)) == ("sleep-in-callback", f"{NODE_FILE}:13")
    assert found.cause == "While a method sleeps, a node with one thread does nothing else."


def test_a_publisher_that_each_call_creates_explains_uneven_intervals() -> None:
    publisher = 'self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)'
    found = rate("uneven", ("        msg = Twist()", f"        {publisher}\n        msg = Twist()"))
    assert (found.diagnosis, str(found.where)) == ("publisher-in-callback", f"{NODE_FILE}:13")
    assert rate("uneven").diagnosis == "uneven-rate"


def test_a_sleep_outside_of_every_callback_is_not_blamed() -> None:
    found = rate("one hertz", ("    rclpy.init(args=args)", "    time.sleep(0.6)\n    rclpy.init(args=args)"))
    assert found.diagnosis == "wrong-rate"


def test_a_sleep_without_a_timer_is_reported() -> None:
    loop = "while rclpy.ok(): self.send(); time.sleep(1.0)"
    found = rate("one hertz", (f"self.timer = {TIMER}", loop))
    assert (found.diagnosis, found.cause) == ("sleep-period", "The node sleeps for 1 s between two commands.")
    once = rate("one hertz", (f"self.timer = {TIMER}", "time.sleep(1.0)"))
    assert (once.diagnosis, once.cause) == ("wrong-rate", "The time between two calls to publish sets the rate.")
    assert "The time between two calls to" not in found.cause


@pytest.mark.parametrize(
    ("changes", "diagnosis", "line", "cause"),
    [
        ((), "uneven-rate", 16, ""),
        (
            (("        msg = Twist()", "        time.sleep(0.1); msg = Twist()"),),
            "uneven-rate",
            16,
            "Does the method that calls publish sleep for longer than the period?",
        ),
        (
            (("publish(msg)", "publish(msg); self.publisher.publish(msg)"),),
            "uneven-rate",
            16,
            "More than one line calls publish, or more than one timer runs.",
        ),
        (
            ((TIMER, f"{TIMER}; {TIMER}"),),
            "uneven-rate",
            16,
            "More than one line calls publish, or more than one timer runs.",
        ),
        (
            (("        msg = Twist()", f"        {TIMER}; msg = Twist()"),),
            "timer-in-callback",
            13,
            "send creates a new timer",
        ),
    ],
)
def test_an_uneven_rhythm_is_explained_by_the_source(
    changes: tuple[tuple[str, str], ...], diagnosis: str, line: int, cause: str
) -> None:
    found = rate("uneven", *changes)
    assert (found.diagnosis, str(found.where)) == (diagnosis, f"{NODE_FILE}:{line}")
    assert found.cause.startswith(cause)
    assert bool(found.cause) == bool(cause)


@pytest.mark.parametrize(
    ("first", "line", "cause"),
    [
        ("self.count = 0", 17, ""),
        ("time.sleep(3)", 9, "A sleep at the start may be the reason."),
        (
            "self.client.wait_for_service()",
            17,
            "The wait for a service (wait_for_service) may be the reason.",
        ),
    ],
)
def test_a_late_start_is_explained_by_the_source(first: str, line: int, cause: str) -> None:
    found = rate("late", ('super().__init__("draw_circle")\n', f'super().__init__("draw_circle")\n        {first}\n'))
    assert (found.diagnosis, str(found.where), found.cause) == ("late-start", f"{NODE_FILE}:{line}", cause)


@pytest.mark.parametrize(
    ("period", "diagnosis"),
    [
        ("1.0", "timer-period"),
        ("1.08", "timer-period"),
        ("0.92", "timer-period"),
        ("1.2", "wrong-rate"),
        ("0.8", "wrong-rate"),
    ],
)
def test_a_timer_explains_a_rate_that_is_nearly_its_own(period: str, diagnosis: str) -> None:
    found = rate("one hertz", (TIMER, f"self.create_timer({period}, self.send)"))
    assert (found.diagnosis, str(found.where)) == (diagnosis, f"{NODE_FILE}:10")


@pytest.mark.parametrize(
    ("length", "diagnosis"),
    [("1.08", "sleep-period"), ("0.92", "sleep-period"), ("1.2", "wrong-rate"), ("LENGTH", "wrong-rate")],
)
def test_a_sleep_explains_a_rate_that_is_nearly_its_own(length: str, diagnosis: str) -> None:
    found = rate("one hertz", (f"self.timer = {TIMER}", f"while True: time.sleep({length})"))
    assert (found.diagnosis, str(found.where)) == (
        diagnosis,
        f"{NODE_FILE}:{10 if diagnosis == 'sleep-period' else 16}",
    )


def test_a_sleep_of_which_nothing_is_known_explains_nothing() -> None:
    found = rate("one hertz", ("        msg = Twist()", "        time.sleep(LENGTH); msg = Twist()"))
    assert (found.diagnosis, str(found.where)) == ("wrong-rate", f"{NODE_FILE}:10")


def test_several_timers_with_other_periods_are_reported() -> None:
    found = rate("four hertz", (TIMER, f"{TIMER}\n        self.other = {TIMER}"))
    assert (found.diagnosis, str(found.where)) == ("several-timers", f"{NODE_FILE}:11")


@pytest.mark.parametrize(
    ("period_s", "diagnosis"), [(2.15, "rate-for-period"), (1.85, "rate-for-period"), (2.25, "timer-period")]
)
def test_the_rate_as_a_period_is_reported_when_it_is_nearly_that(period_s: float, diagnosis: str) -> None:
    made = recording(every(period_s, 2.0, 1.0))
    found = finding("rate", evidence(made, node((TIMER, f"self.create_timer({period_s}, self.send)"))))
    assert found.diagnosis == diagnosis


def test_a_loop_without_a_pause_is_reported_with_its_line() -> None:
    loop = (f"self.timer = {TIMER}", "while True: self.publisher.publish(Twist())")
    assert (rate("ten kilohertz", loop).diagnosis, str(rate("ten kilohertz", loop).where)) == (
        "loop-without-pause",
        f"{NODE_FILE}:10",
    )
    slow = recording([(index / 3.9, 2.0, 1.0) for index in range(1, 39)])
    assert finding("rate", evidence(slow, node(loop))).diagnosis == "wrong-rate"
    quick = recording([(index / 21.0, 2.0, 1.0) for index in range(1, 210)])
    assert finding("rate", evidence(quick, node(loop))).diagnosis == "loop-without-pause"


def test_a_condition_around_the_only_call_explains_why_commands_stop() -> None:
    publish = "        self.publisher.publish("
    found = rate("three quarters", (publish, f"        if self.count < 9:\n    {publish}"))
    assert found.diagnosis == "stopped-early"
    line = str(found.where).rpartition(":")[2]
    assert found.cause == f"publish is called only if the condition on line {line} is true."
    other = rate("three quarters", (publish, f"        if self.count < 9:\n            return\n{publish}"))
    assert (other.diagnosis, other.cause) == ("stopped-early", "")
