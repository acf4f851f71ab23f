"""The reasons why a running node sends nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.causes.why_silent import returns_before, why_nothing, why_qos
from grader.evidence.evidence import Run
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.trial.observed import Offer
from grader.trial.recording import LogLine, Output

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        {made}

    def send(self):
        {sent}
        self.publisher.publish(Twist())


rclpy.spin(Driver())
"""
TIMER = "self.create_timer(0.5, self.send)"


def given(source: str) -> Evidence:
    return evidence(recording([]), submission({NODE_FILE: source}))


def silence(source: str) -> tuple[str, str, int | None] | None:
    cause = why_nothing(given(source), ("publish",))
    if cause is None:
        return None
    assert cause.where is not None
    assert cause.where.file == NODE_FILE
    return cause.diagnosis, cause.text, cause.where.line


@pytest.mark.parametrize(
    ("made", "sent", "diagnosis", "words"),
    [
        ("self.create_timer(500, self.send)  # look", "pass", "timer-milliseconds", "The timer waits 500 s"),
        ("self.create_timer(10, self.send)  # look", "pass", "timer-milliseconds", "The timer waits 10 s"),
        ("self.create_timer(0.5, self.send())  # look", "pass", "callback-called", "create_timer needs the method"),
        (
            "self.create_timer(0.5, lambda: self.send)  # look",
            "pass",
            "not-called",
            "The lambda mentions self.send but",
        ),
        ("while True: self.send()  # look", "pass", "blocks-in-init", "__init__ loops forever"),
        ("while 1: self.send()  # look", "pass", "blocks-in-init", "__init__ loops forever"),
        ("while rclpy.ok(): self.send()  # look", "pass", "blocks-in-init", "__init__ loops forever"),
        (
            TIMER,
            "rclpy.spin_until_future_complete(self, done)  # look",
            "waits-in-callback",
            "spin_until_future_complete waits inside a callback,",
        ),
        (TIMER, "self.client.call(request)  # look", "waits-in-callback", "call waits inside a callback,"),
        ("pass", "pass", "method-never-called", "Nothing calls send."),
        (
            f"rclpy.spin(self)  # look\n        {TIMER}",
            "pass",
            "blocks-in-init",
            "rclpy.spin returns only after Ctrl-C,",
        ),
        ("rclpy.spin(self)", "pass", "method-never-called", "Nothing calls send."),
        (
            "self.create_timer(60, self.step)  # look\n\n    def step(self):\n        self.send()",
            "pass",
            "timer-milliseconds",
            "The timer waits 60 s",
        ),
        (
            "while self.pose is None: time.sleep(0.1)  # look",
            "pass",
            "blocks-in-init",
            "If this loop in __init__ does not end, rclpy.spin is never reached.",
        ),
        (
            "while True:  # look\n            if self.pose:\n                break\n            time.sleep(0.1)",
            "pass",
            "blocks-in-init",
            "If this loop in __init__ does not end, rclpy.spin is never reached.",
        ),
    ],
)
def test_silence_is_explained_at_its_line(made: str, sent: str, diagnosis: str, words: str) -> None:
    source = NODE.format(made=made, sent=sent)
    found = silence(source)
    assert found is not None
    assert (found[0], found[2]) == (diagnosis, line_with(LOOK, source) or 7)
    assert found[1].startswith(words)


@pytest.mark.parametrize(
    ("made", "sent"),
    [
        (TIMER, "pass"),
        ("self.create_timer(0.5, partial(self.send))", "pass"),
        ("self.create_timer(0.5, make_callback(self.send))", "pass"),
        ("self.create_timer(PERIOD, self.send)", "pass"),
        (f"{TIMER}\n        rclpy.spin(self)", "pass"),
        (f"{TIMER}\n        while rclpy.ok(): rclpy.spin_once(self)", "pass"),
        (f"{TIMER}\n        while True: spin_once(self)", "pass"),
        (f"{TIMER}; self.create_timer(60, self.end)\n\n    def end(self):\n        raise SystemExit", "pass"),
        ("self.create_timer(0.5, self.make(3))\n\n    def make(self, x):\n        return lambda: self.send()", "pass"),
        ("self.create_timer(0.5, self.make(3))\n\n    def make(self, x):\n        return self.send", "pass"),
        ("self.create_timer(0.5, self.make(3))\n\n    def make(self, x):\n        return partial(self.send)", "pass"),
        ("self.create_timer(0.5, Sender(self.send))\n\nclass Sender:\n    pass\n\nclass Other:", "pass"),
        (f"while self.count < 3: self.count += 1\n        {TIMER}", "pass"),
        (f"rclpy.spin_until_future_complete(self, done)\n        {TIMER}", "pass"),
        (f"self.client.call(request)\n        {TIMER}", "pass"),
        (TIMER, "subprocess.call(words)"),
        (TIMER, "make().call(words)"),
        (TIMER, "call(words)"),
        (TIMER, "while True: break"),
        (f"while True: break\n        {TIMER}", "pass"),
        (f"while not self.client.wait_for_service(1.0): pass\n        {TIMER}", "pass"),
        (f"while not self.client.service_is_ready(): time.sleep(0.1)\n        {TIMER}", "pass"),
        (
            f"while True:\n            if self.client.service_is_ready():\n                break\n        {TIMER}",
            "pass",
        ),
        (
            f"while True:\n            if self.client:\n                break\n            self.do()\n        {TIMER}",
            "pass",
        ),
        (f"Thread(target=lambda: rclpy.spin(self)).start()\n        {TIMER}", "pass"),
        ("self.create_timer(0.5, self)\n\n    def __call__(self):\n        self.send()", "pass"),
        ("getattr(self, 'se' + 'nd')()", "pass"),
    ],
)
def test_what_looks_right_is_not_blamed(made: str, sent: str) -> None:
    assert silence(NODE.format(made=made, sent=sent)) is None


@pytest.mark.parametrize(
    ("base", "name", "found"),
    [("Thread", "run", False), ("Node", "run", True), ("Driver", "go", True), ("Driver", "destroy_node", False)],
)
def test_a_method_that_a_base_class_calls_is_not_blamed(base: str, name: str, *, found: bool) -> None:
    own = f"\n\nclass Other({base}):\n    def {name}(self):\n        self.publisher.publish(1)\n"
    reported = silence(NODE.format(made=TIMER, sent="pass") + own)
    words = f"Nothing calls {name}. The method is not the callback of a timer or a subscription."
    assert (reported is not None and reported[1] == words) == found


def test_a_method_that_sends_nothing_need_not_be_called() -> None:
    source = NODE.format(made=TIMER, sent="pass") + "\n\nclass Other:\n    def idle(self):\n        print(3)\n"
    assert silence(source) is None
    sends = "class Driver:\n    def __init__(self):\n        self.publisher.publish(Twist())\n\nrclpy.spin(Driver())\n"
    assert silence(sends) is None


@pytest.mark.parametrize(
    ("last", "expected"),
    [
        ("rclpy.spin", ("not-called", 1)),
        ("rclpy.spin(node)", None),
        ("rclpy.spin_once(node, timeout_sec=1.0)", None),
        ("rclpy.shutdown()", ("no-spin", None)),
    ],
)
def test_a_missing_spin_is_reported_in_the_end(last: str, expected: tuple[str, int | None] | None) -> None:
    found = silence(f"{last}\n")
    assert (found and (found[0], found[2])) == expected


SERVICE = NODE.format(
    made="""self.client = self.create_client(Spawn, {name})  # look
        {waits}
        self.create_timer(0.5, self.send)""",
    sent="pass",
)


@pytest.mark.parametrize(
    ("name", "waits", "words"),
    [
        ('"/spwan"', "self.client.wait_for_service()", "The node waits for the service /spwan, which does not exist."),
        ('"spwan"', "self.client.wait_for_service()", "The node waits for the service spwan, which does not exist."),
        ('"/quaff"', "self.client.wait_for_service()", "The node waits for the service /quaff, which does not exist."),
        ('"/spawn"', "self.client.wait_for_service()", None),
        ('"spawn"', "self.client.wait_for_service()", None),
        ('"/spwan"', "self.client.service_is_ready()", None),
        ("NAME", "self.client.wait_for_service()", None),
    ],
)
def test_a_service_that_nobody_offers_is_named(name: str, waits: str, words: str | None) -> None:
    source = SERVICE.format(name=name, waits=waits)
    found = silence(source)
    assert (found is not None) == (words is not None)
    if found is not None and words is not None:
        assert (found[0], found[2]) == ("service-not-there", line_with(LOOK, source))
        assert found[1].startswith(words)
        assert found[1].endswith(" A similar service exists: /spawn.") == ("spwan" in name)


def test_a_service_that_another_node_of_the_trial_offers_exists() -> None:
    quiet = given(SERVICE.format(name='"/catch"', waits="self.client.wait_for_service()"))
    offered = recording([], offers=(Offer("/spawner", "/catch", "turtlesim/srv/Kill"),))
    assert why_nothing(quiet, ("publish",)) is not None
    assert why_nothing(quiet.with_run(Run(offered)), ("publish",)) is None


def test_a_client_without_a_name_is_none() -> None:
    source = NODE.format(made=f"self.create_client(Spawn).wait_for_service()\n        {TIMER}", sent="pass")
    assert silence(source) is None


def test_ends_that_do_not_go_together_are_reported_by_rclpy() -> None:
    source = NODE.format(made=TIMER, sent="pass")
    said = "New subscription discovered on topic, requesting incompatible QoS. No messages will be sent to it."
    quiet = given(source)
    by_stderr = quiet.with_run(Run(recording([], stderr=Output(said))))
    by_log = quiet.with_run(Run(recording([], log=(LogLine(0.5, "WARN", "driver", said),))))
    assert why_qos(quiet) is None
    for loud in (by_stderr, by_log):
        cause = why_qos(loud)
        assert cause is not None
        assert (cause.diagnosis, str(cause.where)) == ("qos-mismatch", f"{NODE_FILE}:4")


LOOP = """\
node = rclpy.create_node("driver")
publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
{made}
while rclpy.ok():
    publisher.publish(Twist())
    {spun}
"""


@pytest.mark.parametrize(
    ("made", "spun", "waits"),
    [
        ("pass", "rclpy.spin_once(node)  # look", True),
        ("pass", "executor.spin_once()  # look", True),
        ("pass", "rclpy.spin_once(node, timeout_sec=0.5)", False),
        ("pass", "rclpy.spin_once(node, None, 0.5)", False),
        ("pass", "rclpy.spin_once(node, timeout_sec=None)  # look", True),
        ("pass", "rclpy.spin_once(node, timeout_sec=limit)", False),
        ("pass", "executor.spin_once(0.5)", False),
        ("pass", "executor.spin_once(self.limit)", False),
        ("client = node.create_client(Empty, '/clear')", "rclpy.spin_once(node)", False),
        ("timer = node.create_timer(0.5, send)", "rclpy.spin_once(node)", False),
        ("heard = node.create_subscription(Pose, '/turtle1/pose', hear, 10)", "rclpy.spin_once(node)", False),
    ],
)
def test_spin_once_without_anything_that_wakes_it_is_a_cause(made: str, spun: str, *, waits: bool) -> None:
    source = LOOP.format(made=made, spun=spun)
    reported = silence(source)
    if waits:
        assert reported is not None
        assert (reported[0], reported[2]) == ("spin-once-waits", line_with(LOOK, source))
    else:
        assert reported is None


def test_a_program_that_never_spins_is_told_so() -> None:
    source = NODE.format(made=TIMER, sent="pass")
    assert silence(source) is None
    cause = why_nothing(given(source.replace("rclpy.spin(", "print(")), ("publish",))
    assert cause is not None
    assert (cause.diagnosis, cause.text) == ("no-spin", "Without rclpy.spin, no timer callback is ever called.")


@pytest.mark.parametrize(("sent", "found"), [("return", True), ("if done: return", False), ("pass", False)])
def test_a_return_before_the_message_is_found(sent: str, *, found: bool) -> None:
    cause = returns_before(given(NODE.format(made=TIMER, sent=sent)), "publish")
    assert (cause is not None) == found
    assert cause is None or cause.text == "send returns on line 8, before it calls publish."


def test_a_return_in_one_of_two_methods_that_send_is_not_blamed() -> None:
    other = "\n\nclass Other(Node):\n    def stop(self):\n        self.publisher.publish(1)\n"
    assert returns_before(given(NODE.format(made=TIMER, sent="return") + other), "publish") is None


@pytest.mark.parametrize("body", ["self.send()", "self.send() or self.send", "(self.send, None)"])
def test_a_lambda_that_calls_something_is_not_blamed(body: str) -> None:
    assert silence(NODE.format(made=f"self.create_timer(0.5, lambda: {body})", sent="pass")) is None
