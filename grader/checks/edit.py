"""A small change that would fix a mistake in the files of a submission. The grader can test it in a copy."""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.submission.where import Where


@dataclass(frozen=True)
class Edit:
    """Replace `old` with `new` on a line of a file, or insert `new` before the line if `old` is empty.

    Lines are counted from 1.
    """

    file: str
    line: int
    old: str
    new: str


def at(where: Where | None, old: str, new: str) -> tuple[Edit, ...]:
    """Return a tuple with an edit of the line at `where`, or an empty tuple if the line is unknown."""
    return () if where is None or where.line is None else (Edit(where.file, where.line, old, new),)


def applied(files: Mapping[str, bytes], edits: Sequence[Edit]) -> dict[str, bytes] | None:
    """Return the files after all edits, or None if a file does not have the line or the text that an edit replaces."""
    changed = dict(files)
    # Edit from the last line to the first, so that an inserted line does not move the lines of later edits.
    for edit in sorted(edits, key=lambda each: -each.line):
        lines = changed.get(edit.file, b"").decode("utf-8", "surrogateescape").split("\n")
        if not 1 <= edit.line <= len(lines):
            return None
        if edit.old:
            new = _replaced(lines[edit.line - 1], edit)
            if new is None:
                return None
            lines[edit.line - 1] = new
        else:
            lines.insert(edit.line - 1, edit.new)
        changed[edit.file] = "\n".join(lines).encode("utf-8", "surrogateescape")
    return changed


def difference(before: Mapping[str, bytes], after: Mapping[str, bytes]) -> str:
    """Return the difference between two sets of files as a unified diff without context."""
    parts: list[str] = []
    for path in sorted(path for path in after if after[path] != before.get(path)):
        old, new = (files.get(path, b"").decode("utf-8", "replace").splitlines() for files in (before, after))
        parts += difflib.unified_diff(old, new, path, path, lineterm="", n=0)
    return "\n".join(parts)


def _replaced(line: str, edit: Edit) -> str | None:
    """Return the line with `edit.new` in place of the first `edit.old`, or None if the line has no `edit.old`.

    If possible, replace a whole name rather than part of a longer name.
    """
    begin = r"(?<![\w.])" if re.match(r"\w", edit.old) else ""
    end = r"(?!\w)" if re.search(r"\w$", edit.old) else ""
    found = re.search(begin + re.escape(edit.old) + end, line) or re.search(re.escape(edit.old), line)
    return None if found is None else line[: found.start()] + edit.new + line[found.end() :]
