"""A program that prints a summary of a bag, and its message about a bag without poses."""

from __future__ import annotations

import pytest

from grader.tests.checks.bag_step import judged, printed, raised, solution
from grader.tests.checks.told import told
from grader.trial.called import Called

PROGRAM = "my_robot_controller/bag_report.py"


@pytest.mark.parametrize(
    ("line", "diagnosis"),
    [
        ("messages=21 rate=2.00 x=4.20 y=6.90 radius=1.80", None),
        ("messages=21 rate=2.10 x=4.20 y=6.90 radius=1.80", "rate-off-by-one"),
        ("messages=21 rate=0.00 x=4.20 y=6.90 radius=1.80", "wrong-rate"),
        ("messages=21 rate=0.50 x=4.20 y=6.90 radius=1.80", "period-for-rate"),
        ("messages=21 rate=9.00 x=4.20 y=6.90 radius=1.80", "wrong-rate"),
        ("messages=20 rate=2.00 x=4.20 y=6.90 radius=1.80", "wrong-count"),
        ("messages=21 rate=2.00 x=6.90 y=4.20 radius=1.80", "x-y-swapped"),
        ("messages=21 rate=2.00 x=4.20 y=6.90 radius=3.60", "diameter"),
        ("messages=21 rate=2.00 x=4.20 y=6.90 radius=nan", "not-a-number"),
        ("messages: 21", "print-format"),
        ("", "prints-nothing"),
    ],
)
def test_a_printed_line_has_a_cause(line: str, diagnosis: str | None) -> None:
    assert judged("report", printed(line)).diagnosis == diagnosis


def test_messages_of_other_topics_do_not_count() -> None:
    line = "messages=43 rate=12.50 x=7.30 y=3.10 radius=0.90"
    assert judged("other-topics", printed(line, "two-topics")).diagnosis == "all-messages"
    taken = raised("two-topics", "AttributeError: 'geometry_msgs__msg__Twist' object has no attribute 'x'")
    assert judged("other-topics", taken).diagnosis == "all-messages"


@pytest.mark.parametrize(
    ("called", "diagnosis"),
    [
        (Called("no-poses", "exit 1", stderr="no poses\n"), None),
        (Called("no-poses", "exit 0", stdout="no poses\n"), "exit-code"),
        (Called("no-poses", "exit 1"), "exit-code"),
        (raised("no-poses", "IndexError: list index out of range"), "program-traceback"),
    ],
)
def test_a_bag_without_poses_is_told(called: Called, diagnosis: str | None) -> None:
    assert judged("no-poses", called).diagnosis == diagnosis


LINE = "messages=21 rate=2.00 x=4.20 y=6.90 radius=1.80"
BOTH = "messages=43 rate=12.50 x=7.30 y=3.10 radius=0.90"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        (f'bag_report printed "{LINE}".', LINE, LINE.replace("21", "20")),
        (f"bag_report bags/slow prints {LINE}", LINE.replace("21", "20"), LINE),
        ("Each message on the topic counts once.", LINE.replace("21", "20"), LINE.replace("2.00", "9.00")),
        ("NaN is the result of an undefined computation.", LINE.replace("1.80", "nan"), "nanoseconds: 5"),
        ("Compare the line letter by letter", "nanoseconds: 5", LINE.replace("1.80", "nan")),
        ("The rate is the number of intervals divided by", LINE.replace("2.00", "9.00"), LINE.replace("2.00", "2.10")),
        ("n messages have only n - 1 intervals.", LINE.replace("2.00", "2.10"), LINE.replace("2.00", "9.00")),
        (
            "This is the time between two messages in seconds.",
            LINE.replace("2.00", "0.50"),
            LINE.replace("2.00", "9.00"),
        ),
        ("bag_report printed nothing.", "", LINE),
        ("The function that the entry point names must reach the line with print.", "", LINE),
    ],
)
def test_a_sentence_about_a_printed_line_is_true(words: str, true: str, near: str) -> None:
    assert words in told(judged("report", printed(true)))
    assert words not in told(judged("report", printed(near)))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("All messages in the bag were counted, not only the poses.", BOTH, BOTH.replace("43", "42")),
        ("Each message on the topic counts once.", BOTH.replace("43", "42"), BOTH),
    ],
)
def test_all_messages_are_more_than_the_poses(words: str, true: str, near: str) -> None:
    assert words in told(judged("other-topics", printed(true, "two-topics")))
    assert words not in told(judged("other-topics", printed(near, "two-topics")))


@pytest.mark.parametrize(("of", "found"), [("Twist", True), ("Pose", False)])
def test_a_command_that_is_used_as_a_pose_is_told(of: str, *, found: bool) -> None:
    taken = raised("two-topics", f"AttributeError: 'a__msg__{of}' object has no attribute 'x'")
    assert ("The program used a command as a pose." in told(judged("other-topics", taken))) == found


@pytest.mark.parametrize(
    ("old", "found"), [("stamp / 1e9", False), ("stamp", True), ("stamp / 10**9", False), ("stamp * 1e-9", False)]
)
def test_a_rate_of_zero_comes_from_nanoseconds_only_if_nothing_divides_by_a_billion(old: str, *, found: bool) -> None:
    source = solution().files[PROGRAM].decode().replace("stamp / 1e9", old).encode()
    zero = told(judged("report", printed(LINE.replace("2.00", "0.00")), files={PROGRAM: source}))
    assert ("Time stamps in a bag are in nanoseconds. A second has 1,000,000,000 nanoseconds." in zero) == found


def ended(how: str, *, stdout: str = "", stderr: str = "") -> Called:
    return Called("no-poses", how, stdout=stdout, stderr=stderr)


TAKEN = raised("no-poses", "AttributeError: 'geometry_msgs__msg__Twist' object has no attribute 'x'")
CRASH = raised("no-poses", "IndexError: list index out of range")


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ('bag_report printed "no poses"', ended("exit 1", stderr="no poses\n"), ended("exit 1")),
        ('bag_report printed "no poses"', ended("exit 1", stdout="no poses\n"), ended("exit 0", stdout="no poses\n")),
        (
            "For a bag without poses, bag_report printed no message (exit 1).",
            ended("exit 1"),
            ended("exit 1", stdout="a"),
        ),
        ("If you call sys.exit with a string, Python prints the string.", ended("exit 1"), ended("signal 9")),
        (
            "For a bag without poses, bag_report did not exit by itself (signal 9).",
            ended("signal 9", stderr="no poses\n"),
            ended("exit 9"),
        ),
        ("For a bag without poses, bag_report ended with exit code 0.", ended("exit 0"), ended("exit 1")),
        (
            "whether this program failed. If you call sys.exit with a string, the exit code is 1.",
            ended("exit 0"),
            ended("exit 1"),
        ),
        (
            "For a bag without poses, bag_report ended with IndexError: list index out of range.",
            CRASH,
            ended("exit 1", stderr="IndexError"),
        ),
        (
            "The program used a command as a pose. AnyReader.messages([]) returns the messages on all topics.",
            TAKEN,
            CRASH,
        ),
        ("A traceback does not help a user.", CRASH, TAKEN),
        (
            "A traceback does not help a user. If there are no poses, call sys.exit with a sentence.",
            CRASH,
            ended("exit 1"),
        ),
        (
            "bag_report prints one sentence about what is missing, and ends with an exit code other than 0.",
            ended("exit 0"),
            ended("exit 1", stderr="no poses\n"),
        ),
    ],
)
def test_a_sentence_about_a_bag_without_poses_is_true(words: str, true: Called, near: Called) -> None:
    assert words in told(judged("no-poses", true))
    assert words not in told(judged("no-poses", near))


@pytest.mark.parametrize(("path", "found_"), [("circle_bag", True), ("bags/slow/metadata.yaml", False)])
def test_a_program_that_opens_another_bag_is_told(path: str, *, found_: bool) -> None:
    finding = judged("report", raised("slow", f"FileNotFoundError: The following paths are missing: [{path}]"))
    words = "The program must open the bag that its first argument names, whatever the name is: sys.argv[1]."
    assert (words in told(finding)) == found_


LOGGED = Called("slow", "exit 0", stdout="noise", stderr=f"[INFO] [1.5] [bag_report]: {LINE}")


@pytest.mark.parametrize(
    ("called", "words", "told"),
    [
        (LOGGED, "The line is on stderr, where the log goes. Write it to stdout, as print does", True),
        (Called("slow", "exit 0", stderr=LINE), "The line is on stderr, where the log goes.", True),
        (printed("noise"), "The line is on stderr, where the log goes.", False),
        (
            Called("slow", "exit 2", stderr="bag_report: error: the following arguments are required: --bag"),
            "The program gets its argument without an option such as --bag.",
            True,
        ),
        (
            Called("slow", "exit 2", stderr="bag_report: error: the following arguments are required: bag, topic"),
            "The program gets its argument without an option such as",
            False,
        ),
    ],
)
def test_how_a_program_is_called_and_answers_is_told(called: Called, words: str, *, told: bool) -> None:
    finding = judged("report", called)
    assert (words in finding.cause) == told
    observed = ("bag_report did not print the line.", "bag_report ended with an error of argparse.")
    assert (finding.observed in observed) == told


@pytest.mark.parametrize(("stderr", "told"), [("the bag has too few messages: 1.\n", True), ("", False)])
def test_a_message_of_the_program_is_compared_with_the_bag(stderr: str, *, told: bool) -> None:
    finding = judged("report", Called("slow", "exit 1", stderr=stderr))
    cause = finding.cause
    assert finding.observed.startswith("bag_report ended (exit 1")
    assert ("The bag contains 21 poses. Does the program find all of them before it ends?" in cause) == told
