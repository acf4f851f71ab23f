"""A lesson as data: the title, HTML, sections and pictures of a lesson.md."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from grader.book.figures import FIGURES
from grader.book.markdown import rendered
from grader.errors import MachineError
from grader.exercise.model import catalogue

if TYPE_CHECKING:
    from pathlib import Path

    from grader.book.markdown import Section

LESSON = "lesson.md"


@dataclass(frozen=True)
class Lesson:
    """The lesson of a step. `body` is HTML without the title. `pictures` are paths relative to the lesson's folder."""

    id: str
    title: str
    body: Markup
    sections: tuple[Section, ...]
    pictures: tuple[str, ...]
    folder: Path

    @property
    def number(self) -> str:
        """The number of the step, such as "03"."""
        return self.id.partition("-")[0]


def lesson_of(folder: Path) -> Lesson:
    """Read the lesson from the folder of a step.

    Raises:
        MachineError: the file cannot be read.
    """
    file = folder / LESSON
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        detail = error.strerror if isinstance(error, OSError) else str(error)
        message = f"The lesson {file} cannot be read: {detail}."
        raise MachineError(message) from error
    made = rendered(text, FIGURES.get(folder.name))
    title = re.sub(r"^Step \d+: ", "", made.title)
    title = title[:1].upper() + title[1:]
    return Lesson(folder.name, title, Markup(made.html), made.sections, made.pictures, folder)


def lessons(course: Path | None = None) -> list[Lesson]:
    """Return the lessons of all steps that have one, in order.

    Raises:
        MachineError: a file cannot be read.
    """
    return [lesson_of(file.parent) for file in catalogue(course).values() if (file.parent / LESSON).is_file()]
