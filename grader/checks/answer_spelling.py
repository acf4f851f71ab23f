"""Compare a student's answers with the right answers, whatever their capitals, spaces and final punctuation."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection

QUOTATION_MARKS = {'"': '"', "'": "'", "`": "`", "“": "”", "„": "“", "\u2018": "\u2019", "«": "»"}
"""Maps each opening quotation mark to its closing one."""
FINAL = frozenset(".,;!")
"""The punctuation that may follow an answer."""


def plain(answer: str) -> str:
    """Return the answer in lower case, with single spaces between its words."""
    return " ".join(answer.lower().split())


def bare(answer: str) -> str:
    """Return the answer without spaces and quotation marks around it, and without final punctuation.

    A full stop that may be a part of the answer stays, as in `2.`, `cd .` or `install/..`.
    """
    text = answer.strip()
    while True:
        if len(text) > 1 and QUOTATION_MARKS.get(text[0]) == text[-1]:
            shorter = text[1:-1].strip()
        elif len(text) > 1 and text[-1] in FINAL and not _belongs(text):
            shorter = text[:-1]
        else:
            return text
        text = shorter


def matching(answer: str, right: Collection[str]) -> str:
    """Return the answer as in `plain`, also without its punctuation if only this makes it one of the right answers."""
    accepted = {plain(each) for each in right}
    return next((each for each in (plain(answer), plain(bare(answer))) if each in accepted), plain(answer))


def _belongs(text: str) -> bool:
    """Return whether the last character may be a part of the answer: of a number, a path or a command."""
    return text[-2].isspace() or text[-2] in "./" or text[:-1].lstrip("+-").isdigit()
