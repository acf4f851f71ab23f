"""The search index for the pages: one entry for each section of each lesson."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from grader.book.markdown import PAGE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.book.lesson import Lesson

INDEX = "search.json"


def search_index(among: Sequence[Lesson]) -> str:
    """Return the sections as JSON: the page with the anchor, the lesson's title, the heading, and the text."""
    entries = [
        {
            "page": f"{lesson.id}/{PAGE}" + (f"#{section.anchor}" if section.anchor else ""),
            "lesson": f"{lesson.number} {lesson.title}",
            "title": section.title,
            "text": section.text,
        }
        for lesson in among
        for section in lesson.sections
    ]
    return json.dumps(entries, ensure_ascii=False, separators=(",", ":"))
