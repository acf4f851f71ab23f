"""The reasons why an answer is wrong, each with an answer that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_answer import why_list, why_unreadable

TRUTH = ("/draw_circle", "/turtlesim")


@pytest.mark.parametrize(
    ("line", "told"),
    [("motion_topic: /turtle1/cmd_vel", True), ("motion_topic = /turtle1/cmd_vel", False), ("a = [b: 1]", False)],
)
def test_a_colon_is_not_an_equals_sign(line: str, *, told: bool) -> None:
    why = why_unreadable(f"[answers]\n{line}\n".encode(), 2)
    assert ("This line has a colon after the name. In TOML, = is between the name and the answer." in why) == told
    assert ('Write a string in "quotation marks"' not in why) == told


@pytest.mark.parametrize("line", [None, 0, 9])
def test_a_line_that_does_not_exist_is_not_looked_at(line: int | None) -> None:
    assert "colon" not in why_unreadable(b"motion_topic: 1", line)


@pytest.mark.parametrize(
    ("given", "diagnosis", "words"),
    [
        (("/draw_circle, /turtlesim",), "wrong-list", "A string contains a comma, so it counts as one item."),
        (("draw_circle", "turtlesim"), "no-slash", "A full name starts with a slash."),
        (("draw_circle", "/turtlesim"), None, ""),
        (("draw_circle",), None, ""),
        ((), None, ""),
    ],
)
def test_the_form_of_the_items_is_told(given: tuple[str, ...], diagnosis: str | None, words: str) -> None:
    cause = why_list(given, TRUTH)
    assert (None if cause is None else cause.diagnosis) == diagnosis
    assert cause is None or cause.text.startswith(words)
