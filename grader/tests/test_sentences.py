"""Each sentence of a report is expected by a test or a case, and another test or case has a near miss without it.

The sentences are the strings in grader/checks, except the titles and the documentation of kinds. A sentence is expected
if a test or a case contains some of its words. It has a near miss if these words are in a case that differs from a
correct package only by edits (the correct package passes, so its report has no such sentence), or in a test that also
judges evidence for which it expects other words or none.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.tests.case import CASES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

TESTS = Path(__file__).parent
CHECKS = TESTS.parent / "checks"
FEWEST_WORDS = 4
WORDS_IN_A_ROW = 3
"""A test expects a sentence if it contains this many successive words of it."""
PATTERN = re.compile(r"\\[wsdb(]|\(\?|\S\|\S|\.\*")
"""Marks a regular expression, which is not a sentence."""
NOT_IN_REPORTS = frozenset({"Kind", "string", "strings", "number", "choice", "names", "integer", "table", "whole"})
"""Functions whose strings describe a kind of check or its parameters."""
NOT_EITHER = frozenset(
    {"kind.py", "diagnoses.py", "diagnoses_of_catching.py", "diagnoses_of_files.py", "diagnoses_of_functions.py"}
)
"""Files whose sentences are only printed for authors. test_catalogue.py covers the diagnoses."""
KEEPS_AWAY = re.compile(r"\bnot in\b|\bfound: bool|== \"\"|\bis None\b|!=|\bnot \w|parametrize")
"""Marks a test that also judges evidence for which it expects other words or none."""
SAYS = re.compile(r"^(?:\[says\]\n(?P<says>.*?)(?=^\[|\Z)|never = (?P<never>\[.*?\])$)", re.DOTALL | re.MULTILINE)
EDGE = "\"'`()[]{},.:;\\"


def test_each_sentence_is_expected_by_a_test_or_a_case() -> None:
    assert lacking(expected()) == {}


def test_each_expected_sentence_has_a_near_miss() -> None:
    assert lacking(near()) == {}


@pytest.mark.parametrize(
    ("sentence", "known"),
    [
        ("The centre is twice as far away as it should be", True),
        ("A quick brown fox jumps over it", False),
        ("It has {} legs", False),
    ],
)
def test_a_sentence_is_known_by_three_words_in_a_row(sentence: str, *, known: bool) -> None:
    assert bool(rows(sentence) & rows_of("centre is twice as far away")) == known


def lacking(known: frozenset[str]) -> dict[str, list[str]]:
    """Map each file to its sentences of which no words are known. Files without such sentences are left out."""
    unknown = ((name, [each for each in found if not rows(each) & known]) for name, found in sentences().items())
    return {name: found for name, found in unknown if found}


@cache
def sentences() -> dict[str, list[str]]:
    """Return the sentences of each file. The values in an f-string are replaced by a line break."""
    return {
        f"{file.parent.name}/{file.name}": list(_sentences(file))
        for file in sorted(CHECKS.rglob("*.py"))
        if file.name not in NOT_EITHER
    }


@cache
def _descriptions() -> frozenset[str]:
    """Return the names of the constants that describe a parameter (`about=NAME`)."""
    trees = [ast.parse(file.read_text("utf-8")) for file in CHECKS.rglob("*.py")]
    keywords = (node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.keyword))
    return frozenset(node.value.id for node in keywords if node.arg == "about" and isinstance(node.value, ast.Name))


def _sentences(file: Path) -> Iterator[str]:
    waiting: list[ast.AST] = [ast.parse(file.read_text("utf-8"))]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Assign) and _descriptions() & {getattr(target, "id", "") for target in node.targets}:
            continue
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in NOT_IN_REPORTS:
            continue
        if isinstance(node, ast.Constant | ast.JoinedStr):
            text = _text(node)
            if _words(text) >= FEWEST_WORDS and not PATTERN.search(text):
                yield text
        if not isinstance(node, ast.JoinedStr):
            waiting += ast.iter_child_nodes(node)


def _words(text: str) -> int:
    return sum(re.search(r"[^\W\d_]{2}", word) is not None for word in text.split())


def _text(node: ast.Constant | ast.JoinedStr) -> str:
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    parts = (part.value for part in node.values if isinstance(part, ast.Constant))
    return "\n".join(part for part in parts if isinstance(part, str))


def rows(sentence: str) -> frozenset[str]:
    """Return each row of successive words of the sentence, or of a part between two values.

    If no part has enough words, the rows are shorter.
    """
    long, short = (
        frozenset().union(*(rows_of(part, count) for part in sentence.splitlines()))
        for count in (WORDS_IN_A_ROW, WORDS_IN_A_ROW - 1)
    )
    return long or short


def rows_of(text: str, count: int = WORDS_IN_A_ROW) -> frozenset[str]:
    """Return each row of successive words of a text, without the punctuation around the words."""
    words = [stripped for word in text.split() if (stripped := word.strip(EDGE))]
    return frozenset(map(" ".join, zip(*(words[at:] for at in range(count)), strict=False)))


def every_row(texts: Iterable[str]) -> frozenset[str]:
    """Return the rows of the usual length and the shorter ones."""
    return frozenset().union(
        *(rows_of(_joined(text), count) for text in texts for count in (WORDS_IN_A_ROW, WORDS_IN_A_ROW - 1))
    )


@cache
def expected() -> frozenset[str]:
    """Return the rows of words in the tests of checks, and in what the cases expect."""
    files = [*(TESTS / "checks").rglob("*.py"), *CASES.glob("*/expected.toml"), *(TESTS / "mistakes").glob("*/*.toml")]
    return every_row(file.read_text("utf-8") for file in files)


@cache
def near() -> frozenset[str]:
    """Return the rows of words for which a test or a case has a near miss."""
    found = [part for file in (TESTS / "checks").rglob("*.py") for part in _tests(file.read_text("utf-8"))]
    for file in (*CASES.glob("*/expected.toml"), *(TESTS / "mistakes").glob("*/expected.toml")):
        only_edits = not (file.parent / "files").exists() and not (file.parent / "make.py").exists()
        for match in SAYS.finditer(file.read_text("utf-8")):
            found += [match["never"] or ""] if match["never"] or not only_edits else [match["says"] or ""]
    return every_row(found)


def _tests(text: str) -> Iterator[str]:
    """Yield each test of a file that keeps words away, with its decorators."""
    for part in re.split(r"\n\n\n(?=@|def |class )", text):
        if "def test_" in part and KEEPS_AWAY.search(part):
            yield part


def _joined(text: str) -> str:
    return re.sub(r'"\s*\n\s*f?"', "", text)
