"""Points through which no circle can be fitted are refused with a ValueError that has a message."""

from __future__ import annotations

import pytest

from grader.tests.checks.bag_step import IMPORT, judged, raised
from grader.tests.checks.told import told
from grader.trial.called import TOO_LATE, Called


@pytest.mark.parametrize(
    ("called", "diagnosis"),
    [
        (raised("too-few", "ValueError: too few", "ValueError Exception"), None),
        (raised("too-few", "ValueError", "ValueError Exception"), "empty-error"),
        (raised("too-few", "numpy.linalg.LinAlgError: singular", "LinAlgError ValueError Exception"), None),
        (raised("too-few", "RuntimeError: too few", "RuntimeError Exception"), "other-error"),
        (Called("too-few", "exit 1"), "other-error"),
        (Called("too-few", "exit 0", kind="NoneType"), "no-error"),
        (Called("too-few", TOO_LATE), "call-too-long"),
    ],
)
def test_two_points_are_refused(called: Called, diagnosis: str | None) -> None:
    assert judged("too-few", called).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        (
            "fit_circle raises ValueError without a message.",
            raised("too-few", "ValueError", "ValueError Exception"),
            raised("too-few", "ValueError: too few", "ValueError Exception"),
        ),
        (
            "The argument of ValueError is the message, which says what is wrong with the points.",
            raised("too-few", "ValueError", "ValueError Exception"),
            raised("too-few", "ValueError: too few", "ValueError Exception"),
        ),
        (
            "fit_circle raises ValueError: too few.",
            raised("too-few", "ValueError: too few", "ValueError Exception"),
            raised("too-few", "RuntimeError: too few", "RuntimeError Exception"),
        ),
        (
            "fit_circle raises ValueError for x = [1.0, 2.0] and y = [1.0, 3.0], with a message that explains why.",
            Called("too-few", "exit 0", kind="NoneType"),
            raised("too-few", "ValueError: too few", "ValueError Exception"),
        ),
        (
            "The caller expects ValueError, and cannot know what another exception means.",
            raised("too-few", "RuntimeError: too few", "RuntimeError Exception"),
            Called("too-few", "exit 1"),
        ),
        ("fit_circle ended the program (exit 1).", Called("too-few", "exit 1"), Called("too-few", "exit 0")),
        ("sys.exit ends the whole program.", Called("too-few", "exit 1"), Called("too-few", "signal 11")),
        (
            "fit_circle returned None.",
            Called("too-few", "exit 0", kind="NoneType"),
            Called("too-few", "exit 0", kind="str"),
        ),
    ],
)
def test_a_sentence_about_refused_points_is_true(words: str, true: Called, near: Called) -> None:
    assert words in told(judged("too-few", true))
    assert words not in told(judged("too-few", near))


def test_an_import_that_raises_a_value_error_refuses_nothing() -> None:
    error = Called("too-few", "exit 1", stderr=f"{IMPORT}ValueError: no", kind="ValueError Exception")
    assert "The import of fit_circle raised ValueError: no." in told(judged("too-few", error))
    assert "The caller expects ValueError" not in told(judged("too-few", error))


def test_a_name_that_does_not_exist_rejects_no_points() -> None:
    """The exception is a mistake in the code, so the sentence about the caller would be misleading."""
    finding = judged("too-few", raised("too-few", "NameError: name 'np' is not defined", "NameError Exception"))
    assert finding.observed == "fit_circle raised NameError: name 'np' is not defined."
    assert "The caller expects ValueError" not in told(finding)
    assert finding.diagnosis != "other-error"
