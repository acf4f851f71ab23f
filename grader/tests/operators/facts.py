"""Judge whether a report names a mistake and makes no false statement, without the tables of diagnoses.

The only inputs are the difference between the correct and the wrong package, the source of the wrong package, and its
recording. An outcome names the mistake in two cases: the outcome refers to a changed line and mentions a changed word
of this line; or it refers to a line with a name that was replaced elsewhere, and mentions the old and the new name. A
statement is false if it contradicts a fact about these inputs: sentences.py recognizes each form of sentence and
decides whether it is true.
"""

from __future__ import annotations

import difflib
import re
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence
    from grader.submission.where import Where

WORD = re.compile(r"[A-Za-z_]\w*|\d+(?:\.\d+)?|[^\w\s]")
COMMON = frozenset({"self", "msg", "my_robot_controller", "py", "def", "import", "from", "name", "node"})
"""Words that occur on too many lines to identify a change."""
SIGNS = {
    ":": "colon",
    ",": "comma",
    **dict.fromkeys("()[]{}", "parenthes|bracket|call"),
    '"': "quot|string|special|typographic",
    **dict.fromkeys("\u201c\u201d", "character"),
    **dict.fromkeys("<>", "tag|comment|Git"),
    "'": "quot|string",
    ".": "dot|module",
    "=": "=|value|compare",
    "#": "comment",
    "-": "negative|sign|backwards|Line|two under",
    "/": "slash|path|divided|closing tag",
    "&": "&|and|read",
    "f": "f-string",
}
"""Maps a changed character to a pattern for the words that may refer to it."""


@dataclass(frozen=True)
class Hunk:
    """Lines of the correct package, and the lines that replace them from line `line` on (or a `moved` file)."""

    file: str
    old: tuple[str, ...]
    new: tuple[str, ...]
    line: int
    moved: bool = False

    def is_at(self, where: Where) -> bool:
        """Return whether a message about this line points to the change (any line if lines were removed)."""
        removed = Counter(WORD.findall("\n".join(self.old))) - Counter(WORD.findall("\n".join(self.new)))
        opened_elsewhere = bool(removed) and set(removed) <= set("()[]{}")
        only_removed = not "".join(self.new).replace("pass", "").strip()
        if self.moved or (where.file == self.file and (only_removed or opened_elsewhere)):
            return True
        return where.file == self.file and (where.line is None or 0 <= where.line - self.line < len(self.new))

    def is_body_below(self, where: Where) -> bool:
        """Return whether the change only removed lines directly below this line."""
        return where.file == self.file and not "".join(self.new).strip() and where.line == self.line - 1

    def is_in(self, text: str) -> bool:
        """Return whether a string mentions the change."""
        before, after = (Counter(WORD.findall("\n".join(lines))) for lines in (self.old, self.new))
        words = {*(before - after), *(after - before)}
        if self.moved:
            return any(word in text for word in re.findall(r"\w{3,}", self.file))
        if not words:  # only the indentation or the order was changed
            return bool(re.search(r"indent|inside|outside|tabs|block|swapped|order|[Ll]ine", text))
        around = {word for word in after if len(word) > 2} - COMMON
        return any(_speaks_of(word, text) for word in words | around)


def _speaks_of(word: str, text: str) -> bool:
    if word in SIGNS:
        return bool(re.search(SIGNS[word], text))
    if word[0].isdigit():
        return float(word) in {float(each) for each in re.findall(r"\d+(?:\.\d+)?", text)}
    return bool(re.search(rf"(?<![A-Za-z]){re.escape(word)}(?![A-Za-z])", text))


@dataclass(frozen=True)
class Facts:
    """A correct package, the wrong package derived from it, and the evidence about the wrong package."""

    right: Mapping[str, str]
    wrong: Mapping[str, str]
    evidence: Evidence

    @cached_property
    def changes(self) -> tuple[Hunk, ...]:
        """Return the changed places."""
        found: list[Hunk] = []
        for path in sorted(self.right.keys() | self.wrong.keys()):
            old, new = (files.get(path, "").split("\n") for files in (self.right, self.wrong))
            moved = (path in self.right) != (path in self.wrong)
            for tag, i, j, begin, end in difflib.SequenceMatcher(a=old, b=new, autojunk=False).get_opcodes():
                if tag == "replace" and j - i == end - begin:  # one hunk per line
                    lines = zip(old[i:j], new[begin:end], strict=True)
                    found += [Hunk(path, (was,), (now,), begin + 1 + at) for at, (was, now) in enumerate(lines)]
                elif tag != "equal" or moved:
                    found.append(Hunk(path, tuple(old[i:j]), tuple(new[begin:end]), begin + 1, moved))
        return tuple(found)

    @cached_property
    def changed(self) -> frozenset[str]:
        """Return the changed files."""
        return frozenset(change.file for change in self.changes)

    @cached_property
    def words(self) -> tuple[Counter[str], Counter[str]]:
        """Return the removed and the added words and characters."""
        both = [Counter[str](), Counter[str]()]
        for path in self.changed:
            for words, files, others in ((both[0], self.right, self.wrong), (both[1], self.wrong, self.right)):
                words.update(Counter(WORD.findall(files.get(path, ""))) - Counter(WORD.findall(others.get(path, ""))))
            if (path in self.right) != (path in self.wrong):
                (both[0] if path in self.right else both[1]).update(re.findall(r"\w+", path))
        return both[0], both[1]

    @cached_property
    def source(self) -> str:
        """Return the Python files of the wrong package's node without comments."""
        used = {module.file for module in self.evidence.code.modules}
        files = (text for path, text in self.wrong.items() if path in used)
        return "\n".join(re.sub(r"(?m)#.*$", "", text) for text in files)

    def line(self, outcome: Outcome, number: int) -> str:
        """Return the line with this number in the file to which an outcome refers."""
        where = outcome.finding.where
        lines = self.wrong.get(where.file, "").splitlines() if where is not None else []
        return lines[number - 1] if 0 < number <= len(lines) else ""

    def names(self, outcome: Outcome) -> bool:
        """Return whether an outcome refers to a change and mentions what was changed."""
        where = outcome.finding.where
        text = f"{outcome.finding.observed} {outcome.finding.cause}"
        return where is not None and any(
            (change.is_at(where) and change.is_in(text))
            or self._uses_old_name(where, change, text)
            or (change.is_body_below(where) and "no body" in text)
            for change in self.changes
        )

    def _uses_old_name(self, where: Where, change: Hunk, text: str) -> bool:
        """Return whether the line uses a name that the change replaced, and the text mentions both names."""
        lines = self.wrong.get(where.file, "").split("\n")
        line = lines[where.line - 1] if where.line is not None and where.line <= len(lines) else ""
        old, new = (set(re.findall(r"[A-Za-z_]\w+", "\n".join(each))) for each in (change.old, change.new))
        used = {word for word in old - new if re.search(rf"\b{word}\b", line) and _speaks_of(word, text)}
        return bool(used) and any(_speaks_of(word, text) for word in new - old)
