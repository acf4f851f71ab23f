"""Source code in coloured pieces, with the few CSS classes that the style sheet page.css defines."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

Piece = tuple[str, str]
"""A pair (class, text).

The CSS class is an empty string, or a class for which the page's style sheet defines a colour.
"""


def coloured(text: str, language: str = "python") -> list[list[Piece]]:
    """Return the pieces of each line. Code in a language that pygments does not support has no colours."""
    from pygments.lexers import get_lexer_by_name
    from pygments.util import ClassNotFound

    try:
        lexer = get_lexer_by_name(language, stripnl=False, ensurenl=False)
    except ClassNotFound:
        return [[("", line)] if line else [] for line in text.split("\n")]
    lines: list[list[Piece]] = [[]]
    for kind, part in lexer.get_tokens(text):
        for index, piece in enumerate(part.split("\n")):
            if index:
                lines.append([])
            if piece:
                lines[-1].append((_class(str(kind)), piece))
    return [list(_joined(line)) for line in lines]


def _class(token: str) -> str:
    """Return the style sheet's class for a pygments token type."""
    for name, kinds in (
        ("c", ("Token.Comment",)),
        ("s", ("Token.Literal.String",)),
        ("n", ("Token.Literal.Number",)),
        ("k", ("Token.Keyword", "Token.Operator.Word", "Token.Name.Tag")),
        ("d", ("Token.Name.Function", "Token.Name.Class", "Token.Name.Decorator")),
    ):
        if token.startswith(kinds):
            return name
    return ""


def _joined(line: list[Piece]) -> Iterator[Piece]:
    """Join neighbouring pieces of the same class, so that the browser gets fewer elements."""
    kind, text = "", ""
    for each, part in line:
        if each != kind and text:
            yield kind, text
            text = ""
        kind, text = each, text + part
    if text:
        yield kind, text
