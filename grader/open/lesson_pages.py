"""The pages and files that the server sends: lessons, contents, search index, pictures, style sheets and scripts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.book.lesson import LESSON, lessons
from grader.book.markdown import PAGE
from grader.book.page import ASSETS as BOOK
from grader.book.page import contents_values, lesson_values
from grader.book.search import INDEX, search_index
from grader.book.site import FOLDER, assets, pictures
from grader.exercise.model import catalogue
from grader.report.escaped_template import ASSETS as REPORT
from grader.report.escaped_template import fill
from grader.view.page_server import ASSETS as VIEW

if TYPE_CHECKING:
    from grader.book.lesson import Lesson

OWN = Path(__file__).parent / "assets"


class LessonPages:
    """Finds the content for the path of a request. The path of a request is never used as a path on the disk."""

    def __init__(self) -> None:
        self._read: tuple[object, list[Lesson]] = (None, [])
        shared = [*VIEW.glob("*.js"), VIEW / "simulator.css", REPORT / "player.js"]
        own = [file for file in OWN.iterdir() if file.suffix in (".js", ".css")]
        self._assets = {f"{FOLDER}/{name}": file for name, file in assets().items()}
        self._assets |= {f"{FOLDER}/{file.name}": file for file in [*shared, *own]}

    def find(self, path: str) -> str | Path | None:
        """Return the text of a page or of the search index, the path of a file, or None if the path is unknown."""
        if path in self._assets:
            return self._assets[path]
        among = self._lessons()
        if path == PAGE:
            return fill("open_contents.html", contents_values(among, policy=""), OWN, BOOK)
        if path == INDEX:
            return search_index(among)
        for at, lesson in enumerate(among):
            if path == f"{lesson.id}/{PAGE}":
                return fill("open.html", lesson_values(lesson, among, at, policy=""), OWN, BOOK)
        return pictures(among).get(path)

    def _lessons(self) -> list[Lesson]:
        """Return the lessons. If a file has changed, the lessons are read again."""
        files = [file.parent / LESSON for file in catalogue().values()]
        stamp = [(file, file.stat().st_mtime_ns) for file in files if file.is_file()]
        if stamp != self._read[0]:
            self._read = (stamp, lessons())
        return self._read[1]
