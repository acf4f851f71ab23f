"""`%lesson` shows a step's lesson in a notebook in any folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

from grader.exercise.model import catalogue, course_folder
from grader.notebook.cells import Cells
from grader.notebook.lesson import pieces

if TYPE_CHECKING:
    from collections.abc import Iterator

STEP = "03-circle-publisher"
LESSON = course_folder() / STEP / "lesson.md"


@pytest.mark.parametrize("step", catalogue())
def test_a_lesson_is_complete_and_has_no_broken_links(step: str) -> None:
    found = pieces(course_folder() / step / "lesson.md")
    assert all(piece.is_file() for piece in found if isinstance(piece, Path))
    text = "".join(piece for piece in found if isinstance(piece, str))
    assert ".md)" not in text
    assert "](../" not in text
    whole = (course_folder() / step / "lesson.md").read_text("utf-8")
    assert len(text) > 0.9 * len(whole)


@pytest.fixture
def shell() -> Iterator[InteractiveShell]:
    yield InteractiveShell.instance()  # type: ignore[no-untyped-call, unused-ignore]
    InteractiveShell.clear_instance()


def test_the_magic_shows_text_and_pictures(
    shell: InteractiveShell,  # noqa: ARG001
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    with capture_output() as shown:  # type: ignore[no-untyped-call, unused-ignore]
        Cells().lesson(STEP)
    assert LESSON.read_text("utf-8").splitlines()[0] in shown.outputs[0].data["text/markdown"]
    assert sum("image/png" in output.data for output in shown.outputs) == 1
