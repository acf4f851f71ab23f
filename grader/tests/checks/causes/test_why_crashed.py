"""The causes of exceptions that rclpy raises."""

from __future__ import annotations

import pytest

from grader.checks.causes.crash import crash_of
from grader.checks.causes.why_crashed import why_crashed
from grader.tests.checks.crashes import DRIVER, reported, to_look_at
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission
from grader.trial.recording import Output, ProcessEnd

ERROR = "InvalidTopicNameException: Invalid topic name: topic name must not contain characters"


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('self.create_publisher(Twist, "/turtle1/cmd vel", 10)', 'The name here is "/turtle1/cmd vel", with a space.'),
        ('self.create_subscription(Pose, topic="a-b", callback=x)', 'The name here is "a-b".'),
        ("self.create_publisher(Twist, TOPIC, 10)", "underscores and slashes."),
        ('print("no topic")', "underscores and slashes."),
    ],
)
def test_an_invalid_topic_is_shown(line: str, words: str) -> None:
    found = reported(DRIVER.format(line=line), ERROR)
    assert found.diagnosis == "topic-name-invalid"
    assert found.cause.endswith(words)


def test_an_invalid_topic_is_shown_at_its_own_line() -> None:
    call = "self.create_publisher(  # crashed\n            Twist, 'a b', 10)  # look\n        x = 1"
    source = DRIVER.format(line=call).replace("x = 1  # crashed", "x = 1")
    assert reported(source, ERROR).line == to_look_at(source)


RULES = {
    "topic name must not end with '/'": "A topic name must not end with a slash.",
    "topic name must not contain repeated '/'": "A topic name must not have two slashes in a row.",
    "topic name token must not start with a number": "No part of a topic name may begin with a digit.",
    "topic name must not be empty": "A topic name must not be empty.",
    "topic name must not contain characters other than": "use only letters, digits, underscores and slashes",
}


@pytest.mark.parametrize(("message", "rule"), RULES.items())
def test_each_rule_for_topic_names_is_told_alone(message: str, rule: str) -> None:
    found = reported(DRIVER.format(line="self.other()"), f"InvalidTopicNameException: Invalid topic name: {message}")
    assert [each for each in RULES.values() if each in found.cause] == [rule]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        ("NameError: free variable 'y' referenced", "This name has no value here. Check the spelling"),
        ("TabError: inconsistent use", "The indentation mixes tabs and spaces."),
        ("IndentationError: unexpected indent", "All lines of a block must have the same indentation."),
        ("KeyError: 'speed'", "The dictionary has no such key, or the set has no such item."),
    ],
)
def test_an_exception_without_a_known_cause_is_explained_by_its_class(error: str, words: str) -> None:
    assert reported(DRIVER.format(line="self.other()"), error).cause.startswith(words)
    assert reported(DRIVER.format(line="self.other()"), "OtherError: what").cause == ""


@pytest.mark.parametrize(
    ("said", "exit_code", "found"),
    [
        ("draw_circle: error: the following arguments are required: --speed", 2, True),
        ("draw_circle: error: the following arguments are required: --speed, --rate", 2, False),
        ("draw_circle: error: unrecognized arguments: --speed", 2, False),
        ("draw_circle: error: the following arguments are required: --speed", 3, False),
    ],
)
def test_an_argument_that_the_program_requires_is_named(said: str, exit_code: int, *, found: bool) -> None:
    source = DRIVER.format(line="parser.parse_args()")
    end = ProcessEnd(by="itself", exit_code=exit_code, t_s=-0.1, stop_s=None)
    given = evidence(
        recording([], end=end, stderr=Output(f"usage: draw_circle\n{said}\n")), submission({NODE_FILE: source})
    )
    crash = crash_of(given)
    assert crash is not None
    cause = why_crashed(given, crash)
    words = "The program needs the argument --speed, but the grader starts it without arguments."
    several = "The program needs the arguments --speed, --rate, but the grader starts it without arguments. Give each"
    assert (words in cause.text, several in cause.text) == (found, "--rate" in said)
    assert (cause.where is not None) == (found or "--rate" in said)


@pytest.mark.parametrize(
    ("thread", "exit_code", "told"),
    [
        ("Thread(target=rclpy.spin, args=(node,)).start()", -6, True),
        ("Thread(target=rclpy.spin, args=(node,)).start()", -11, False),
        ("Thread(target=node.work).start()", -6, False),
    ],
)
def test_a_thread_that_spins_while_the_program_ends_may_abort(thread: str, exit_code: int, *, told: bool) -> None:
    end = ProcessEnd(by="itself", exit_code=exit_code, t_s=0.1, stop_s=None)
    given = evidence(recording([], end=end), submission({NODE_FILE: f"node = Driver()\n{thread}\n"}))
    crash = crash_of(given)
    assert crash is not None
    cause = why_crashed(given, crash)
    assert (cause.diagnosis, cause.text.startswith("rclpy.spin runs in this thread.")) == (
        "ends-at-once" if told else "crash",
        told,
    )


@pytest.mark.parametrize(
    ("error", "found"),
    [("dictionary changed size during iteration", True), ("dictionary keys changed", False), ("no service", False)],
)
def test_a_loop_over_what_it_changes_is_told(error: str, *, found: bool) -> None:
    cause = reported(DRIVER.format(line="self.drive()"), f"RuntimeError: {error}").cause
    assert ("Loop over a copy: list() makes one." in cause) == found
    assert ("An item was added or removed while a loop went through the collection." in cause) == found


@pytest.mark.parametrize(
    ("error", "init", "found"),
    [
        ("no running event loop", "self.create_timer(0.5, self.send)", True),
        ("no running event loop", "self.send()", False),
        ("cannot start a new loop", "self.create_timer(0.5, self.send)", False),
    ],
)
def test_a_callback_has_no_event_loop_of_asyncio(error: str, init: str, *, found: bool) -> None:
    source = DRIVER.format(line="await asyncio.sleep(0.5)").replace("self.count = 0", init)
    cause = reported(source, f"RuntimeError: {error}").cause
    assert ("rclpy calls this callback without the event loop of asyncio." in cause) == found


@pytest.mark.parametrize(
    ("error", "found"), [("rclpy.exceptions.InvalidQoSProfileException: no depth", True), ("KeyError: 'depth'", False)]
)
def test_a_quality_needs_a_depth(error: str, *, found: bool) -> None:
    cause = reported(DRIVER.format(line="QoSProfile()"), error).cause
    assert ("A QoSProfile needs a depth, which is the size of the queue." in cause) == found


SPINNING = "RuntimeError: Executor is already spinning"


@pytest.mark.parametrize(
    ("line", "diagnosis", "words"),
    [
        ("rclpy.spin_once(self)", "spins-in-callback", "spin_once spins inside a callback"),
        ("rclpy.spin(self)", "spins-in-callback", "Remove the call. rclpy.spin in main calls every callback."),
        ("rclpy.spin_until_future_complete(self, x)", "waits-in-callback", "pass the next step to add_done_callback."),
    ],
)
def test_a_callback_cannot_spin_what_is_being_spun(line: str, diagnosis: str, words: str) -> None:
    source = DRIVER.format(line=line)
    called = reported(source.replace("self.count = 0", "self.create_timer(0.5, self.send)"), SPINNING)
    assert (called.diagnosis, called.line) == (diagnosis, to_look_at(source))
    assert words in called.cause
    elsewhere = reported(source, SPINNING)
    assert (elsewhere.diagnosis, elsewhere.line) == ("crash", to_look_at(source))
    assert elsewhere.cause.startswith("Another call spins the nodes already, for example in a thread")
    assert words not in reported(source, "RuntimeError: no").cause
