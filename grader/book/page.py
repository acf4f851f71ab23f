"""The page of a lesson, and the page with the list of all lessons."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.book.markdown import PAGE
from grader.report.escaped_template import fill

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.book.lesson import Lesson

ASSETS = Path(__file__).parent / "assets"
TITLE = "ROS 2 topics, graded by doing"
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; require-trusted-types-for 'script'; trusted-types 'none'"
)
"""The content security policy for pages on any web server. The pages load nothing from other sites."""


def lesson_page(lesson: Lesson, among: Sequence[Lesson], repository: str = "", policy: str = POLICY) -> str:
    """Return a lesson's page. `among` contains all lessons in order, and `repository` is the URL of the sources."""
    at = [each.id for each in among].index(lesson.id)
    return fill("lesson.html", lesson_values(lesson, among, at, repository, policy), ASSETS)


def lesson_values(
    lesson: Lesson, among: Sequence[Lesson], at: int, repository: str = "", policy: str = POLICY
) -> Mapping[str, object]:
    """Return the values for the template of a lesson. `at` is the index of the lesson among all lessons."""
    return {
        **_values(among, "../", repository, policy),
        "lesson": lesson,
        "contents": [section for section in lesson.sections if section.level == 2],
        "before": among[at - 1] if at else None,
        "after": among[at + 1] if at + 1 < len(among) else None,
    }


def contents_page(among: Sequence[Lesson], repository: str = "", policy: str = POLICY) -> str:
    """Return the page with the list of all lessons."""
    return fill("contents.html", contents_values(among, repository, policy), ASSETS)


def contents_values(among: Sequence[Lesson], repository: str = "", policy: str = POLICY) -> Mapping[str, object]:
    """Return the values for the template of the page with the list of all lessons."""
    return _values(among, "", repository, policy)


def _values(among: Sequence[Lesson], root: str, repository: str, policy: str) -> dict[str, object]:
    """Return the values that all pages need. `root` is the relative path from the page to the folder of the book."""
    return {
        "course": TITLE,
        "lessons": among,
        "root": root,
        "page": PAGE,
        "repository": repository.rstrip("/"),
        "policy": policy,
    }
