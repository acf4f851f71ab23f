"""Write the lessons as static pages for any web server."""

from __future__ import annotations

from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from grader.book.lesson import lessons
from grader.book.markdown import PAGE
from grader.book.page import ASSETS, contents_page, lesson_page
from grader.book.search import INDEX, search_index
from grader.errors import UsageError
from grader.report.escaped_template import ASSETS as REPORT_ASSETS
from grader.report.output_file import not_written

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.book.lesson import Lesson

VIEW_ASSETS = Path(__file__).parents[1] / "view/assets"
FOLDER = "assets"
"""The folder in the book that contains the style sheets and scripts."""


def write_book(out: Path, repository: str = "") -> int:
    """Write all pages to the folder `out`. Return the number of lessons. Existing files are replaced.

    Raises:
        UsageError: `out` is not a folder, or cannot be written.
        MachineError: a lesson cannot be read, the disk is full, or the machine failed in another way.
    """
    among = lessons()
    if out.exists() and not out.is_dir():
        message = f"{out} is a file. Choose a folder for the pages."
        raise UsageError(message)
    for path, content in _files(among, repository):
        file = out / path
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        except OSError as error:
            raise not_written(file, error) from error
    return len(among)


def assets() -> dict[str, Path]:
    """Return the style sheets, scripts and pictures of the pages by name. Templates are omitted."""
    files = [REPORT_ASSETS / "page.css", VIEW_ASSETS / "turtle.svg", VIEW_ASSETS / "svg.js", *sorted(ASSETS.iterdir())]
    return {file.name: file for file in files if file.suffix in (".css", ".js", ".svg")}


def pictures(among: Sequence[Lesson]) -> dict[str, Path]:
    """Return the pictures of the lessons by their paths in the book. Only pictures inside course/ are included."""
    found = {}
    for lesson in among:
        course = lesson.folder.parent.resolve()
        for picture in lesson.pictures:
            file = (lesson.folder / picture).resolve()
            if file.is_relative_to(course) and file.is_file():
                found[str(PurePosixPath(file.relative_to(course)))] = file
    return found


def _files(among: Sequence[Lesson], repository: str) -> Iterator[tuple[str, bytes]]:
    yield PAGE, contents_page(among, repository).encode()
    yield INDEX, search_index(among).encode()
    for lesson in among:
        yield f"{lesson.id}/{PAGE}", lesson_page(lesson, among, repository).encode()
    for name, file in assets().items():
        yield f"{FOLDER}/{name}", file.read_bytes()
    for path, file in pictures(among).items():
        yield path, file.read_bytes()
