"""The sentences about the end of a node, and about the exception that caused it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.causes.crash import (
    MEANINGS,
    MOST_LINE,
    MOST_NAME,
    START,
    Crash,
    crash_of,
    end_observed,
    ended_early,
    read_traceback,
)
from grader.checks.causes.why_crashed import why_crashed
from grader.submission.where import Where
from grader.tests.checks.made import NODE_FILE, evidence, recording
from grader.tests.checks.shapes import TRACEBACK
from grader.trial.recording import Output, ProcessEnd

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

FILES = {NODE_FILE: b"", "helper.py": b"", "my_robot_controller/helper.py": b""}
HANDLING = "\nDuring handling of the above exception, another exception occurred:\n\n"
CAUSE = "\nThe above exception was the direct cause of the following exception:\n\n"


def ended(by: str = "itself", exit_code: int = 1, t_s: float = 3.0, stderr: str = "", **more: str) -> Evidence:
    end = ProcessEnd(by=by, exit_code=exit_code, t_s=t_s, stop_s=None, **more)  # type: ignore[arg-type]
    return evidence(recording([], end=end, stderr=Output(stderr)))


def traceback(error: str, line: int = 14, file: str = f"/ws/{NODE_FILE}") -> str:
    return f'{START}\n  File "{file}", line {line}, in send\n    x\n{error}\n'


@pytest.mark.parametrize(
    ("given", "error", "early", "observed"),
    [
        (ended("SIGINT", 0), None, "", ""),
        (ended("SIGINT", stderr=TRACEBACK), None, "", ""),
        (ended(exit_code=0), None, "The node exited on its own.", "The node exited on its own after 3.0 s."),
        (ended(exit_code=0, t_s=0.0), None, "The node exited on its own.", "The node exited on its own at startup."),
        (ended(exit_code=0, t_s=0.4), None, "The node exited on its own.", "The node exited on its own after 0.4 s."),
        (ended(), "exit code 1", "The node crashed: exit code 1.", "The node crashed after 3.0 s: exit code 1."),
        (ended(exit_code=-11), "SIGSEGV", "The node crashed: SIGSEGV.", "The node crashed after 3.0 s: SIGSEGV."),
        (ended(exit_code=-1), "SIGHUP", "The node crashed: SIGHUP.", "The node crashed after 3.0 s: SIGHUP."),
        (ended(exit_code=-99), "signal 99", "The node crashed: signal 99.", "The node crashed after 3.0 s: signal 99."),
        (
            ended(stderr=TRACEBACK),
            "ZeroDivisionError",
            f"The node crashed: ZeroDivisionError at {NODE_FILE}:14.",
            "The node crashed after 3.0 s: ZeroDivisionError: division by zero.",
        ),
        (
            ended(exit_code=0, stderr=TRACEBACK),
            "ZeroDivisionError",
            f"The node crashed: ZeroDivisionError at {NODE_FILE}:14.",
            "The node crashed after 3.0 s: ZeroDivisionError: division by zero.",
        ),
        (
            ended("SIGKILL", out_of="memory"),
            "it used all the memory that a node may use",
            "",
            "",
        ),
    ],
)
def test_an_end_is_reported_in_words(given: Evidence, error: str | None, early: str, observed: str) -> None:
    crash = crash_of(given)
    assert (crash and crash.error, ended_early(given), end_observed(given)) == (error, early, observed)


def test_an_exception_is_reported_with_its_words_if_it_has_any() -> None:
    assert Crash("KeyError", "'x'").observed == "KeyError: 'x'"
    assert Crash("InvalidNodeNameException", "other than '_':").observed.endswith("other than '_'")
    assert Crash("TypeError", "bad arguments.").observed == "TypeError: bad arguments"
    assert Crash("KeyError", "").observed == "KeyError"


@pytest.mark.parametrize(
    ("crash", "meaning"),
    [
        (Crash("AssertionError", "The 'x' field must be of type 'float'"), "This field is a float."),
        (Crash("AssertionError", "it is so"), "An assertion failed: a condition was false, or a message field"),
        (
            Crash("TypeError", "The 'x' field must be of type 'float'"),
            "An operation or a function got a value of the wrong type",
        ),
    ],
)
def test_an_error_has_a_meaning(crash: Crash, meaning: str) -> None:
    assert crash.meaning.startswith(meaning)
    assert Crash("BananaError", "").meaning == ""


@pytest.mark.parametrize(
    ("error", "meaning"),
    [
        ("ParameterNotDeclaredException", "Declare a parameter with declare_parameter before you read or set it."),
        ("SyntaxError", "Python cannot read this line or the line before it."),
        ("ZeroDivisionError", "A number was divided by zero."),
    ],
)
def test_a_meaning_belongs_to_its_error_only(error: str, meaning: str) -> None:
    assert crash_of(ended(stderr=traceback(f"{error}: x"))) == Crash(error, "x", Where(NODE_FILE, 14))
    assert Crash(error, "x").meaning == meaning
    assert [other for other, said in MEANINGS.items() if said == meaning] == [error]


@pytest.mark.parametrize(
    ("between", "error"),
    [
        ("During handling of the above exception, another exception occurred:", "ValueError"),
        ("The above exception was the direct cause of the following exception:", "ValueError"),
        ("The above exception was printed by the node itself:", "KeyError"),
    ],
)
def test_only_pythons_own_words_make_a_chain(between: str, error: str) -> None:
    crash = read_traceback(f"{traceback('ValueError: a')}\n{between}\n\n{traceback('KeyError: b')}", FILES)
    assert crash is not None
    assert crash.error == error


@pytest.mark.parametrize(
    ("text", "error", "line"),
    [
        (traceback("ValueError: a") + traceback("KeyError: b"), "KeyError", 14),
        (traceback("ValueError: a") + HANDLING + traceback("KeyError: b"), "ValueError", 14),
        (traceback("ValueError: a") + CAUSE + traceback("KeyError: b"), "ValueError", 14),
        (traceback("KeyboardInterrupt") + HANDLING + traceback("KeyError: b", 9), "KeyError", 9),
        (
            traceback("ValueError: a") + HANDLING + traceback("rclpy.X.NotInitializedException: b", 9),
            "NotInitializedException",
            9,
        ),
        (traceback("ValueError: a", file="/opt/x.py") + HANDLING + traceback("KeyError: b", 9), "ValueError", 9),
        (traceback("ValueError: a", file="/opt/x.py"), "ValueError", None),
        (traceback("ExternalShutdownException"), None, None),
        (traceback("not an error at all!"), None, None),
        (f"{START}\n", None, None),
        ("another exception occurred\n" + "x\n" * 3 + traceback("KeyError: b"), "KeyError", 14),
        (
            traceback("ValueError: a") + "another exception occurred\nx\nx\nx\n" + traceback("KeyError: b"),
            "KeyError",
            14,
        ),
        (f"another exception occurred\n{traceback('KeyError: b')}", "KeyError", 14),
        (traceback("ValueError: a", 3) + "\n" + START + "\nnot an error!\n", "ValueError", 3),
        (traceback("ValueError: a", 3) + f"Exception ignored in: <x>\n{traceback('KeyError: b', 9)}", "ValueError", 3),
        (f"Exception ignored in: <x>\n{traceback('KeyError: b', 9)}", None, None),
        (traceback("ValueError: a", 3, "/opt/site-packages/rclpy/helper.py"), "ValueError", None),
        (traceback("ValueError: a", 3, "/ws/site-packages/helper.py"), "ValueError", 3),
    ],
)
def test_the_exception_is_the_root_of_the_last_chain(text: str, error: str | None, line: int | None) -> None:
    crash = read_traceback(text, FILES)
    assert (crash and crash.error) == error
    assert (crash and crash.where and crash.where.line) == line


def test_a_message_goes_as_far_as_its_first_line_and_without_pythons_guesses() -> None:
    crash = read_traceback(traceback("AttributeError: no 'x'. Did you mean: 'y'?\n  more\n"), FILES)
    assert crash is not None
    assert crash.message == "no 'x'"


@pytest.mark.parametrize(
    "error", ["ValueError: " + "A" * 300_000, "TypeError: " + "a." * 100_000 + "() missing", "E" * 300_000]
)
def test_a_long_message_takes_no_time(error: str) -> None:
    given = ended(stderr=traceback(error))
    crash = crash_of(given)
    assert crash is not None
    assert (len(crash.error) <= MOST_NAME, len(crash.message) <= MOST_LINE) == (True, True)
    assert why_crashed(given, crash).diagnosis == "crash"


def test_the_file_is_the_one_whose_whole_path_fits() -> None:
    crash = read_traceback(traceback("ValueError: a", file="/ws/my_robot_controller/helper.py"), FILES)
    assert crash is not None
    assert str(crash.where) == "my_robot_controller/helper.py:14"
    other = read_traceback(traceback("ValueError: a", file="/ws/another_helper.py"), FILES)
    assert other is not None
    assert other.where is None
