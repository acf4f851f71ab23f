"""Mistakes in the words of a command line that word processors and web pages cause, and paths with missing quotes."""

# ruff: noqa: RUF001, RUF002 - these are the characters to find

from __future__ import annotations

import os
import re
import shlex
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

DASHES = "-‐‑‒–—―−﹣－"
_WITH_DASH = re.compile(f"[{re.escape(DASHES)}]+[A-Za-z][\\w-]*(=\\S*)?")
_MOST_PARTS = 12
"""The maximum number of words that are joined to one path."""
_OPENING = "“„”‘‚’«»"
_CLOSING = "”“’‘»«"


def slip(command: str, words: Sequence[str], options: Collection[str]) -> str:
    """Return a message about a typographic dash, typographic quotation marks or a path without quotes, or "".

    `words` are the words after `command`, and `options` are its options, such as "--html". The message ends with the
    command line that works.

    Example:
        >>> slip("grader check", ["–html", "x.html"], ["--html"]).partition("Type: ")[2]
        'grader check --html x.html'
    """
    fixed = [_option(word, options) or word for word in words]
    if fixed != list(words):
        first = next(word for word, right in zip(words, fixed, strict=True) if word != right)
        return (
            f"{first.partition('=')[0]} begins with a typographic dash, as word processors and web pages write it. "
            f"Options begin with minus signs. Type: {_line(command, fixed)}"
        )
    fixed = _without_quotes(words)
    if fixed != list(words):
        return (
            "The quotation marks are typographic, as word processors and web pages write them, and the shell does not "
            f"know them. Type: {_line(command, fixed)}"
        )
    fixed = _joined(words)
    if fixed != list(words):
        return f"A path with spaces needs quotation marks. Type: {_line(command, fixed)}"
    return ""


def hint(words: Sequence[str]) -> str:
    """Return a sentence about such a mistake in the words of a command that has failed, or "".

    In contrast to `slip`, the options of the command are not known. A value in braces without quotation marks counts,
    too.

    Example:
        >>> hint(["topic", "list", "–t"])
        '–t begins with a typographic dash. Type: -t'
    """
    for word in words:
        if _WITH_DASH.fullmatch(word) and _has_typographic_dash(word):
            return f"{word} begins with a typographic dash. Type: {_with_minus_signs(word)}"
    straight = _without_quotes(words)
    if straight != list(words):
        changed = next(new for new, old in zip(straight, words, strict=False) if new != old)
        return f"The quotation marks are typographic. Type straight ones: {shlex.quote(changed)}"
    return next((f"A value with spaces needs quotation marks. Type: {shlex.quote(each)}" for each in _split(words)), "")


def _split(words: Sequence[str]) -> Iterator[str]:
    """Yield each value that begins with a brace and that is spread over several words, joined by spaces."""
    for first, word in enumerate(words):
        for last in range(first + 1, len(words) if word.startswith("{") and _open_braces(word) > 0 else 0):
            whole = " ".join(words[first : last + 1])
            if _open_braces(whole) == 0:
                yield whole
                break


def _open_braces(text: str) -> int:
    return text.count("{") - text.count("}")


def _line(command: str, words: Sequence[str]) -> str:
    return f"{command} {shlex.join(words)}"


def _option(word: str, options: Collection[str]) -> str:
    """Return the option that a word with typographic dashes stands for, or "" if it stands for none."""
    if not _has_typographic_dash(word):
        return ""
    option = _with_minus_signs(word)
    return option if option.partition("=")[0] in options and not _exists(word) else ""


def _has_typographic_dash(word: str) -> bool:
    """Return whether the dashes at the beginning of the word are not only minus signs."""
    return word[: len(word) - len(word.lstrip(DASHES))].strip("-") != ""


def _with_minus_signs(word: str) -> str:
    name = word.lstrip(DASHES)
    return f"--{name}" if len(name.partition("=")[0]) > 1 else f"-{name}"


def _without_quotes(words: Sequence[str]) -> list[str]:
    """Return the words with the typographic quotation marks removed. The words between two of them become one."""
    for first, opening in enumerate(words):
        if not opening or opening[0] not in _OPENING or _exists(opening):
            continue
        for last in range(first, len(words)):
            whole = " ".join(words[first : last + 1])
            if len(whole) > 2 and whole[-1] in _CLOSING:
                # The shell does not replace ~ after such a quotation mark, or between the quotation marks of a shell.
                inner = os.path.expanduser(whole[1:-1])  # noqa: PTH111 - Path.expanduser can raise RuntimeError
                return [*words[:first], inner, *_without_quotes(words[last + 1 :])]
    return list(words)


def _joined(words: Sequence[str]) -> list[str]:
    """Return the words, with the words of a path that exists if they are joined by spaces as one word."""
    there = [_exists(word) for word in words]
    if all(there):  # such as the many paths of submissions/*
        return list(words)
    for first in range(len(words)):
        for last in range(min(len(words), first + _MOST_PARTS), first + 1, -1):
            whole = " ".join(words[first:last])
            if not all(there[first:last]) and _exists(whole):
                return [*words[:first], whole, *words[last:]]
    return list(words)


def _exists(path: str) -> bool:
    # In contrast to Path.exists, this function raises no error if the path is too long.
    return os.path.exists(path)  # noqa: PTH110
