"""Each sentence that explains a cause is expected by a test or a case, by some of its words.

The sentences are the strings in grader/checks/causes. A string whose words no test and no case expects is not tested,
and must be listed in `NOT_EXPECTED` with the file that contains it. The list may only become shorter.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

from grader.tests.case import CASES

TESTS = Path(__file__).parent
CAUSES = TESTS.parent / "checks" / "causes"
FEWEST_WORDS = 4
WORDS_IN_A_ROW = 3
"""A test expects a sentence if it contains this many successive words of it."""
PATTERN = re.compile(r"\\[wsdb(]|\(\?|\S\|\S|\.\*")
"""Marks a regular expression, which is not a sentence."""
NOT_EXPECTED = {
    "no_entry_point.py": 1,
    "weak_tests.py": 2,
    "why_fit.py": 3,
    "why_killed.py": 1,
    "why_no_goal.py": 4,
    "why_no_test.py": 3,
    "why_not_caught.py": 2,
    "why_other_object.py": 1,
    "why_rejected.py": 4,
    "why_unasked.py": 1,
}
"""Maps a file of the causes to the number of its sentences that no test and no case expects."""


def test_each_sentence_is_expected_by_a_test_or_a_case() -> None:
    missing = {file.name: [each for each in sentences(file) if not is_expected(each)] for file in CAUSES.glob("*.py")}
    new = {name: found for name, found in missing.items() if len(found) > NOT_EXPECTED.get(name, 0)}
    assert new == {}


def sentences(file: Path) -> list[str]:
    """Return the strings of a module that are sentences. The values in an f-string are replaced by a line break."""
    tree = ast.parse(file.read_text("utf-8"))
    nodes = list(ast.walk(tree))
    parts = {id(part) for node in nodes if isinstance(node, ast.JoinedStr) for part in ast.walk(node)} - {
        id(node) for node in nodes if isinstance(node, ast.JoinedStr)
    }
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    strings = [
        node for node in nodes if isinstance(node, ast.Constant | ast.JoinedStr) and id(node) not in parts | docstrings
    ]
    return [each for each in map(_text, strings) if _words(each) >= FEWEST_WORDS and not PATTERN.search(each)]


def _words(text: str) -> int:
    return sum(re.search(r"[^\W\d_]{2}", word) is not None for word in text.split())


def _text(node: ast.Constant | ast.JoinedStr) -> str:
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    return "\n".join(
        part.value for part in node.values if isinstance(part, ast.Constant) and isinstance(part.value, str)
    )


def is_expected(sentence: str) -> bool:
    """Return whether some test or case contains successive words of the sentence."""
    for part in sentence.splitlines():
        words = part.split()
        rows = [" ".join(words[at : at + WORDS_IN_A_ROW]) for at in range(max(1, len(words) - WORDS_IN_A_ROW + 1))]
        if any(
            len(row.split()) >= min(WORDS_IN_A_ROW, len(words)) and len(row) > FEWEST_WORDS and row in expected()
            for row in rows
        ):
            return True
    return False


@cache
def expected() -> str:
    """Return the text of the checks' tests, and the words that the cases expect."""
    files = [*(TESTS / "checks").rglob("*.py"), *CASES.glob("*/expected.toml"), *(TESTS / "mistakes").glob("*/*.toml")]
    text = "\n".join(file.read_text("utf-8") for file in files)
    return re.sub(r'"\s*\n\s*f?"', "", text)
