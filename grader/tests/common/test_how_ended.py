from __future__ import annotations

import pytest

from grader.common.how_ended import how_ended, program_ended


@pytest.mark.parametrize(
    ("code", "how"),
    [(0, "ended with exit code 0"), (2, "ended with exit code 2"), (-11, "was killed (SIGSEGV)")],
)
def test_a_return_code_says_how_a_process_ended(code: int, how: str) -> None:
    assert how_ended(code) == how


def test_a_signal_without_a_name_is_a_number() -> None:
    assert how_ended(-40) == "was killed (signal 40)"


def test_only_an_error_leads_to_the_lines_above() -> None:
    assert program_ended("draw_circle", 0) == "\ndraw_circle ended without an error."
    assert program_ended("draw_circle", 1).endswith("exit code 1. The lines above may show where and why.")
