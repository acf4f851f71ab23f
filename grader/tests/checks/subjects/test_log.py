"""The log lines of a node: their format, their rate, and the causes of a log without such lines."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.log import LOG_LINES, LOG_RATE
from grader.tests.checks.made import DURATION_S, NODE, NODE_FILE, evidence, found, recording, submission
from grader.tests.checks.node_log import HELLO, LOGS, OTHER_FORM, POINTS, RATE, hello, in_format, lines
from grader.tests.checks.shapes import TRACEBACK, crashed
from grader.tests.checks.told import told
from grader.trial.recording import LogLine, Output

if TYPE_CHECKING:
    from grader.trial.recording import Recording


def test_lines_in_the_format_are_enough_whatever_else_is_logged() -> None:
    assert in_format(lines("I begin", "Hello 0", "Hello 1")).observed == 'The log contains lines such as "Hello 0".'


@pytest.mark.parametrize(
    ("log", "format_", "observed", "cause"),
    [
        ("hello 0", HELLO, 'The last log line is "hello 0".', "Upper and lower case matter."),
        (
            "Hello 0!",
            HELLO,
            'The last log line is "Hello 0!".',
            "The line contains more than it should.",
        ),
        (
            "Hello: 0",
            HELLO,
            'The last log line is "Hello: 0".',
            "Compare the line letter by letter: capital letters, spaces and dots matter.",
        ),
        ("Count 0", HELLO, 'The last log line is "Count 0".', 'The line does not contain "Hello".'),
        (
            "X = 1.23 at y=5",
            "x={x:.2f} y={y:.2f} distance={d:.2f}",
            'The last log line is "X = 1.23 at y=5".',
            'The line does not contain "x=" and "distance=".',
        ),
        (
            "Hello",
            HELLO,
            'The last log line is "Hello".',
            OTHER_FORM,
        ),
        (
            "x=1.234",
            POINTS,
            'The last log line is "x=1.234".',
            f"{OTHER_FORM} In an f-string, {{value:.2f}} writes two decimal places.",
        ),
        (
            "Hello <bound method FirstNode.count of <first_node.FirstNode object at 0x7f>>",
            HELLO,
            'The last log line is "Hello <bound method FirstNode.count of <first_node.FirstNode object at 0x7f>>".',
            "count is a method, so the line shows the method itself instead of a value.",
        ),
        (
            "Hello \u0663",  # a digit, but not an ASCII digit
            HELLO,
            'The last log line is "Hello \u0663".',
            OTHER_FORM,
        ),
    ],
)
def test_a_line_in_another_format_is_shown_with_what_differs(log: str, format_: str, observed: str, cause: str) -> None:
    finding = in_format(lines(log), format_)
    assert (finding.status, finding.observed, finding.cause) == (Status.FAILED, observed, cause)
    assert finding.diagnosis in ("log-capitals", "log-more", "log-numbers", "log-format")


@pytest.mark.parametrize(
    ("node", "stdout", "diagnosis"),
    [
        (LOGS, "Hello 0\nHello 1\n", "print-instead"),
        (NODE, "", "no-log"),
        (LOGS.replace("rclpy.spin(", "str("), "", "no-spin"),
        (LOGS.replace("create_timer(0.5, self.send)", "x"), "", "method-never-called"),
        (LOGS.replace("create_timer(0.5", "create_timer(500"), "", "timer-milliseconds"),
        (LOGS.replace("self.send)", "self.send())"), "", "callback-called"),
    ],
)
def test_a_silent_log_is_explained_by_the_source(node: str, stdout: str, diagnosis: str) -> None:
    finding = in_format((), node=node, stdout=stdout)
    assert (finding.diagnosis, finding.where is not None) == (diagnosis, True)
    assert finding.observed == ("The lines are printed, not logged." if stdout else "The node logged nothing.")


@pytest.mark.parametrize(
    ("node", "stdout", "words"),
    [
        (
            NODE.replace("self.publisher.publish(msg)", "print(1)"),
            "1.000\n",
            "but it printed lines. | print only writes",
        ),
        (NODE.replace("self.publisher.publish(msg)", "print(1)"), "", "never called."),
        (LOGS.replace("def send(self):", "def send(self):\n        print(1)"), "1.000\n", "may never run."),
        (NODE, "from a library\n", "never called."),
    ],
)
def test_a_node_that_prints_other_lines_and_never_logs_is_told_the_difference(
    node: str, stdout: str, words: str
) -> None:
    finding = in_format((), node=node, stdout=stdout)
    assert words in f"{finding.observed} | {finding.cause}"
    assert ("printed lines" in finding.observed) == ("printed lines" in words)


def test_a_crash_explains_a_silent_log() -> None:
    trial = recording([], end=crashed(-0.2), graphs=(), stderr=Output(TRACEBACK))
    finding = found(LOG_LINES, evidence(trial), format=HELLO)
    assert (finding.diagnosis, str(finding.where)) == ("crash", f"{NODE_FILE}:14")


@pytest.mark.parametrize("forged", ["turtlesim", "other"])
def test_only_what_the_node_logged_before_ctrl_c_counts(forged: str) -> None:
    late = tuple(replace(line, t_s=DURATION_S + 0.1) for line in hello(0))
    ours = lines("Hello 0", logger="turtlesim") if forged == "turtlesim" else ()
    assert in_format((*ours, *late)).status is Status.FAILED


@pytest.mark.parametrize(("every_s", "status"), [(1.0, "passed"), (0.5, "failed"), (2.0, "failed")])
def test_the_rate_is_that_of_the_lines_in_the_format(every_s: float, status: str) -> None:
    count = int(9.5 / every_s)
    said = lines(*(f"Hello {number}" for number in range(count)), every_s=every_s)
    noise = tuple(LogLine(line.t_s + 0.3, "INFO", line.logger, "something else") for line in said)
    trial = recording([], log=tuple(sorted((*said, *noise), key=lambda line: line.t_s)))
    finding = found(LOG_RATE, evidence(trial), format=HELLO, **RATE)
    assert finding.status.value == status
    assert "log line" in finding.observed.lower()


def test_a_submission_is_read_and_never_run() -> None:
    package = submission({NODE_FILE: "raise SystemExit\n"})
    assert found(LOG_LINES, evidence(recording([]), package), format=HELLO).status is Status.FAILED


def about_lines(text: str, **changes: Any) -> str:  # noqa: ANN401
    trial = recording([], log=lines(text), **changes)
    return told(found(LOG_LINES, evidence(trial, submission({NODE_FILE: LOGS})), format=HELLO))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("A placeholder such as {} or %d is still in the line", "Hello %d", "Hello 5 %"),
        ("A placeholder such as {} or %d is still in the line", "Hello {}", "Hello {counter}"),
        ("The line contains the braces themselves.", "Hello {counter}", "Hello {}"),
        ("The words are right, but the numbers are missing or have the wrong format.", "Hello", "Hi"),
        ("The line contains more than it should.", "Hello 0!", "hello 0"),
        ("Upper and lower case matter.", "hello 0", "Hello 0!"),
    ],
)
def test_a_sentence_about_a_line_is_true(words: str, true: str, near: str) -> None:
    assert words in about_lines(true)
    assert words not in about_lines(near)


@pytest.mark.parametrize(("line", "found"), [("Hello 0", True), ("Hello", False)])
def test_a_log_with_such_a_line_passes_and_another_is_told_what_is_expected(line: str, *, found: bool) -> None:
    finding = in_format(lines(line))
    words = 'The log contains lines such as "Hello 0".'
    assert (finding.observed == words, finding.expected == words) == (found, not found)


RECEIVES = "New publisher discovered, offering incompatible QoS. No messages will be received from it."
SENDS = "New subscription discovered, requesting incompatible QoS. No messages will be sent to it."


@pytest.mark.parametrize(("warning", "found"), [(RECEIVES, True), (SENDS, False)])
def test_only_a_subscription_can_receive_nothing(warning: str, *, found: bool) -> None:
    given = about_lines("I begin", stderr=Output(warning))
    assert ("No message reached the subscription, and no such line was logged." in given) == found
    assert ('The last log line is "I begin".' in given) != found
    silent = recording([], stderr=Output(warning))
    nothing = told(found_in(silent))
    assert ("No message reached the subscription, and nothing was logged." in nothing) == found


def found_in(trial: Recording) -> Finding:
    return found(LOG_LINES, evidence(trial, submission({NODE_FILE: LOGS})), format=HELLO)


@pytest.mark.parametrize(
    ("level", "words"),
    [
        ("debug", "Messages of the level debug are not shown. Use get_logger().info(...)."),
        ("inform", "get_logger().info(...) is never called."),
    ],
)
def test_the_level_of_a_message_decides_whether_it_is_shown(level: str, words: str) -> None:
    finding = in_format((), node=LOGS.replace(".info(", f".{level}("))
    assert (finding.cause, finding.diagnosis) == (words, "no-log")
