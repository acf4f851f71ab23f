"""The commands of `ros2` that a page may run."""

from __future__ import annotations

import os

import pytest

from grader.common.interpreter import Start
from grader.errors import UsageError
from grader.open import question
from grader.open.question import arguments


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("topic list", ["topic", "list"]),
        ("ros2 topic list -t", ["topic", "list", "-t"]),
        ("ros2 topic echo /turtle1/pose", ["topic", "echo", "/turtle1/pose", "--once"]),
        ("$ ros2 node info /turtlesim", ["node", "info", "/turtlesim"]),
        ("topic hz /turtle1/cmd_vel", ["topic", "hz", "/turtle1/cmd_vel"]),
        ("interface show geometry_msgs/msg/Twist", ["interface", "show", "geometry_msgs/msg/Twist"]),
        ("param get /turtlesim background_r", ["param", "get", "/turtlesim", "background_r"]),
        ("'action' list", ["action", "list"]),
        ("action find turtlesim/action/RotateAbsolute", ["action", "find", "turtlesim/action/RotateAbsolute"]),
    ],
)
def test_a_question(text: str, words: list[str]) -> None:
    assert arguments(text) == words


@pytest.mark.parametrize(
    ("text", "guess"),
    [
        ("topics list", "topic list"),
        ("ros2 topic lsit", "topic list"),
        ("nodes info /turtlesim", "node info"),
        ("interface shwo geometry_msgs/msg/Twist", "interface show"),
    ],
)
def test_a_typing_error_gets_a_suggestion(text: str, guess: str) -> None:
    with pytest.raises(UsageError, match=f"Did you mean `ros2 {guess}`"):
        arguments(text)


@pytest.mark.parametrize(
    "text", ["topic pub /a", "param set /a b 1", "service call /clear", "topic bw /a", "bag record"]
)
def test_a_command_that_needs_a_terminal_is_no_typing_error(text: str) -> None:
    with pytest.raises(UsageError, match="Only commands that change nothing can be run here"):
        arguments(text)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "topic",
        "topic pub /turtle1/cmd_vel geometry_msgs/msg/Twist",
        "service call /clear std_srvs/srv/Empty",
        "param set /turtlesim background_r 0",
        "action send_goal /a b {}",
        "run turtlesim turtlesim_node",
        "bag record -a",
        "daemon start",
        "param dump /turtlesim",
        "topic list; rm -rf x",
        "topic list && x",
        "topic list $(x)",
        "topic list `x`",
        "topic list > x",
        "topic echo /a --qos-profile x",
        "topic list --spin-time 9999",
        "topic list -",
        "topic echo /a --filter '__import__(\"os\")'",
        "topic list 'a",
        "topic info " + "a " * 20,
        "$",
        "bash -c x",
        "ros2 ros2 topic list",
        "topic list a\x00b",
        "topic echo /a\n/b --field x",
    ],
)
def test_anything_else_is_refused_with_a_sentence(text: str) -> None:
    with pytest.raises(UsageError) as refused:
        arguments(text)
    assert str(refused.value).endswith((".", "?"))


def test_a_command_with_too_many_words_is_refused_for_this_reason() -> None:
    with pytest.raises(UsageError, match="At most 8 words"):
        arguments("topic info -v -v -v -v -v -v /pose")


@pytest.mark.parametrize("text", ["topic info 'a", "topic list \\"])
def test_a_command_that_the_shell_would_not_complete(text: str) -> None:
    with pytest.raises(UsageError, match="a quote that is not closed, or ends with a backslash"):
        arguments(text)


def test_only_a_command_that_waits_for_messages_reports_that_none_arrived(monkeypatch: pytest.MonkeyPatch) -> None:
    endless = Start(["sleep", "60"], dict(os.environ))
    monkeypatch.setattr(question, "interpreter", lambda *_, **__: endless)
    monkeypatch.setattr(question, "PATIENCE_S", 0.2)
    none = question.Answer("No message arrived within 0 s.", stopped=False)
    assert question.answer(["topic", "echo", "/a", "--once"], {}) == none
    monkeypatch.setattr(question, "HZ_S", 0.2)
    few = question.Answer("Too few messages to measure a rate arrived within 0 s.", stopped=False)
    assert question.answer(["topic", "hz", "/a"], {}) == few
    stopped = question.answer(["topic", "list"], {})
    assert stopped.stopped
    assert "No message" not in stopped.output
